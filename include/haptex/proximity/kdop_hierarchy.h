// A hierarchy of discrete-orientation polytopes over the triangles of a moving mesh.
//
// Klosowski et al., Efficient collision detection using bounding volume hierarchies of k-DOPs, IEEE
// Trans. Visualization and Computer Graphics 4(1) (1998). The tree over the cloth and k = 26 are
// those of the HAPTEX textile simulation.
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
  int triangles_per_leaf = 8;  ///< at most, >= 1; 8 by `scripts/bench proximity`
  InstructionSet instruction_set = bestInstructionSet();
};

/// What is compared in single precision has a margin of this fraction of all that went into it.
/// Heights are sums of three numbers, each rounded to single precision, and so is the sum: they are
/// off by at most 6 * 2^-24 = 3.6e-7 of the largest term.
constexpr double kSinglePrecisionMargin = 1e-6;

/// A volume as KdopHierarchy::volume() takes it.
struct VolumeIndex {
  int level, index;
};

/// Work done by queries.
struct QueryCost {
  std::int64_t volumes = 0;    ///< tested
  std::int64_t triangles = 0;  ///< whose distance was computed
};

/// What the elements may be near to: a union of convex parts.
class Body {
 public:
  virtual ~Body() = default;
  virtual int parts() const = 0;
  /// Smallest normal . x over the points x of a part (m |normal|).
  virtual double least(int part, const Eigen::Vector3d& normal) const = 0;
  /// What is to be said of a triangle (corners in m, in the frame of the mesh). Its distance may
  /// not be smaller than what least() allows.
  virtual NearElement near(int index, const Triangle& triangle) const = 0;
};

/// A complete binary tree: level 0 is one volume around everything, level n has 2^n of them, each
/// around one half of the triangles of the volume above. Which triangles belong together is decided
/// once, at construction; refit() adapts the volumes to new positions. Volumes are stored in single
/// precision and tested with a margin for its rounding, distances are computed in double precision:
/// the answers are those of brute force.
///
/// refit() does not allocate, nor does query() once the vector of the answer has its capacity and
/// the thread has asked about as many parts before. Queries may run at the same time, but not
/// during refit().
class KdopHierarchy {
 public:
  /// @param triangles vertex indices; triangles without area are allowed
  /// @param positions where the vertices are while the tree is built: for cloth the rest
  ///   coordinates, so that neighbours in the fabric share a volume however it is folded. The
  ///   volumes are fitted to them.
  /// @throws std::invalid_argument naming what is wrong: no triangle, an index outside of the
  ///   positions, a position that is not finite or beyond kMaxLength, triangles_per_leaf < 1,
  ///   an instruction set that the processor lacks
  KdopHierarchy(std::vector<std::array<int, 3>> triangles,
                const std::vector<Eigen::Vector3d>& positions,
                const HierarchySettings& settings = {});

  /// Adapts all volumes to new positions, from the leaves to the root.
  /// @throws std::invalid_argument if their number differs, or one is not finite or beyond
  ///   kMaxLength; volumes and positions are then as before
  void refit(const std::vector<Eigen::Vector3d>& positions);

  /// The elements near a cursor or another body, sorted by isNearer().
  /// @param found replaced
  /// @param cost  added to, if given
  /// @throws std::invalid_argument what requireValid() throws
  void query(const Cursor& cursor, const Range& range, std::vector<NearElement>& found,
             QueryCost* cost = nullptr) const;
  void query(const Body& body, const Range& range, std::vector<NearElement>& found,
             QueryCost* cost = nullptr) const;

  /// The volumes that such a query tests, each once. For pictures: it takes several times as long
  /// as the query, and allocates.
  /// @throws std::invalid_argument what requireValid() throws
  std::vector<VolumeIndex> tested(const Cursor& cursor, const Range& range) const;
  std::vector<VolumeIndex> tested(const Body& body, const Range& range) const;

  const std::vector<std::array<int, 3>>& triangles() const { return triangles_; }
  const std::vector<Eigen::Vector3d>& positions() const { return positions_; }
  /// Where a triangle of the mesh is (m), by its index from 0.
  Triangle triangle(int index) const;

  int levels() const { return levels_; }
  /// Volume `index` of a level.
  /// @throws std::out_of_range if there is no such volume
  Kdop volume(int level, int index) const;

  // For traversals other than queries: volumes are numbered breadth first.

  kernels::VolumeTree tree() const { return {heights_.data(), first_leaf_}; }
  const kernels::Kernels& kernels() const { return *kernels_; }
  /// Groups of axes, see kdop_kernels.h.
  int groups() const { return groups_; }
  int leaves() const { return first_leaf_ + 1; }
  /// The triangles of leaf i of leaves() are those of order() from leafBegin(i) to leafBegin(i +
  /// 1).
  int leafBegin(int leaf) const;
  const std::vector<int>& order() const { return order_; }
  /// Limits for Kernels::nearPairs() of volumes that may be up to a distance (m) apart.
  void computePairLimits(double distance, std::vector<float>& limits) const;
  /// Positions relative to one of them, x, y, z and a number without meaning for each (m).
  const std::vector<float>& localPositions() const { return particles_; }
  /// Largest coordinate of the local positions (m).
  double extent() const { return extent_; }

 private:
  class Search;

  void build(const std::vector<Eigen::Vector3d>& positions);
  void listLeafParticles();
  void computeLeast(const Body& body, double distance, std::vector<float>& least) const;
  float gapOf(int volume, const std::vector<float>& least) const;

  std::vector<std::array<int, 3>> triangles_;
  std::vector<Eigen::Vector3d> positions_;  // m

  KdopKind kind_;
  int groups_;  // of axes, see kdop_kernels.h
  const kernels::Kernels* kernels_;
  std::vector<float> axes_;             // as RefitData has them
  std::vector<float> inverse_lengths_;  // as NarrowingSearch has them

  int levels_;
  int first_leaf_;
  std::vector<int> order_;           // triangles, leaf by leaf
  std::vector<int> leaf_begin_;      // in leaf_particles_
  std::vector<int> leaf_particles_;  // each particle of a leaf once

  Eigen::Vector3d origin_;        // m, of the single-precision numbers
  double extent_;                 // m, largest coordinate relative to the origin
  std::vector<float> particles_;  // m, relative to the origin, four per particle
  std::vector<float> heights_;    // m |n|, relative to the origin, breadth first
};

}  // namespace haptex::proximity
