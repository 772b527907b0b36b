#include "haptex/oracles/experiments/virtual_wall.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <deque>
#include <sstream>
#include <stdexcept>

#include "haptex/exoskeleton/control/minimum_jerk.h"
#include "haptex/oracles/experiments/exoskeleton_loop.h"

namespace haptex::oracles {

using namespace exoskeleton;
using Eigen::Vector3d;
using std::chrono::milliseconds;

namespace {

constexpr double kBefore = 0.005;                     // m, of the open fingers to the wall
constexpr double kHolds[] = {0.3, 1.0, 2.0};          // N
constexpr double kPress = 2.0;                        // N, in the cycles
constexpr int kMove = 200;                            // ms, to the wall, into it, or out of it
constexpr int kRest = 200;                            // ms, in the wall and before it
constexpr milliseconds kSettle{2000}, kWindow{3000};  // of a hold
constexpr double kMaxRipple = 0.01;                   // N RMS
constexpr double kMaxOvershoot = 0.2;
constexpr double kMaxShare = 0.01;
// J. The sensor's noise, as a constant error, along the way into the wall and out: 2 * 5 mm.
constexpr double kNoiseEnergy = EmulatedDevice::kForceNoise * 0.01;

void requireSound(const VirtualWall& wall) {
  const bool sound = std::isfinite(wall.stiffness) && wall.stiffness > 0.0 &&
                     std::isfinite(wall.damping) && wall.damping >= 0.0 && wall.delay >= 0;
  if (sound) return;
  std::ostringstream message;
  message << "virtual wall: stiffness " << wall.stiffness << " N/m, damping " << wall.damping
          << " N s/m, delay " << wall.delay
          << " ms: allowed are finite numbers, the stiffness > 0, the others >= 0";
  throw std::invalid_argument(message.str());
}

/// A wall before one finger, and the commands that are on their way from it.
class Face {
 public:
  Face(const VirtualWall& wall, const Vector3d& surface, const Vector3d& normal)
      : wall_(wall), surface_(surface), normal_(normal) {
    requireSound(wall);
  }

  /// m, in hand_base; depth > 0 is in the wall.
  Vector3d place(double depth) const { return surface_ - depth * normal_; }
  /// m, how deep the person has to want to be in order to press with a force (N).
  double depthOfTarget(double force, const FingerMechanics& person) const {
    return force *
           (1.0 / wall_.stiffness + 1.0 / person.pulp_stiffness + 1.0 / person.fingertip_stiffness);
  }
  const Vector3d& normal() const { return normal_; }

  ForceCommand command(const FingerMeasurement& measured) {
    ForceCommand command;
    command.position = measured.pose.translation();
    command.velocity = measured.velocity;
    const double depth = (surface_ - command.position).dot(normal_);
    const double force = wall_.stiffness * depth - wall_.damping * command.velocity.dot(normal_);
    if (depth > 0.0 && force > 0.0) {
      command.force = force * normal_;
      if (wall_.linearised) {
        command.stiffness = wall_.stiffness * normal_ * normal_.transpose();
        command.damping = wall_.damping * normal_ * normal_.transpose();
      }
    }
    on_their_way_.push_back(command);
    const ForceCommand arrived = on_their_way_.front();
    if (static_cast<int>(on_their_way_.size()) > wall_.delay) on_their_way_.pop_front();
    return arrived;
  }

 private:
  VirtualWall wall_;
  Vector3d surface_, normal_;
  std::deque<ForceCommand> on_their_way_;
};

PerFinger<Face> faces(const PerFinger<Vector3d>& open, const PerFinger<VirtualWall>& walls) {
  const Vector3d way = (open[Finger::kIndex] - open[Finger::kThumb]).normalized();
  const auto face = [&](Finger finger, const Vector3d& normal) {
    return Face(walls[finger], open[finger] - kBefore * normal, normal);
  };
  return {{face(Finger::kIndex, way), face(Finger::kThumb, -way)}};
}

class Experiment {
 public:
  Experiment(const std::string& urdf, const FingerMechanics& mechanics,
             const PerFinger<Vector3d>& open, const PerFinger<VirtualWall>& walls)
      : loop_(urdf, 1, mechanics), mechanics_(mechanics), faces_(faces(open, walls)) {
    for (const Finger finger : kFingers) loop_.device().setTarget(finger, open[finger]);
    loop_.makeReady();
    loop_.setCommander([this](Finger finger, Time) {
      return faces_[finger].command(loop_.controller().measured(finger));
    });
  }

  void hold(double force) {
    press(force);
    loop_.run(kSettle);
    PerFinger<Vector3d> sum{{Vector3d::Zero(), Vector3d::Zero()}};
    PerFinger<double> squares{};
    int count = 0;
    loop_.run(kWindow, [&](const ExoskeletonLoop& loop) {
      ++count;
      for (const Finger finger : kFingers) {
        const Vector3d felt = loop.device().truth(finger).contact_force;
        sum[finger] += felt;
        squares[finger] += felt.squaredNorm();
      }
    });
    for (const Finger finger : kFingers) {
      const double variance = squares[finger] / count - (sum[finger] / count).squaredNorm();
      double& ripple = touches_[finger].ripple;
      ripple = std::max(ripple, std::sqrt(std::max(0.0, variance)));
    }
  }

  void cycle() {
    for (const Finger finger : kFingers) {
      observed_[finger] = given_[finger] = 0.0;
      last_place_[finger] = loop_.device().truth(finger).position;
    }
    watching_ = true;
    press(kPress);
    rest();
    retract();
    rest();
    watching_ = false;
    for (const Finger finger : kFingers) {
      double& most = touches_[finger].given_energy;
      most = std::max(most, given_[finger]);
    }
  }

  void retract() { moveTo({{-kBefore, -kBefore}}); }

  PerFinger<WallTouch> touches() const {
    if (loop_.controller().operatingState().mode != Mode::kEnabled) {
      throw std::runtime_error("virtual wall: " + loop_.controller().fault());
    }
    return touches_;
  }

  std::uint64_t controllerActed(Finger finger) const {
    return loop_.controller().measured(finger).safety.passivity_limited;
  }

 private:
  void press(double force) {
    PerFinger<double> depths;
    for (const Finger finger : kFingers) {
      depths[finger] = faces_[finger].depthOfTarget(force, mechanics_);
    }
    moveTo(depths);
  }

  void moveTo(const PerFinger<double>& depths) {
    for (int i = 1; i <= kMove; ++i) {
      const double share = minimumJerk(static_cast<double>(i) / kMove);
      for (const Finger finger : kFingers) {
        const double depth = depths_[finger] + share * (depths[finger] - depths_[finger]);
        loop_.device().setTarget(finger, faces_[finger].place(depth));
      }
      tick();
    }
    depths_ = depths;
  }

  void rest() {
    for (int i = 0; i < kRest; ++i) tick();
  }

  void tick() {
    loop_.run(milliseconds(1), [this](const ExoskeletonLoop&) {
      if (watching_) watch();
    });
    if (!watching_) return;
    for (const Finger finger : kFingers) {
      const FingerMeasurement& measured = loop_.controller().measured(finger);
      observed_[finger] -= 1e-3 * measured.desired_force.dot(measured.velocity);
      double& lowest = touches_[finger].observed_energy;
      lowest = std::min(lowest, observed_[finger]);
    }
  }

  void watch() {
    for (const Finger finger : kFingers) {
      const EmulatedTruth& truth = loop_.device().truth(finger);
      given_[finger] += truth.contact_force.dot(truth.position - last_place_[finger]);
      last_place_[finger] = truth.position;
      const double felt = truth.contact_force.dot(faces_[finger].normal());
      double& overshoot = touches_[finger].overshoot;
      overshoot = std::max(overshoot, felt / kPress - 1.0);
    }
  }

  ExoskeletonLoop loop_;
  FingerMechanics mechanics_;
  PerFinger<Face> faces_;
  PerFinger<double> depths_{{-kBefore, -kBefore}};  // m, of the targets
  PerFinger<WallTouch> touches_;
  PerFinger<double> observed_{}, given_{};  // J, in this cycle
  PerFinger<Vector3d> last_place_{{Vector3d::Zero(), Vector3d::Zero()}};
  bool watching_ = false;
};

}  // namespace

bool WallTouch::steady() const { return ripple < kMaxRipple && overshoot < kMaxOvershoot; }

bool WallTouch::observedPassive() const {
  return observed_energy >= -kNoiseEnergy && controller_share < kMaxShare;
}

PerFinger<WallTouch> touchWalls(const std::string& urdf, const FingerMechanics& mechanics,
                                const PerFinger<Vector3d>& open,
                                const PerFinger<VirtualWall>& walls, int cycles) {
  Experiment experiment(urdf, mechanics, open, walls);
  for (const double force : kHolds) experiment.hold(force);
  experiment.retract();
  PerFinger<std::uint64_t> before;
  for (const Finger finger : kFingers) before[finger] = experiment.controllerActed(finger);
  for (int i = 0; i < cycles; ++i) experiment.cycle();
  PerFinger<WallTouch> touches = experiment.touches();
  const double ticks = std::max(1, cycles) * 2.0 * (kMove + kRest);
  for (const Finger finger : kFingers) {
    const auto acted = static_cast<double>(experiment.controllerActed(finger) - before[finger]);
    touches[finger].controller_share = acted / ticks;
  }
  return touches;
}

}  // namespace haptex::oracles
