// The air's force on a plate at any angle of attack, and falling sheets.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "haptex/cloth/dynamics/integrator.h"
#include "haptex/kes/virtual_test.h"
#include "haptex/material/linear_fabric.h"
#include "haptex/oracles/checks/random_checks.h"

namespace haptex::oracles {
namespace {

using cloth::Cloth;
using cloth::ClothState;
using Eigen::Vector3d;

/// A plate that moves in wind: with the velocity w = m n + q t relative to the air, its part m
/// along the normal n and q along t in the plane, and s = |w|,
///   -rho A/2 {(cn |m| m + cl m q^2/s) n + (ct q^2 - cl m^2 q/s) t}.
void validatePlate(Random& random, const Sink& sink) {
  const double width = random.uniform(0.05, 0.5), height = random.uniform(0.05, 0.5);
  const int across = 3 + random.below(8), along = 3 + random.below(8);
  const mesh::ClothMesh mesh =
      kes::irregularRectangle(width, height, across, along, random.below(1000000));
  cloth::ModelledEffects effects;
  effects.gravity.setZero();
  effects.air = cloth::Air();
  effects.air->coefficients = {random.uniform(0.5, 2.0), random.uniform(0.0, 0.1),
                               random.uniform(0.0, 2.0)};
  effects.air->wind.mean = random.logarithmic(0.01, 10.0) * random.direction();
  const Cloth cloth(mesh, material::linearFabric(100.0), effects);
  const double turn = random.uniform(-M_PI, M_PI);
  const Eigen::Matrix3d pose = Eigen::AngleAxisd(turn, random.direction()).toRotationMatrix();
  const double speed = random.logarithmic(0.01, 10.0);
  const Vector3d velocity = speed * random.direction();
  ClothState state = cloth.initialState();
  for (Vector3d& place : state.positions) place = pose * place;
  std::fill(state.velocities.begin(), state.velocities.end(), velocity);
  std::vector<Vector3d> forces;
  cloth.computeForces(state, forces);
  Vector3d measured = Vector3d::Zero();
  for (const Vector3d& force : forces) measured += force;

  const cloth::AirCoefficients& c = effects.air->coefficients;
  const Vector3d relative = velocity - effects.air->wind.mean, normal = pose.col(0);
  const double m = relative.dot(normal), s = relative.norm();
  const Vector3d in_plane = relative - m * normal;
  const double q = in_plane.norm();
  const Vector3d exact = -0.5 * cloth::kAirDensity * width * height *
                         ((c.normal * std::abs(m) * m + c.lift * m * q * q / s) * normal +
                          (c.tangential * q - c.lift * m * m / s) * in_plane);
  CaseName text("cloth", "air/plate");
  text.with("speed", s).with("angle_of_attack", std::asin(std::abs(m) / s));
  // Elements at rest pull with the rounding of their strain, at most the modulus times 1e-14.
  sink(
      {text.text(), exact.norm(), measured.norm(), (measured - exact).norm() / exact.norm(), 1e-9});
}

/// Falling across its plane, after six times what it takes: 1 - tanh(6) is 1.2e-5.
void validateFall(Random& random, const Sink& sink) {
  material::Fabric fabric = material::linearFabric(random.logarithmic(30.0, 1000.0));
  fabric.areal_density = random.logarithmic(0.02, 0.3);
  const double gravity = random.uniform(2.0, 15.0);
  cloth::ModelledEffects effects;
  effects.gravity = {-gravity, 0.0, 0.0};
  effects.air = cloth::Air();
  const Cloth cloth(kes::irregularRectangle(0.2, 0.2, 4, 4, random.below(1000000)), fabric,
                    effects);
  const double exact = std::sqrt(2.0 * fabric.areal_density * gravity /
                                 (cloth::kAirDensity * effects.air->coefficients.normal));
  const double duration = 6.0 * exact / gravity, time_step = duration / (60 + random.below(200));
  cloth::Integrator integrator(cloth, {});
  ClothState state = cloth.initialState();
  while (state.time < duration) integrator.step(cloth, state, time_step);
  CaseName text("cloth", "air/terminal_velocity");
  text.with("density", fabric.areal_density).with("gravity", gravity).with("step", time_step);
  base::Quantity worst{"", 0.0, 0.0, -1.0, 0.0};
  for (const Vector3d& velocity : state.velocities) {
    base::keepWorse(worst, base::relativeTo(exact, text.text(), exact, -velocity.x(), 1e-4));
  }
  sink(worst);
}

}  // namespace

void randomAir(const std::string&, Random& random, const Sink& sink) {
  for (int i = 0; i < 5; ++i) validatePlate(random, sink);
  validateFall(random, sink);
}

}  // namespace haptex::oracles
