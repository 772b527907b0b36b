// Which elements of a moving mesh are near other elements of it.
//
// The hierarchy is traversed against itself, as Klosowski et al. (1998) do with two. Parts that are
// not curved enough to come near themselves are left out, see flat_regions.h. The front of the
// traversal, the pairs of volumes at which it ended, is where the next one begins.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "haptex/linear/thread_pool.h"
#include "haptex/proximity/element_pair.h"
#include "haptex/proximity/flat_regions.h"
#include "haptex/proximity/kdop_hierarchy.h"
#include "haptex/proximity/leaf_elements.h"

namespace haptex::proximity {

/// Two elements that are near each other.
struct NearPair {
  ElementPair elements;
  PairDistance nearest;
};

/// Work done by SelfProximity.
struct SelfProximityCost {
  std::int64_t volume_pairs = 0;  ///< tested
  std::int64_t flat_tests = 0;    ///< of volumes, whether they are flat
  std::int64_t leaf_pairs = 0;    ///< whose elements were compared
  std::int64_t distances = 0;     ///< computed
};

/// Finds all pairs of a vertex and a triangle, and of two edges, that
/// - have no vertex in common, and
/// - are at most `distance` apart, but
/// - were more than `distance` apart in the reference state: neighbours in the fabric that are held
///   apart by its own stiffness are no contacts. A distance below all altitudes of the reference
///   triangles excludes nothing.
/// The answer is that of asking all pairs, bit by bit. It does not depend on earlier steps.
///
/// Neighbours that were at most distance / FlatRegions::kLeastStretch apart in the reference state
/// are looked at one by one in every step: meant is a distance below half of an altitude of the
/// triangles, where they are none or few.
class SelfProximity {
 public:
  /// @param hierarchy over the triangles of the mesh, must outlive this
  /// @param reference positions (m) of the particles: for a sheet its rest coordinates (u, v, 0).
  ///   Only where they lie in a plane and do not overlap can flat parts be left out
  /// @param distance  m, finite and >= 0
  /// @throws std::invalid_argument naming the distance, or what KdopHierarchy::refit() throws about
  ///   the reference
  SelfProximity(const KdopHierarchy& hierarchy, const std::vector<Eigen::Vector3d>& reference,
                double distance);

  /// Of a mesh that has no flat state: no pair counts as one of neighbours, and no part is left
  /// out.
  SelfProximity(const KdopHierarchy& hierarchy, double distance);

  /// Looks for pairs where the hierarchy was last fitted to. Does not allocate once all buffers
  /// have had the size that they need.
  /// @param found replaced; ordered by where the elements are in the hierarchy, the same for the
  ///   same positions
  /// @param bounds if given, replaced by a displacement (m) for each particle: half of the distance
  ///   of the nearest pair that it is part of, also of those that the reference state excludes, at
  ///   most distance / 2. As long as every particle moves by less than that, and be it along a
  ///   curve, no two elements can touch: the bound of offset geometric contact (Chen et al., ACM
  ///   Trans. Graphics 44(4), 2025)
  /// @param cost added to, if given
  /// @param pool shares the work if it is given, to the same answer
  void find(std::vector<NearPair>& found, std::vector<double>* bounds = nullptr,
            SelfProximityCost* cost = nullptr, linear::ThreadPool* pool = nullptr);

  const MeshElements& elements() const { return elements_; }
  double distance() const { return distance_; }
  /// Pairs that are looked at one by one, see above, ascending.
  const std::vector<ElementPair>& neighbours() const { return neighbours_; }

 private:
  using Pair = kernels::VolumePair;
  /// Of the pairs of leaves, and what is found there.
  struct Part {
    LeafElements::Scratch scratch;
    std::vector<ElementPair> candidates;  // of a pair of leaves
    std::vector<NearPair> found;
    std::int64_t distances = 0;
  };
  static constexpr int kParts = 16;
  struct Answer;

  void findNeighbours(const KdopHierarchy& hierarchy, bool& reference_touches);
  void traverse(const KdopHierarchy& hierarchy, bool leave_out);
  void visit(const KdopHierarchy& hierarchy, int volume, bool leave_out);
  void visit(const KdopHierarchy& hierarchy, const Pair* pairs, int count);
  void compare(const KdopHierarchy& hierarchy, const Pair& leaves);
  template <typename Test>
  void testCandidates(const KdopHierarchy& hierarchy, linear::ThreadPool* pool, const Test& test);
  bool isNeighbour(const ElementPair& pair, const std::array<int, 4>& vertices) const;

  const KdopHierarchy& hierarchy_;
  MeshElements elements_;
  LeafElements leaf_elements_;
  FlatRegions flat_;
  std::vector<Eigen::Vector3d> reference_;  // m
  double distance_;                         // m
  double reach_ = 0.0;                      // m, of neighbours in the reference state
  double longest_edge_ = 0.0;               // m, in the reference state
  std::vector<ElementPair> neighbours_;
  std::vector<bool> is_excluded_;  // of neighbours_
  bool flat_is_known_ = false;

  int age_of_front_ = 0;              // finds since it began at the root
  std::int64_t tests_from_root_ = 0;  // that were needed then
  std::int64_t last_tests_ = 0;
  std::vector<Pair> front_, next_front_;
  std::vector<float> limits_;
  std::vector<Pair> leaf_pairs_;
  std::vector<int> new_leaves_;
  std::array<Part, kParts> parts_;
  SelfProximityCost cost_;
};

}  // namespace haptex::proximity
