#include "haptex/cloth/dynamics/stages/relative_motion.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "haptex/linear/shared_rows.h"

namespace haptex::cloth {
namespace {

using Eigen::Vector3d;

constexpr double kMost = 0.15;  // of an edge's length
constexpr double kLeft = 0.8;   // of that
constexpr int kMaxSweeps = 10;

/// What the ends of an edge move relative to each other.
struct RelativeMotion {
  RelativeMotion(const Positions& base, double a, const Velocities& velocities, int i, int j)
      : velocity(velocities[i] - velocities[j]),
        way_squared(a * a * velocity.squaredNorm()),
        most_squared(kMost * kMost * (base[i] - base[j]).squaredNorm()) {}
  bool isBeyond() const { return way_squared > most_squared; }
  /// Of the velocity, that is too much.
  double excess() const { return 1.0 - kLeft * std::sqrt(most_squared / way_squared); }

  Vector3d velocity;    // m/s
  double way_squared;   // m^2, in the stage
  double most_squared;  // m^2, that it may be
};

}  // namespace

RelativeMotionLimit::RelativeMotionLimit(const Cloth& cloth)
    : apart_(cloth.mesh().triangles.size(), 0), moved_(cloth.particleCount(), 0) {}

bool RelativeMotionLimit::apply(const Cloth& cloth, const std::vector<char>& fixed,
                                const Positions& base, double a, ClothState& at,
                                linear::ThreadPool* pool) {
  const std::vector<std::array<int, 3>>& triangles = cloth.mesh().triangles;
  const auto motion = [&](int i, int j) { return RelativeMotion(base, a, at.velocities, i, j); };
  const auto count = static_cast<int>(triangles.size());
  linear::shareRows(pool, count, [&](int begin, int end) {
    for (int t = begin; t < end; ++t) {
      const auto [i, j, k] = triangles[t];
      apart_[t] = motion(i, j).isBeyond() || motion(j, k).isBeyond() || motion(k, i).isBeyond();
    }
  });
  std::fill(moved_.begin(), moved_.end(), 0);
  const auto mobility = [&](int i) { return fixed[i] ? 0.0 : 1.0 / cloth.masses()[i]; };
  bool any = false, found = true;
  for (int sweep = 1; found && sweep <= kMaxSweeps; ++sweep) {
    found = false;
    const auto push = [&](int i, const Vector3d& change) {
      at.velocities[i] += change;
      at.positions[i] += a * change;
      moved_[i] = static_cast<char>(sweep);
    };
    for (int t = 0; t < count; ++t) {
      const std::array<int, 3>& corners = triangles[t];
      // Where no corner has moved since the last sweep came by, no edge is beyond the limit.
      const int moved = std::max({moved_[corners[0]], moved_[corners[1]], moved_[corners[2]]});
      if (sweep == 1 ? !apart_[t] && moved == 0 : moved < sweep - 1) continue;
      for (int side = 0; side < 3; ++side) {
        const int i = corners[side], j = corners[(side + 1) % 3];
        const RelativeMotion relative = motion(i, j);
        const double mobilities = mobility(i) + mobility(j);
        if (!relative.isBeyond() || mobilities == 0.0) continue;
        const Vector3d impulse = relative.excess() / mobilities * relative.velocity;
        push(i, -mobility(i) * impulse);
        push(j, mobility(j) * impulse);
        found = true;
      }
    }
    any = any || found;
  }
  return any;
}

}  // namespace haptex::cloth
