#include "haptex/studies/trade_off.h"

#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>

#include "haptex/base/constants.h"
#include "haptex/cloth/dynamics/integrator.h"
#include "haptex/contact/obstacles/obstacle_collision.h"
#include "haptex/kes/equilibrium.h"
#include "haptex/oracles/experiments/hanging_strip.h"
#include "haptex/oracles/scenes/obstacle_scenes.h"
#include "haptex/simulation/step_cost.h"

namespace haptex::studies {
namespace {

using cloth::Cloth;
using cloth::ClothState;
using contact::ObstacleCollision;
using Eigen::Vector3d;

constexpr double kSphereRadius = 0.15;  // m
constexpr double kHeld = 0.2;           // N/m, tension of what is held taut
constexpr double kPull = 1.0;           // N/m, and of what is pulled

// All durations are whole cycles.
constexpr int kHangCycles = 120;
constexpr int kHangMeanCycles = 40;
constexpr int kSwingCycles = 100;
constexpr int kStretchCycles = 72;
constexpr int kDrapeCycles = 32;
constexpr int kFoldCycles = 96;

int cyclesOf(Motion motion) {
  switch (motion) {
    case Motion::kHang:
      return kHangCycles;
    case Motion::kSwing:
      return kSwingCycles;
    case Motion::kStretch:
      return kStretchCycles;
    case Motion::kFold:
      return kFoldCycles;
    default:
      return kDrapeCycles;
  }
}

const TradeOffPoint& requireSound(const TradeOffPoint& point) {
  if (point.cells <= 0) {
    throw std::invalid_argument("cells is " + std::to_string(point.cells) +
                                "; it must be positive");
  }
  if (point.steps_per_cycle <= 0) {
    throw std::invalid_argument("steps_per_cycle is " + std::to_string(point.steps_per_cycle) +
                                "; it must be positive");
  }
  if (!(point.thickness > 0.0) || !std::isfinite(point.thickness)) {
    throw std::invalid_argument("thickness is " + std::to_string(point.thickness) +
                                "; it must be positive");
  }
  return point;
}

material::Fabric fabricOf(Motion motion, material::Fabric fabric, const TradeOffPoint& point) {
  if (motion == Motion::kFold && fabric.compression) {
    fabric.compression->thickness *= requireSound(point).thickness;
  }
  return fabric;
}

Cloth sampleOf(Motion motion, const material::Fabric& fabric, const TradeOffPoint& point) {
  cloth::ModelledEffects effects;
  effects.viscosity = true;
  effects.gravity = {0.0, 0.0, -base::kStandardGravity};
  effects.elasticity = point.elasticity;
  effects.bending = fabric.bending.has_value();
  effects.contacts = motion == Motion::kDrape;
  effects.self_collision = motion == Motion::kFold;
  Eigen::Isometry3d above = Eigen::Isometry3d::Identity();
  if (effects.contacts) above.translation().z() = kSphereRadius + ObstacleCollision::kOffset;
  const int cells = requireSound(point).cells;
  mesh::ClothMesh mesh = isTouched(motion)
                             ? oracles::flatSheet({kSampleSize, kSampleSize}, cells, cells, above)
                             : mesh::makeRectangle(kSampleSize, kSampleSize, cells, cells,
                                                   mesh::Triangulation::kAlternating);
  return Cloth(std::move(mesh), fabricOf(motion, fabric, point), effects);
}

class MotionRun {
 public:
  MotionRun(Motion motion, const material::Fabric& fabric, const TradeOffPoint& point)
      : motion_(motion),
        point_(point),
        cloth_(sampleOf(motion, fabric, point)),
        state_(cloth_.initialState()),
        integrator_(cloth_, point.step),
        upper_(sideParticles(cloth_.mesh(), mesh::Side::kTop)),
        lower_(sideParticles(cloth_.mesh(), mesh::Side::kBottom)) {
    if (motion == Motion::kDrape) {
      collision_.emplace(cloth_,
                         std::vector<mesh::Obstacle>{{"sphere", mesh::ObstacleSphere{kSphereRadius},
                                                      Eigen::Isometry3d::Identity()}});
    } else if (motion == Motion::kFold) {
      for (std::size_t i = 0; i < cloth_.particleCount(); ++i) {
        const Vector3d& place = state_.positions[i];
        if (place.y() > -1e-9 * kSampleSize) cloth_.attach(static_cast<int>(i), {place});
      }
    } else {
      moveSide(upper_, Vector3d::Zero(), 0.0);
    }
    first_energy_ = energyOf(state_);
  }

  void rest() {
    if (motion_ == Motion::kStretch) holdTaut();
    kes::Equilibrium(cloth_).settle(cloth_, state_, 0.1);
    if (motion_ != Motion::kHang) first_energy_ = energyOf(state_);
  }

  Trajectory follow() {
    if (motion_ == Motion::kSwing || motion_ == Motion::kStretch) rest();
    Trajectory trajectory;
    ClothState mean = state_;
    mean.positions.assign(cloth_.particleCount(), Vector3d::Zero());
    mean.velocities = mean.positions;
    const int cycles = cyclesOf(motion_);
    for (int cycle = 0; cycle < cycles; ++cycle) {
      direct(cycle);
      const Vector3d momentum = cloth_.momentum(state_);
      trajectory.accepted = advance(trajectory);
      if (!trajectory.accepted) break;
      trajectory.simulated_seconds = (cycle + 1) * kCycle;
      if (fastest() > 1e-3) trajectory.settling_seconds = trajectory.simulated_seconds;
      if (motion_ == Motion::kHang) {
        if (cycle >= cycles - kHangMeanCycles) addShare(1.0 / kHangMeanCycles, mean);
      } else {
        trajectory.snapshots.push_back(snapshot(state_));
        if (!lower_held_) trajectory.snapshots.back().force = forceSince(momentum);
      }
    }
    if (motion_ == Motion::kHang && trajectory.accepted) {
      trajectory.snapshots.push_back(snapshot(mean));
    }
    return trajectory;
  }

  Snapshot snapshot(const ClothState& state) {
    Snapshot now;
    for (int j = 0; j <= kComparedIntervals; ++j) {
      for (int i = 0; i <= kComparedIntervals; ++i) now.positions.push_back(placeOf(state, i, j));
    }
    now.energy = energyOf(state) - first_energy_;
    if (!collision_) now.force = edgeForce(state);
    return now;
  }
  const ClothState& state() const { return state_; }

 private:
  /// What happens at the beginning of a cycle.
  void direct(int cycle) {
    if (motion_ == Motion::kSwing) {
      if (cycle == 0) moveSide(upper_, {0.08, 0.0, 0.0}, 32 * kCycle);
      if (cycle == 40) moveSide(upper_, {-0.16, 0.0, 0.0}, 40 * kCycle);
    } else if (motion_ == Motion::kStretch) {
      if (cycle == 0) {
        moveSide(lower_, (tautLength(kPull) - tautLength(kHeld)) * aside(), 24 * kCycle);
      }
      if (cycle == 32) {
        for (int particle : lower_) cloth_.release(particle);
        lower_held_ = false;
      }
    } else if (motion_ == Motion::kFold) {
      const auto move = [&](const Vector3d& way, int cycles) {
        moveSide(lower_, kSampleSize * way, cycles * kCycle);
      };
      lower_held_ = true;
      if (cycle == 0) move({0.0, 0.5, 0.5}, 32);
      if (cycle == 32) move({0.0, 0.275, -0.49}, 32);
      if (cycle == 64) move({0.0, 0.05, 0.0}, 16);
    }
  }

  /// Lets the sample find its equilibrium between its edges, of which the lower one is held aside.
  void holdTaut() {
    const double stretch = tautLength(kHeld) / kSampleSize;
    for (Vector3d& place : state_.positions) {
      place = Vector3d(0.0, place.y(), 0.0) - stretch * place.z() * aside();
    }
    moveSide(lower_, Vector3d::Zero(), 0.0);
    lower_held_ = true;
  }

  Vector3d aside() const { return {0.5, 0.0, -std::sqrt(0.75)}; }
  double tautLength(double tension) const {
    return kSampleSize * oracles::stretchUnder(tension, cloth_.fabric().warp.elastic);
  }

  void moveSide(const std::vector<int>& side, const Vector3d& displacement, double duration) {
    for (int particle : side) {
      cloth_.attach(particle, {state_.positions[particle], displacement, state_.time, duration});
    }
  }

  /// By a cycle. False: a step was not accepted.
  bool advance(Trajectory& trajectory) {
    const double start = simulation::threadSeconds();
    bool accepted = true;
    const double h = point_.timeStep();
    for (int i = 0; accepted && i < point_.steps_per_cycle; ++i) {
      if (i + 1 == point_.steps_per_cycle) before_.positions = state_.positions;
      const cloth::StepReport report = collision_ ? collision_->step(cloth_, integrator_, state_, h)
                                                  : integrator_.step(cloth_, state_, h);
      accepted = report.accepted;
      trajectory.steps += accepted;
      trajectory.solves += report.newton_iterations;
    }
    trajectory.computing_seconds += simulation::threadSeconds() - start;
    return accepted;
  }

  double energyOf(const ClothState& state) const {
    return cloth_.potentialEnergy(state) + cloth_.kineticEnergy(state);
  }

  /// Of column i in row j of the points that are compared.
  Vector3d placeOf(const ClothState& state, int i, int j) const {
    const auto cell_at = [&](int k) {
      return std::min(k * cells() / kComparedIntervals, cells() - 1);
    };
    const int column = cell_at(i), row = cell_at(j);
    const auto share = [&](int k, int cell) {
      return static_cast<double>(k * cells()) / kComparedIntervals - cell;
    };
    const double right = share(i, column), up = share(j, row);
    const auto* lower = &state.positions[row * (cells() + 1) + column];
    const auto* upper = lower + cells() + 1;
    return (1.0 - up) * ((1.0 - right) * lower[0] + right * lower[1]) +
           up * ((1.0 - right) * upper[0] + right * upper[1]);
  }
  int cells() const { return point_.cells; }

  /// Of the attached edge that is told about: the upper one, which rests, or of fold the lower one.
  /// The viscous part is that of how strains have changed within the last step: velocities at the
  /// end of a long step would stretch what only turns.
  Vector3d edgeForce(const ClothState& state) {
    ClothState slow = state;
    for (Vector3d& velocity : slow.velocities) velocity.setZero();
    Vector3d force = -edgeSum(slow);
    const double h = point_.timeStep();
    if (lower_held_) {
      for (std::size_t i = 0; i < cloth_.particleCount(); ++i) {
        slow.positions[i] = 0.5 * (before_.positions[i] + state.positions[i]);
      }
      force += edgeSum(slow);
      for (std::size_t i = 0; i < cloth_.particleCount(); ++i) {
        slow.velocities[i] = (state.positions[i] - before_.positions[i]) / h;
      }
      force -= edgeSum(slow);
    }
    return force;
  }

  Vector3d edgeSum(const ClothState& state) {
    cloth_.computeForces(state, forces_);
    Vector3d sum = Vector3d::Zero();
    for (int particle : motion_ == Motion::kFold ? lower_ : upper_) sum += forces_[particle];
    return sum;
  }

  /// Mean over the last cycle of what the sphere exerts.
  Vector3d forceSince(const Vector3d& momentum) const {
    Vector3d weight = Vector3d::Zero();
    for (double mass : cloth_.masses()) weight += mass * cloth_.effects().gravity;
    return (cloth_.momentum(state_) - momentum) / kCycle - weight;
  }

  void addShare(double share, ClothState& mean) const {
    for (std::size_t i = 0; i < cloth_.particleCount(); ++i) {
      mean.positions[i] += share * state_.positions[i];
    }
  }

  double fastest() const {
    double speed = 0.0;
    for (const Vector3d& velocity : state_.velocities) speed = std::max(speed, velocity.norm());
    return speed;
  }

  Motion motion_;
  TradeOffPoint point_;
  Cloth cloth_;
  ClothState state_;
  ClothState before_ = state_;  // one step
  bool lower_held_ = false;
  cloth::Integrator integrator_;
  std::optional<ObstacleCollision> collision_;
  std::vector<int> upper_, lower_;
  double first_energy_ = 0.0;
  std::vector<Vector3d> forces_;
};

}  // namespace

bool canFollow(Motion motion, const TradeOffPoint& point) {
  if (motion == Motion::kFold) return cloth::collidesWithItself(point.step.method, false);
  return point.thickness == 1.0;
}

Trajectory follow(Motion motion, const material::Fabric& fabric, const TradeOffPoint& point) {
  return MotionRun(motion, fabric, point).follow();
}

Trajectory restOfHang(const material::Fabric& fabric, const TradeOffPoint& point) {
  MotionRun run(Motion::kHang, fabric, point);
  run.rest();
  Trajectory trajectory;
  trajectory.snapshots.push_back(run.snapshot(run.state()));
  return trajectory;
}

}  // namespace haptex::studies
