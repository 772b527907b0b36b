// The energies of which contact of a cloth with itself is the sum, at given positions.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "haptex/cloth/forces/self_contact/layer_law.h"
#include "haptex/cloth/forces/self_contact/near_obstacles.h"
#include "haptex/cloth/forces/self_contact/near_pairs.h"
#include "haptex/cloth/forces/self_contact/rest_surface.h"
#include "haptex/cloth/forces/self_contact/surface_features.h"

namespace haptex::cloth {

/// A vertex near a face, an edge or a vertex, or two edges near each other; or one of them of the
/// cloth and the other one of an obstacle.
struct PairEnergy {
  int count;                      ///< of its particles, 1 to 4
  std::array<int, 4> vertices;    ///< particles
  std::array<double, 4> weights;  ///< sum up to 0: sum w_i x_i = distance normal; or to 1 with an
                                  ///< obstacle: sum w_i x_i = nearest point of the cloth
  Eigen::Vector3d normal;         ///< unit; out of an obstacle
  double distance;                ///< m; from the surface of an obstacle
  double energy;                  ///< J
  double force;                   ///< N along the normal, < 0 of what is subtracted
  double stiffness;               ///< N/m along the normal; 0 of what is subtracted
  bool parallel = false;          ///< whether the energy depends on the edge vectors, too
  Eigen::Vector3d by_first = Eigen::Vector3d::Zero();   ///< N, energy's derivative by the first
                                                        ///< edge vector besides by the distance
  Eigen::Vector3d by_second = Eigen::Vector3d::Zero();  ///< N, likewise the second
  int obstacle = -1;                                    ///< -1: the cloth and itself
  std::array<int, 2> fabrics = {0, 0};                  ///< of both sides; alike at an obstacle
  Eigen::Vector3d way = Eigen::Vector3d::Zero();  ///< m, that the obstacle's surface goes there in
                                                  ///< the step

  /// Derivative of the energy by the place of vertex i (N).
  Eigen::Vector3d gradient(int i) const {
    Eigen::Vector3d sum = -force * weights[i] * normal;
    if (parallel) sum += (i < 2 ? by_first : by_second) * (i % 2 == 0 ? -1.0 : 1.0);
    return sum;
  }
};

/// Lists the energies. Of every vertex with half of its area, so that both sides together have the
/// whole pressure, the law's energy at the distance of the surface, counted as SurfaceFeatures
/// says. It is C1 because distances to convex sets are. Of edges the law's guard, times
///   m = c (2 - c), c = |a x b|^2 / (1e-3 A B) up to 1, with the edge vectors a, b and the rest
///   lengths squared A, B,
/// because the distance of edges that become parallel has a kink (Li et al. 2020).
///
/// In cloth of several fabrics the law is that of each two which meet (LayerPair). A vertex between
/// regions has of each fabric the area that belongs to it, and an edge the fabric of one of its
/// triangles.
///
/// An obstacle's surface mirrors the cloth: at the distance g of its middle surface from there, the
/// fabric has the pressure of two layers 2 g apart, on the whole area of its vertices. What the
/// obstacle's vertices and edges do between them is the guard's affair.
class PairEnergies {
 public:
  /// @param layers of the fabrics that the surface names
  PairEnergies(const RestSurface& rest, FabricLayers layers);

  /// Makes room for the obstacles.
  void setObstacles(const ObstacleSurfaces& surfaces);

  /// @param near  has found all pairs that are within the law's thickness at these positions
  /// @param found replaced
  void find(const std::vector<Eigen::Vector3d>& positions, const NearPairs& near,
            std::vector<PairEnergy>& found);
  /// @param near   has found all that are within half of the thickness there
  /// @param at_end of the step, or else at its beginning
  /// @param found  added to
  void findOfObstacles(const std::vector<Eigen::Vector3d>& positions, const NearObstacles& near,
                       bool at_end, std::vector<PairEnergy>& found);

  const FabricLayers& layers() const { return layers_; }

 private:
  using Positions = std::vector<Eigen::Vector3d>;
  using Pair = NearPairs::Pair;
  /// Of the obstacles at one end of a step.
  struct Obstacles {
    const ObstacleSurfaces& surfaces;
    bool at_end;
    const Positions& places;
  };

  /// Of a vertex: what belongs to it of a fabric, m^2.
  struct Area {
    int fabric;
    double area;
  };
  void addAreas();
  int fabricOf(int triangle) const { return fabrics_.empty() ? 0 : fabrics_[triangle]; }
  int fabricOfEdge(int edge) const { return edge_fabrics_.empty() ? 0 : edge_fabrics_[edge]; }

  void addVertex(const Positions& positions, int vertex, std::vector<PairEnergy>& found);
  void addVertexAtObstacle(const Positions& positions, const Obstacles& obstacles, const Pair& pair,
                           std::vector<PairEnergy>& found);
  void addObstacleVertex(const Positions& positions, const Obstacles& obstacles, const Pair& pair,
                         std::vector<PairEnergy>& found) const;
  void addEdges(const Positions& positions, const Pair& pair, std::vector<PairEnergy>& found) const;
  void addEdgesAtObstacle(const Positions& positions, const Obstacles& obstacles, const Pair& pair,
                          std::vector<PairEnergy>& found) const;

  FabricLayers layers_;
  int particles_;
  std::vector<std::array<int, 3>> triangles_;
  SurfaceFeatures cloth_;
  std::optional<SurfaceFeatures> obstacles_;
  std::vector<int> fabrics_, edge_fabrics_;    // of triangles and edges; empty: all of fabric 0
  std::vector<Area> areas_;                    // half of what belongs to the vertices, and
  std::vector<int> first_area_;                // where each one's begin; one more
  std::vector<double> edge_areas_;             // m^2, half of what belongs to an edge
  std::vector<double> edge_squares_;           // m^2, rest length squared
  std::vector<double> obstacle_edge_squares_;  // m^2, likewise
  std::vector<double> triangle_areas_;         // m^2
  std::vector<int> near_;                      // triangles near the vertex, ascending
};

}  // namespace haptex::cloth
