#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "haptex/base/constants.h"
#include "haptex/base/workload.h"
#include "haptex/kes/equilibrium.h"
#include "haptex/material/fabric_file.h"
#include "haptex/oracles/checks/cloth_oracles.h"
#include "haptex/oracles/checks/validation.h"
#include "haptex/oracles/scenes/obstacle_scenes.h"
#include "haptex/oracles/scenes/self_collision_scenes.h"
#include "haptex/oracles/scenes/tangled_starts.h"

namespace haptex::oracles {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using mesh::ClothMesh;

constexpr double kStep = 0.0125;  // s

cloth::StepSettings newtonSteps(int iterations) {
  cloth::StepSettings settings;
  settings.newton_iterations = iterations;
  return settings;
}

void attach(cloth::Cloth& cloth, int particle, const Vector3d& place) {
  cloth::AttachmentPath path;
  path.start = place;
  cloth.attach(particle, path);
}

void validateStack(const std::vector<material::Fabric>& fabrics, int layers, const Sink& sink) {
  const LayerStack stack = restingStack(fabrics, layers, base::unlessSanitized(80, 10));
  const std::string in_turn = fabrics.size() > 1 ? "_in_turn" : "";
  sink(base::relativeTo(stack.exact,
                        "self_collision/stack_of_" + numbered(layers) + in_turn + "/height",
                        stack.exact, stack.height, 0.01));
}

/// A layer between two others, of which the upper one is loaded, is pulled out: force at its edge.
/// @param fabrics of the outer ones and of the layer; or one of all
void validatePull(const std::vector<material::Fabric>& fabrics, const std::string& name,
                  const Sink& sink) {
  constexpr double kSpeed = 0.01, kPressure = 100.0;  // m/s, Pa
  const material::Fabric &outer = fabrics.front(), &inner = fabrics.back();
  const double distance = 0.5 * (thicknessAt(*outer.compression, kPressure) +
                                 thicknessAt(*inner.compression, kPressure));
  const double friction = std::sqrt(*outer.friction * *inner.friction);
  // The ends by which layers are held lie beyond the others.
  const ClothMesh lower = flatSheet({0.06, 0.04}, 6, 4, placedAt({0.0, 0.0, 0.0}));
  const ClothMesh middle = flatSheet({0.083, 0.029}, 8, 3, placedAt({0.0215, 0.0, distance}));
  const ClothMesh upper = flatSheet({0.05, 0.03}, 5, 3, placedAt({-0.012, 0.0, 2.0 * distance}));
  const ClothMesh mesh = asOneMesh({lower, middle, upper}, static_cast<int>(fabrics.size()));
  SelfCollidingCloth stack({mesh, 0.0}, fabrics, newtonSteps(20));
  const int of_lower = static_cast<int>(lower.initial_positions.size());
  const int to_upper = of_lower + static_cast<int>(middle.initial_positions.size());
  double load = 0.0;
  std::vector<int> pulled;
  for (int i = 0; i < static_cast<int>(stack.state.positions.size()); ++i) {
    const Vector3d place = stack.state.positions[i];
    if (i >= of_lower && i < to_upper) {
      if (place.x() > 0.062) pulled.push_back(i);
    } else if (i < of_lower || place.x() < -0.036) {
      attach(stack.cloth, i, place);
    } else if (place.x() > -0.003 && place.x() < 0.01 && std::abs(place.y()) < 0.01) {
      const double force = kPressure * 1e-4;  // of a cell of 10 mm
      stack.cloth.setExternalForce(i, {0.0, 0.0, -force});
      load += force;
    }
  }
  std::vector<Vector3d> forces;
  double pull = 0.0;
  const int steps = base::unlessSanitized(80, 4), measured_steps = steps / 2;
  for (int step = 1; step <= steps; ++step) {
    for (const int particle : pulled) {
      const Vector3d start = stack.cloth.mesh().initial_positions[particle];
      attach(stack.cloth, particle, start + Vector3d(kSpeed * kStep * step, 0.0, 0.0));
    }
    stack.step(kStep);
    if (step <= steps - measured_steps) continue;
    stack.cloth.computeForces(stack.state, forces);
    for (const int particle : pulled) pull -= forces[particle].x() / measured_steps;
  }
  const double measured = pull / (2.0 * load);
  sink(base::relativeTo(friction, "self_collision/" + name + "/MIU", friction, measured,
                        base::unlessSanitized(0.02, 2.0)));
}

/// Two sheets fly into each other, without anything else.
void validateMomentum(const material::Fabric& fabric, const Sink& sink) {
  const Isometry3d oblique = placedAt({0.01, 0.005, 0.006}) *
                             Eigen::AngleAxisd(0.15, Vector3d(1.0, 0.6, 0.0).normalized());
  cloth::StepSettings settings = newtonSteps(60);
  settings.tolerance = 1e-10;
  settings.newton_tolerance = 1e-14;
  SelfCollidingCloth sheets({asOneMesh({flatSheet({0.06, 0.06}, 6, 6, placedAt({0.0, 0.0, 0.0})),
                                        flatSheet({0.04, 0.04}, 4, 4, oblique)}),
                             0.0},
                            {fabric}, settings);
  const auto momentum = [&] { return sheets.cloth.momentum(sheets.state); };
  double scale = 0.0;
  for (std::size_t i = 0; i < sheets.cloth.particleCount(); ++i) {
    sheets.state.velocities[i] = i < 49 ? Vector3d(0.0, 0.02, 0.1) : Vector3d(0.0, 0.0, -0.4);
    scale += sheets.cloth.masses()[i] * sheets.state.velocities[i].norm();
  }
  const auto energy = [&] {
    return sheets.cloth.potentialEnergy(sheets.state) + sheets.cloth.kineticEnergy(sheets.state);
  };
  const Vector3d begin = momentum();
  const double first_energy = energy();
  double most_energy = 0.0;
  bool touched = false;
  const int steps = base::unlessSanitized(20, 4);
  for (int i = 0; i < steps; ++i) {
    sheets.step(kStep);
    most_energy = std::max(most_energy, energy());
    touched = touched || !sheets.cloth.selfContact()->touching(sheets.state.positions).empty();
  }
  sink({"self_collision/colliding_sheets/touching", 1.0, touched ? 1.0 : 0.0, touched ? 0.0 : 1.0,
        0.0});
  sink({"self_collision/colliding_sheets/momentum", 0.0, (momentum() - begin).norm() / scale,
        (momentum() - begin).norm() / scale, 1e-12});
  const double growth = std::max(0.0, most_energy / first_energy - 1.0);
  sink({"self_collision/colliding_sheets/energy_growth", 0.0, growth, growth, 1e-9});
}

/// Intersections in any state, of the cloth with itself and with obstacles, and the energy that
/// cloth which falls has beyond that of its start, as a share of what it falls by.
void validateScenes(const material::Fabric& fabric, const Sink& sink) {
  constexpr int kCells = base::unlessSanitized(8, 3);
  for (const SelfCollidingCloth::Set& set : selfCollisionScenes(kCells)) {
    SelfCollidingCloth scene(set, {fabric}, newtonSteps(10));
    const double start = scene.energy();
    std::size_t most = 0;
    double highest = start, lowest = start;
    const int steps = static_cast<int>(std::lround(set.duration / kStep));
    for (int i = 0; i < base::unlessSanitized(steps, 5); ++i) {
      scene.step(kStep);
      most = std::max(most, scene.intersections());
      highest = std::max(highest, scene.energy());
      lowest = std::min(lowest, scene.energy());
    }
    const std::string name = "self_collision/" + set.name;
    sink({name + "/intersections", 0.0, static_cast<double>(most), static_cast<double>(most), 0.0});
    if (!set.falls) continue;
    const double growth = (highest - start) / (highest - lowest);
    sink({name + "/energy_growth", 0.0, growth, growth, 1e-9});
  }
}

/// The share of random tangled starts that is free after a second.
void validateTangledStarts(const std::string& config_directory, const Sink& sink) {
  const UntangledStarts ends =
      untangleStarts(base::unlessSanitized(20, 2), base::unlessSanitized(80, 4), config_directory);
  const double misreported = ends.misreported, growth = ends.energy_growth;
  sink({"self_collision/tangled_starts/free", 1.0, ends.free_share, 1.0 - ends.free_share,
        base::unlessSanitized(0.05, 1.0)});
  sink({"self_collision/tangled_starts/misreported", 0.0, misreported, misreported, 0.0});
  sink({"self_collision/tangled_starts/energy_growth", 0.0, growth, growth, 1e-9});
}

}  // namespace

void validateSelfCollision(const std::string& config_directory, const Sink& sink) {
  const material::Fabric wool = material::loadFabric(config_directory + "/fabrics/wool.yaml");
  const material::Fabric denim = material::loadFabric(config_directory + "/fabrics/denim.yaml");
  validateStack({wool}, 5, sink);
  if (!base::kSanitized) validateStack({wool}, 20, sink);
  validateStack({denim, wool}, 5, sink);
  validatePull({wool}, "pulled_out", sink);
  validatePull({denim, wool}, "pulled_out_of_denim", sink);
  validateMomentum(wool, sink);
  validateScenes(wool, sink);
  validateTangledStarts(config_directory, sink);
}

}  // namespace haptex::oracles
