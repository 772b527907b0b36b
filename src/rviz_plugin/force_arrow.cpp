#include "haptex/rviz_plugin/force_arrow.h"

#include <OGRE/OgreEntity.h>
#include <OGRE/OgreMaterial.h>
#include <OGRE/OgreSceneManager.h>
#include <OGRE/OgreSceneNode.h>
#include <OGRE/OgreTechnique.h>
#include <rviz/ogre_helpers/arrow.h>
#include <rviz/ogre_helpers/movable_text.h>
#include <rviz/ogre_helpers/shape.h>

#include <algorithm>
#include <cstdio>

#include "haptex/nodes/force_renderer/contact_markers.h"

namespace haptex::rviz_plugin {
namespace {

constexpr float kShaft = 0.0022F, kHead = 0.0055F;       // m, diameters
constexpr double kHeadShare = 0.3, kLongestHead = 0.01;  // of the length; m
constexpr float kTextHeight = 0.009F;                    // m
constexpr double kTextBeyond = 0.004;                    // m, of the head
const Ogre::ColourValue kTextColour(0.1F, 0.1F, 0.1F);

Ogre::Vector3 ogre(const Eigen::Vector3d& vector) {
  const Eigen::Vector3f numbers = vector.cast<float>();
  return {numbers.x(), numbers.y(), numbers.z()};
}

void bringToFront(rviz::Shape& shape) {
  shape.getMaterial()->getTechnique(0)->setDepthCheckEnabled(false);
  shape.getEntity()->setRenderQueueGroup(Ogre::RENDER_QUEUE_9);
}

}  // namespace

ForceArrow::ForceArrow(Ogre::SceneManager& manager, Ogre::SceneNode& parent,
                       const Eigen::Vector3f& colour)
    : manager_(manager),
      node_(parent.createChildSceneNode()),
      text_node_(node_->createChildSceneNode()),
      arrow_(std::make_unique<rviz::Arrow>(&manager, node_)),
      text_(
          std::make_unique<rviz::MovableText>("0 N", "Liberation Sans", kTextHeight, kTextColour)) {
  arrow_->setColor(colour[0], colour[1], colour[2], 1.0F);
  bringToFront(*arrow_->getShaft());
  bringToFront(*arrow_->getHead());
  text_->setTextAlignment(rviz::MovableText::H_CENTER, rviz::MovableText::V_CENTER);
  text_->showOnTop(true);
  text_node_->attachObject(text_.get());
  hide();
}

ForceArrow::~ForceArrow() {
  text_node_->detachObject(text_.get());
  text_.reset();
  arrow_.reset();
  manager_.destroySceneNode(text_node_);
  manager_.destroySceneNode(node_);
}

void ForceArrow::show(const Eigen::Vector3d& place, const Eigen::Vector3d& force) {
  const double norm = force.norm();
  if (!place.allFinite() || !force.allFinite() || norm < nodes::kMinShownForce) {
    hide();
    return;
  }
  const double length = nodes::arrowLength(norm);
  const double head = std::min(kHeadShare * length, kLongestHead);
  arrow_->set(static_cast<float>(length - head), kShaft, static_cast<float>(head), kHead);
  arrow_->setPosition(ogre(place));
  arrow_->setDirection(ogre(force / norm));
  char caption[32];
  std::snprintf(caption, sizeof(caption), norm < 0.1 ? "%.3f N" : "%.2f N", norm);
  text_->setCaption(caption);
  text_node_->setPosition(ogre(place + (length + kTextBeyond) / norm * force));
  node_->setVisible(true);
}

void ForceArrow::hide() { node_->setVisible(false); }

}  // namespace haptex::rviz_plugin
