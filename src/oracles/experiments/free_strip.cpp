#include "haptex/oracles/experiments/free_strip.h"

#include <cmath>

#include "haptex/base/require.h"
#include "haptex/cloth/dynamics/integrator.h"
#include "haptex/material/contraction.h"
#include "haptex/material/strain_measures.h"

namespace haptex::oracles {

using cloth::ClothState;
using Eigen::Vector3d;
using material::Fabric;

Uniaxial exactUniaxial(const Fabric& fabric, kes::Direction direction, double strain) {
  const bool weft = direction == kes::Direction::kWeft;
  const auto& along = (weft ? fabric.weft : fabric.warp).elastic;
  const auto& across = (weft ? fabric.warp : fabric.weft).elastic;
  const double coupling = material::contractionModulus(fabric);
  const double green = material::greenStrain(strain);
  constexpr double kNoWidth = -0.5;  // Green's strain of a width of zero
  const double most = -across.evaluate(kNoWidth).stress;
  base::require(std::isfinite(strain) && strain > -1.0, "exactUniaxial", "strain", strain,
                "finite and > -1");
  if (coupling == 0.0) return {strain, 0.0, (1.0 + strain) * along.evaluate(green).stress};
  base::require(coupling * green < most, "exactUniaxial", "strain", strain,
                "< " + base::shortNumber(material::engineeringStrain(most / coupling)) +
                    ", where no width is left");
  double below = kNoWidth, above = 0.5;
  while (across.evaluate(above).stress + coupling * green < 0.0) above *= 2.0;
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (below + above);
    (across.evaluate(middle).stress + coupling * green < 0.0 ? below : above) = middle;
  }
  const double stress = along.evaluate(green).stress + coupling * above;
  return {strain, material::engineeringStrain(above), (1.0 + strain) * stress};
}

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

}  // namespace haptex::oracles
