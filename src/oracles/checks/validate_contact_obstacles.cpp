// Collision of the cloth with obstacles: against what mechanics says, and whether any particle is
// ever inside.
#include <algorithm>
#include <cmath>
#include <string>

#include "haptex/base/constants.h"
#include "haptex/base/workload.h"
#include "haptex/material/linear_fabric.h"
#include "haptex/oracles/checks/contact_oracles.h"
#include "haptex/oracles/experiments/capstan.h"
#include "haptex/oracles/scenes/obstacle_scenes.h"

namespace haptex::oracles {
namespace {

using cloth::IntegrationMethod;
using cloth::NamedIntegrationMethod;
using contact::ObstacleCollision;
using Eigen::Vector3d;
using mesh::Obstacle;

constexpr double kTimeStep = 0.0125;  // s
constexpr double kCone = 1e-9;        // rounding of |T| / (mu N)
const std::string kPrefix = "contact/obstacle/";

cloth::StepSettings settingsOf(IntegrationMethod method) {
  cloth::StepSettings settings;
  settings.method = method;
  return settings;
}

void validateRestOnTable(const NamedIntegrationMethod& method, const Sink& sink) {
  const Obstacle table{"table", mesh::ObstacleBox{{0.3, 0.3, 0.02}}, placedAt({0.0, 0.0, -0.01})};
  CollidingCloth scene(flatSheet({0.1, 0.1}, 10, 10, placedAt({0.0, 0.0, 0.02})),
                       material::linearFabric(100.0, 0.1), base::kStandardGravity,
                       settingsOf(method.method), {table});
  while (scene.state.time < 1.0) scene.step(kTimeStep);
  const double weight = 0.1 * 0.01 * base::kStandardGravity;
  const std::string name = kPrefix + "table/" + method.name;
  sink(base::relativeTo(weight, name + "/normal_force", weight, scene.contactForce().z(), 1e-6));
  double worst = 0.0;
  for (const Vector3d& place : scene.state.positions) {
    worst = std::max(worst, std::abs(place.z() - ObstacleCollision::kOffset));
  }
  sink({name + "/gap_m", 0.0, worst, worst, ObstacleCollision::kTolerance});
}

void validateIncline(const NamedIntegrationMethod& method, const Sink& sink) {
  constexpr double kAngle = 0.35;  // rad
  const std::string name = kPrefix + "incline/" + method.name;
  const double way =
      std::abs(slideDown(kAngle, 1.02 * std::tan(kAngle), method.method, kTimeStep).way);
  sink({name + "/sticks_m", 0.0, way, way, 1e-9});
  for (const double share : {0.0, 0.5, 0.9}) {
    const double friction = share * std::tan(kAngle);
    const double exact = base::kStandardGravity * (std::sin(kAngle) - friction * std::cos(kAngle));
    sink(base::relativeTo(exact, name + "/slips_" + std::to_string(std::lround(100.0 * share)),
                          exact, slideDown(kAngle, friction, method.method, kTimeStep).acceleration,
                          0.01));
  }
}

/// With the defaults: 12.5 ms, two solves.
void validateCapstan(const Sink& sink) {
  for (const double friction : {0.1, 0.3, 0.7}) {
    if (base::kSanitized && friction > 0.1) break;
    CapstanCase capstan;
    capstan.fabric = material::linearFabric(1000.0, 1.0);
    capstan.friction = friction;
    capstan.wrap = M_PI;
    capstan.time_step = kTimeStep;
    capstan.steps = 100;
    const CapstanOutcome outcome = pullOverCapstan(capstan);
    const std::string name = kPrefix + "capstan/" + std::to_string(std::lround(100.0 * friction));
    sink(base::relativeTo(outcome.exact, name, outcome.exact, outcome.ratio, 0.01));
    // All contacts together, and the worst particle.
    sink({name + "/total_over_limit", 1.0, outcome.total, std::max(0.0, outcome.total - 1.0),
          kCone});
    sink({name + "/particle_over_limit", 1.0, outcome.particle,
          std::max(0.0, outcome.particle - 1.0), kCone});
  }
}

/// Least distance over `duration`, of a sheet that hangs from its top edge.
double leastDistanceOf(const Obstacle& obstacle, double duration) {
  mesh::ClothMesh mesh = mesh::makeRectangle(0.2, 0.2, 16, 16, mesh::Triangulation::kAlternating);
  const auto held = sideParticles(mesh, mesh::Side::kTop);
  CollidingCloth scene(std::move(mesh), material::linearFabric(200.0, 0.2), base::kStandardGravity,
                       {}, {obstacle});
  for (int particle : held) {
    scene.cloth.attach(particle, {scene.state.positions[particle], Vector3d::Zero(), 0.0, 0.0});
  }
  double least = scene.leastDistance();
  while (scene.state.time < duration) {
    scene.step(kTimeStep);
    least = std::min(least, scene.leastDistance());
  }
  return least;
}

void sinkLeast(const std::string& name, const Obstacle& obstacle, double duration,
               const Sink& sink) {
  const double least = leastDistanceOf(obstacle, duration);
  sink({kPrefix + "inside/" + name + "_m", ObstacleCollision::kOffset, least,
        std::max(0.0, ObstacleCollision::kOffset - least), ObstacleCollision::kTolerance});
}

void validateInside(const Sink& sink) {
  for (const double rate : {0.2, 1.0, 2.0, 5.0}) {  // 1/s
    Obstacle ball{"ball", mesh::ObstacleSphere{0.03}, placedAt({0.08, 0.0, -0.12})};
    ball.motion = mesh::ObstacleOrbit{{0.0, 0.0, -0.12}, Vector3d::UnitZ(), 1.0 / rate};
    std::string name = std::to_string(rate);
    name.resize(3);
    sinkLeast("orbit_" + name, ball, base::unlessSanitized(std::max(2.0, 1.5 / rate), 0.5), sink);
  }
  Obstacle fast{"fast", mesh::ObstacleSphere{0.02}, placedAt({-1.0, 0.0, -0.15})};
  fast.motion = mesh::ObstacleDrift{{10.0, 0.0, 0.0}};
  sinkLeast("sphere_10_m_per_s", fast, 0.4, sink);
  Obstacle plate{"plate", mesh::ObstacleBox{{1e-3, 0.1, 0.1}}, placedAt({-0.5, 0.0, -0.2})};
  plate.motion = mesh::ObstacleDrift{{5.0, 0.0, 0.0}};
  sinkLeast("thin_box_5_m_per_s", plate, 0.4, sink);
}

/// A sheet falls onto a sphere in steps of 1 ms, without and with friction: how far its energy ever
/// rises above what it has been, as a share of the potential energy that it starts with over the
/// sphere.
void validateEnergy(const NamedIntegrationMethod& method, const Sink& sink) {
  for (const double friction : {0.0, 0.3}) {
    Obstacle ball{"ball", mesh::ObstacleSphere{0.04}, placedAt({0.0, 0.0, -0.05})};
    ball.friction = friction;
    CollidingCloth scene(flatSheet({0.15, 0.15}, 14, 14, placedAt({0.0, 0.0, 0.01})),
                         material::linearFabric(200.0, 0.2), base::kStandardGravity,
                         settingsOf(method.method), {ball});
    double least = scene.energy(), growth = 0.0;
    while (scene.state.time < base::unlessSanitized(0.5, 0.15)) {
      scene.step(1e-3);
      growth = std::max(growth, scene.energy() - least);
      least = std::min(least, scene.energy());
    }
    const double scale = 0.1 * 0.15 * 0.15 * base::kStandardGravity * 0.05;
    // BDF-2 is stable by a norm of two states, so the energy of one may rise a little.
    const double tolerance = method.method == IntegrationMethod::kBdf2 ? 1e-3 : 1e-6;
    sink({kPrefix + "energy_growth/" + method.name + (friction > 0.0 ? "/friction" : "/smooth"),
          0.0, growth / scale, growth / scale, tolerance});
  }
}

}  // namespace

void validateContactObstacles(const Sink& sink) {
  for (const NamedIntegrationMethod& method : cloth::kIntegrationMethods) {
    if (!isImplicit(method.method)) continue;
    validateRestOnTable(method, sink);
    validateIncline(method, sink);
    validateEnergy(method, sink);
  }
  validateCapstan(sink);
  validateInside(sink);
}

}  // namespace haptex::oracles
