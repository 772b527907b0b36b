// Rigid bodies of a scene, as its file describes them.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace haptex::mesh {

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

/// Turns about an axis like a stone on a rope: the obstacle keeps the same side to the axis.
struct ObstacleOrbit {
  Eigen::Vector3d centre;  ///< m, on the axis
  Eigen::Vector3d axis;    ///< unit; the turn is right-handed about it
  double period;           ///< s, > 0
};

/// Goes on in a straight line.
struct ObstacleDrift {
  Eigen::Vector3d velocity;  ///< m/s
};

/// Makes a sphere or a box, of the same density all through, a rigid body that goes as it is
/// pushed.
struct ObstacleBody {
  double mass;                                                 ///< kg, > 0
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();          ///< m/s, at the start
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();  ///< rad/s, likewise, world frame
  double friction = 0.0;  ///< of it on other obstacles, >= 0; of two bodies the less
};

/// Data only: what is near an obstacle is told by the room proximity, what it does to the cloth by
/// the room contact.
struct Obstacle {
  std::string name;  ///< unique in its scene
  std::variant<ObstacleSphere, ObstacleBox, ObstacleCapsule, ObstacleMesh> shape;
  Eigen::Isometry3d pose;  ///< at time 0, from the obstacle's frame to the world frame
  std::variant<std::monostate, ObstacleOrbit, ObstacleDrift> motion = {};  ///< rests without one
  std::optional<double> friction = {};  ///< of the cloth on it, >= 0; the fabric's if not given

  std::optional<ObstacleBody> body = {};  ///< of a sphere or a box without motion of its own

  /// Of a body, which goes as it is pushed, that at the start.
  /// @param time s, simulated
  Eigen::Isometry3d poseAt(double time) const;
  bool moves() const { return motion.index() != 0 || body; }
};

}  // namespace haptex::mesh
