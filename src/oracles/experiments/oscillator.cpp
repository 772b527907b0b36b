#include "haptex/oracles/experiments/oscillator.h"

#include <cmath>

#include "haptex/cloth/dynamics/integrator.h"

namespace haptex::oracles {

using Eigen::Vector3d;

double simulatedOscillatorEnergy(const cloth::StepSettings& settings, double phase,
                                 double time_step, int steps) {
  constexpr double kAmplitude = 0.02;  // m
  material::Fabric limp;
  limp.areal_density = 0.1;
  cloth::ModelledEffects effects;
  effects.point_loads = true;
  cloth::Cloth cloth(mesh::makeRectangle(0.1, 0.1, 1, 1, mesh::Triangulation::kOneWay), limp,
                     effects);
  cloth::ClothState state = cloth.initialState();
  std::vector<cloth::PointLoad> springs(cloth.particleCount());
  double energy_begin = 0.0;
  for (std::size_t t = 0; t < cloth.mesh().triangles.size(); ++t) {
    for (int corner = 0; corner < 3; ++corner) {
      const int particle = cloth.mesh().triangles[t][corner];
      const double stiffness = cloth.masses()[particle] * std::pow(phase / time_step, 2);
      springs[particle] = {static_cast<int>(t), Vector3d::Unit(corner), state.positions[particle],
                           Vector3d::Zero(), stiffness * Eigen::Matrix3d::Identity()};
    }
  }
  cloth.setPointLoads(springs);
  for (std::size_t i = 0; i < springs.size(); ++i) {
    state.positions[i].x() += kAmplitude;
    energy_begin += 0.5 * springs[i].stiffness(0, 0) * kAmplitude * kAmplitude;
  }
  cloth::Integrator integrator(cloth, settings);
  for (int i = 0; i < steps; ++i) integrator.step(cloth, state, time_step);
  return (cloth.potentialEnergy(state) + cloth.kineticEnergy(state)) / energy_begin;
}

}  // namespace haptex::oracles
