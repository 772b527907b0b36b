#include "haptex/nodes/rviz_plugin/live_display.h"

#include <OGRE/OgreSceneNode.h>
#include <rviz/display_context.h>
#include <rviz/frame_manager.h>

namespace haptex::nodes {

void LiveDisplay::onDisable() {
  subscriptions_.end();
  clear();
}

void LiveDisplay::reset() {
  Display::reset();
  subscribe();
}

void LiveDisplay::update(float /*wall_dt*/, float /*ros_dt*/) {
  subscriptions_.callAvailable();
  refresh();
}

void LiveDisplay::clear() {
  forget();
  clearStatuses();
  said_.clear();
}

void LiveDisplay::subscribe() {
  subscriptions_.end();
  clear();
  if (isEnabled() && initialized() && addTopics()) subscriptions_.begin();
}

bool LiveDisplay::place(const std_msgs::Header& header) {
  Ogre::Vector3 position;
  Ogre::Quaternion orientation;
  if (!context_->getFrameManager()->getTransform(header.frame_id, ros::Time(), position,
                                                 orientation)) {
    refuse("Transform",
           "none from " + header.frame_id.substr(0, 200) + " to " + fixed_frame_.toStdString());
    return false;
  }
  say("Transform", rviz::StatusProperty::Ok, "there");
  scene_node_->setPosition(position);
  scene_node_->setOrientation(orientation);
  return true;
}

void LiveDisplay::say(const std::string& what, rviz::StatusProperty::Level level,
                      const std::string& text) {
  const std::pair<int, std::string> said(level, text);
  if (said_[what] == said) return;
  said_[what] = said;
  setStatusStd(level, what, text);
}

void LiveDisplay::refuse(const std::string& what, const std::string& why) {
  say(what, rviz::StatusProperty::Error, why);
}

void LiveDisplay::unsay(const std::string& what) {
  if (said_.erase(what) > 0) deleteStatusStd(what);
}

}  // namespace haptex::nodes
