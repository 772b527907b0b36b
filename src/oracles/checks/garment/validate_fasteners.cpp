// Buttons, hooks and elastic bands that are pulled through cloth until they open: by the force on a
// clamp at the cloth's edge, which knows nothing of fasteners. Cloth that slides along a
// drawstring.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "haptex/base/workload.h"
#include "haptex/cloth/forces/fasteners/place_in.h"
#include "haptex/kes/equilibrium.h"
#include "haptex/material/fabric_file.h"
#include "haptex/material/linear_fabric.h"
#include "haptex/mesh/rest_place.h"
#include "haptex/oracles/checks/garment_oracles.h"
#include "haptex/oracles/checks/random_checks.h"
#include "haptex/scene/scene.h"
#include "haptex/simulation/simulated_cloth.h"

namespace haptex::oracles {
namespace {

using cloth::Fastener;
using cloth::FastenerKind;
using Eigen::Vector3d;

constexpr double kReleaseTolerance = 0.02;  // relative

/// Two pieces of a fabric in one plane, the second one above the first, each clamped along its far
/// edge, and a fastener between a place in each.
struct FastenedPieces {
  material::Fabric fabric = material::linearFabric(500.0);
  Fastener fastener;
  double width = 0.08, height = 0.1;  // m, of each
  int cells = 6;                      // along either side
  mesh::Triangulation triangulation = mesh::Triangulation::kAlternating;
  Eigen::Vector2d place = {0.5, 0.2};  // of the fastener, from the inner edge, in parts of a piece
  bool viscosity = false;
  cloth::StepSettings step;
  double time_step = 0.01;
};

/// @param rest of the place in a piece @param first particle of the piece
cloth::ClothPlace placeAt(const mesh::ClothMesh& piece, const Eigen::Vector2d& rest, int first) {
  cloth::ClothPlace place = cloth::placeIn(piece, mesh::findRestPlace(piece, rest).value());
  for (int& particle : place.particles) particle += first;
  return place;
}

/// The frame clamp carries the upper edge of the second piece. The places start as far apart as the
/// fastener is slack.
scene::Scene sceneOf(const FastenedPieces& pieces) {
  scene::Scene scene;
  const mesh::ClothMesh piece = mesh::makeRectangle(pieces.width, pieces.height, pieces.cells,
                                                    pieces.cells, pieces.triangulation);
  const int count = static_cast<int>(piece.rest_coordinates.size());
  const double from_edge = pieces.place.y() * pieces.height;
  const double along = pieces.place.x() * pieces.width;
  Fastener fastener = pieces.fastener;
  fastener.places = {placeAt(piece, {along, pieces.height - from_edge}, 0),
                     placeAt(piece, {along, from_edge}, count)};
  const double raised = pieces.height - 2.0 * from_edge + fastener.length;
  for (int which : {0, 1}) {
    for (const Eigen::Vector2d& rest : piece.rest_coordinates) {
      scene.mesh.rest_coordinates.push_back(rest + Eigen::Vector2d(0.0, which * pieces.height));
      scene.mesh.initial_positions.emplace_back(0.0, rest.x(), rest.y() + which * raised);
    }
    for (const auto& [a, b, c] : piece.triangles) {
      scene.mesh.triangles.push_back({a + which * count, b + which * count, c + which * count});
    }
  }
  scene.effects.viscosity = pieces.viscosity;
  scene.effects.fasteners = {fastener};
  scene.attached_particles = mesh::sideParticles(scene.mesh, mesh::Side::kBottom);
  scene::CarryingFrame clamp{"clamp",
                             Eigen::Isometry3d::Identity(),
                             mesh::sideParticles(scene.mesh, mesh::Side::kTop),
                             {}};
  for (const int particle : clamp.particles) {
    clamp.places.push_back(scene.mesh.initial_positions[particle]);
    scene.attached_particles.push_back(particle);
  }
  scene.frames.push_back(std::move(clamp));
  scene.time_step = pieces.time_step;
  scene.step = pieces.step;
  return scene;
}

/// What a tensile tester notes.
struct PulledOpen {
  bool opened = false;
  double way = 0.0;    // m, of the clamp until then
  double most = 0.0;   // N, on the clamp until then
  double event = 0.0;  // N, that the fastener told
  double after = 0.0;  // N, on the clamp at rest afterwards
};

/// @param speed m/s, of the clamp
PulledOpen pullOpen(const FastenedPieces& pieces, double speed) {
  constexpr int kMostSteps = 20000, kRestSteps = 50;
  simulation::SimulatedCloth cloth(sceneOf(pieces), pieces.fabric);
  std::vector<Vector3d> forces;
  const auto clamp_force = [&] {
    cloth.cloth().computeForces(cloth.state(), forces);
    return cloth.frames().wrench(0, cloth.cloth(), cloth.state(), forces).force.norm();
  };
  PulledOpen result;
  for (int i = 1; i <= kMostSteps && !result.opened; ++i) {
    result.way = i * speed * pieces.time_step;
    cloth.moveFrame(0, Eigen::Isometry3d(Eigen::Translation3d(0.0, 0.0, result.way)));
    if (!cloth.step()) break;
    result.most = base::largerOrNaN(result.most, clamp_force());
    result.opened = !cloth.openedFasteners().empty();
  }
  if (!result.opened) return result;
  result.event = cloth.openedFasteners().front().force;
  for (int i = 0; i < kRestSteps; ++i) cloth.step(0.1);
  result.after = clamp_force();
  return result;
}

/// So many steps until it opens, whatever the fabric: by a first pull with few.
void checkRelease(const FastenedPieces& pieces, int steps, const std::string& name,
                  const Sink& sink) {
  FastenedPieces rough = pieces;
  rough.viscosity = false;
  rough.time_step = 0.05;
  const double way = pullOpen(rough, 0.002).way;
  const double release = pieces.fastener.release_force;
  const PulledOpen pulled = pullOpen(pieces, way / (steps * pieces.time_step));
  sink(base::relativeTo(release, name + "/clamp", release, pulled.opened ? pulled.most : NAN,
                        kReleaseTolerance));
  sink(base::relativeTo(release, name + "/event", release, pulled.event, kReleaseTolerance));
  sink({name + "/after_N", 0.0, pulled.after, pulled.after, 1e-3 * release});
}

/// Tension against the distance of the places, both of cloth in equilibrium: the force on the clamp
/// against stiffness (distance - length), and nothing where it is slack or open.
void checkCurve(const FastenedPieces& pieces, const std::string& name, const Sink& sink) {
  const scene::Scene scene = sceneOf(pieces);
  cloth::Cloth cloth(scene.mesh, pieces.fabric, scene.effects);
  cloth::ClothState state = cloth.initialState();
  const scene::CarryingFrame& clamp = scene.frames.front();
  std::vector<Vector3d> forces;
  const auto clamp_force = [&](double way) {
    for (const int particle : scene.attached_particles) {
      const bool moved = std::count(clamp.particles.begin(), clamp.particles.end(), particle) > 0;
      cloth.attach(particle, {scene.mesh.initial_positions[particle] +
                              Vector3d(0.0, 0.0, moved ? way : 0.0)});
    }
    kes::Equilibrium equilibrium(cloth);
    equilibrium.settle(cloth, state, 0.02);
    Vector3d sum = Vector3d::Zero();
    for (const int particle : clamp.particles) sum += equilibrium.forces()[particle];
    return sum.norm();
  };
  const Fastener& fastener = scene.effects.fasteners.front();
  constexpr int kPoints = 5;
  const double reach = fastener.release_force / fastener.stiffness;
  base::Quantity worst = base::relativeTo(1.0, name + "/curve", 0.0, 0.0, 1e-6);
  for (int i = 1; i <= kPoints; ++i) {
    const double way = 0.9 * reach * i / kPoints;
    const double force = clamp_force(way);
    const double exact =
        fastener.stiffness * (cloth.fasteners()->distance(0, state.positions) - fastener.length);
    base::keepWorse(worst,
                    base::relativeTo(fastener.release_force, worst.name, exact, force, 1e-6));
  }
  sink(worst);
  cloth::ClothState slack = cloth.initialState();
  const double bottom = slack.positions.front().z();
  for (Vector3d& place : slack.positions) place.z() = bottom;
  std::vector<Vector3d> pulls(cloth.particleCount(), Vector3d::Zero());
  cloth.fasteners()->addForces(slack.ofForces(), pulls);
  cloth::Fasteners::set(0, false, state.memory.data());
  cloth.fasteners()->addForces(state.ofForces(), pulls);
  double most = 0.0;
  for (const Vector3d& pull : pulls) most = base::largerOrNaN(most, pull.norm());
  sink({name + "/slack_or_open_N", 0.0, most, most, 0.0});
}

/// Both pieces fly apart until the fastener opens: what kinetic and potential energy together gain,
/// and how far any step changes the momentum.
void checkFlight(FastenedPieces pieces, double speed, const std::string& name, const Sink& sink) {
  scene::Scene scene = sceneOf(pieces);
  scene.attached_particles.clear();
  scene.frames.clear();
  const std::size_t half = scene.mesh.initial_positions.size() / 2;
  for (std::size_t i = 0; i < 2 * half; ++i) {
    scene.start_velocities.emplace_back(0.2 * speed, 0.0, i < half ? -speed : speed);
  }
  simulation::SimulatedCloth flight(scene, pieces.fabric);
  const auto energy = [&] {
    return flight.cloth().kineticEnergy(flight.state()) +
           flight.cloth().potentialEnergy(flight.state());
  };
  const auto momentum = [&] { return flight.cloth().momentum(flight.state()); };
  const double energy_before = energy();
  const double momentum_at_start = momentum().norm();
  double gained = 0.0, drift = 0.0;
  bool opened = false;
  int after = 0;
  for (int i = 0; i < 2000 && after < 20; ++i) {
    const double before = energy();
    const Vector3d momentum_before = momentum();
    if (!flight.step()) break;
    opened = opened || !flight.openedFasteners().empty();
    after += opened ? 1 : 0;
    // Steps may gain what those before have lost (cloth::EnergyBalance), but not where one opens.
    if (!flight.openedFasteners().empty()) gained = std::max(gained, energy() - before);
    gained = base::largerOrNaN(gained, energy() - energy_before);
    // What is taken out of velocities so that no step gains energy is momentum, too, whatever acts.
    if (flight.lastReport().energy_taken > 0.0) continue;
    drift = base::largerOrNaN(drift, (momentum() - momentum_before).norm());
  }
  sink({name + "/energy_gained", 0.0, opened ? gained / energy_before : NAN,
        opened ? gained / energy_before : NAN, 1e-9});
  sink({name + "/momentum_of_a_step", 0.0, drift / momentum_at_start, drift / momentum_at_start,
        1e-9});
}

Fastener fastenerOf(FastenerKind kind, double stiffness, double release_force) {
  Fastener fastener;
  fastener.name = nameOf(kind);
  fastener.kind = kind;
  fastener.stiffness = stiffness;
  fastener.release_force = release_force;
  if (kind == FastenerKind::kElastic) fastener.length = 0.06;
  return fastener;
}

constexpr std::array kKinds = {FastenerKind::kButton, FastenerKind::kHook, FastenerKind::kElastic};

FastenedPieces drawPieces(const std::string& config_directory, FastenerKind kind, Random& random,
                          CaseName& name) {
  constexpr std::array kFabrics = {"wool",         "denim",        "cotton_poplin",
                                   "acrylic_knit", "silk_habutae", "cotton_canvas"};
  const std::string fabric = kFabrics[random.below(kFabrics.size())];
  const bool elastic = kind == FastenerKind::kElastic;
  FastenedPieces pieces;
  pieces.fabric = material::loadFabric(config_directory + "/fabrics/" + fabric + ".yaml");
  pieces.fastener =
      fastenerOf(kind, elastic ? random.logarithmic(20.0, 200.0) : random.logarithmic(500.0, 2e4),
                 random.logarithmic(0.5, 5.0));
  if (elastic) pieces.fastener.length = random.uniform(0.02, 0.2);
  pieces.width = random.uniform(0.05, 0.15);
  pieces.height = random.uniform(0.05, 0.15);
  pieces.cells = 3 + random.below(6);
  if (random.chance(0.5)) pieces.triangulation = mesh::Triangulation::kOneWay;
  pieces.place = {random.uniform(0.2, 0.8), random.uniform(0.05, 0.4)};
  pieces.viscosity = random.chance(0.5);
  pieces.step.newton_iterations = random.chance(0.5) ? 1 : 10;
  pieces.time_step = random.logarithmic(1e-3, 0.0125);
  name.with(nameOf(kind)).with(fabric).with("stiffness", pieces.fastener.stiffness);
  name.with("release", pieces.fastener.release_force).with("cells", pieces.cells);
  name.with("step", pieces.time_step);
  return pieces;
}

/// N, of a drawstring between two places at the same height, 2 * half apart (m), with a weight (N)
/// that has slid to its middle: 2 T cos(angle) is the weight, and stiffness (distance - length) is
/// T.
double tensionBy(double weight, double half, const Fastener& drawstring) {
  double low = 0.0, high = 1e3 * weight;
  for (int i = 0; i < 200; ++i) {
    const double tension = 0.5 * (low + high);
    const double side = 0.5 * (drawstring.length + tension / drawstring.stiffness);
    const double height = side > half ? std::sqrt(side * side - half * half) : 0.0;
    (2.0 * tension * height / side < weight ? low : high) = tension;
  }
  return 0.5 * (low + high);
}

/// A triangle of cloth hangs by its tip on a drawstring from one piece of cloth that is held to
/// another.
void checkDrawstring(const std::string& name, const Sink& sink) {
  constexpr double kHalf = 0.1, kGravity = 9.81;  // m, m/s^2
  constexpr int kTips[] = {0, 3, 6};
  Fastener drawstring = fastenerOf(FastenerKind::kDrawstring, 200.0, 50.0);
  drawstring.length = 0.25;
  mesh::ClothMesh mesh;
  for (int piece = 0; piece < 3; ++piece) {
    const Vector3d tip(0.0, (piece - 1) * kHalf, piece == 1 ? -0.05 : 0.0);
    for (const Eigen::Vector2d& rest :
         {Eigen::Vector2d(0.0, 0.0), Eigen::Vector2d(-0.02, -0.04), Eigen::Vector2d(0.02, -0.04)}) {
      mesh.rest_coordinates.push_back(rest + Eigen::Vector2d(0.05 * piece, 0.0));
      mesh.initial_positions.push_back(tip + Vector3d(0.0, rest.x(), rest.y()));
    }
    mesh.triangles.push_back({kTips[piece], kTips[piece] + 1, kTips[piece] + 2});
    drawstring.places.push_back({{kTips[piece], -1, -1}});
  }
  scene::Scene scene;
  scene.effects.gravity = {0.0, 0.0, -kGravity};
  scene.effects.fasteners = {drawstring};
  cloth::Cloth cloth(mesh, material::linearFabric(500.0), scene.effects);
  for (const int particle : {0, 1, 2, 6, 7, 8}) {
    cloth.attach(particle, {mesh.initial_positions[particle]});
  }
  cloth::ClothState state = cloth.initialState();
  kes::Equilibrium(cloth).settle(cloth, state, 0.02);
  const double weight = kGravity * (cloth.masses()[3] + cloth.masses()[4] + cloth.masses()[5]);
  const double exact = tensionBy(weight, kHalf, drawstring);
  sink(base::relativeTo(exact, name + "/tension_N", exact,
                        cloth.fasteners()->tension(0, state.positions), 1e-4));
  sink({name + "/aside_m", 0.0, state.positions[3].y(), std::abs(state.positions[3].y()), 1e-6});
}

}  // namespace

void validateFasteners(const std::string& config_directory, const Sink& sink) {
  const std::string name = "garment/fastener/";
  for (const FastenerKind kind : kKinds) {
    const bool elastic = kind == FastenerKind::kElastic;
    FastenedPieces pieces;
    pieces.fabric = material::loadFabric(config_directory + "/fabrics/wool.yaml");
    pieces.fastener = fastenerOf(kind, elastic ? 60.0 : 2000.0, elastic ? 5.0 : 3.0);
    checkRelease(pieces, 500, name + nameOf(kind), sink);
    if (elastic) checkCurve(pieces, name + nameOf(kind), sink);
    // One-step methods: BDF-2 carries what is taken out of velocities on into the next steps.
    for (const auto method :
         {cloth::IntegrationMethod::kBackwardEuler, cloth::IntegrationMethod::kBackwardMidpoint,
          cloth::IntegrationMethod::kTrBdf2}) {
      pieces.step = {};
      pieces.step.method = method;
      pieces.step.newton_iterations = 10;
      pieces.step.tolerance = 1e-12;
      pieces.time_step = 1e-4;
      pieces.fastener.stiffness = 50.0;
      pieces.fastener.release_force = 0.05;
      checkFlight(pieces, 0.3, name + nameOf(kind) + "/" + nameOf(method), sink);
    }
  }
  checkDrawstring(name + nameOf(FastenerKind::kDrawstring), sink);
}

void randomFastener(const std::string& config_directory, Random& random, const Sink& sink) {
  for (const FastenerKind kind : kKinds) {
    CaseName name("garment", "fastener");
    const FastenedPieces pieces = drawPieces(config_directory, kind, random, name);
    const int steps = base::unlessSanitized(400 + random.below(600), 400);
    name.with("steps", steps);
    checkRelease(pieces, steps, name.text(), sink);
  }
  CaseName name("garment", "fastener");
  checkCurve(drawPieces(config_directory, FastenerKind::kElastic, random, name), name.text(), sink);
}

}  // namespace haptex::oracles
