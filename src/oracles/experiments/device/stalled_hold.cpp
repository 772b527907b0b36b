#include "haptex/oracles/experiments/device/stalled_hold.h"

#include <algorithm>
#include <chrono>
#include <deque>
#include <stdexcept>

#include "haptex/base/workload.h"
#include "haptex/exoskeleton/control/minimum_jerk.h"
#include "haptex/oracles/experiments/exoskeleton_loop.h"

namespace haptex::oracles {

using namespace exoskeleton;
using Eigen::Vector3d;
using std::chrono::milliseconds;

namespace {

constexpr double kBefore = 0.005;  // m, of the open fingers to the walls
constexpr int kMove = 300;         // ms, to the walls and into them
constexpr milliseconds kSettle{1500}, kAfter{400};
constexpr double kDip = 0.8;                                            // of the hold
constexpr std::size_t kJumpSteps = 5 * ExoskeletonLoop::kStepsPerTick;  // 5 ms
constexpr double kStep = 1e3 * base::seconds(ExoskeletonLoop::kStep);   // ms
constexpr Time kDeadline = milliseconds(20);
constexpr int kMoments = base::unlessSanitized(4, 1);  // of a period, for a death

/// From the other fingertip to this one.
Vector3d directionOf(Finger finger, const PerFinger<Vector3d>& open) {
  const Vector3d way = (open[Finger::kIndex] - open[Finger::kThumb]).normalized();
  return finger == Finger::kIndex ? way : -way;
}

/// The worse finger's felt force, step by step.
class Watch {
 public:
  explicit Watch(double hold) { felt_.hold = felt_.least = hold; }

  void feel(double force) {
    felt_.least = std::min(felt_.least, force);
    if (force < kDip * felt_.hold) felt_.below += kStep;
    felt_.overshoot = std::max(felt_.overshoot, force - felt_.hold);
    last_.push_back(force);
    if (last_.size() > kJumpSteps) last_.pop_front();
    const double lowest = *std::min_element(last_.begin(), last_.end());
    felt_.jump = std::max(felt_.jump, force - lowest);
  }

  StalledHold result() const {
    StalledHold result = felt_;
    result.least /= felt_.hold;
    return result;
  }

 private:
  StalledHold felt_;
  std::deque<double> last_;
};

StalledHold worse(const StalledHold& a, const StalledHold& b) {
  return {std::min(a.hold, b.hold), std::min(a.least, b.least), std::max(a.below, b.below),
          std::max(a.jump, b.jump), std::max(a.overshoot, b.overshoot)};
}

class Pinch {
 public:
  Pinch(const std::string& urdf, const PerFinger<Vector3d>& open, double stiffness)
      : loop_(urdf, 1), open_(open), stiffness_(stiffness) {
    for (const Finger finger : kFingers) loop_.device().setTarget(finger, open[finger]);
    loop_.makeReady();
    loop_.setCommander([this](Finger finger, Time) { return command(finger); });
  }

  void press(double force) {
    const FingerMechanics person;
    const double depth =
        force * (1.0 / stiffness_ + 1.0 / person.pulp_stiffness + 1.0 / person.fingertip_stiffness);
    for (int i = 1; i <= kMove; ++i) {
      const double way = (kBefore + depth) * minimumJerk(static_cast<double>(i) / kMove);
      for (const Finger finger : kFingers) {
        loop_.device().setTarget(finger, open_[finger] - way * directionOf(finger, open_));
      }
      loop_.run(milliseconds(1));
    }
    loop_.run(kSettle);
  }

  StalledHold stall(StalledPart part, Time duration) {
    PerFinger<Watch> watches{{Watch(felt(Finger::kIndex)), Watch(felt(Finger::kThumb))}};
    if (part == StalledPart::kCommands) loop_.stallCommander(duration);
    if (part == StalledPart::kDriver) loop_.stallDriver(duration);
    if (part == StalledPart::kMeasurements) loop_.stallMeasurements(duration);
    loop_.run(duration + kAfter, [&](const ExoskeletonLoop&) {
      for (const Finger finger : kFingers) watches[finger].feel(felt(finger));
    });
    if (loop_.controller().operatingState().mode != Mode::kEnabled) {
      throw std::runtime_error("stalled hold: " + loop_.controller().fault());
    }
    return worse(watches[Finger::kIndex].result(), watches[Finger::kThumb].result());
  }

 private:
  double felt(Finger finger) const {
    return loop_.device().truth(finger).contact_force.dot(directionOf(finger, open_));
  }

  /// As a renderer does: from what was measured last, linearised there.
  ForceCommand command(Finger finger) const {
    const FingerMeasurement& measured = loop_.controller().measured(finger);
    const Vector3d normal = directionOf(finger, open_);
    ForceCommand command;
    command.position = measured.pose.translation();
    command.velocity = measured.velocity;
    const double depth = (open_[finger] - command.position).dot(normal) - kBefore;
    if (depth <= 0.0) return command;
    command.force = stiffness_ * depth * normal;
    command.stiffness = stiffness_ * normal * normal.transpose();
    return command;
  }

  ExoskeletonLoop loop_;
  PerFinger<Vector3d> open_;
  double stiffness_;
};

void kill(ExoskeletonLoop& loop, DyingPart part) {
  constexpr Time kForEver = std::chrono::hours(1);
  switch (part) {
    case DyingPart::kCommander:
      return loop.killCommander();
    case DyingPart::kSilentCommander:
      return loop.stallCommander(kForEver);
    case DyingPart::kDriver:
      return loop.killDriver();
    case DyingPart::kSilentDriver:
      return loop.stallDriver(kForEver);
    case DyingPart::kMotors:
      return loop.killMotors();
  }
}

}  // namespace

const char* name(StalledPart part) {
  switch (part) {
    case StalledPart::kCommands:
      return "commands";
    case StalledPart::kMeasurements:
      return "measurements";
    case StalledPart::kDriver:
      return "driver";
  }
  return "";
}

std::vector<StalledHold> holdThroughStalls(const std::string& urdf, const PerFinger<Vector3d>& open,
                                           double force, double stiffness, StalledPart part,
                                           const std::vector<Time>& durations) {
  Pinch pinch(urdf, open, stiffness);
  pinch.press(force);
  std::vector<StalledHold> holds;
  holds.reserve(durations.size());
  for (const Time duration : durations) holds.push_back(pinch.stall(part, duration));
  return holds;
}

Death dieInAHold(const std::string& urdf, const PerFinger<Vector3d>& open, double force,
                 DyingPart part) {
  Death worst;
  for (int moment = 0; moment < kMoments; ++moment) {
    ExoskeletonLoop loop(urdf, 1 + moment);
    for (const Finger finger : kFingers) loop.device().setTarget(finger, open[finger]);
    loop.makeReady();
    loop.setCommander([&](Finger finger, Time) {
      ForceCommand command;
      command.force = force * directionOf(finger, open);
      return command;
    });
    loop.run(kSettle + moment * ExoskeletonLoop::kStep * ExoskeletonLoop::kStepsPerTick / kMoments);
    const Time death = loop.now();
    kill(loop, part);
    loop.run(2 * kDeadline, [&](const ExoskeletonLoop& now) {
      const Time since = now.now() - death;
      for (const Finger finger : kFingers) {
        const EmulatedTruth& truth = now.device().truth(finger);
        if (!truth.motor_force.isZero(0.0)) {
          worst.motors_on = std::max(worst.motors_on, 1e3 * base::seconds(since));
        }
        if (since != kDeadline) continue;
        worst.force_left = std::max(worst.force_left, truth.contact_force.norm());
      }
    });
  }
  return worst;
}

}  // namespace haptex::oracles
