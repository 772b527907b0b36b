#include "haptex/nodes/rviz_plugin/contact_display.h"

#include <OGRE/OgreCamera.h>
#include <OGRE/OgreSceneNode.h>
#include <OGRE/OgreViewport.h>
#include <rviz/display_context.h>
#include <rviz/properties/bool_property.h>
#include <rviz/view_controller.h>
#include <rviz/view_manager.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "haptex/nodes/common/vector_messages.h"

namespace haptex::nodes {
namespace {

using base::Finger;
using base::kFingers;

constexpr int kLabelAway = 6;                        // pixels
constexpr int kLegendLeft = 12, kLegendBottom = 12;  // pixels: the cloth has the upper corner
const Eigen::Vector3f kColour(0.75F, 0.10F, 0.15F);

}  // namespace

ContactDisplay::ContactDisplay() {
  legend_wanted_ = new rviz::BoolProperty(
      "Legend", true, "The colours of the patch and of its contact points.", this);
  connect(legend_wanted_, &rviz::Property::changed, this, [this] { showLegend(); });
}

ContactDisplay::~ContactDisplay() { subscriptions_.end(); }

void ContactDisplay::onInitialize() {
  legend_ = std::make_unique<OverlayPicture>();
  for (const Finger finger : kFingers) {
    arrows_[finger] = std::make_unique<ForceArrow>(*scene_manager_, *scene_node_, kColour);
    labels_[finger] = std::make_unique<OverlayPicture>();
  }
}

void ContactDisplay::forget() {
  for (auto& arrow : arrows_.values) {
    if (arrow) arrow->hide();
  }
  for (auto& label : labels_.values) {
    if (label) label->hide();
  }
  if (legend_) legend_->hide();
}

bool ContactDisplay::addTopics() {
  for (const Finger finger : kFingers) {
    subscriptions_.add<haptex::Contact>(
        base::name(finger) + std::string("/contact"), 1,
        [this, finger](const haptex::ContactConstPtr& contact) { receive(finger, *contact); });
  }
  return true;
}

void ContactDisplay::receive(Finger finger, const haptex::Contact& contact) {
  if (!place(contact.header)) return;
  if (contact.touching != 0) {
    arrows_[finger]->show(fromMessage(contact.centre), fromMessage(contact.force));
  } else {
    arrows_[finger]->hide();
  }
  showLegend();
}

void ContactDisplay::showLegend() {
  if (!legend_) return;
  if (legend_wanted_->getBool() && isEnabled()) {
    legend_->showAtBottom(paintColourBar(scaleOf(ColourBy::kContactForce)), kLegendLeft,
                          kLegendBottom);
  } else {
    legend_->hide();
  }
}

/// In pixels of the view, where it is before the camera.
std::optional<Eigen::Vector2i> ContactDisplay::placeOf(const Eigen::Vector3d& point) const {
  rviz::ViewController* view = context_->getViewManager()->getCurrent();
  const Ogre::Camera* camera = view != nullptr ? view->getCamera() : nullptr;
  if (camera == nullptr || camera->getViewport() == nullptr) return std::nullopt;
  const Eigen::Vector3f local = point.cast<float>();
  const Ogre::Vector3 seen = camera->getViewMatrix() * scene_node_->convertLocalToWorldPosition(
                                                           {local.x(), local.y(), local.z()});
  const Ogre::Vector3 place = camera->getProjectionMatrix() * seen;
  if (seen.z >= 0.0F || std::abs(place.x) > 1.0F || std::abs(place.y) > 1.0F) return std::nullopt;
  const auto* port = camera->getViewport();
  return Eigen::Vector2i(static_cast<int>(0.5F * (1.0F + place.x) * port->getActualWidth()),
                         static_cast<int>(0.5F * (1.0F - place.y) * port->getActualHeight()));
}

/// Beside the heads of the arrows, the upper one above, the lower one below, so that both are read
/// in a pinch.
void ContactDisplay::refresh() {
  base::PerFinger<std::optional<Eigen::Vector2i>> places;
  for (const Finger finger : kFingers) {
    if (const auto& shown = arrows_[finger]->shown()) places[finger] = placeOf(shown->head);
  }
  const auto& index = places[Finger::kIndex];
  const auto& thumb = places[Finger::kThumb];
  const bool index_above = !index || !thumb || index->y() <= thumb->y();
  for (const Finger finger : kFingers) {
    if (!places[finger]) {
      labels_[finger]->hide();
      continue;
    }
    const double force = arrows_[finger]->shown()->force;
    char caption[48];
    std::snprintf(caption, sizeof(caption), force < 0.1 ? "%s %.3f N" : "%s %.2f N",
                  base::name(finger), force);
    const QImage picture = paintLabel(caption);
    const bool above = (finger == Finger::kIndex) == index_above;
    const auto* port = context_->getViewManager()->getCurrent()->getCamera()->getViewport();
    const int rightmost = port->getActualWidth() - picture.width();  // whole within the view
    labels_[finger]->show(
        picture, std::min(places[finger]->x() + kLabelAway, rightmost),
        places[finger]->y() + (above ? -kLabelAway - picture.height() : kLabelAway));
  }
}

}  // namespace haptex::nodes
