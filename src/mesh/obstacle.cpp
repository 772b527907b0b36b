#include "haptex/mesh/obstacle.h"

#include <cmath>

namespace haptex::mesh {
namespace {

struct Move {
  const Eigen::Isometry3d& pose;
  double time;

  Eigen::Isometry3d operator()(std::monostate) const { return pose; }
  Eigen::Isometry3d operator()(const ObstacleOrbit& orbit) const {
    const double angle = 2.0 * M_PI * std::fmod(time / orbit.period, 1.0);
    return Eigen::Translation3d(orbit.centre) * Eigen::AngleAxisd(angle, orbit.axis) *
           Eigen::Translation3d(-orbit.centre) * pose;
  }
  Eigen::Isometry3d operator()(const ObstacleDrift& drift) const {
    return Eigen::Translation3d(time * drift.velocity) * pose;
  }
};

}  // namespace

Eigen::Isometry3d Obstacle::poseAt(double time) const {
  return std::visit(Move{pose, time}, motion);
}

}  // namespace haptex::mesh
