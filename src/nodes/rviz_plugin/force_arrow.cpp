#include "haptex/nodes/rviz_plugin/force_arrow.h"

#include <OGRE/OgreEntity.h>
#include <OGRE/OgreMaterial.h>
#include <OGRE/OgreSceneManager.h>
#include <OGRE/OgreSceneNode.h>
#include <OGRE/OgreTechnique.h>
#include <rviz/ogre_helpers/arrow.h>
#include <rviz/ogre_helpers/shape.h>

#include <algorithm>

#include "haptex/nodes/force_renderer/contact_markers.h"

namespace haptex::nodes {
namespace {

constexpr float kShaft = 0.0022F, kHead = 0.0055F;       // m, diameters
constexpr double kHeadShare = 0.3, kLongestHead = 0.01;  // of the length; m

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
      arrow_(std::make_unique<rviz::Arrow>(&manager, node_)) {
  arrow_->setColor(colour[0], colour[1], colour[2], 1.0F);
  bringToFront(*arrow_->getShaft());
  bringToFront(*arrow_->getHead());
  hide();
}

ForceArrow::~ForceArrow() {
  arrow_.reset();
  manager_.destroySceneNode(node_);
}

void ForceArrow::show(const Eigen::Vector3d& place, const Eigen::Vector3d& force) {
  const double norm = force.norm();
  if (!place.allFinite() || !force.allFinite() || norm < kMinShownForce) {
    hide();
    return;
  }
  const double length = arrowLength(norm);
  const double head = std::min(kHeadShare * length, kLongestHead);
  arrow_->set(static_cast<float>(length - head), kShaft, static_cast<float>(head), kHead);
  arrow_->setPosition(ogre(place));
  arrow_->setDirection(ogre(force / norm));
  shown_ = Shown{place + length / norm * force, norm};
  node_->setVisible(true);
}

void ForceArrow::hide() {
  shown_.reset();
  node_->setVisible(false);
}

}  // namespace haptex::nodes
