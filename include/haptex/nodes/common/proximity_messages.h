// Conversions between the proximity room and the messages of msg/ and srv/. Messages come from
// outside: nothing in them is believed.
#pragma once

#include <haptex/ClothMesh.h>
#include <haptex/ClothState.h>
#include <haptex/QueryProximity.h>

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <vector>

#include "haptex/mesh/mesh.h"
#include "haptex/proximity/cursor.h"
#include "haptex/proximity/near_element.h"

namespace haptex::nodes {

/// The triangles of a mesh message and where its particles are in the fabric.
struct RestMesh {
  std::uint32_t number = 0;                   ///< of the mesh
  std::vector<std::array<int, 3>> triangles;  ///< particle indices
  /// m, (u along the weft, v along the warp, n), in the first panel n that a particle is of: panels
  /// lie 1 m apart, so that nothing of two of them is near each other by chance.
  std::vector<Eigen::Vector3d> rest_coordinates;
  std::vector<int> panels;  ///< per triangle; empty: all are of one
  /// m, (u, v) per triangle and corner in its own panel; empty: those of the particles.
  std::vector<std::array<Eigen::Vector2d, 3>> corner_coordinates;

  bool operator==(const RestMesh& other) const {
    return number == other.number && triangles == other.triangles &&
           rest_coordinates == other.rest_coordinates && panels == other.panels &&
           corner_coordinates == other.corner_coordinates;
  }
};

/// The cloth that a mesh message says, without fabrics and forces; where panels are merged, with
/// hinges at their seams. Initial positions are the rest coordinates in the plane x = 0.
/// @throws std::invalid_argument as mesh::requireSound()
mesh::ClothMesh clothOf(const RestMesh& rest);

/// Triangles without area are allowed.
/// @throws std::invalid_argument naming field, value and what is allowed: no triangle, arrays that
///   do not fit together, a particle that does not exist, a number that is not finite or beyond
///   proximity::kMaxLength
RestMesh restMesh(const haptex::ClothMesh& message);

/// @throws std::invalid_argument likewise: another frame than fixedFrame(), a position that is not
///   finite or beyond proximity::kMaxLength
void requireValid(const haptex::ClothState& message);

/// Everything about a request but its frame and the obstacles that there are.
/// @throws std::invalid_argument likewise: an unknown shape, points, radii or an obstacle that do
///   not go with it, a number that is not finite, too large, or negative where it must not be
void requireValid(const haptex::QueryProximity::Request& request);

/// The cursor of a valid request for another shape than OBSTACLE.
/// @param world_from_frame transform from the frame of the points to the world frame
/// @throws std::invalid_argument if that takes it beyond proximity::kMaxLength
proximity::Cursor cursorInWorld(const haptex::QueryProximity::Request& request,
                                const Eigen::Isometry3d& world_from_frame);

/// Fills in elements, distance, success and message.
/// @param found sorted by distance
/// @param asked m, how far was asked for
void fillResponse(const std::vector<proximity::NearElement>& found, double asked,
                  haptex::QueryProximity::Response& response);

/// The answer to a request that is refused: no elements, distance +Inf.
haptex::QueryProximity::Response refusal(const std::string& message);

}  // namespace haptex::nodes
