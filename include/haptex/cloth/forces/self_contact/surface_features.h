// The faces, edges and vertices of a surface that are nearest to a place, each with how often it
// counts.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace haptex::cloth {

/// In the sum
///   sum over triangles - sum over inner edges + sum over inner vertices
/// of anything that depends on the distance of a place (Li et al., Convergent Incremental Potential
/// Contact, 2023), all that a plane ball around the place reaches is counted once, however it is
/// cut into triangles. Simplices that are nearest at the same point are one feature, and what
/// cancels counts 0 times. Triangles without area have no inner edges nor vertices.
///
/// Where triangles of several fabrics meet, an edge or a vertex counts as much for each as it has
/// triangles of it. So a place that goes from one fabric to another sees the one fade and the other
/// come, within its reach and without a jump.
class SurfaceFeatures {
 public:
  struct Feature {
    int size;                       ///< of vertices, 1 to 3
    std::array<int, 3> ids;         ///< of the vertices, ascending, then -1
    std::array<double, 3> weights;  ///< of the nearest point, their sum 1
    double times;                   ///< to be added; what is subtracted counts down
    int fabric = 0;
  };

  /// @param triangles vertex indices @param vertices their number
  /// @param fabrics   of the triangles; empty: all of fabric 0
  SurfaceFeatures(const std::vector<std::array<int, 3>>& triangles, std::size_t vertices,
                  std::vector<int> fabrics = {});

  /// @param positions m, of the vertices
  /// @param place     m
  /// @param near      triangles, ascending, with all that are at most `reach` (m) away
  /// @return until the next call
  const std::vector<Feature>& nearest(const std::vector<Eigen::Vector3d>& positions,
                                      const Eigen::Vector3d& place, const std::vector<int>& near,
                                      double reach);

 private:
  using Positions = std::vector<Eigen::Vector3d>;

  int fabricOf(int triangle) const { return fabrics_.empty() ? 0 : fabrics_[triangle]; }
  void countTriangle(const Positions& positions, const Eigen::Vector3d& place, int triangle,
                     double reach);
  void countEdge(const Positions& positions, const Eigen::Vector3d& place, int from, int to,
                 double times, int fabric);
  void count(Feature feature);
  void countShared(const Positions& positions, const Eigen::Vector3d& place,
                   const std::vector<int>& near, int triangle);

  std::vector<std::array<int, 3>> triangles_;
  std::vector<int> fabrics_;                // of the triangles
  std::vector<std::array<int, 3>> across_;  // per triangle and edge from corner i: the triangle
                                            // that shares it; -1: none, or several
  std::vector<std::vector<int>> around_;    // per inner vertex its triangles, ascending; else none
  std::vector<Feature> features_;
};

}  // namespace haptex::cloth
