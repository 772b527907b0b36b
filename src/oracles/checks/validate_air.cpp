// The oracles of the air: drag, terminal velocity, relativity, and a strip in the wind.
#include <algorithm>
#include <cmath>

#include "haptex/cloth/dynamics/integrator.h"
#include "haptex/kes/virtual_test.h"
#include "haptex/oracles/checks/cloth_oracles.h"

namespace haptex::oracles {
namespace {

using cloth::Cloth;
using cloth::ClothState;
using Eigen::Vector3d;

constexpr double kTerminalTolerance = 1e-3;
constexpr double kStripTolerance = 0.01;
constexpr double kMotionTolerance = 1e-10;  // of linear systems

cloth::ModelledEffects inAir(const Vector3d& wind, const Vector3d& gravity) {
  cloth::ModelledEffects effects;
  effects.air = cloth::Air();
  effects.air->wind.mean = wind;
  effects.gravity = gravity;
  return effects;
}

/// Pushed through still air on an irregular mesh, along its normal and in its plane: rho A c v^2/2.
void validatePlate(const material::Fabric& fabric, const Sink& sink) {
  constexpr double kWidth = 0.3, kHeight = 0.2;
  const Cloth cloth(kes::irregularRectangle(kWidth, kHeight, 6, 4, 5), fabric,
                    inAir(Vector3d::Zero(), Vector3d::Zero()));
  const cloth::AirCoefficients coefficients = cloth.effects().air->coefficients;
  const auto force = [&](const Vector3d& velocity) {
    ClothState state = cloth.initialState();
    std::fill(state.velocities.begin(), state.velocities.end(), velocity);
    std::vector<Vector3d> forces;
    cloth.computeForces(state, forces);
    Vector3d sum = Vector3d::Zero();
    for (const Vector3d& each : forces) sum += each;
    return Vector3d(-sum);
  };
  const double area = kWidth * kHeight;
  for (const auto& [name, speed] : {std::pair{"/v0.1", 0.1}, {"/v1", 1.0}, {"/v10", 10.0}}) {
    const double pressure = 0.5 * cloth::kAirDensity * area * speed * speed;
    const double across = pressure * coefficients.normal;
    const double along = pressure * coefficients.tangential;
    sink(base::relativeTo(across, std::string("cloth/air/plate_across") + name, across,
                          force({speed, 0.0, 0.0}).x(), kRounding));
    sink(base::relativeTo(along, std::string("cloth/air/plate_along") + name, along,
                          force({0.0, speed, 0.0}).y(), kRounding));
  }
}

/// A free flat sheet that falls across its plane, sqrt(2 m g / (rho c A)), before it turns: the
/// fall is not stable, and rounding grows.
void validateTerminalVelocity(const material::Fabric& fabric, const Sink& sink) {
  constexpr double kGravity = 9.81, kDuration = 1.0;
  const Cloth cloth(kes::irregularRectangle(0.2, 0.2, 4, 4, 5), fabric,
                    inAir(Vector3d::Zero(), {-kGravity, 0.0, 0.0}));
  const double exact = std::sqrt(2.0 * fabric.areal_density * kGravity /
                                 (cloth::kAirDensity * cloth.effects().air->coefficients.normal));
  for (double time_step : {0.001, 0.0125, 0.04}) {
    ClothState state = cloth.initialState();
    cloth::Integrator integrator(cloth, {});
    while (state.time < kDuration) integrator.step(cloth, state, time_step);
    double slowest = 0.0, fastest = 0.0;
    for (const Vector3d& velocity : state.velocities) {
      slowest = std::min(slowest == 0.0 ? 1e9 : slowest, -velocity.x());
      fastest = std::max(fastest, -velocity.x());
    }
    const double measured = fastest - exact > exact - slowest ? fastest : slowest;
    sink(base::relativeTo(exact,
                          "cloth/air/terminal_velocity/h" + std::to_string(time_step).substr(0, 6),
                          exact, measured, kTerminalTolerance));
  }
}

/// Wind on a cloth at rest against a cloth that moves through air at rest: largest difference of
/// places after a while, relative to the way.
void validateRelativity(const material::Fabric& fabric, const Sink& sink) {
  constexpr double kDuration = 0.2, kTimeStep = 0.005;
  const Vector3d wind(2.0, 1.0, -0.5);
  const mesh::ClothMesh mesh = kes::irregularRectangle(0.2, 0.2, 5, 5, 5);
  const Cloth blown(mesh, fabric, inAir(wind, {0.0, 0.0, -9.81}));
  const Cloth moved(mesh, fabric, inAir(Vector3d::Zero(), {0.0, 0.0, -9.81}));
  for (const cloth::NamedIntegrationMethod& named : cloth::kIntegrationMethods) {
    if (!isImplicit(named.method)) continue;
    cloth::StepSettings settings;
    settings.method = named.method;
    settings.solver = linear::LinearSolverMethod::kCholesky;
    settings.tolerance = 1e-10;
    ClothState resting = blown.initialState(), moving = moved.initialState();
    for (Vector3d& velocity : moving.velocities) velocity = -wind;
    cloth::Integrator in_wind(blown, settings), in_still_air(moved, settings);
    while (resting.time < kDuration) {
      in_wind.step(blown, resting, kTimeStep);
      in_still_air.step(moved, moving, kTimeStep);
    }
    double difference = 0.0;
    for (std::size_t i = 0; i < resting.positions.size(); ++i) {
      const Vector3d there = moving.positions[i] + resting.time * wind;
      difference = base::largerOrNaN(difference, (resting.positions[i] - there).norm());
    }
    const double relative = difference / (wind.norm() * resting.time);
    sink({std::string("cloth/air/relativity/") + named.name, 0.0, relative, relative,
          kMotionTolerance});
  }
}

/// A hanging strip without bending in a steady wind that presses on its normal alone. Where the
/// tension vanishes, at the lower end, the pressure balances the part of the weight across the
/// strip, r cos^2 = sin of the angle from the vertical with r = rho c w^2 / (2 density g). There
/// the strip is straight, and then nowhere curved: sin = (sqrt(1 + 4 r^2) - 1) / (2 r). In strong
/// wind the lower end flutters a little about that.
void validateStripInWind(const Sink& sink) {
  constexpr double kDensity = 0.05, kGravity = 9.81, kLength = 0.3;
  material::Fabric fabric;  // stiff enough to stretch by less than 1e-4
  fabric.name = "light strip";
  fabric.areal_density = kDensity;
  fabric.weft.elastic = fabric.warp.elastic = material::StrainStressCurve::linear(5e3);
  fabric.shear.elastic = material::StrainStressCurve::linear(2.5e3);
  for (double ratio : {0.25, 1.0, 4.0}) {
    cloth::ModelledEffects effects = inAir(Vector3d::Zero(), {0.0, 0.0, -kGravity});
    effects.air->coefficients = {1.17, 0.0, 0.0};
    const double speed = std::sqrt(ratio * 2.0 * kDensity * kGravity / (cloth::kAirDensity * 1.17));
    effects.air->wind.mean = {speed, 0.0, 0.0};
    Cloth cloth(mesh::makeRectangle(0.06, kLength, 4, 20, mesh::Triangulation::kAlternating),
                fabric, effects);
    for (int particle : sideParticles(cloth.mesh(), mesh::Side::kTop)) {
      cloth::AttachmentPath place;
      place.start = cloth.mesh().initial_positions[particle];
      cloth.attach(particle, place);
    }
    ClothState state = cloth.initialState();
    cloth::Integrator integrator(cloth, {});
    while (state.time < 20.0) integrator.step(cloth, state, 0.02);
    const double exact = std::asin((std::sqrt(1.0 + 4.0 * ratio * ratio) - 1.0) / (2.0 * ratio));
    const std::string name =
        "cloth/air/strip_in_wind/r" + std::to_string(static_cast<int>(100.0 * ratio)) + "percent";
    base::Quantity worst{"", 0.0, 0.0, -1.0, 0.0};  // of all angles of rows from the one above
    for (int row = 0; row < 20; ++row) {
      const Vector3d down = state.positions[row * 5 + 2] - state.positions[(row + 1) * 5 + 2];
      base::keepWorse(worst, base::relativeTo(exact, name, exact, std::atan2(down.x(), -down.z()),
                                              kStripTolerance));
    }
    sink(worst);
  }
}

}  // namespace

void validateAir(const material::Fabric& fabric, const Sink& sink) {
  validatePlate(fabric, sink);
  validateTerminalVelocity(fabric, sink);
  validateRelativity(fabric, sink);
  validateStripInWind(sink);
}

}  // namespace haptex::oracles
