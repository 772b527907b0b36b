// An obstacle where it is in a step, and how those with mass touch the others.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "haptex/cloth/dynamics/rigid_bodies.h"
#include "haptex/mesh/obstacle.h"
#include "haptex/proximity/rigid_obstacle.h"

namespace haptex::contact {

/// In its own frame, and where it is at both ends of a step.
struct PlacedObstacle {
  proximity::RigidObstacle shape;
  double reach;  ///< m, radius around the origin that holds it and what touches it
  Eigen::Isometry3d begin, end;
  double friction;             ///< of the cloth on it
  int body = -1;               ///< number among those with mass; -1: it moves as it wants
  double body_friction = 0.0;  ///< of a body on obstacles
  /// m: points by which it touches other obstacles' surfaces, and how near to those they get.
  std::vector<Eigen::Vector3d> points = {};
  double clearance = 0.0;
};

/// Fills points and clearance: a sphere touches with its centre, a radius away; a capsule with five
/// points of its axis; a box with its corners, `offset` away; a mesh with none.
void setPoints(const mesh::Obstacle& obstacle, double offset, PlacedObstacle& placed);

/// Most contacts that findBodyContacts() may find.
std::size_t mostBodyContacts(const std::vector<PlacedObstacle>& obstacles);

/// What may touch within a step of h seconds between bodies, and between them and the other
/// obstacles. Paths are straight and followed all along, so that speed lets no point through. Edges
/// of boxes that cross edges, and meshes that reach into boxes, are not seen.
void findBodyContacts(const std::vector<PlacedObstacle>& obstacles, double h,
                      std::vector<cloth::BodyContact>& contacts);

}  // namespace haptex::contact
