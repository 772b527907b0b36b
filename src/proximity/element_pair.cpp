#include "haptex/proximity/element_pair.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "haptex/proximity/triangle_edges.h"

namespace haptex::proximity {
namespace {

using Eigen::Vector3d;
using Eigen::Vector4d;
using Places = std::array<Vector3d, 4>;

constexpr double kSafety = 1e-9;  // far more than the rounding of distances

Places placesOf(const ElementPair& pair, const MeshElements& elements,
                const std::vector<Vector3d>& positions) {
  const std::array<int, 4> vertices = verticesOf(pair, elements);
  return {positions[vertices[0]], positions[vertices[1]], positions[vertices[2]],
          positions[vertices[3]]};
}

/// The best of several pairs of points of two segments.
class SegmentSearch {
 public:
  explicit SegmentSearch(const Places& places) : p_(places) {}

  PairDistance run() {
    if (const auto inside = nearestInside(p_[0], p_[1], p_[2], p_[3])) {
      consider((*inside)[0], (*inside)[1]);
      if (!isNearlyParallel()) return result();
    }
    for (int end = 0; end < 2; ++end) {
      consider(end, nearestFraction(p_[end], p_[2], p_[3]));
      consider(nearestFraction(p_[2 + end], p_[0], p_[1]), end);
    }
    return result();
  }

 private:
  /// So that rounding may make an end the better place.
  bool isNearlyParallel() const {
    constexpr double kSine = 1e-3;
    const Vector3d way = p_[1] - p_[0], other = p_[3] - p_[2];
    return way.cross(other).squaredNorm() < kSine * kSine * way.squaredNorm() * other.squaredNorm();
  }

  PairDistance result() const {
    return {std::sqrt(square_),
            Vector4d(1.0 - fractions_[0], fractions_[0], 1.0 - fractions_[1], fractions_[1])};
  }

  void consider(double s, double t) {
    const double square =
        ((p_[0] + s * (p_[1] - p_[0])) - (p_[2] + t * (p_[3] - p_[2]))).squaredNorm();
    if (!(square < square_)) return;
    square_ = square;
    fractions_ = {s, t};
  }

  const Places& p_;
  double square_ = std::numeric_limits<double>::infinity();
  std::array<double, 2> fractions_ = {0.0, 0.0};
};

}  // namespace

MeshElements::MeshElements(const std::vector<std::array<int, 3>>& triangles_of_mesh)
    : triangles(triangles_of_mesh) {
  for (const auto& triangle : triangles) {
    for (int i = 0; i < 3; ++i) {
      const int a = triangle[i], b = triangle[(i + 1) % 3];
      vertices.push_back(a);
      if (a != b) edges.push_back(edgeBetween(a, b));
    }
  }
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
}

int MeshElements::indexOf(const Edge& edge) const {
  return static_cast<int>(std::lower_bound(edges.begin(), edges.end(), edge) - edges.begin());
}

std::array<int, 4> verticesOf(const ElementPair& pair, const MeshElements& elements) {
  if (pair.kind == ElementPairKind::kVertexTriangle) {
    const auto& triangle = elements.triangles[pair.second];
    return {pair.first, triangle[0], triangle[1], triangle[2]};
  }
  const Edge& first = elements.edges[pair.first];
  const Edge& second = elements.edges[pair.second];
  return {first[0], first[1], second[0], second[1]};
}

bool isAdjacent(const ElementPair& pair, const MeshElements& elements) {
  const std::array<int, 4> v = verticesOf(pair, elements);
  if (pair.kind == ElementPairKind::kVertexTriangle) {
    return v[0] == v[1] || v[0] == v[2] || v[0] == v[3];
  }
  return v[0] == v[2] || v[0] == v[3] || v[1] == v[2] || v[1] == v[3];
}

PairDistance vertexTriangleDistance(const Places& places) {
  const Triangle triangle = {places[1], places[2], places[3]};
  const TrianglePoint nearest = closestPoint(triangle, places[0]);
  return {nearest.distance,
          Vector4d(1.0, nearest.barycentric[0], nearest.barycentric[1], nearest.barycentric[2])};
}

PairDistance edgeEdgeDistance(const Places& places) { return SegmentSearch(places).run(); }

PairDistance distanceOf(ElementPairKind kind, const Places& places) {
  return kind == ElementPairKind::kVertexTriangle ? vertexTriangleDistance(places)
                                                  : edgeEdgeDistance(places);
}

Separation separationOf(ElementPairKind kind, const Places& places) {
  const PairDistance nearest = distanceOf(kind, places);
  Separation separation{nearest.distance, nearest.weights, Vector3d::Zero()};
  const int first_end = kind == ElementPairKind::kVertexTriangle ? 1 : 2;
  for (int i = 0; i < 4; ++i) {
    if (i >= first_end) separation.weights[i] *= -1.0;
    separation.away += separation.weights[i] * places[i];
  }
  return separation;
}

bool isSurelyApart(ElementPairKind kind, const Places& places, double distance) {
  const bool is_face = kind == ElementPairKind::kVertexTriangle;
  const Vector3d normal = is_face ? (places[2] - places[1]).cross(places[3] - places[1])
                                  : (places[1] - places[0]).cross(places[3] - places[2]);
  // Whatever the rounding of the normal, all places of one element have to be on one side.
  const int first_end = is_face ? 1 : 2;
  double least = std::numeric_limits<double>::infinity(), most = -least, size = 0.0;
  for (int i = 0; i < first_end; ++i) {
    for (int j = first_end; j < 4; ++j) {
      const Vector3d offset = places[j] - places[i];
      const double height = normal.dot(offset);
      least = std::min(least, height);
      most = std::max(most, height);
      size = std::max(size, offset.squaredNorm());
    }
  }
  const double clear = std::max(least, -most);
  if (!(clear > 0.0 && clear * clear > distance * distance * normal.squaredNorm())) return false;
  const double wanted = (1.0 + kSafety) * distance + kSafety * std::sqrt(size);
  return clear * clear > wanted * wanted * normal.squaredNorm();
}

std::vector<ElementPair> nearPairsByBruteForce(const MeshElements& elements,
                                               const std::vector<Vector3d>& positions,
                                               double distance) {
  std::vector<ElementPair> found;
  const auto consider = [&](const ElementPair& pair) {
    if (isAdjacent(pair, elements)) return;
    if (distanceOf(pair.kind, placesOf(pair, elements, positions)).distance <= distance) {
      found.push_back(pair);
    }
  };
  for (int vertex : elements.vertices) {
    for (int triangle = 0; triangle < static_cast<int>(elements.triangles.size()); ++triangle) {
      consider({ElementPairKind::kVertexTriangle, vertex, triangle});
    }
  }
  for (int first = 0; first < static_cast<int>(elements.edges.size()); ++first) {
    for (int second = first + 1; second < static_cast<int>(elements.edges.size()); ++second) {
      consider({ElementPairKind::kEdgeEdge, first, second});
    }
  }
  return found;
}

}  // namespace haptex::proximity
