// The display haptex/Cloth of rviz.
#pragma once

#include <haptex/ClothMesh.h>
#include <haptex/ClothState.h>

#include <cstddef>
#include <memory>
#include <optional>

#include "haptex/nodes/rviz_plugin/cloth_surface.h"
#include "haptex/nodes/rviz_plugin/fabric_looks.h"
#include "haptex/nodes/rviz_plugin/live_display.h"
#include "haptex/nodes/rviz_plugin/overlay_picture.h"
#include "haptex/nodes/rviz_plugin/surface_object.h"

namespace rviz {
class BoolProperty;
class EnumProperty;
class FloatProperty;
class StringProperty;
}  // namespace rviz

namespace haptex::nodes {

/// Draws cloth/mesh and cloth/state, coloured by strain, stress, contact force, fabric or panel,
/// with a legend over the view, or as its fabrics look. The newest state is read once per frame of
/// rviz, older ones are not read at all. What is refused is said in the display's status, and what
/// was shown before stays.
class ClothDisplay : public LiveDisplay {
 public:
  ClothDisplay();
  ~ClothDisplay() override;

 protected:
  void onInitialize() override;
  bool addTopics() override;
  void forget() override;
  void refresh() override;

 private:
  void addProperties();
  void receive(const haptex::ClothMeshConstPtr& mesh);
  void rebuild();
  void restyle();
  void draw();
  void recolour();
  void showLegend();
  void takeLooks();
  ColourBy colourBy() const;
  std::optional<Eigen::Vector3d> eye() const;

  rviz::StringProperty* topics_;
  rviz::EnumProperty* colour_by_;
  rviz::StringProperty* btf_folder_;
  rviz::FloatProperty* full_scale_;
  rviz::BoolProperty* wireframe_;
  rviz::BoolProperty* grain_lines_;
  rviz::BoolProperty* self_shadow_;
  rviz::FloatProperty* opacity_;
  rviz::BoolProperty* legend_wanted_;

  haptex::ClothMeshConstPtr mesh_;    // the last that was not refused, or none
  haptex::ClothStateConstPtr state_;  // the newest, or none
  bool state_is_new_ = false;
  std::optional<Eigen::Vector3d> eye_;     // what was drawn is darkened for
  std::unique_ptr<ClothSurface> surface_;  // of mesh_
  FabricLooks looks_;
  std::size_t looks_read_ = 0;  // of the fabrics of mesh_, that surface_ has
  std::unique_ptr<SurfaceObject> object_;
  std::unique_ptr<OverlayPicture> legend_;
};

}  // namespace haptex::nodes
