#include "haptex/rviz_plugin/contact_display.h"

#include <OGRE/OgreSceneNode.h>
#include <rviz/display_context.h>
#include <rviz/frame_manager.h>
#include <rviz/properties/bool_property.h>

#include <string>

namespace haptex::rviz_plugin {
namespace {

using base::Finger;
using base::kFingers;

constexpr int kLegendLeft = 12, kLegendTop = 270;  // pixels, below the legend of the cloth
const Eigen::Vector3f kColour(0.75F, 0.10F, 0.15F);

Eigen::Vector3d vector(const geometry_msgs::Vector3& message) {
  return {message.x, message.y, message.z};
}

}  // namespace

ContactDisplay::ContactDisplay() {
  legend_wanted_ = new rviz::BoolProperty(
      "Legend", true, "The colours of the patch and of its contact points.", this);
  connect(legend_wanted_, &rviz::Property::changed, this, [this] { showLegend(); });
}

ContactDisplay::~ContactDisplay() { subscriptions_.end(); }

void ContactDisplay::onInitialize() {
  legend_ = std::make_unique<OverlayPicture>();
  for (auto& arrow : arrows_.values) {
    arrow = std::make_unique<ForceArrow>(*scene_manager_, *scene_node_, kColour);
  }
}

void ContactDisplay::onEnable() { subscribe(); }

void ContactDisplay::onDisable() {
  subscriptions_.end();
  hide();
}

void ContactDisplay::reset() {
  Display::reset();
  subscribe();
}

void ContactDisplay::hide() {
  for (auto& arrow : arrows_.values) {
    if (arrow) arrow->hide();
  }
  if (legend_) legend_->hide();
}

void ContactDisplay::subscribe() {
  subscriptions_.end();
  hide();
  if (!isEnabled() || !initialized()) return;
  for (const Finger finger : kFingers) {
    subscriptions_.add<haptex::Contact>(
        base::name(finger) + std::string("/contact"), 1,
        [this, finger](const haptex::ContactConstPtr& contact) { receive(finger, *contact); });
  }
  subscriptions_.begin();
}

/// In the newest place of the message's frame.
void ContactDisplay::receive(Finger finger, const haptex::Contact& contact) {
  Ogre::Vector3 position;
  Ogre::Quaternion orientation;
  if (!context_->getFrameManager()->getTransform(contact.header.frame_id, ros::Time(), position,
                                                 orientation)) {
    setStatusStd(rviz::StatusProperty::Error, "Transform",
                 "none from " + contact.header.frame_id.substr(0, 200) + " to " +
                     fixed_frame_.toStdString());
    return;
  }
  deleteStatus("Transform");
  scene_node_->setPosition(position);
  scene_node_->setOrientation(orientation);
  if (contact.touching != 0) {
    const Eigen::Vector3d centre(contact.centre.x, contact.centre.y, contact.centre.z);
    arrows_[finger]->show(centre, vector(contact.force));
  } else {
    arrows_[finger]->hide();
  }
  showLegend();
}

void ContactDisplay::showLegend() {
  if (!legend_) return;
  if (legend_wanted_->getBool() && isEnabled()) {
    legend_->show(paintColourBar(scaleOf(ColourBy::kContactForce)), kLegendLeft, kLegendTop);
  } else {
    legend_->hide();
  }
}

void ContactDisplay::update(float /*wall_dt*/, float /*ros_dt*/) { subscriptions_.callAvailable(); }

}  // namespace haptex::rviz_plugin
