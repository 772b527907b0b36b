#include "haptex/oracles/experiments/capstan.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "haptex/material/fabric_file.h"
#include "haptex/material/linear_fabric.h"
#include "haptex/oracles/scenes/obstacle_scenes.h"

namespace haptex::oracles {
namespace {

using Eigen::Vector3d;

/// The curve in the x-z plane along which the strip lies: straight, around, straight.
struct Track {
  double radius, wrap;

  double length() const { return radius * wrap; }
  double angle(double way) const { return std::clamp(way / radius, 0.0, wrap) - 0.5 * wrap; }
  Vector3d tangent(double way) const { return {std::cos(angle(way)), 0.0, -std::sin(angle(way))}; }
  /// @param way m, from where the strip comes to the cylinder
  Vector3d place(double way) const {
    const double a = angle(way), beyond = way - std::clamp(way, 0.0, length());
    return Vector3d(radius * std::sin(a), 0.0, radius * std::cos(a)) + beyond * tangent(way);
  }
};

/// Elongation at which weft pulls with a tension (N per rest width), by bisection.
double elongationAt(const material::Fabric& fabric, double tension) {
  double low = 0.0, high = 1.0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high), stretch = 1.0 + middle;
    const double pull =
        stretch * fabric.weft.elastic.evaluate(0.5 * (stretch * stretch - 1.0)).stress;
    (pull < tension ? low : high) = middle;
  }
  return low;
}

struct Strip {
  mesh::ClothMesh mesh;
  double load;  // N per width, of the dead load
};

/// Stretched as it is when it slips everywhere.
Strip makeStrip(const CapstanCase& capstan, const Track& track) {
  const double travel = 1.5 * capstan.steps * capstan.time_step * capstan.speed;
  const double leg = 3.0 * capstan.cell;
  const int cells =
      static_cast<int>(std::ceil((track.length() + 2.0 * leg + travel) / capstan.cell));
  Strip strip{flatSheet({cells * capstan.cell, 2.0 * capstan.cell}, cells, 2,
                        Eigen::Isometry3d::Identity()),
              0.0};
  const double stretch = 1.0 + capstan.strain;
  const double pull =
      stretch * capstan.fabric.weft.elastic.evaluate(0.5 * (stretch * stretch - 1.0)).stress;
  strip.load = pull * std::exp(-capstan.friction * capstan.wrap);
  // From the drawn end backwards; a column of particles has a place on the track.
  constexpr int kPieces = 20;  // of a cell
  std::vector<double> ways(cells + 1);
  double way = track.length() + leg;
  for (int column = cells; column >= 0; --column) {
    ways[column] = way;
    for (int piece = 0; piece < kPieces; ++piece) {
      const double angle = std::clamp(way, 0.0, track.length()) / track.radius;
      const double tension = strip.load * std::exp(capstan.friction * angle);
      way -= capstan.cell / kPieces * (1.0 + elongationAt(capstan.fabric, tension));
    }
  }
  for (std::size_t i = 0; i < strip.mesh.initial_positions.size(); ++i) {
    Vector3d& place = strip.mesh.initial_positions[i];
    const int column =
        static_cast<int>(std::lround(strip.mesh.rest_coordinates[i].x() / capstan.cell));
    place = track.place(ways[column]) + Vector3d(0.0, place.y(), 0.0);
  }
  return strip;
}

/// What one step's contacts did.
void lookAtContacts(const CollidingCloth& scene, double friction, CapstanOutcome& outcome) {
  const auto& reactions = scene.integrator.contactReactions();
  double tangential = 0.0, normal = 0.0;
  for (std::size_t i = 0; i < reactions.size(); ++i) {
    if (reactions[i].state == cloth::ContactReaction::State::kOpen) continue;
    const Vector3d& n = scene.cloth.contacts()[i].normal;
    const double load = n.dot(reactions[i].force);
    const double friction_force = (reactions[i].force - load * n).norm();
    ++outcome.contacts;
    normal += load;
    tangential += friction_force;
    outcome.pull = std::max(outcome.pull, -load);
    constexpr double kRounding = 1e-12;  // N
    if (friction_force > kRounding) {
      outcome.particle =
          std::max(outcome.particle, load > 0.0 ? friction_force / (friction * load) : 1e9);
    }
  }
  if (normal > 0.0) outcome.total = std::max(outcome.total, tangential / (friction * normal));
}

material::Fabric drawFabric(const std::string& config_directory, base::RepeatableRandom& random) {
  constexpr double kSoftest = 100.0, kStiffest = 16448.0;  // N/m
  const int kind = random.below(4);
  const double modulus = random.logarithmic(kSoftest, kStiffest);
  if (kind < 2) {
    material::Fabric fabric = material::linearFabric(modulus, 1e-3 * modulus);
    fabric.name = "linear_" + std::to_string(std::lround(modulus));
    return fabric;
  }
  material::Fabric wool = material::loadFabric(config_directory + "/fabrics/wool.yaml");
  wool.name = kind == 2 ? "wool_weft" : "wool_warp";
  if (kind == 3) std::swap(wool.weft, wool.warp);
  return wool;
}

}  // namespace

CapstanCase drawCapstan(const std::string& config_directory, base::RepeatableRandom& random) {
  CapstanCase capstan;
  capstan.fabric = drawFabric(config_directory, random);
  capstan.friction = random.uniform(0.1, 0.7);
  capstan.wrap = random.uniform(0.5 * M_PI, 2.0 * M_PI);
  capstan.time_step = random.logarithmic(1e-3, 12.5e-3);
  capstan.speed = random.logarithmic(1e-3, 0.1);
  capstan.cell = random.logarithmic(1e-3, 1e-2);
  capstan.radius = capstanRadius(capstan.cell);
  return capstan;
}

double capstanRadius(double cell) { return std::max(0.02, 12.0 * cell); }

CapstanOutcome pullOverCapstan(const CapstanCase& capstan) {
  const Track track{capstan.radius, capstan.wrap};
  Strip strip = makeStrip(capstan, track);
  const double width = 2.0 * capstan.cell;
  mesh::Obstacle capsule{
      "capsule",
      mesh::ObstacleCapsule{capstan.radius - contact::ObstacleCollision::kOffset, 4.0 * width},
      Eigen::Isometry3d(Eigen::AngleAxisd(M_PI / 2.0, Vector3d::UnitX()))};
  capsule.friction = capstan.friction;
  cloth::StepSettings settings;
  settings.method = capstan.method;
  settings.newton_iterations = capstan.solves;
  settings.threads = capstan.threads;
  material::Fabric fabric = capstan.fabric;
  fabric.bending.reset();
  CollidingCloth scene(std::move(strip.mesh), fabric, 0.0, settings, {capsule});
  const auto loaded = sideParticles(scene.cloth.mesh(), mesh::Side::kLeft);
  const auto drawn = sideParticles(scene.cloth.mesh(), mesh::Side::kRight);
  // Lumped: a quarter at the corners, half in the middle.
  for (const int particle : loaded) {
    const double y = scene.state.positions[particle].y();
    const double share = std::abs(y) > 0.5 * capstan.cell ? 0.25 : 0.5;
    scene.cloth.setExternalForce(particle, -share * width * strip.load * track.tangent(-1.0));
  }
  // The middle of a path so long that its speed is constant there.
  const double duration = 100.0 * 1.5 * capstan.steps * capstan.time_step;
  const Vector3d way = duration * capstan.speed / 1.875 * track.tangent(track.length() + 1.0);
  for (const int particle : drawn) {
    const Vector3d start = scene.state.positions[particle] - 0.5 * way;
    scene.cloth.attach(particle, {start, way, -0.5 * duration, duration});
  }
  const Vector3d along = track.tangent(track.length() + 1.0);
  CapstanOutcome outcome{};
  outcome.exact = std::exp(capstan.friction * capstan.wrap);
  std::vector<Vector3d> forces;
  double pull = 0.0;
  const int before = capstan.steps / 2;
  for (int step = 0; step < before + capstan.steps; ++step) {
    const cloth::StepReport report = scene.step(capstan.time_step);
    lookAtContacts(scene, capstan.friction, outcome);
    outcome.rounds += report.contact_rounds;
    outcome.seconds += report.total_seconds;
    if (step < before) continue;
    scene.cloth.computeForces(scene.state, forces);
    for (const int particle : drawn) pull -= forces[particle].dot(along);
  }
  const double inertia = fabric.areal_density * capstan.speed * capstan.speed;  // N/m
  outcome.ratio = (pull / capstan.steps / width - inertia) / (strip.load - inertia);
  const double all = before + capstan.steps;
  outcome.rounds /= all;
  outcome.seconds /= all;
  outcome.contacts /= all;
  return outcome;
}

}  // namespace haptex::oracles
