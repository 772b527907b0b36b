// The display haptex/Contact of rviz.
#pragma once

#include <haptex/Contact.h>
#include <rviz/display.h>

#include <Eigen/Core>
#include <memory>
#include <optional>

#include "haptex/base/finger.h"
#include "haptex/rviz_plugin/background_subscriptions.h"
#include "haptex/rviz_plugin/force_arrow.h"
#include "haptex/rviz_plugin/overlay_picture.h"

namespace rviz {
class BoolProperty;
}  // namespace rviz

namespace haptex::rviz_plugin {

/// The forces on both fingertips (<finger>/contact) as arrows with numbers, before the hand and the
/// cloth, and the colour bar of the patch and its contact points (contact/markers).
class ContactDisplay : public rviz::Display {
 public:
  ContactDisplay();
  ~ContactDisplay() override;

  void update(float wall_dt, float ros_dt) override;
  void reset() override;

 protected:
  void onInitialize() override;
  void onEnable() override;
  void onDisable() override;

 private:
  void subscribe();
  void receive(base::Finger finger, const haptex::Contact& contact);
  void hide();
  void showLegend();
  std::optional<Eigen::Vector2i> placeOf(const Eigen::Vector3d& point) const;
  void showLabels();

  rviz::BoolProperty* legend_wanted_;
  base::PerFinger<std::unique_ptr<ForceArrow>> arrows_;
  base::PerFinger<std::unique_ptr<OverlayPicture>> labels_;
  std::unique_ptr<OverlayPicture> legend_;
  BackgroundSubscriptions subscriptions_;  // last: its callbacks use the members above
};

}  // namespace haptex::rviz_plugin
