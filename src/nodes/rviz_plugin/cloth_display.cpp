#include "haptex/nodes/rviz_plugin/cloth_display.h"

#include <OGRE/OgreCamera.h>
#include <OGRE/OgreSceneManager.h>
#include <OGRE/OgreSceneNode.h>
#include <haptex/ContactForces.h>
#include <rviz/display_context.h>
#include <rviz/properties/bool_property.h>
#include <rviz/properties/enum_property.h>
#include <rviz/properties/float_property.h>
#include <rviz/properties/string_property.h>
#include <rviz/view_controller.h>
#include <rviz/view_manager.h>

#include <cmath>
#include <exception>
#include <string>
#include <utility>
#include <vector>

namespace haptex::nodes {
namespace {

constexpr int kLegendLeft = 12, kLegendTop = 12;  // pixels

}  // namespace

ClothDisplay::ClothDisplay() { addProperties(); }

ClothDisplay::~ClothDisplay() { subscriptions_.end(); }

void ClothDisplay::addProperties() {
  topics_ = new rviz::StringProperty(
      "Topics", "cloth", "Where mesh, state and contact_forces of the cloth are.", this);
  colour_by_ = new rviz::EnumProperty("Colour by", "Strain", "What the colours tell.", this);
  colour_by_->addOption("Strain", static_cast<int>(ColourBy::kStrain));
  colour_by_->addOption("Stress", static_cast<int>(ColourBy::kStress));
  colour_by_->addOption("Contact force", static_cast<int>(ColourBy::kContactForce));
  colour_by_->addOption("Fabric", static_cast<int>(ColourBy::kFabric));
  colour_by_->addOption("Panel", static_cast<int>(ColourBy::kPanel));
  colour_by_->addOption("Look", static_cast<int>(ColourBy::kLook));
  btf_folder_ = new rviz::StringProperty(
      "BTF folder", "",
      "For looks: where FABRIC.btf of each fabric is, as rosrun haptex fabric_btf writes it.",
      this);
  full_scale_ = new rviz::FloatProperty("Full scale", 0.0F,
                                        "Value of the last colour: strain without unit, stress in "
                                        "N/m, force in N. 0: 0.01, 100 N/m, 0.1 N.",
                                        this);
  full_scale_->setMin(0.0F);
  wireframe_ =
      new rviz::BoolProperty("Wireframe", false, "The edges of the triangles alone.", this);
  grain_lines_ = new rviz::BoolProperty("Grain lines", false, "Edges along weft and warp.", this);
  self_shadow_ = new rviz::BoolProperty(
      "Self-shadow", false, "Darkened where the cloth hides the sky from itself.", this);
  opacity_ = new rviz::FloatProperty("Alpha", 1.0F, "1: opaque, 0: not to be seen.", this);
  opacity_->setMin(0.0F);
  opacity_->setMax(1.0F);
  legend_wanted_ = new rviz::BoolProperty("Legend", true, "What the colours stand for.", this);
  connect(topics_, &rviz::Property::changed, this, [this] { subscribe(); });
  connect(colour_by_, &rviz::Property::changed, this, [this] { rebuild(); });
  connect(btf_folder_, &rviz::Property::changed, this, [this] {
    looks_.forget();
    rebuild();
  });
  for (rviz::Property* property :
       {static_cast<rviz::Property*>(full_scale_), static_cast<rviz::Property*>(wireframe_),
        static_cast<rviz::Property*>(grain_lines_), static_cast<rviz::Property*>(self_shadow_),
        static_cast<rviz::Property*>(opacity_), static_cast<rviz::Property*>(legend_wanted_)}) {
    connect(property, &rviz::Property::changed, this, [this] { restyle(); });
  }
}

void ClothDisplay::onInitialize() { legend_ = std::make_unique<OverlayPicture>(); }

bool ClothDisplay::addTopics() {
  const std::string topics = topics_->getStdString();
  std::string error;
  if (topics.empty() || !ros::names::validate(topics, error)) {
    refuse("Topics", topics.empty() ? "no name is given: by default it is cloth" : error);
    return false;
  }
  say("Mesh", rviz::StatusProperty::Warn,
      ros::names::resolve(topics + "/mesh") + " has not come yet");
  subscriptions_.add<haptex::ClothMesh>(
      topics + "/mesh", 1, [this](const haptex::ClothMeshConstPtr& mesh) { receive(mesh); });
  subscriptions_.add<haptex::ClothState>(topics + "/state", 1,
                                         [this](const haptex::ClothStateConstPtr& state) {
                                           state_ = state;
                                           state_is_new_ = true;
                                         });
  subscriptions_.add<haptex::ContactForces>(topics + "/contact_forces", 1,
                                            [this](const haptex::ContactForcesConstPtr& forces) {
                                              if (surface_) surface_->take(*forces);
                                            });
  return true;
}

void ClothDisplay::forget() {
  object_.reset();
  surface_.reset();
  mesh_.reset();
  state_.reset();
  if (legend_) legend_->hide();
}

ColourBy ClothDisplay::colourBy() const {
  return static_cast<ColourBy>(colour_by_->getOptionInt());
}

void ClothDisplay::receive(const haptex::ClothMeshConstPtr& mesh) {
  try {
    auto surface = std::make_unique<ClothSurface>(*mesh, colourBy());
    mesh_ = mesh;
    object_.reset();
    object_ = std::make_unique<SurfaceObject>(*scene_manager_, *scene_node_, *surface);
    surface_ = std::move(surface);
    looks_read_ = 0;
    say("Mesh", rviz::StatusProperty::Ok,
        std::to_string(mesh->triangles.size() / 3) + " triangles of " + mesh->fabrics.front());
    restyle();
  } catch (const std::exception& error) {
    if (!object_) forget();  // or the surface before would be drawn into none
    refuse("Mesh", error.what());
  }
}

void ClothDisplay::rebuild() {
  if (colourBy() != ColourBy::kLook) unsay("Look");
  if (mesh_) receive(haptex::ClothMeshConstPtr(mesh_));
}

void ClothDisplay::restyle() {
  if (!object_) return;
  const double full = full_scale_->getFloat();
  surface_->setFullScale(std::isfinite(full) ? full : 0.0);
  surface_->setOpacity(opacity_->getFloat());
  object_->setStyle({wireframe_->getBool(), grain_lines_->getBool(), opacity_->getFloat() < 1.0F});
  showLegend();
  state_is_new_ = state_ != nullptr;
}

void ClothDisplay::showLegend() {
  if (!legend_wanted_->getBool() || surface_->colourBy() == ColourBy::kLook) {
    legend_->hide();
    return;
  }
  const bool names = !surface_->groups().empty();
  const char* title = surface_->colourBy() == ColourBy::kPanel ? "panels" : "fabrics";
  legend_->show(names ? paintNames(title, surface_->groups()) : paintColourBar(surface_->scale()),
                kLegendLeft, kLegendTop);
}

/// Those that have been read by now, and says what there is of them.
void ClothDisplay::takeLooks() {
  const std::string folder = btf_folder_->getStdString();
  if (folder.empty()) {
    refuse("Look", "no BTF folder is given");
    return;
  }
  std::vector<std::shared_ptr<const appearance::Brdf>> brdfs;
  std::size_t read = 0;
  std::string open, errors;
  for (const std::string& fabric : mesh_->fabrics) {
    const FabricLooks::Look look = looks_.of(folder + "/" + fabric + ".btf");
    brdfs.push_back(look.brdf);
    if (look.brdf) {
      ++read;
    } else if (look.error.empty()) {
      open += (open.empty() ? "" : ", ") + fabric;
    } else {
      errors += (errors.empty() ? "" : "; ") + look.error;
    }
  }
  if (read != looks_read_) {
    surface_->setLooks(std::move(brdfs));
    looks_read_ = read;
    state_is_new_ = true;
  }
  if (!errors.empty()) {
    refuse("Look", errors);
  } else if (!open.empty()) {
    say("Look", rviz::StatusProperty::Warn, "being read: " + open);
  } else {
    say("Look", rviz::StatusProperty::Ok, "of all fabrics");
  }
}

/// In the frame of the cloth; none where nothing depends on it.
std::optional<Eigen::Vector3d> ClothDisplay::eye() const {
  rviz::ViewController* view = context_->getViewManager()->getCurrent();
  const bool matters = self_shadow_->getBool() || surface_->colourBy() == ColourBy::kLook;
  if (!matters || view == nullptr) return std::nullopt;
  const Ogre::Vector3 eye =
      scene_node_->convertWorldToLocalPosition(view->getCamera()->getDerivedPosition());
  const Eigen::Vector3d place(eye.x, eye.y, eye.z);
  return place.allFinite() ? std::optional(place) : std::nullopt;
}

void ClothDisplay::refresh() {
  if (!surface_ || !state_) return;
  if (surface_->colourBy() == ColourBy::kLook) takeLooks();
  // What is seen of the same state may be another side, or have another look.
  const std::optional<Eigen::Vector3d> place_of_eye = eye();
  const bool has_turned = place_of_eye && place_of_eye != eye_;
  if (surface_->knows(*state_)) {
    if (state_is_new_) {
      draw();
    } else if (has_turned) {
      recolour();
    }
  }
  state_is_new_ = false;
  place(state_->header);
}

void ClothDisplay::draw() {
  try {
    eye_ = eye();
    surface_->setEye(eye_);
    surface_->setSelfShadow(self_shadow_->getBool());
    surface_->take(*state_);
    object_->update(*surface_, surface_->attached(*state_));
    say("State", rviz::StatusProperty::Ok, "drawn");
    queueRender();
  } catch (const std::exception& error) {
    refuse("State", error.what());
  }
}

void ClothDisplay::recolour() {
  eye_ = eye();
  if (!eye_) return;
  surface_->seeFrom(*eye_);
  object_->recolour(*surface_);
  queueRender();
}

}  // namespace haptex::nodes
