// Where a cloth intersects itself: the contours of the intersection.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

#include "haptex/proximity/element_pair.h"
#include "haptex/proximity/mesh_intersections.h"

namespace haptex::cloth {

/// The surfaces of a mesh, as what looks at its intersections needs them.
struct MeshTopology {
  /// @param triangles without defects
  MeshTopology(const std::vector<std::array<int, 3>>& triangles, std::size_t particles);

  /// Unit, of a triangle; zero of one without an area.
  Eigen::Vector3d normalOf(const std::vector<Eigen::Vector3d>& positions, int triangle) const;

  proximity::MeshElements elements;
  std::vector<std::array<int, 3>> edges_of;     ///< of a triangle, edge i from its corner i on
  std::vector<std::vector<int>> triangles_at;   ///< of an edge, ascending
  std::vector<std::vector<int>> neighbours_of;  ///< of a particle, along edges, ascending
};

/// An edge that goes through a triangle.
struct Crossing {
  int edge;                 ///< in MeshElements::edges
  int triangle;             ///< index
  double share;             ///< of the edge, from its first end to the place
  Eigen::Vector3d weights;  ///< barycentric, of the place in the triangle
  int contour;              ///< that it is a part of
  bool on_first;            ///< whether the edge belongs to the contour's first side, and the
                            ///< triangle to its second; or else the other way round
  /// No unit. The contour becomes shorter where the edge goes that way against the triangle:
  ///   sum over the triangles that contain the edge of R - 2 (E . R) / (E . N) N,
  /// R the unit direction of the contour into the triangle, E the edge's, N the normal of the
  /// triangle that is crossed (Volino and Magnenat-Thalmann, Resolving surface collisions through
  /// intersection contour minimization, SIGGRAPH 2006).
  Eigen::Vector3d shorter;
};

/// Finds crossings and joins them to contours: two triangles intersect along a segment, and go on
/// along it into those beyond the edge that it ends at. Of what a contour goes through, one surface
/// is its first side and the other one its second. Pairs that intersect without a crossing, because
/// they lie in a plane or touch, are contours of their own.
///
/// Allocates nothing once its buffers have had the size that they need.
class IntersectionContours {
 public:
  /// @param topology must outlive this
  explicit IntersectionContours(const MeshTopology& topology);

  /// @param pairs that intersect (MeshIntersections::find()), ascending
  void find(const std::vector<Eigen::Vector3d>& positions,
            const std::vector<proximity::TrianglePair>& pairs);

  int count() const { return count_; }
  /// By edge and triangle.
  const std::vector<Crossing>& crossings() const { return crossings_; }
  /// Of a pair given to find(): its contour, and whether its first triangle is on the first side.
  int contourOf(std::size_t pair) const { return contour_of_[pair]; }
  bool isFirstOnFirst(std::size_t pair) const { return on_first_[pair]; }

 private:
  /// A crossing as one of the pairs sees it of whose segment it is an end.
  struct Hit {
    int edge, triangle;
    double share;
    int pair;
    bool edge_of_first;     // the edge is one of the pair's first triangle
    Eigen::Vector3d place;  // m
    Eigen::Vector3d ahead;  // unit, to the other end of the segment; zero where it has none

    friend bool operator<(const Hit& a, const Hit& b) {
      if (a.edge != b.edge) return a.edge < b.edge;
      return a.triangle != b.triangle ? a.triangle < b.triangle : a.pair < b.pair;
    }
  };

  void findHits(const std::vector<Eigen::Vector3d>& positions, const proximity::TrianglePair& pair,
                int index);
  int rootOf(int pair);
  void join(const Hit& a, const Hit& b);
  Eigen::Vector3d shorter(const std::vector<Eigen::Vector3d>& positions, const Hit& hit) const;
  void nameContours();

  const MeshTopology& topology_;
  int count_ = 0;
  std::vector<Hit> hits_;
  std::vector<int> parent_;    // of a pair, in trees of joined ones
  std::vector<char> swapped_;  // against the parent: the first triangle is on its second's side
  std::vector<int> contour_of_;
  std::vector<char> on_first_;
  std::vector<Crossing> crossings_;
};

}  // namespace haptex::cloth
