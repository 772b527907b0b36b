// The display haptex/Contact of rviz.
#pragma once

#include <haptex/Contact.h>

#include <Eigen/Core>
#include <memory>
#include <optional>

#include "haptex/base/finger.h"
#include "haptex/nodes/rviz_plugin/force_arrow.h"
#include "haptex/nodes/rviz_plugin/live_display.h"
#include "haptex/nodes/rviz_plugin/overlay_picture.h"

namespace rviz {
class BoolProperty;
}  // namespace rviz

namespace haptex::nodes {

/// The forces on both fingertips (<finger>/contact) as arrows with numbers, before the hand and the
/// cloth, and the colour bar of the patch and its contact points (contact/markers).
class ContactDisplay : public LiveDisplay {
 public:
  ContactDisplay();
  ~ContactDisplay() override;

 protected:
  void onInitialize() override;
  bool addTopics() override;
  void forget() override;
  void refresh() override;

 private:
  void receive(base::Finger finger, const haptex::Contact& contact);
  void showLegend();
  std::optional<Eigen::Vector2i> placeOf(const Eigen::Vector3d& point) const;

  rviz::BoolProperty* legend_wanted_;
  base::PerFinger<std::unique_ptr<ForceArrow>> arrows_;
  base::PerFinger<std::unique_ptr<OverlayPicture>> labels_;
  std::unique_ptr<OverlayPicture> legend_;
};

}  // namespace haptex::nodes
