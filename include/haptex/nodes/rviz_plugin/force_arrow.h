// An arrow of a force in an Ogre scene.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>

namespace Ogre {
class SceneManager;
class SceneNode;
}  // namespace Ogre
namespace rviz {
class Arrow;
}  // namespace rviz

namespace haptex::nodes {

/// An arrow of the length arrowLength(), before whatever hides it. By the thread of the
/// scene.
class ForceArrow {
 public:
  /// @param parent the node to which this adds its own; outlives this, as the manager does
  /// @param colour red, green and blue from 0 to 1
  ForceArrow(Ogre::SceneManager& manager, Ogre::SceneNode& parent, const Eigen::Vector3f& colour);
  ~ForceArrow();
  ForceArrow(const ForceArrow&) = delete;
  ForceArrow& operator=(const ForceArrow&) = delete;

  /// @param place m, where it begins @param force N; below kMinShownForce, and where a
  /// number
  ///   is not finite, nothing is shown
  void show(const Eigen::Vector3d& place, const Eigen::Vector3d& force);
  void hide();

  /// Where its head ends (m), of what is shown, and the force (N).
  struct Shown {
    Eigen::Vector3d head;
    double force;
  };
  const std::optional<Shown>& shown() const { return shown_; }

 private:
  Ogre::SceneManager& manager_;
  Ogre::SceneNode* node_;
  std::unique_ptr<rviz::Arrow> arrow_;
  std::optional<Shown> shown_;
};

}  // namespace haptex::nodes
