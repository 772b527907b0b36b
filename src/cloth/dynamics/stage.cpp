#include "haptex/cloth/dynamics/stage.h"

#include <algorithm>

namespace haptex::cloth {

using Eigen::Vector3d;

StageStart startTrapezoid(const Cloth& cloth, const ClothState& begin, double first,
                          const RecentMotion* motion, ClothState& base) {
  StageStart start;
  start.a = 0.5 * first;
  start.goes_on = motion != nullptr && motion->leadsTo(begin);
  ForceState at_begin = begin.ofForces();
  StrainPast strains;
  if (start.goes_on) {
    strains = motion->strains();
    at_begin.past = &strains;
    start.past = motion->strainsAfter(begin, start.a);
  }
  // Forces first, in the place of the velocities.
  std::fill(base.velocities.begin(), base.velocities.end(), Vector3d::Zero());
  cloth.forces().addForces(at_begin, base.velocities);
  for (std::size_t i = 0; i < cloth.particleCount(); ++i) {
    base.positions[i] = begin.positions[i] + start.a * begin.velocities[i];
    base.velocities[i] = begin.velocities[i] + start.a / cloth.masses()[i] * base.velocities[i];
  }
  cloth.ties().carry(begin.time, base.velocities);  // they have no mass
  return start;
}

StageStart startBdf2(const ClothState& before, const ClothState& middle, double first,
                     double second, RecentMotion* motion, ClothState& base,
                     Velocities& velocities) {
  const double ratio = second / first;
  const double divisor = 1.0 + 2.0 * ratio;
  const double of_before = ratio * ratio / divisor;
  for (std::size_t i = 0; i < before.positions.size(); ++i) {
    const Vector3d way = middle.positions[i] - before.positions[i];
    base.positions[i] = middle.positions[i] + of_before * way;
    base.velocities[i] =
        middle.velocities[i] + of_before * (middle.velocities[i] - before.velocities[i]);
    velocities[i] = way / first;
  }
  StageStart start;
  start.a = second * (1.0 + ratio) / divisor;
  start.goes_on = motion != nullptr;
  if (start.goes_on) {
    motion->takeBdf2(before, first, middle.positions, of_before, start.a);
    start.past = motion->strains();
  }
  return start;
}

void setInertia(const Cloth& cloth, const ClothState& base, const Velocities& velocities,
                linear::ThreadPool* pool, linear::SymmetricBlockMatrix& matrix,
                linear::BlockVector& rhs) {
  matrix.setZero(pool);
  for (int i = 0; i < matrix.size(); ++i) {
    const double mass = cloth.masses()[i];
    matrix.diagonal(i).diagonal().setConstant(mass);
    rhs.col(i) = -mass * (velocities[i] - base.velocities[i]);
  }
}

}  // namespace haptex::cloth
