#include "haptex/oracles/experiments/free_strip.h"

#include <algorithm>
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

Uniaxial exactObliqueUniaxial(const Fabric& fabric, kes::Direction along, double grain,
                              double stress) {
  const double weft = fabric.weft.elastic.evaluate(0.0).slope;
  const double warp = fabric.warp.elastic.evaluate(0.0).slope;
  const double shear = fabric.shear.elastic.evaluate(0.0).slope;
  const double coupling = material::contractionModulus(fabric);
  const double determinant = weft * warp - coupling * coupling;
  base::require(determinant > 0.0 && shear > 0.0, "exactObliqueUniaxial", "resistance",
                std::min(determinant, shear), "> 0");
  // The strip's length along n, its width along (-n.y, n.x), in the axes of the threads.
  const bool along_weft = along == kes::Direction::kWeft;
  const Eigen::Vector2d n = along_weft ? Eigen::Vector2d(std::cos(grain), -std::sin(grain))
                                       : Eigen::Vector2d(std::sin(grain), std::cos(grain));
  const Eigen::Vector2d across(-n.y(), n.x());
  const double suu = stress * n.x() * n.x(), svv = stress * n.y() * n.y();
  const double euu = (warp * suu - coupling * svv) / determinant;
  const double evv = (weft * svv - coupling * suu) / determinant;
  const double euv = stress * n.x() * n.y() / shear;  // U.V
  const auto squared_stretch = [&](const Eigen::Vector2d& way) {
    const double squared =
        1.0 + 2.0 * (euu * way.x() * way.x() + evv * way.y() * way.y() + euv * way.x() * way.y());
    base::require(squared > 0.0, "exactObliqueUniaxial", "stress", stress,
                  "so small that no stretch vanishes");
    return squared;
  };
  const double stretch = std::sqrt(squared_stretch(n));
  return {stretch - 1.0, std::sqrt(squared_stretch(across)) - 1.0, stress * stretch};
}

Uniaxial simulateUniaxial(const FreeStrip& strip, double force) {
  constexpr double kLength = 0.1, kWidth = 0.02;
  const int cells_along = strip.cells_along, cells_across = strip.cells_across;
  const bool weft = strip.along == kes::Direction::kWeft;
  cloth::ModelledEffects effects;
  effects.contraction = strip.fabric.contraction.has_value();
  mesh::ClothMesh mesh =
      weft ? kes::irregularRectangle(kLength, kWidth, cells_along, cells_across, strip.seed)
           : kes::irregularRectangle(kWidth, kLength, cells_across, cells_along, strip.seed);
  mesh.panels = {{0, strip.grain}};
  cloth::Cloth cloth(mesh, strip.fabric, effects);
  const int axis = weft ? 1 : 2;
  const std::vector<int> begin =
      sideParticles(cloth.mesh(), weft ? mesh::Side::kLeft : mesh::Side::kBottom);
  const std::vector<int> end =
      sideParticles(cloth.mesh(), weft ? mesh::Side::kRight : mesh::Side::kTop);
  for (int i = 0; i <= cells_across; ++i) {
    const double share = (i == 0 || i == cells_across ? 0.5 : 1.0) / cells_across;
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
  return {length(begin[1], end[1], kLength), length(begin[0], begin[cells_across], kWidth), force};
}

}  // namespace haptex::oracles
