// Cloth that frames carry: their reaction against virtual work, and whether it comes back after
// many cycles.
#include <Eigen/Geometry>
#include <cmath>
#include <string>
#include <vector>

#include "haptex/base/constants.h"
#include "haptex/kes/equilibrium.h"
#include "haptex/material/fabric_file.h"
#include "haptex/oracles/checks/garment_oracles.h"
#include "haptex/oracles/checks/random_checks.h"
#include "haptex/scene/scene.h"
#include "haptex/simulation/carrying_frames.h"
#include "haptex/simulation/simulated_cloth.h"

namespace haptex::oracles {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kWidth = 0.2, kLength = 0.3;  // m
constexpr double kTolerance = 1e-6;
constexpr int kCycles = 100;

/// A hinge that a bar at one end of a sheet turns about.
struct Hinge {
  Vector3d place;  // m
  Vector3d axis;   // of length 1

  Isometry3d turned(double angle) const {
    return Eigen::Translation3d(place) * Eigen::AngleAxisd(angle, axis);
  }
};

/// A sheet of wool that hangs in the plane x = 0 between a bar below that stands, the frame car,
/// and one that turns, the frame bow.
scene::Scene sheetBetweenBars(const Hinge& hinge) {
  scene::Scene scene;
  scene.mesh = mesh::makeRectangle(kWidth, kLength, 8, 12, mesh::Triangulation::kAlternating);
  scene.effects.viscosity = scene.effects.bending = true;
  scene.effects.gravity = {0.0, 0.0, -base::kStandardGravity};
  const auto carried = [&](const char* name, mesh::Side side, const Isometry3d& start) {
    scene::CarryingFrame frame{name, start, mesh::sideParticles(scene.mesh, side), {}};
    for (const int particle : frame.particles) {
      frame.places.push_back(start.inverse() * scene.mesh.initial_positions[particle]);
      scene.attached_particles.push_back(particle);
    }
    scene.frames.push_back(std::move(frame));
  };
  carried("bow", mesh::Side::kTop, hinge.turned(0.0));
  carried("car", mesh::Side::kBottom, Isometry3d::Identity());
  scene.time_step = 0.02;
  return scene;
}

material::Fabric wool(const std::string& config_directory) {
  return material::loadFabric(config_directory + "/fabrics/wool.yaml");
}

/// In equilibrium with the bow turned.
struct Turned {
  double energy;                                  // J
  std::vector<simulation::FrameWrench> wrenches;  // of both frames
};

class Linkage {
 public:
  Linkage(const Hinge& hinge, const material::Fabric& fabric)
      : hinge_(hinge),
        scene_(sheetBetweenBars(hinge)),
        cloth_(scene_.mesh, fabric, scene_.effects),
        frames_(scene_.frames, cloth_.particleCount()),
        state_(cloth_.initialState()),
        equilibrium_((hold(), cloth_)) {}

  Turned at(double angle) {
    frames_.move(0, hinge_.turned(angle));
    hold();
    equilibrium_.settle(cloth_, state_, 0.02);
    Turned turned{cloth_.potentialEnergy(state_), {}};
    for (std::size_t i = 0; i < frames_.size(); ++i) {
      turned.wrenches.push_back(frames_.wrench(i, cloth_, state_, equilibrium_.forces()));
    }
    return turned;
  }

 private:
  void hold() {
    for (std::size_t f = 0; f < frames_.size(); ++f) {
      for (std::size_t i = 0; i < frames_.particles(f).size(); ++i) {
        const Vector3d place = frames_.pose(f) * scene_.frames[f].places[i];
        cloth_.attach(frames_.particles(f)[i], {place});
      }
    }
  }

  Hinge hinge_;
  scene::Scene scene_;
  cloth::Cloth cloth_;
  simulation::CarryingFrames frames_;
  cloth::ClothState state_;
  kes::Equilibrium equilibrium_;
};

/// The torque about the hinge is what the energy loses per angle (virtual work), and both frames
/// together carry the weight.
void validateReaction(const Hinge& hinge, double angle, const material::Fabric& fabric,
                      const std::string& name, const Sink& sink) {
  Linkage linkage(hinge, fabric);
  linkage.at(0.5 * angle);
  constexpr double kStep = 2e-5;  // rad
  double energies[4];
  const double steps[4] = {-2.0, -1.0, 1.0, 2.0};
  for (int i = 0; i < 4; ++i) energies[i] = linkage.at(angle + steps[i] * kStep).energy;
  const double slope =
      (energies[0] - 8.0 * energies[1] + 8.0 * energies[2] - energies[3]) / (12.0 * kStep);
  const Turned turned = linkage.at(angle);
  const double torque = turned.wrenches[0].torque.dot(hinge.axis);
  sink(
      base::relativeTo(slope, name + "/reaction_against_virtual_work", -slope, torque, kTolerance));
  const double weight = fabric.areal_density * kWidth * kLength * base::kStandardGravity;
  const double carried = -(turned.wrenches[0].force + turned.wrenches[1].force).z();
  const double pull = turned.wrenches[0].force.norm();
  sink(base::relativeTo(weight + pull, name + "/weight_in_the_pull", weight, carried, kTolerance));
}

/// The bow turns towards the sheet and back, so that it goes slack and taut; where it comes to rest
/// after many times against after one.
void validateCycles(const material::Fabric& fabric, const Sink& sink) {
  const Hinge hinge{{-0.1, 0.0, -0.2}, Vector3d::UnitY()};
  simulation::SimulatedCloth cloth(sheetBetweenBars(hinge), fabric);
  const auto turn = [&](double from, double to) {
    constexpr int kSteps = 40;
    for (int i = 1; i <= kSteps; ++i) {
      const double share = 0.5 - 0.5 * std::cos(M_PI * i / kSteps);
      cloth.moveFrame(0, hinge.turned(from + share * (to - from)));
      cloth.step();
    }
  };
  const auto rest = [&] {
    for (int i = 0; i < 500; ++i) cloth.step();
    return cloth.state().positions;
  };
  constexpr double kTaut = -0.05, kAngle = 0.8;  // rad; taut, so that it rests in one way only
  turn(0.0, kTaut);
  std::vector<Vector3d> once;
  for (int cycle = 1; cycle <= kCycles; ++cycle) {
    turn(kTaut, kAngle);
    turn(kAngle, kTaut);
    if (cycle == 1) once = rest();
  }
  const std::vector<Vector3d> last = rest();
  double drift = 0.0;
  for (std::size_t i = 0; i < last.size(); ++i) {
    drift = base::largerOrNaN(drift, (last[i] - once[i]).norm());
  }
  sink({"garment/linkage/drift_after_100_cycles_m", 0.0, drift, drift, 1e-6});
}

}  // namespace

void validateLinkage(const std::string& config_directory, const Sink& sink) {
  const material::Fabric fabric = wool(config_directory);
  validateReaction({{0.1, 0.0, -0.2}, Vector3d::UnitY()}, 0.05, fabric, "garment/linkage/pulled",
                   sink);
  validateReaction({{0.0, 0.0, -0.3}, Vector3d::UnitX()}, 0.05, fabric, "garment/linkage/sheared",
                   sink);
  validateCycles(fabric, sink);
}

void randomLinkage(const std::string& config_directory, Random& random, const Sink& sink) {
  const double x = random.uniform(0.05, 0.2), y = random.uniform(-0.1, 0.1);
  const double z = random.uniform(-0.4, -0.1), slant = random.uniform(-0.2, 0.2);
  const double angle = random.uniform(0.01, 0.05);
  const Hinge hinge{{x, y, z}, Vector3d(0.0, 1.0, slant).normalized()};
  CaseName name("garment", "linkage");
  name.with("x", x).with("y", y).with("z", z).with("slant", slant).with("angle", angle);
  validateReaction(hinge, angle, wool(config_directory), name.text(), sink);
}

}  // namespace haptex::oracles
