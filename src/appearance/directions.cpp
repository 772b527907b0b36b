#include "haptex/appearance/directions.h"

#include <algorithm>
#include <cmath>

#include "haptex/base/require.h"

namespace haptex::appearance {
namespace {

using Eigen::Vector3d;

constexpr int kRings = 6;
constexpr double kRingStep = M_PI / 12.0;
constexpr std::array<int, kRings> kOnRing{1, 6, 12, 18, 20, 24};
constexpr std::array<int, kRings> kFirstOfRing{0, 1, 7, 19, 37, 57};
static_assert(kFirstOfRing.back() + kOnRing.back() == kDirections);

std::array<Vector3d, kDirections> makeDirections() {
  std::array<Vector3d, kDirections> directions;
  for (int ring = 0; ring < kRings; ++ring) {
    const double polar = ring * kRingStep;
    for (int i = 0; i < kOnRing[ring]; ++i) {
      const double azimuth = 2.0 * M_PI * i / kOnRing[ring];
      directions[kFirstOfRing[ring] + i] = {std::sin(polar) * std::cos(azimuth),
                                            std::sin(polar) * std::sin(azimuth), std::cos(polar)};
    }
  }
  return directions;
}

}  // namespace

const std::array<Vector3d, kDirections>& sampledDirections() {
  static const std::array<Vector3d, kDirections> directions = makeDirections();
  return directions;
}

DirectionWeights weightsOf(const Vector3d& direction) {
  const double rings =
      std::min(std::atan2(direction.head<2>().norm(), direction.z()) / kRingStep, kRings - 1.0);
  double turn = std::atan2(direction.y(), direction.x()) / (2.0 * M_PI);
  if (turn < 0.0) turn += 1.0;
  const int inner = std::min(static_cast<int>(rings), kRings - 2);
  DirectionWeights weights;
  for (int side = 0; side < 2; ++side) {
    const int ring = inner + side, count = kOnRing[ring];
    const double of_ring = side == 0 ? 1.0 - (rings - inner) : rings - inner;
    const double place = turn * count;
    const int before = static_cast<int>(place);  // count itself if a turn is rounded up to 1
    const double share = place - before;
    weights.index[2 * side] = kFirstOfRing[ring] + before % count;
    weights.index[2 * side + 1] = kFirstOfRing[ring] + (before + 1) % count;
    weights.weight[2 * side] = of_ring * (1.0 - share);
    weights.weight[2 * side + 1] = of_ring * share;
  }
  return weights;
}

Vector3d soundDirection(const char* name, const Vector3d& direction) {
  if (!direction.allFinite() || !(direction.z() > 0.0)) {
    base::refuse("the direction of the ", name, " is (", direction.x(), ", ", direction.y(), ", ",
                 direction.z(), "): allowed are finite ones with z > 0, above the fabric");
  }
  Vector3d unit = direction.stableNormalized();
  if (unit.z() >= kFlattest) return unit;
  unit.head<2>() *= std::sqrt(1.0 - kFlattest * kFlattest) / unit.head<2>().norm();
  unit.z() = kFlattest;
  return unit;
}

}  // namespace haptex::appearance
