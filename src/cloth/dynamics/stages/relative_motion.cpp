#include "haptex/cloth/dynamics/stages/relative_motion.h"

#include <array>
#include <cmath>

namespace haptex::cloth {

using Eigen::Vector3d;

bool limitRelativeMotion(const Cloth& cloth, const std::vector<char>& fixed, const Positions& base,
                         double a, ClothState& at) {
  constexpr double kMost = 0.15;  // of an edge's length
  constexpr double kLeft = 0.8;   // of that
  constexpr int kMaxSweeps = 10;
  const auto mobility = [&](int i) { return fixed[i] ? 0.0 : 1.0 / cloth.masses()[i]; };
  const auto push = [&](int i, const Vector3d& change) {
    at.velocities[i] += change;
    at.positions[i] += a * change;
  };
  bool any = false, found = true;
  for (int sweep = 0; found && sweep < kMaxSweeps; ++sweep) {
    found = false;
    for (const std::array<int, 3>& corners : cloth.mesh().triangles) {
      for (int side = 0; side < 3; ++side) {
        const int i = corners[side], j = corners[(side + 1) % 3];
        const Vector3d relative = at.velocities[i] - at.velocities[j];
        const double way_squared = a * a * relative.squaredNorm();
        const double most_squared = kMost * kMost * (base[i] - base[j]).squaredNorm();
        if (!(way_squared > most_squared)) continue;
        const double mobilities = mobility(i) + mobility(j);
        if (mobilities == 0.0) continue;
        const double taken = 1.0 - kLeft * std::sqrt(most_squared / way_squared);
        const Vector3d impulse = taken / mobilities * relative;
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
