#include "haptex/studies/drape.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "haptex/base/constants.h"
#include "haptex/base/repeatable_random.h"
#include "haptex/cloth/dynamics/cloth.h"
#include "haptex/cloth/dynamics/integrator.h"
#include "haptex/mesh/circles.h"
#include "haptex/studies/drape_shadow.h"

namespace haptex::studies {
namespace {

using cloth::Cloth;
using cloth::ClothState;
using cloth::ParticleContact;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kOffCentre = 1e-3;     // m, along either axis
constexpr double kWaviness = 2e-4;      // m, of each order
constexpr int kWaves = 12;              // orders
constexpr double kThreadStrain = 1e-4;  // by the weight of what hangs
constexpr double kReach = 5e-3;         // m, of bodies that a particle may touch within a step
constexpr double kProminence = 2e-3;    // m, of a fold in the shadow's edge
constexpr int kAngles = 720;
constexpr double kCellGrowth = 0.1;  // of cells, over their distance from the clamp

void requireSound(const DrapeTest& test) {
  const auto require = [](const char* name, double value, double most) {
    if (std::isfinite(value) && value > 0.0 && value < most) return;
    std::ostringstream message;
    message << name << " of the drape test is " << value << "; it must be greater than 0";
    if (std::isfinite(most)) message << " and less than " << most;
    throw std::invalid_argument(message.str());
  };
  const double any = INFINITY;
  require("fabric_radius", test.fabric_radius, any);
  require("support_radius", test.support_radius, test.fabric_radius);
  require("cell", test.cell,
          std::min(test.fabric_radius - test.support_radius, 2.0 * test.support_radius));
  require("time_step", test.time_step, any);
  require("damping", test.damping, any);
  require("lowering_time", test.lowering_time, any);
  require("rest_speed", test.rest_speed, any);
  require("most_time", test.most_time, any);
}

/// With threads that can follow folds.
material::Fabric softened(material::Fabric fabric, const DrapeTest& test) {
  const double weight = fabric.areal_density * base::kStandardGravity *
                        (test.fabric_radius - test.support_radius);  // N/m
  const double enough = weight / kThreadStrain;
  for (material::MembraneCurves* threads : {&fabric.weft, &fabric.warp}) {
    if (threads->elastic.evaluate(0.0).slope > enough) {
      threads->elastic = material::StrainStressCurve::linear(enough);
    }
  }
  return fabric;
}

/// The circle (m) up to which particles are held: a clamp made of held particles ends half way
/// between the last two circles of them (docs/mechanics.md, Bending), so the last one is half a
/// cell beyond the support's edge.
double heldRadius(const DrapeTest& test) { return test.support_radius + 0.5 * test.cell; }

/// How far out of the clamp a place of the flat disc is, 0 to 1 at the rim.
double share(const DrapeTest& test, const Vector3d& place) {
  const double held = heldRadius(test);
  return std::max(0.0, (place.norm() - held) / (test.fabric_radius - held));
}

/// The circles of particles (m): two that are held, half a cell on either side of the support's
/// edge, and those beyond.
std::vector<double> circlesOf(const DrapeTest& test) {
  const double held = heldRadius(test);
  std::vector<double> beyond = {test.cell};  // of the last circle that is held
  const double free = test.fabric_radius - held;
  while (beyond.back() < free) {
    beyond.push_back(beyond.back() * (1.0 + kCellGrowth) + test.cell);
  }
  const std::size_t last = beyond.size() - 1;
  if (last > 0 && beyond[last] - free > free - beyond[last - 1]) beyond.pop_back();
  std::vector<double> radii = {held - test.cell, held};
  for (const double distance : beyond) radii.push_back(held + free * distance / beyond.back());
  return radii;
}

/// The disc as it is laid on, not quite centred. Its initial positions are flat, and without
/// friction.
mesh::ClothMesh layDisc(const DrapeTest& test, base::RepeatableRandom& random) {
  mesh::ClothMesh mesh = mesh::meshOfCircles(circlesOf(test));
  const Eigen::Rotation2Dd turn(random.uniform(0.0, 2.0 * M_PI));
  const Vector2d off = random.inSquare(-kOffCentre, kOffCentre);
  for (std::size_t i = 0; i < mesh.initial_positions.size(); ++i) {
    Vector3d& place = mesh.initial_positions[i];
    // What is held stays where it is, and the mesh reaches farther out on one side.
    place.head<2>() += share(test, place) * off;
    mesh.rest_coordinates[i] = turn * Vector2d(place.head<2>());
  }
  return mesh;
}

class Drapemeter {
 public:
  Drapemeter(const material::Fabric& fabric, const DrapeTest& test, unsigned seed)
      : test_(test),
        random_(seed),
        cloth_(layDisc(test, random_), softened(fabric, test), effectsOf(fabric)),
        state_(cloth_.initialState()),
        integrator_(cloth_, settings()) {
    clamp();
    ruffle();
  }

  DrapeOutcome run() {
    double time = 0.0, fastest = 0.0;
    do {
      time += test_.time_step;
      lower(std::min(1.0, time / test_.lowering_time));
      findContacts();
      fastest = step();
    } while (time < test_.most_time && !(time > test_.lowering_time && fastest < test_.rest_speed));
    return outcome(time, fastest);
  }

 private:
  static cloth::ModelledEffects effectsOf(const material::Fabric& fabric) {
    cloth::ModelledEffects effects;
    effects.gravity = {0.0, 0.0, -base::kStandardGravity};
    effects.bending = effects.contacts = true;
    effects.bending_hysteresis = fabric.bending_hysteresis.has_value();
    effects.elasticity = cloth::Elasticity::kBilinear;
    return effects;
  }

  static cloth::StepSettings settings() {
    cloth::StepSettings settings;
    settings.newton_iterations = 2;
    return settings;
  }

  void clamp() {
    constexpr double kRounding = 1e-9;  // m
    for (std::size_t i = 0; i < cloth_.particleCount(); ++i) {
      if (state_.positions[i].norm() > heldRadius(test_) + kRounding) continue;
      cloth_.attach(static_cast<int>(i), {state_.positions[i], Vector3d::Zero(), 0.0, 0.0});
    }
  }

  /// Waves around the free ring, highest at the rim; the plane starts below them.
  void ruffle() {
    double heights[kWaves], phases[kWaves];
    for (int k = 0; k < kWaves; ++k) {
      heights[k] = random_.uniform(0.0, kWaviness);
      phases[k] = random_.uniform(0.0, 2.0 * M_PI);
    }
    for (std::size_t i = 0; i < cloth_.particleCount(); ++i) {
      if (cloth_.isAttached(static_cast<int>(i))) continue;
      Vector3d& place = state_.positions[i];
      const double out = share(test_, place);
      const double angle = std::atan2(place.y(), place.x());
      for (int k = 0; k < kWaves; ++k) {
        place.z() += out * heights[k] * std::cos((k + 1) * angle + phases[k]);
      }
      lowest_ = std::min(lowest_, place.z());
    }
  }

  /// @param share of the way, 1 at the end
  void lower(double share) {
    if (test_.descent == Descent::kOnPlane) {
      plane_ = lowest_ - share * (test_.fabric_radius - test_.support_radius);
      if (share >= 1.0) plane_ = -INFINITY;
      return;
    }
    for (std::size_t i = 0; i < cloth_.particleCount(); ++i) {
      const double carried = (1.0 - share) * base::kStandardGravity * cloth_.masses()[i];
      cloth_.setExternalForce(static_cast<int>(i), carried * Vector3d::UnitZ());
    }
  }

  /// Half spaces that keep the free particles above the plane and outside of the support.
  void findContacts() {
    contacts_.clear();
    const double end = state_.time + stepLength();
    for (std::size_t i = 0; i < cloth_.particleCount(); ++i) {
      const int particle = static_cast<int>(i);
      if (cloth_.isAttached(particle)) continue;
      const Vector3d& place = state_.positions[i];
      const double radius = place.head<2>().norm();
      const double above = place.z() - plane_, outside = radius - test_.support_radius;
      if (std::min(above, outside) > kReach) continue;
      Vector3d normal = Vector3d::UnitZ();
      if (outside < above) normal = Vector3d(place.x(), place.y(), 0.0) / radius;
      contacts_.push_back(
          {particle, normal, place, std::min(above, outside), Vector3d::Zero(), 0.0, end});
    }
    cloth_.setContacts(contacts_);
  }

  /// A step of backward Euler that starts without velocity ends at the minimum of
  ///   |x - x0|_M^2 / (2 h^2) + potential energy:
  /// of the overdamped motion m damping x' = F that is the implicit step by damping h^2.
  double stepLength() const { return std::sqrt(test_.time_step / test_.damping); }

  /// @return m/s, of the fastest particle
  double step() {
    const std::vector<Vector3d> before = state_.positions;
    for (Vector3d& velocity : state_.velocities) velocity.setZero();
    if (!integrator_.step(cloth_, state_, stepLength()).accepted) {
      throw std::runtime_error("a step of the drape test was not finite");
    }
    double farthest = 0.0;
    for (std::size_t i = 0; i < before.size(); ++i) {
      farthest = std::max(farthest, (state_.positions[i] - before[i]).norm());
    }
    return farthest / test_.time_step;
  }

  DrapeOutcome outcome(double time, double fastest) const {
    DrapeOutcome outcome{0.0, 0, cloth_.potentialEnergy(state_), time, fastest, 0, cloth_.mesh()};
    outcome.shape.initial_positions = state_.positions;
    const std::vector<double> radii = shadowRadii(outcome.shape, kAngles);
    outcome.coefficient = drapeCoefficient(radii, test_.fabric_radius, test_.support_radius);
    outcome.nodes = countNodes(radii, kProminence);
    constexpr double kRounding = 1e-6;  // m
    for (std::size_t i = 0; i < cloth_.particleCount(); ++i) {
      const Vector3d& place = state_.positions[i];
      if (!cloth_.isAttached(static_cast<int>(i)) && place.z() < -kRounding &&
          place.head<2>().norm() < test_.support_radius - kRounding) {
        ++outcome.inside_support;
      }
    }
    return outcome;
  }

  DrapeTest test_;
  base::RepeatableRandom random_;
  Cloth cloth_;
  ClothState state_;
  cloth::Integrator integrator_;
  std::vector<ParticleContact> contacts_;
  double lowest_ = 0.0;       // m, of the fabric as it is laid on
  double plane_ = -INFINITY;  // m, height
};

}  // namespace

DrapeOutcome drape(const material::Fabric& fabric, const DrapeTest& test, unsigned seed) {
  requireSound(test);
  return Drapemeter(fabric, test, seed).run();
}

}  // namespace haptex::studies
