// Obstacles with mass: against the mechanics of rigid bodies, and what they and the cloth have
// together.
#include <algorithm>
#include <cmath>
#include <string>

#include "haptex/base/constants.h"
#include "haptex/base/workload.h"
#include "haptex/material/fabric_file.h"
#include "haptex/material/linear_fabric.h"
#include "haptex/oracles/checks/validation.h"
#include "haptex/oracles/scenes/body_scenes.h"
#include "haptex/oracles/scenes/obstacle_scenes.h"
#include "haptex/scene/scene.h"
#include "haptex/simulation/simulated_cloth.h"

namespace haptex::oracles {
namespace {

using cloth::IntegrationMethod;
using contact::FreeBody;
using contact::ObstacleCollision;
using Eigen::Vector3d;
using mesh::Obstacle;

constexpr double kTimeStep = 0.0125;  // s
constexpr double kGravity = base::kStandardGravity;
const std::string kPrefix = "body/";

cloth::StepSettings settingsOf(IntegrationMethod method, int solves) {
  cloth::StepSettings settings;
  settings.method = method;
  settings.newton_iterations = solves;
  settings.solver = linear::LinearSolverMethod::kCholesky;
  return settings;
}

void validateFlight(const Sink& sink) {
  Obstacle box{"box", mesh::ObstacleBox{{0.1, 0.2, 0.3}}, placedAt(Vector3d::Zero())};
  box.body = mesh::ObstacleBody{2.0, {1.0, 0.0, 3.0}, {7.0, 0.3, 0.2}};
  CollidingCloth scene = bodiesAlone({box}, kGravity);
  const FreeBody& body = scene.collision.bodies()[0];
  const Vector3d turning = body.angularMomentum();
  const auto energy_of_turning = [&] {
    return body.kineticEnergy() - 0.5 * body.momentum().squaredNorm() / body.mass();
  };
  const double energy = energy_of_turning();
  double off_momentum = 0.0, off_energy = 0.0;
  for (int i = 0; i < 80; ++i) {
    scene.step(kTimeStep);
    off_momentum = std::max(off_momentum, (body.angularMomentum() - turning).norm());
    off_energy = std::max(off_energy, std::abs(energy_of_turning() - energy));
  }
  const double t = scene.state.time;
  const double exact = 3.0 * t - 0.5 * kGravity * t * t;
  sink(base::relativeTo(exact, kPrefix + "free_fall/place", exact, body.pose().translation().z(),
                        kRounding));
  const double speed = 3.0 - kGravity * t;
  sink(base::relativeTo(speed, kPrefix + "free_fall/speed", speed, body.velocity()[2], kRounding));
  sink({kPrefix + "free_fall/angular_momentum", 0.0, off_momentum / turning.norm(),
        off_momentum / turning.norm(), kRounding});
  // Of the Runge-Kutta steps of an unstable spin about the middle axis.
  sink({kPrefix + "free_fall/energy_of_turning", 0.0, off_energy / energy, off_energy / energy,
        1e-5});
}

void validateIncline(const Sink& sink) {
  constexpr double kAngle = 0.35;  // rad
  constexpr double kTolerance = 1e-9;
  const double along = kGravity * std::sin(kAngle), across = kGravity * std::cos(kAngle);
  const double rolls = 5.0 / 7.0 * along;
  const double slips = along - 0.05 * across;
  const auto ball = [](double friction) {
    return ballOf(0.3, 0.04, Vector3d::Zero(), Vector3d::Zero(), friction);
  };
  sink(base::relativeTo(rolls, kPrefix + "incline/ball_rolls", rolls,
                        accelerationDown(ball(0.5), 0.04, kAngle), kTolerance));
  sink(base::relativeTo(slips, kPrefix + "incline/ball_slips", slips,
                        accelerationDown(ball(0.05), 0.04, kAngle), kTolerance));
  const double slides = along - 0.2 * across;
  Obstacle box{"box", mesh::ObstacleBox{{0.1, 0.08, 0.02}}, placedAt(Vector3d::Zero())};
  box.body = mesh::ObstacleBody{0.3, Vector3d::Zero(), Vector3d::Zero(), 0.2};
  const double half = 0.01 + ObstacleCollision::kOffset;
  sink(base::relativeTo(slides, kPrefix + "incline/box_slides", slides,
                        accelerationDown(box, half, kAngle), kTolerance));
  box.body->friction = 1.02 * std::tan(kAngle);
  const double sticks = accelerationDown(box, half, kAngle);
  sink({kPrefix + "incline/box_sticks_m_per_s2", 0.0, sticks, std::abs(sticks), kTolerance});
}

/// Head on, in the air: one moves on with what both had.
void validateImpact(const Sink& sink) {
  Obstacle other = ballOf(0.5, 0.05, {0.3, 0.0, 0.0}, {-1.0, 0.0, 0.0});
  other.name = "other";
  CollidingCloth scene =
      bodiesAlone({ballOf(0.2, 0.03, Vector3d::Zero(), {2.0, 0.0, 0.0}), other}, 0.0);
  for (int i = 0; i < 40; ++i) scene.step(kTimeStep);
  const double exact = (0.2 * 2.0 - 0.5 * 1.0) / 0.7;
  for (const FreeBody& body : scene.collision.bodies()) {
    sink(base::relativeTo(exact, kPrefix + "impact/two_balls", exact, body.velocity()[0], 1e-12));
  }
}

struct Together {
  Vector3d momentum, turning = Vector3d::Zero();
  double energy;

  explicit Together(const CollidingCloth& scene)
      : momentum(scene.cloth.momentum(scene.state)), energy(scene.energy()) {
    for (std::size_t i = 0; i < scene.cloth.particleCount(); ++i) {
      turning +=
          scene.cloth.masses()[i] * scene.state.positions[i].cross(scene.state.velocities[i]);
    }
    for (const FreeBody& body : scene.collision.bodies()) {
      momentum += body.momentum();
      turning += body.pose().translation().cross(body.momentum()) + body.angularMomentum();
      energy += body.kineticEnergy() -
                body.mass() * scene.cloth.effects().gravity.dot(body.pose().translation());
    }
  }
};

/// A ball hits a free sheet in the air, off its middle, going a fifth of its radius in a step.
void validateCollision(IntegrationMethod method, double mass, const std::string& of_mass,
                       const Sink& sink) {
  const bool implicit = isImplicit(method);
  const double h = implicit ? kTimeStep : 2e-4;
  CollidingCloth scene(flatSheet({0.2, 0.2}, 12, 12, placedAt(Vector3d::Zero())),
                       material::linearFabric(100.0), 0.0, settingsOf(method, 3),
                       {ballOf(mass, 0.03, {0.02, 0.01, 0.04}, {0.1, 0.0, -0.5})});
  const Together before(scene);
  double momentum = 0.0, turning = 0.0, growth = 0.0, least = before.energy;
  while (scene.state.time < base::unlessSanitized(0.5, 0.1)) {
    scene.step(h);
    const Together now(scene);
    momentum = std::max(momentum, (now.momentum - before.momentum).norm());
    turning = std::max(turning, (now.turning - before.turning).norm());
    growth = std::max(growth, now.energy - least);
    least = std::min(least, now.energy);
  }
  const std::string name = kPrefix + "collision/" + nameOf(method) + "/" + of_mass + "/";
  momentum /= before.momentum.norm();
  sink({name + "momentum", 0.0, momentum, momentum, 1e-10});
  if (!implicit) {  // backward Euler itself takes angular momentum out of cloth that turns
    turning /= before.turning.norm();
    sink({name + "angular_momentum", 0.0, turning, turning, 1e-10});
    return;
  }
  growth /= before.energy;
  sink({name + "energy_growth", 0.0, growth, growth, 1e-9});
  const double lost = scene.collision.bodies()[0].velocity()[2] + 0.5;
  sink({name + "hit_m_per_s", 1e-4, lost, lost > 1e-4 ? 0.0 : 1.0, 0.0});
}

/// A ball comes to rest on a sheet that is held around: what holds it carries both weights.
void validateRest(const Sink& sink) {
  constexpr double kMass = 0.05;  // kg
  CollidingCloth scene(flatSheet({0.2, 0.2}, 12, 12, placedAt(Vector3d::Zero())),
                       material::linearFabric(200.0, 2.0), kGravity,
                       settingsOf(IntegrationMethod::kBackwardEuler, 3),
                       {ballOf(kMass, 0.03, {0.01, 0.005, 0.05}, Vector3d::Zero())});
  for (const mesh::Side side :
       {mesh::Side::kTop, mesh::Side::kBottom, mesh::Side::kLeft, mesh::Side::kRight}) {
    for (const int particle : sideParticles(scene.cloth.mesh(), side)) {
      scene.cloth.attach(particle, {scene.state.positions[particle], Vector3d::Zero(), 0.0, 0.0});
    }
  }
  double growth = 0.0, least = Together(scene).energy;
  while (scene.state.time < base::unlessSanitized(20.0, 2.0)) {
    scene.step(kTimeStep);
    const double energy = Together(scene).energy;
    growth = std::max(growth, energy - least);
    least = std::min(least, energy);
  }
  std::vector<Vector3d> forces;
  scene.cloth.computeForces(scene.state, forces);
  double held = 0.0, mass = kMass;
  for (std::size_t i = 0; i < scene.cloth.particleCount(); ++i) {
    if (scene.cloth.attachments()[i]) held -= forces[i].z();
    mass += scene.cloth.masses()[i];
  }
  sink(base::relativeTo(mass * kGravity, kPrefix + "rest/held_by_attachments_N", mass * kGravity,
                        held, base::unlessSanitized(1e-4, 0.5)));
  const double by_cloth = scene.contactForce().z();
  sink(base::relativeTo(kMass * kGravity, kPrefix + "rest/carried_by_cloth_N", -kMass * kGravity,
                        by_cloth, base::unlessSanitized(1e-4, 0.5)));
  const double scale = kMass * kGravity * 0.05;
  sink({kPrefix + "rest/energy_growth", 0.0, growth / scale, growth / scale, 1e-6});
}

/// The shipped scene: the ball never gets through the net, which takes its energy.
void validateNet(const std::string& config_directory, const Sink& sink) {
  scene::Scene scene = scene::loadScene(config_directory + "/scenes/net.yaml");
  const material::Fabric fabric = material::loadFabric(scene.fabric_path);
  simulation::SimulatedCloth net(std::move(scene), fabric);
  const double start = net.bodies()[0].kineticEnergy();
  double farthest = 0.0;
  int rejected = 0;
  while (net.state().time < base::unlessSanitized(2.0, 0.2)) {
    rejected += net.step() ? 0 : 1;
    farthest = std::min(farthest, net.bodies()[0].pose().translation().x());
  }
  const std::string name = kPrefix + "net/";
  sink({name + "steps_rejected", 0.0, double(rejected), double(rejected), 0.0});
  // The net is 0.15 m deep and slack.
  sink({name + "farthest_m", -0.2, farthest, std::max(0.0, -0.2 - farthest), 0.0});
  if (base::kSanitized) return;  // it is still on its way
  const double height = net.bodies()[0].pose().translation().z();
  sink({name + "ends_in_tray_m", -0.245 + 0.0175, height, std::abs(height + 0.245 - 0.0175), 1e-6});
  const double left = net.bodies()[0].kineticEnergy() / start;
  sink({name + "energy_left", 0.0, left, left, 0.05});
}

}  // namespace

void validateBody(const std::string& config_directory, const Sink& sink) {
  validateFlight(sink);
  validateIncline(sink);
  validateImpact(sink);
  for (const auto& [mass, name] : {std::pair{1e-5, "light"}, {4e-3, "alike"}, {1.0, "heavy"}}) {
    validateCollision(IntegrationMethod::kBackwardEuler, mass, name, sink);
    validateCollision(IntegrationMethod::kTwoStepEuler, mass, name, sink);
  }
  validateRest(sink);
  validateNet(config_directory, sink);
}

}  // namespace haptex::oracles
