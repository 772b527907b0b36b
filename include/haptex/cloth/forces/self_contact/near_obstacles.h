// Pairs of elements of a cloth and of obstacles that are near each other, while both move.
#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <vector>

#include "haptex/cloth/forces/self_contact/near_pairs.h"
#include "haptex/cloth/forces/self_contact/obstacle_surfaces.h"
#include "haptex/proximity/box_tree.h"

namespace haptex::cloth {

/// The pairs are those of proximity::ElementPair between a cloth and obstacles. The vertices of the
/// obstacles are numbered after the particles. In a pair of a vertex of an obstacle and a triangle
/// of the cloth, `first` is so too; all other numbers count from 0 on either side. Of two edges the
/// cloth's is the first.
///
/// Finds them through boxes around all triangles, those of the obstacles in a tree, those of the
/// cloth one after the other, and then around their vertices and edges. The threads of a pool, if
/// one is given, share that, and find the same pairs in the same order. Allocates nothing once its
/// buffers have had the size that they need.
class NearObstacles {
 public:
  using Pair = NearPairs::Pair;
  using Places = std::vector<Eigen::Vector3d>;  // m

  /// @param searched m, up to which pairs can be asked for, > 0
  NearObstacles(const std::vector<std::array<int, 3>>& triangles, std::size_t particles,
                std::shared_ptr<ObstacleSurfaces> surfaces, double searched);

  ObstacleSurfaces& surfaces() const { return *surfaces_; }
  double searched() const { return searched_; }  ///< m

  /// Afterwards pairs() has all whose surfaces are at most `distance` apart.
  /// @param positions, places m, of the particles and of the vertices of the obstacles, finite
  /// @param distance  m, below the one searched for
  void find(const Places& positions, const Places& places, double distance,
            linear::ThreadPool* pool = nullptr);
  /// As NearPairs::leastDistance() and isBeyond(), of the surfaces.
  double leastDistance(const Pair& pair) const { return pair.distance - moved_ - kRounding; }
  bool isBeyond(const Pair& pair, double distance) const { return leastDistance(pair) > distance; }
  /// By kind, first and second.
  const std::vector<Pair>& pairs() const { return pairs_; }

  /// Pairs that may come near each other on straight ways, among them all whose surfaces ever are
  /// at most `distance` apart, however much shorter ways become.
  /// @param common, ways         m, of the particles: way i is common + ways[i]
  /// @param places, place_ways   m, of the vertices of the obstacles, and their ways; null: they
  ///   rest
  const std::vector<Pair>& onWays(const Places& positions, const Eigen::Vector3d& common,
                                  const Places& ways, const Places& places,
                                  const Places* place_ways, double distance,
                                  linear::ThreadPool* pool = nullptr);

 private:
  using Box = proximity::BoxTree::Box;
  /// The vertices and edges of every triangle that no triangle before it has.
  struct OwnElements {
    explicit OwnElements(const proximity::MeshElements& elements);
    std::vector<std::vector<int>> vertices, edges;
  };

  static constexpr double kRounding = 1e-12;  // m, more than that of distances

  void fitObstacleBoxes(const Places& places, const Places* ways);
  void collect(double distance, linear::ThreadPool* pool);
  void join(std::vector<Pair>& pairs) const;
  double distanceOf(const Pair& pair, const Places& positions, const Places& places) const;
  void addPairs(int of_cloth, int of_obstacle, double distance, std::vector<Pair>& found) const;

  std::shared_ptr<ObstacleSurfaces> surfaces_;
  proximity::MeshElements cloth_;
  int particles_;
  double searched_;  // m
  OwnElements own_of_cloth_, own_of_obstacles_;
  std::vector<Box> corner_boxes_;  // of the ways of all vertices, without radius
  std::vector<Box> boxes_;         // of the obstacles' triangles
  proximity::BoxTree tree_;
  Places fitted_at_;                      // m, of the obstacles whose boxes these are at rest
  std::vector<std::vector<Pair>> found_;  // by part of the cloth
  std::vector<Pair> pairs_, on_ways_;
  Places searched_at_, places_searched_at_;  // m; empty before the first find()
  double moved_ = 0.0;                       // m, farthest of both since, together
};

}  // namespace haptex::cloth
