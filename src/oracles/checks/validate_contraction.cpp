// The oracles of transverse contraction: a free strip against the equations, and a clamped square.
#include <cmath>

#include "haptex/base/workload.h"
#include "haptex/kes/static_sample.h"
#include "haptex/kes/virtual_test.h"
#include "haptex/oracles/checks/cloth_oracles.h"
#include "haptex/oracles/experiments/free_strip.h"

namespace haptex::oracles {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using material::Fabric;

constexpr double kContractionTolerance = 1e-6;

void validateFreeStrip(const Fabric& fabric, kes::Direction direction, double strain,
                       const Sink& sink) {
  const Uniaxial exact = exactUniaxial(fabric, direction, strain);
  const Uniaxial measured = simulateUniaxial({fabric, direction}, exact.force);
  const std::string name = "cloth/contraction/strip/" + fabric.name +
                           (direction == kes::Direction::kWeft ? "/weft/" : "/warp/") +
                           std::to_string(strain).substr(0, 5);
  sink(base::relativeTo(1.0 + exact.strain, name + "/stretch", 1.0 + exact.strain,
                        1.0 + measured.strain, kContractionTolerance));
  sink(base::relativeTo(1.0 + exact.transverse_strain, name + "/transverse_stretch",
                        1.0 + exact.transverse_strain, 1.0 + measured.transverse_strain,
                        kContractionTolerance));
}

/// A square between jaws that hold its ends, 2500 elements: force per width (N/m) and how much of
/// its width is left in the middle.
struct Square {
  double force;
  double waist;
};

Square pullSquare(const Fabric& fabric, bool contraction, double strain) {
  constexpr double kSide = 0.1;
  cloth::ModelledEffects effects;
  effects.contraction = contraction;
  constexpr int kCellsAlong = base::unlessSanitized(50, 12),
                kCellsAcross = base::unlessSanitized(25, 6);
  kes::StaticSample sample(kes::irregularRectangle(kSide, kSide, kCellsAcross, kCellsAlong, 2),
                           fabric, effects);
  const std::vector<int> jaw = sideParticles(sample.mesh(), mesh::Side::kTop);
  std::vector<int> held = sideParticles(sample.mesh(), mesh::Side::kBottom);
  held.insert(held.end(), jaw.begin(), jaw.end());
  sample.equilibrate(held, [&](const Vector2d& rest) {
    return Vector3d(0.0, rest.x(), (1.0 + strain) * rest.y());
  });
  double force = 0.0;
  for (int particle : jaw) force += sample.reaction(particle).z();
  const int row = kCellsAlong / 2 * (kCellsAcross + 1);
  const Vector3d across = sample.position(row + kCellsAcross) - sample.position(row);
  return {force / kSide, across.norm() / kSide};
}

/// With and without contraction, as the HAPTEX comparison. What is exact are bounds: the sample is
/// stiffer than one with free ends and softer than one whose width is held everywhere, which is
/// what it is without contraction.
void validateSquare(const Fabric& fabric, double strain, const Sink& sink) {
  const std::string name =
      "cloth/contraction/square/" + fabric.name + "/" + std::to_string(strain).substr(0, 5);
  const Square without = pullSquare(fabric, false, strain);
  const Square with = pullSquare(fabric, true, strain);
  const double held =
      kes::exactTensileForce(fabric, kes::Direction::kWarp, strain) / kes::kSampleWidth;
  const Uniaxial free = exactUniaxial(fabric, kes::Direction::kWarp, strain);
  const auto between = [&](const std::string& what, double low, double high, double measured) {
    const double outside = std::max(0.0, std::max(low - measured, measured - high));
    sink({name + what, high, measured, std::isnan(measured) ? measured : outside / high, 1e-6});
  };
  between("/force_without", held, held, without.force);
  between("/force_with", free.force, held, with.force);
  between("/waist_without", 1.0, 1.0, without.waist);
  between("/waist_with", 1.0 + free.transverse_strain, 1.0, with.waist);
}

}  // namespace

void validateContraction(const Fabric& wool, const Sink& sink) {
  Fabric linear;  // 100 N/m with the Poisson ratio 0.3
  linear.name = "linear_0.3";
  linear.areal_density = 0.1;
  linear.weft.elastic = linear.warp.elastic = material::StrainStressCurve::linear(100.0);
  linear.shear.elastic = material::StrainStressCurve::linear(35.0);
  linear.contraction = 0.3;
  for (double strain : {0.01, 0.1, 0.3}) {
    validateFreeStrip(linear, kes::Direction::kWeft, strain, sink);
  }
  for (double strain : {0.02, 0.06, 0.1})
    validateFreeStrip(wool, kes::Direction::kWeft, strain, sink);
  for (double strain : {0.002, 0.006, 0.01}) {
    validateFreeStrip(wool, kes::Direction::kWarp, strain, sink);
  }
  validateSquare(linear, 0.1, sink);
  validateSquare(linear, 0.3, sink);
  validateSquare(wool, 0.006, sink);
}

}  // namespace haptex::oracles
