// Rigid bodies of a scene, as its file describes them.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <string>
#include <variant>
#include <vector>

namespace haptex::cloth {

/// Solid, centred in the obstacle's frame.
struct ObstacleSphere {
  double radius;  ///< m, > 0
};

/// Solid, centred in the obstacle's frame, edges along its axes.
struct ObstacleBox {
  Eigen::Vector3d sides;  ///< m, whole edge lengths, each > 0
};

/// Solid: what is within `radius` of a segment along z, centred in the obstacle's frame.
struct ObstacleCapsule {
  double radius;  ///< m, > 0
  double length;  ///< m, of the segment, > 0
};

/// A surface; a closed one is not filled.
struct ObstacleMesh {
  std::vector<Eigen::Vector3d> vertices;      ///< m, in the obstacle's frame
  std::vector<std::array<int, 3>> triangles;  ///< vertex indices
};

/// Data only: what is near an obstacle is told by the room proximity.
struct Obstacle {
  std::string name;  ///< unique in its scene
  std::variant<ObstacleSphere, ObstacleBox, ObstacleCapsule, ObstacleMesh> shape;
  Eigen::Isometry3d pose;  ///< from the obstacle's frame to the world frame
};

}  // namespace haptex::cloth
