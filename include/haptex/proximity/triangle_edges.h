// Edges of triangles: edge i leads from corner i to the next one.
#pragma once

#include <Eigen/Core>
#include <algorithm>

namespace haptex::proximity {

/// Where on the segment from begin to end (m) the point nearest to a place lies, 0 at begin to 1 at
/// end; 0 for a segment without length.
inline double nearestFraction(const Eigen::Vector3d& place, const Eigen::Vector3d& begin,
                              const Eigen::Vector3d& end) {
  const Eigen::Vector3d way = end - begin;
  const double square = way.squaredNorm();
  return square > 0.0 ? std::clamp((place - begin).dot(way) / square, 0.0, 1.0) : 0.0;
}

/// Barycentric weights of the point a fraction along an edge.
inline Eigen::Vector3d edgeWeights(int edge, double fraction) {
  Eigen::Vector3d weights = Eigen::Vector3d::Zero();
  weights[edge] = 1.0 - fraction;
  weights[(edge + 1) % 3] = fraction;
  return weights;
}

}  // namespace haptex::proximity
