// The energies of which contact of a cloth with itself is the sum, at given positions.
#pragma once

#include <Eigen/Core>
#include <array>
#include <utility>
#include <vector>

#include "haptex/cloth/forces/self_contact/layer_law.h"
#include "haptex/cloth/forces/self_contact/near_pairs.h"

namespace haptex::cloth {

/// A vertex near a face, an edge or a vertex, or two edges near each other.
struct PairEnergy {
  int count;                      ///< of its vertices, 2 to 4
  std::array<int, 4> vertices;    ///< particles
  std::array<double, 4> weights;  ///< sum up to 0: sum w_i x_i = distance normal
  Eigen::Vector3d normal;         ///< unit
  double distance;                ///< m
  double energy;                  ///< J
  double force;                   ///< N along the normal, < 0 of what is subtracted
  double stiffness;               ///< N/m along the normal; 0 of what is subtracted
  bool parallel = false;          ///< whether the energy depends on the edge vectors, too
  Eigen::Vector3d by_first = Eigen::Vector3d::Zero();   ///< N, energy's derivative by the first
                                                        ///< edge vector besides by the distance
  Eigen::Vector3d by_second = Eigen::Vector3d::Zero();  ///< N, likewise the second

  /// Derivative of the energy by the place of vertex i (N).
  Eigen::Vector3d gradient(int i) const {
    Eigen::Vector3d sum = -force * weights[i] * normal;
    if (parallel) sum += (i < 2 ? by_first : by_second) * (i % 2 == 0 ? -1.0 : 1.0);
    return sum;
  }
};

/// Lists the energies. Of every vertex with half of its area, so that both sides together have the
/// whole pressure, the law's energy at the distance of the surface, as
///   sum over triangles - sum over inner edges + sum over inner vertices
/// of the energies at their distances (Li et al., Convergent Incremental Potential Contact, 2023).
/// All that a plane ball reaches is counted once in this sum, however it is cut into triangles, and
/// it is C1 because distances to convex sets are. What cancels is left out. Of edges the law's
/// guard, times
///   m = c (2 - c), c = |a x b|^2 / (1e-3 A B) up to 1, with the edge vectors a, b and the rest
///   lengths squared A, B,
/// because the distance of edges that become parallel has a kink (Li et al. 2020).
class PairEnergies {
 public:
  /// @param reference positions (m) of the particles in the flat fabric, without defects
  PairEnergies(const std::vector<std::array<int, 3>>& triangles,
               const std::vector<Eigen::Vector3d>& reference, const LayerLaw& law);

  /// @param pairs all that are within the law's thickness at these positions, and more
  /// @param found replaced
  void find(const std::vector<Eigen::Vector3d>& positions,
            const std::vector<NearPairs::Pair>& pairs, std::vector<PairEnergy>& found);

  const LayerLaw& law() const { return law_; }

 private:
  /// A face, an edge or a vertex that is the nearest part of some simplices.
  struct Feature {
    int size;                // of vertices
    std::array<int, 3> ids;  // of the vertices, ascending, then -1
    std::array<double, 3> weights;
    int times;  // to be added; what is subtracted counts down
  };
  using Positions = std::vector<Eigen::Vector3d>;
  using Pair = NearPairs::Pair;

  void addVertex(const Positions& positions, const Pair* begin, const Pair* end,
                 std::vector<PairEnergy>& found);
  void countTriangle(const Positions& positions, int vertex, const std::array<int, 3>& corners);
  void countEdge(const Positions& positions, int vertex, int from, int to);
  void count(Feature feature);
  void countShared(const Positions& positions, int vertex, int triangle);
  bool isNear(int triangle) const;
  void addEdges(const Positions& positions, const Pair& pair, std::vector<PairEnergy>& found) const;

  LayerLaw law_;
  std::vector<std::array<int, 3>> triangles_;
  std::vector<std::array<int, 3>> across_;  // per triangle and edge from corner i: the triangle
                                            // that shares it; -1: none, or several
  std::vector<std::vector<int>> around_;    // per inner vertex its triangles, ascending; else none
  std::vector<double> vertex_areas_;        // m^2, half of what belongs to a vertex
  std::vector<double> edge_areas_;          // m^2, half of what belongs to an edge
  std::vector<double> edge_squares_;        // m^2, rest length squared
  std::vector<int> near_;                   // triangles near the vertex, ascending
  std::vector<Feature> features_;
};

}  // namespace haptex::cloth
