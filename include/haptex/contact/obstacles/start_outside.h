// Starts of a cloth that reach into the obstacles of its scene.
#pragma once

#include <string>
#include <vector>

#include "haptex/mesh/mesh.h"
#include "haptex/mesh/obstacle.h"

namespace haptex::contact {

/// What moveOutside() has done.
struct StartMove {
  int particles = 0;     ///< that start somewhere else now
  double longest = 0.0;  ///< m, the longest way of one of them
  int triangle = -1;     ///< the first that touched an obstacle; -1: none did
  std::string obstacle;  ///< that it touched
};

/// Moves the initial positions (world frame, m) of a cloth that touches obstacles in their poses at
/// the start out of them, to a clearance of ObstacleCollision::kOffset. What is inside of a solid
/// goes along the normal of its nearest surface; of a closed mesh that the cloth goes through, what
/// is on the side where fewer particles are. Edges keep the length that they have at the start as
/// far as that is possible, so what is beside it follows (position based dynamics: Mueller,
/// Heidelberger, Hennix and Ratcliff, J. Visual Communication and Image Representation 18, 2007).
/// What comes to intersect itself by it is for cloth::Untangling.
///
/// Nothing is moved where no triangle touches, or where this leads to no start outside, as for a
/// needle that is stuck through the cloth or a surface that is not closed.
/// @param held particles that stay where they are
/// @param start s, simulated
/// @throws std::invalid_argument what makeObstacle() says
StartMove moveOutside(mesh::ClothMesh& mesh, const std::vector<mesh::Obstacle>& obstacles,
                      const std::vector<int>& held, double start = 0.0);

}  // namespace haptex::contact
