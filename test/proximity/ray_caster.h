// Sky shares by casting rays at every triangle: the second implementation.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <vector>

#include "haptex/proximity/sky_occlusion.h"

namespace haptex::proximity {

/// Whether a ray meets a triangle (Moeller and Trumbore 1997, J. Graphics Tools 2:21).
inline bool meets(const Eigen::Vector3d& from, const Eigen::Vector3d& along,
                  const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  const Eigen::Vector3d first = b - a, second = c - a, p = along.cross(second);
  const double det = first.dot(p);
  if (std::abs(det) < 1e-300) return false;
  const Eigen::Vector3d to = from - a;
  const double u = to.dot(p) / det;
  if (u < 0.0 || u > 1.0) return false;
  const Eigen::Vector3d q = to.cross(first);
  const double v = along.dot(q) / det;
  return v >= 0.0 && u + v <= 1.0 && second.dot(q) / det > 0.0;
}

/// Of one particle, with `rays` rays for each side: Hammersley's points on the disc of the cosine.
inline SkyShare castSky(const std::vector<std::array<int, 3>>& triangles,
                        const std::vector<Eigen::Vector3d>& positions, int particle, int rays) {
  using Eigen::Vector3d;
  Vector3d normal = Vector3d::Zero();
  for (const auto& t : triangles) {
    if (t[0] != particle && t[1] != particle && t[2] != particle) continue;
    normal += (positions[t[1]] - positions[t[0]]).cross(positions[t[2]] - positions[t[0]]);
  }
  if (!(normal.norm() > 0.0)) return {};
  normal.normalize();
  const Vector3d u = normal.unitOrthogonal(), v = normal.cross(u);
  int seen[2] = {0, 0};
  for (int side = 0; side < 2; ++side) {
    for (int i = 0; i < rays; ++i) {
      double inverse = 0.0, digit = 0.5;
      for (int bits = i; bits > 0; bits /= 2, digit /= 2.0) inverse += digit * (bits % 2);
      const double r = std::sqrt((i + 0.5) / rays), angle = 2.0 * M_PI * inverse;
      const Vector3d along = r * std::cos(angle) * u + r * std::sin(angle) * v +
                             (side == 0 ? 1.0 : -1.0) * std::sqrt(1.0 - r * r) * normal;
      bool hidden = false;
      for (std::size_t t = 0; t < triangles.size() && !hidden; ++t) {
        const auto& [a, b, c] = triangles[t];
        if (a == particle || b == particle || c == particle) continue;
        hidden = meets(positions[particle], along, positions[a], positions[b], positions[c]);
      }
      seen[side] += !hidden;
    }
  }
  return {static_cast<float>(seen[0]) / static_cast<float>(rays),
          static_cast<float>(seen[1]) / static_cast<float>(rays)};
}

}  // namespace haptex::proximity
