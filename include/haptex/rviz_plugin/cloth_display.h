// The display haptex/Cloth of rviz.
#pragma once

#include <haptex/ClothMesh.h>
#include <haptex/ClothState.h>
#include <rviz/display.h>

#include <map>
#include <memory>
#include <string>
#include <utility>

#include "haptex/rviz_plugin/background_subscriptions.h"
#include "haptex/rviz_plugin/cloth_surface.h"
#include "haptex/rviz_plugin/overlay_picture.h"
#include "haptex/rviz_plugin/surface_object.h"

namespace rviz {
class BoolProperty;
class EnumProperty;
class FloatProperty;
class StringProperty;
}  // namespace rviz

namespace haptex::rviz_plugin {

/// Draws cloth/mesh and cloth/state, coloured by strain, stress, contact force, fabric or panel,
/// with a legend over the view. The newest state is read once per frame of rviz, older ones are not
/// read at all. What is refused is said in the display's status, and what was shown before stays.
class ClothDisplay : public rviz::Display {
 public:
  ClothDisplay();
  ~ClothDisplay() override;

  void update(float wall_dt, float ros_dt) override;
  void reset() override;

 protected:
  void onInitialize() override;
  void onEnable() override;
  void onDisable() override;

 private:
  void addProperties();
  void subscribe();
  void forget();
  void receive(const haptex::ClothMeshConstPtr& mesh);
  void rebuild();
  void restyle();
  void draw();
  void place(const std_msgs::Header& header);
  void showLegend();
  ColourBy colourBy() const;
  void refuse(const std::string& what, const std::string& why);
  void say(const std::string& what, rviz::StatusProperty::Level level, const std::string& text);

  rviz::StringProperty* topics_;
  rviz::EnumProperty* colour_by_;
  rviz::FloatProperty* full_scale_;
  rviz::BoolProperty* wireframe_;
  rviz::BoolProperty* grain_lines_;
  rviz::FloatProperty* opacity_;
  rviz::BoolProperty* legend_wanted_;

  haptex::ClothMeshConstPtr mesh_;    // the last that was not refused, or none
  haptex::ClothStateConstPtr state_;  // the newest, or none
  bool state_is_new_ = false;
  std::map<std::string, std::pair<int, std::string>> said_;  // level and text of each status
  std::unique_ptr<ClothSurface> surface_;                    // of mesh_
  std::unique_ptr<SurfaceObject> object_;
  std::unique_ptr<OverlayPicture> legend_;
  BackgroundSubscriptions subscriptions_;  // last: its callbacks use the members above
};

}  // namespace haptex::rviz_plugin
