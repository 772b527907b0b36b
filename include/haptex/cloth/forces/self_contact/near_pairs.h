// Pairs of elements of a cloth that are near each other, while it moves.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "haptex/cloth/forces/self_contact/rest_surface.h"
#include "haptex/proximity/kdop_hierarchy.h"
#include "haptex/proximity/self_proximity.h"

namespace haptex::cloth {

/// Which particles of a cloth that intersects itself belong to which side of which tangle: a bit
/// for each tangle, if need be for several. Empty, or all 0: to none.
struct TangleSides {
  std::vector<std::uint64_t> first, second;

  bool operator==(const TangleSides& other) const {
    return first == other.first && second == other.second;
  }
};

/// Keeps the answer of proximity::SelfProximity as long as the particles have moved so little since
/// that it still has all pairs that are asked for.
///
/// Allocates nothing once its buffers have had the size that they need.
class NearPairs {
 public:
  struct Pair {
    proximity::ElementPairKind kind;
    int first, second;            ///< ElementPair
    std::array<int, 4> vertices;  ///< proximity::verticesOf()
    int obstacle = -1;            ///< that has one of the elements; -1: none (NearObstacles)
    double radius = 0.0;          ///< m, within which that element is solid
    double distance = 0.0;        ///< m, at most that of the surfaces where they were searched for

    friend bool operator<(const Pair& a, const Pair& b) {
      return proximity::ElementPair{a.kind, a.first, a.second} <
             proximity::ElementPair{b.kind, b.first, b.second};
    }
  };

  /// @param distance m, up to which pairs can be asked for, > 0. Looks for those up to searched().
  /// @throws std::invalid_argument if the cloth has several panels, and an altitude of a triangle
  /// is
  ///   not above the distance: neighbours are known in one panel only
  NearPairs(const RestSurface& rest, double distance);
  NearPairs(const NearPairs&) = delete;
  NearPairs& operator=(const NearPairs&) = delete;

  /// Afterwards pairs() has all that are at most `distance` apart at these positions, but for
  /// neighbours in the fabric.
  /// @param positions m
  /// @param distance  m, below searched()
  /// @param pool      shares the work if it is given, to the same pairs
  /// @return false, and pairs() as before, if a position is not finite or beyond
  ///   proximity::kMaxLength
  bool find(const std::vector<Eigen::Vector3d>& positions, double distance,
            linear::ThreadPool* pool = nullptr);
  /// From now on pairs() and neighbours() are without those of an element on one side of a tangle
  /// and another one on its other side: these do not know on which side of each other they belong.
  /// @return whether that is a change
  bool leaveOut(const TangleSides& sides);
  /// How far (m) the farthest of some places is from where it was before; as many.
  static double farthest(const std::vector<Eigen::Vector3d>& now,
                         const std::vector<Eigen::Vector3d>& before);
  /// The same beyond a motion that all have in common: no two of them have come nearer to each
  /// other by more than twice that (m).
  static double farthestBeyondCommon(const std::vector<Eigen::Vector3d>& now,
                                     const std::vector<Eigen::Vector3d>& before);

  /// m, that a pair of pairs() is at least apart at the positions of the last find(). May be < 0.
  double leastDistance(const Pair& pair) const { return pair.distance - 2.0 * moved_ - kRounding; }
  /// Whether it is surely farther apart than a distance (m).
  bool isBeyond(const Pair& pair, double distance) const { return leastDistance(pair) > distance; }
  /// By kind, first and second.
  const std::vector<Pair>& pairs() const { return pairs_; }
  /// Pairs that were at most 2 searched() apart in the flat fabric: those that find() leaves out
  /// are among them. None in a mesh whose altitudes are more, or of several panels.
  const std::vector<Pair>& neighbours() const { return neighbours_; }

  double searched() const { return self_.distance(); }  ///< m
  const std::vector<std::array<int, 3>>& triangles() const { return hierarchy_.triangles(); }
  std::size_t particleCount() const { return hierarchy_.positions().size(); }

 private:
  static constexpr double kRounding = 1e-12;  // m, more than that of distances
  struct Found {                              // of one first element
    int second;
    int place;  // in found_
  };

  int bucketOf(const proximity::ElementPair& pair) const;
  void sortFound(linear::ThreadPool* pool);
  Pair named(const proximity::ElementPair& pair) const;
  bool isInTangle(const Pair& pair) const;

  static proximity::SelfProximity makeProximity(const proximity::KdopHierarchy& hierarchy,
                                                const RestSurface& rest, double distance);

  proximity::KdopHierarchy hierarchy_;
  proximity::SelfProximity self_;
  std::vector<proximity::NearPair> found_;
  std::vector<Found> sorted_;       // found_ by kind, first and second
  std::vector<int> end_of_bucket_;  // in sorted_, of the pairs of one kind and first element
  std::vector<Pair> pairs_, neighbours_;
  std::vector<Pair> all_neighbours_;          // those in tangles, too
  TangleSides sides_;                         // empty if there are no tangles
  std::vector<Eigen::Vector3d> searched_at_;  // m; empty before the first find()
  double moved_ = 0.0;                        // m, farthest since, beyond a common motion
};

}  // namespace haptex::cloth
