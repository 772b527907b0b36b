// Edges of triangles: edge i leads from corner i to the next one.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <optional>

namespace haptex::proximity {

/// Where on the segment from begin to end (m) the point nearest to a place lies, 0 at begin to 1 at
/// end; 0 for a segment without length.
inline double nearestFraction(const Eigen::Vector3d& place, const Eigen::Vector3d& begin,
                              const Eigen::Vector3d& end) {
  const Eigen::Vector3d way = end - begin;
  const double square = way.squaredNorm();
  return square > 0.0 ? std::clamp((place - begin).dot(way) / square, 0.0, 1.0) : 0.0;
}

/// Where two segments, each from its begin to its end (m), are nearest to each other, as fractions
/// of the first and of the second; nothing unless that is inside of both, or where they are
/// parallel or one has no length.
inline std::optional<std::array<double, 2>> nearestInside(const Eigen::Vector3d& begin,
                                                          const Eigen::Vector3d& end,
                                                          const Eigen::Vector3d& other_begin,
                                                          const Eigen::Vector3d& other_end) {
  const auto is_fraction = [](double number) { return number >= 0.0 && number <= 1.0; };
  const Eigen::Vector3d way = end - begin, other_way = other_end - other_begin;
  const Eigen::Vector3d offset = other_begin - begin;
  const double square = way.squaredNorm();
  if (square <= 0.0) return std::nullopt;
  // Orthogonalised, which rounds less than the normal equations where they are nearly parallel.
  const Eigen::Vector3d across = other_way - (other_way.dot(way) / square) * way;
  const Eigen::Vector3d offset_across = offset - (offset.dot(way) / square) * way;
  const double across_square = across.squaredNorm();
  if (across_square <= 0.0) return std::nullopt;
  const double t = -offset_across.dot(across) / across_square;
  if (!is_fraction(t)) return std::nullopt;
  const double s = (offset + t * other_way).dot(way) / square;
  if (!is_fraction(s)) return std::nullopt;
  return {{s, t}};
}

/// Barycentric weights of the point a fraction along an edge.
inline Eigen::Vector3d edgeWeights(int edge, double fraction) {
  Eigen::Vector3d weights = Eigen::Vector3d::Zero();
  weights[edge] = 1.0 - fraction;
  weights[(edge + 1) % 3] = fraction;
  return weights;
}

}  // namespace haptex::proximity
