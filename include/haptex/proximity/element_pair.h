// Pairs of elements of a mesh through which surfaces touch first: a vertex and a triangle, or two
// edges.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "haptex/proximity/triangle_distance.h"

namespace haptex::proximity {

using Edge = std::array<int, 2>;  ///< vertex indices, the smaller one first
inline Edge edgeBetween(int a, int b) { return a < b ? Edge{a, b} : Edge{b, a}; }

/// Vertices, edges and triangles of a mesh.
struct MeshElements {
  /// @param triangles vertex indices, not checked
  explicit MeshElements(const std::vector<std::array<int, 3>>& triangles);

  std::vector<std::array<int, 3>> triangles;
  std::vector<int> vertices;  ///< those that a triangle has, ascending
  std::vector<Edge> edges;    ///< each once, ascending

  /// Of the edge between two vertices, which must be one, in edges.
  int indexOf(const Edge& edge) const;
};

enum class ElementPairKind {
  kVertexTriangle,  ///< first is a vertex, second a triangle that does not have it
  kEdgeEdge,        ///< two edges without a common vertex, the smaller index first
};

struct ElementPair {
  ElementPairKind kind;
  int first;   ///< vertex index, or index in MeshElements::edges
  int second;  ///< triangle index, or index in MeshElements::edges
};

inline bool operator==(const ElementPair& a, const ElementPair& b) {
  return a.kind == b.kind && a.first == b.first && a.second == b.second;
}
inline bool operator<(const ElementPair& a, const ElementPair& b) {
  if (a.kind != b.kind) return a.kind < b.kind;
  return a.first != b.first ? a.first < b.first : a.second < b.second;
}

/// The vertices of a pair: vertex and corners of the triangle, or the ends of both edges.
std::array<int, 4> verticesOf(const ElementPair& pair, const MeshElements& elements);

/// Whether the elements have a vertex in common: then they are no pair.
bool isAdjacent(const ElementPair& pair, const MeshElements& elements);

/// The two points of a pair that are nearest to each other.
struct PairDistance {
  double distance;          ///< m
  Eigen::Vector4d weights;  ///< of verticesOf(): those of each element sum up to 1
};

/// Of a vertex and a triangle, 0 at a place of the triangle; see closestPoint().
PairDistance vertexTriangleDistance(const std::array<Eigen::Vector3d, 4>& places);
/// Of two segments, places 0 to 1 and 2 to 3, which may be points and parallel: the best of the
/// nearest points of their insides and of each end with the other segment, right to some 1e-16
/// times the largest coordinate difference.
PairDistance edgeEdgeDistance(const std::array<Eigen::Vector3d, 4>& places);
PairDistance distanceOf(ElementPairKind kind, const std::array<Eigen::Vector3d, 4>& places);

/// The way from the nearest point of the second element of a pair to that of the first.
struct Separation {
  double distance;          ///< m
  Eigen::Vector4d weights;  ///< of verticesOf(): those of PairDistance, of the second one negative
  Eigen::Vector3d away;     ///< m, the sum of the weights times the places
};
Separation separationOf(ElementPairKind kind, const std::array<Eigen::Vector3d, 4>& places);

/// Whether a plane between the elements, along the triangle or both edges, tells that they are
/// farther apart than a distance (m), by more than distanceOf() may be off. Faster than that; false
/// says nothing.
bool isSurelyApart(ElementPairKind kind, const std::array<Eigen::Vector3d, 4>& places,
                   double distance);

/// All pairs that are not adjacent and at most `distance` (m) apart, ascending, by asking all: the
/// oracle of SelfProximity.
std::vector<ElementPair> nearPairsByBruteForce(const MeshElements& elements,
                                               const std::vector<Eigen::Vector3d>& positions,
                                               double distance);

}  // namespace haptex::proximity
