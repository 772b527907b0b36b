// A hierarchy of discrete-orientation polytopes over the triangles of a moving mesh.
//
// Volino et al., From early virtual garment simulation to interactive fashion design (2005); Klosowski et al.,
// Efficient collision detection using bounding volume hierarchies of k-DOPs (1998).
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "haptex/proximity/cursor.h"
#include "haptex/proximity/kdop.h"
#include "haptex/proximity/kdop_kernels.h"
#include "haptex/proximity/near_element.h"

namespace haptex::proximity {

struct HierarchySettings {
  KdopKind kind = KdopKind::k26;
  int triangles_per_leaf = 4;  ///< at most, >= 1
  InstructionSet instruction_set = bestInstructionSet();
};

/// Work done by one query.
struct QueryCost {
  std::int64_t volumes = 0;    ///< tested
  std::int64_t triangles = 0;  ///< whose distance was computed
};

/// A complete binary tree: level 0 is one volume around everything, level n has 2^n of them, each
/// around one half of the triangles of the volume above. Which triangles belong together is decided
/// once, at construction; refit() adapts the volumes to new positions. Volumes are stored in single
/// precision and tested with a margin for its rounding, distances are computed in double precision:
/// the answers are those of brute force.
///
/// Neither refit() nor query() allocates, if the vector of the answer has the capacity. Queries
/// may run at the same time, but not during refit().
class KdopHierarchy {
 public:
  /// @param triangles vertex indices
  /// @param positions where the vertices are while the tree is built: for cloth the rest
  ///   coordinates, so that neighbours in the fabric share a volume however it is folded. The
  ///   volumes are fitted to them.
  /// @throws std::invalid_argument naming what is wrong: no triangle, an index outside of the
  ///   positions, a position that is not finite or beyond kLargestLength, triangles_per_leaf < 1
  KdopHierarchy(std::vector<std::array<int, 3>> triangles,
                const std::vector<Eigen::Vector3d>& positions,
                const HierarchySettings& settings = {});

  /// Adapts all volumes to new positions, from the leaves to the root.
  /// @throws std::invalid_argument if their number differs, or one is not finite or beyond
  ///   kLargestLength; volumes and positions are then as before
  void refit(const std::vector<Eigen::Vector3d>& positions);

  /// The elements near a cursor, sorted by distance, then by index.
  /// @param found replaced
  /// @param cost  added to, if given
  /// @throws std::invalid_argument what requireValid() throws
  void query(const Cursor& cursor, const Range& range, std::vector<NearElement>& found,
             QueryCost* cost = nullptr) const;

  const std::vector<std::array<int, 3>>& triangles() const { return triangles_; }
  const std::vector<Eigen::Vector3d>& positions() const { return positions_; }
  Triangle triangle(int index) const;

  int levels() const { return levels_; }
  /// Volume `index` of a level, around the triangles of all volumes below it.
  /// @throws std::out_of_range if there is no such volume
  Kdop volume(int level, int index) const;

};

}  // namespace haptex::proximity
