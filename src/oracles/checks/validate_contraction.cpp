// The oracles of transverse contraction: a free strip against the equations, and a clamped square.
#include <cmath>

#include "haptex/base/workload.h"
#include "haptex/cloth/dynamics/integrator.h"
#include "haptex/kes/static_sample.h"
#include "haptex/kes/virtual_test.h"
#include "haptex/material/contraction.h"
#include "haptex/material/strain_measures.h"
#include "haptex/oracles/checks/cloth_oracles.h"

namespace haptex::oracles {
namespace {

using cloth::ClothState;
using Eigen::Vector2d;
using Eigen::Vector3d;
using material::Fabric;

constexpr double kStripTolerance = 1e-6;

/// A strip pulled along one direction with free sides.
struct Uniaxial {
  double strain;             ///< engineering, along
  double transverse_strain;  ///< engineering
  double force;              ///< per rest width, N/m
};

/// Solves fv(ev) + c eu = 0 for the transverse strain by bisection; fv rises.
Uniaxial exactUniaxial(const Fabric& fabric, kes::Direction direction, double strain) {
  const bool weft = direction == kes::Direction::kWeft;
  const auto& along = (weft ? fabric.weft : fabric.warp).elastic;
  const auto& across = (weft ? fabric.warp : fabric.weft).elastic;
  const double coupling = material::contractionModulus(fabric);
  const double green = material::greenStrain(strain);
  double below = -0.5, above = 0.5;
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (below + above);
    (across.evaluate(middle).stress + coupling * green < 0.0 ? below : above) = middle;
  }
  const double stress = along.evaluate(green).stress + coupling * above;
  return {strain, material::engineeringStrain(above), material::forcePerWidth(stress, green)};
}

/// Loads both ends with the exact force and lets everything else be free: the strains that follow.
Uniaxial simulateUniaxial(const Fabric& fabric, kes::Direction direction, double force) {
  constexpr double kLength = 0.1, kWidth = 0.02;
  constexpr int kAlong = 20, kAcross = 4;
  const bool weft = direction == kes::Direction::kWeft;
  cloth::ModelledEffects effects;
  effects.contraction = true;
  cloth::Cloth cloth(weft ? kes::irregularRectangle(kLength, kWidth, kAlong, kAcross, 2)
                          : kes::irregularRectangle(kWidth, kLength, kAcross, kAlong, 2),
                     fabric, effects);
  const int axis = weft ? 1 : 2;
  const std::vector<int> begin =
      sideParticles(cloth.mesh(), weft ? mesh::Side::kLeft : mesh::Side::kBottom);
  const std::vector<int> end =
      sideParticles(cloth.mesh(), weft ? mesh::Side::kRight : mesh::Side::kTop);
  for (int i = 0; i <= kAcross; ++i) {
    const double share = (i == 0 || i == kAcross ? 0.5 : 1.0) / kAcross;
    const Vector3d load = force * kWidth * share * Vector3d::Unit(axis);
    cloth.setExternalForce(begin[i], -load);
    cloth.setExternalForce(end[i], load);
  }
  cloth::StepSettings settings;
  settings.solver = linear::LinearSolverMethod::kCholesky;
  settings.tolerance = 1e-9;
  settings.newton_iterations = 100;
  settings.newton_tolerance = 1e-13;
  cloth::Integrator integrator(cloth, settings);
  ClothState state = cloth.initialState();
  for (int i = 0; i < 20; ++i) {
    for (Vector3d& velocity : state.velocities) velocity.setZero();
    integrator.step(cloth, state, 1.0);
  }
  const auto length = [&](int from, int to, double at_rest) {
    return (state.positions[to] - state.positions[from]).norm() / at_rest - 1.0;
  };
  return {length(begin[1], end[1], kLength), length(begin[0], begin[kAcross], kWidth), force};
}

void validateFreeStrip(const Fabric& fabric, kes::Direction direction, double strain,
                       const Sink& sink) {
  const Uniaxial exact = exactUniaxial(fabric, direction, strain);
  const Uniaxial measured = simulateUniaxial(fabric, direction, exact.force);
  const std::string name = "cloth/contraction/strip/" + fabric.name +
                           (direction == kes::Direction::kWeft ? "/weft/" : "/warp/") +
                           std::to_string(strain).substr(0, 5);
  sink(base::relativeTo(1.0 + exact.strain, name + "/stretch", 1.0 + exact.strain,
                        1.0 + measured.strain, kStripTolerance));
  sink(base::relativeTo(1.0 + exact.transverse_strain, name + "/transverse_stretch",
                        1.0 + exact.transverse_strain, 1.0 + measured.transverse_strain,
                        kStripTolerance));
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
