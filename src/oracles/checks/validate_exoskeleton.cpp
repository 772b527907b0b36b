#include <Eigen/Geometry>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "haptex/base/workload.h"
#include "haptex/exoskeleton/control/finger_kinematics.h"
#include "haptex/exoskeleton/emulator/hand_path.h"
#include "haptex/oracles/checks/validation.h"
#include "haptex/oracles/exact/finger_geometry.h"
#include "haptex/oracles/experiments/device/stalled_hold.h"
#include "haptex/oracles/experiments/device/static_force.h"
#include "haptex/oracles/experiments/device/turning_hand.h"
#include "haptex/oracles/experiments/exoskeleton_loop.h"
#include "haptex/oracles/experiments/pinch.h"

namespace haptex::oracles {
namespace {

using base::Finger;
using base::kFingers;
using Eigen::Vector3d;
using exoskeleton::FingerKinematics;
using exoskeleton::JointVector;
using exoskeleton::kJoints;
using exoskeleton::kMotors;
using exoskeleton::kReduction;
using exoskeleton::MotorVector;

constexpr int kSteps = 11;           // of the grid in each driven joint, from limit to limit
constexpr double kMotorStep = 1e-3;  // rad, for differences: truncation and rounding below 1e-9
constexpr double kDegree = M_PI / 180.0;
constexpr int kForcePoses = base::unlessSanitized(24, 2);
constexpr double kOpenFor = 1.5;        // s, of config/paths/pinch.yaml: open around the sample
constexpr double kHold = 1.6;           // N, felt in the demo's pinch
constexpr double kHoldStiffness = 800;  // N/m, of a fingertip in wool that is held with it
constexpr double kDeathForce = 3.0;     // N
constexpr double kKnownDeath = 10.0;    // ms, of a death that the other end of a connection sees
constexpr double kSilentDeath = 20.0;   // ms, of one that is seen by silence only
constexpr double kForceLeft = 0.1;      // N, more than without motors
constexpr double kFeltWeight = 0.02;    // N
constexpr double kFriction = 0.05;      // N, at the fingertip: FingerMechanics
constexpr double kForceResolution = 0.005;  // N, the resolution of the HAPTEX exoskeleton

void forEachConfiguration(const FingerKinematics& finger,
                          const std::function<void(const JointVector&)>& visit) {
  const MotorVector lower = finger.motorAngles(finger.lowerLimits());
  const MotorVector span = finger.motorAngles(finger.upperLimits()) - lower;
  for (int i = 0; i < kSteps; ++i) {
    for (int j = 0; j < kSteps; ++j) {
      for (int k = 0; k < kSteps; ++k) {
        visit(finger.jointAngles(lower + (MotorVector(i, j, k) / (kSteps - 1)).cwiseProduct(span)));
      }
    }
  }
}

/// The worst of a quantity over the joint space.
base::Quantity worstOf(const FingerKinematics& finger,
                       const std::function<base::Quantity(const JointVector&)>& at) {
  base::Quantity worst{"", 0.0, 0.0, -1.0, 0.0};
  forEachConfiguration(finger,
                       [&](const JointVector& angles) { base::keepWorse(worst, at(angles)); });
  return worst;
}

/// Change of the fingertip's position per change of the motors by `direction`, by differences.
Vector3d slope(FingerKinematics& finger, const MotorVector& motors, const MotorVector& direction) {
  const MotorVector step = kMotorStep * direction;
  return (finger.fingertip(finger.jointAngles(motors + step)).translation() -
          finger.fingertip(finger.jointAngles(motors - step)).translation()) /
         (2.0 * kMotorStep);
}

base::Quantity jacobian(FingerKinematics& finger, const std::string& prefix) {
  return worstOf(finger, [&](const JointVector& angles) {
    const Eigen::Matrix3d found = finger.motorJacobian(angles);
    Eigen::Matrix3d difference;
    for (int i = 0; i < kMotors; ++i) {
      difference.col(i) = slope(finger, finger.motorAngles(angles), MotorVector::Unit(i));
    }
    return base::Quantity{prefix + "jacobian_norm_by_differences", difference.norm(), found.norm(),
                          (found - difference).norm() / found.norm(), 1e-7};
  });
}

/// What the motors put in, torque times speed, comes out as force times velocity.
base::Quantity powerBalance(FingerKinematics& finger, const std::string& prefix) {
  std::mt19937 generator(1);
  std::normal_distribution<double> normal;
  const auto any = [&] {
    const double x = normal(generator), y = normal(generator), z = normal(generator);
    return Vector3d(x, y, z);
  };
  return worstOf(finger, [&](const JointVector& angles) {
    const Vector3d force = any();      // N
    const MotorVector speeds = any();  // rad/s
    const Vector3d velocity = slope(finger, finger.motorAngles(angles), speeds);
    const MotorVector torques = finger.motorJacobian(angles).transpose() * force;
    return base::relativeTo(force.norm() * finger.motorJacobian(angles).norm() * speeds.norm(),
                            prefix + "power_W", force.dot(velocity), torques.dot(speeds), 1e-7);
  });
}

base::Quantity closedForm(FingerKinematics& finger, const Anthropometry& known,
                          const std::string& prefix) {
  return worstOf(finger, [&](const JointVector& angles) {
    const Vector3d exact = closedFormTip(known, angles);
    const Vector3d found = finger.fingertip(angles).translation();
    return base::Quantity{prefix + "closed_form_tip_distance_m", exact.norm(), found.norm(),
                          (found - exact).norm(), 1e-14};
  });
}

void coupling(const FingerKinematics& finger, const Anthropometry& known, const std::string& prefix,
              const Sink& sink) {
  const auto last = [&](double before) {
    return finger.jointAngles(kReduction * MotorVector(0.0, 0.0, before))[kJoints - 1];
  };
  // The URDF gives six digits of both.
  sink(base::relativeTo(1.0, prefix + "coupling_ratio", known.multiplier, last(1.0) - last(0.0),
                        1e-6));
  sink(base::relativeTo(1.0, prefix + "coupling_offset_rad", known.offset, last(0.0), 1e-6));
}

void transmission(const FingerKinematics& finger, const std::string& prefix, const Sink& sink) {
  const double exact = 2.0 * M_PI / 14.0;
  for (int i = 0; i < kMotors; ++i) {
    sink(base::relativeTo(exact,
                          prefix + "joint_" + std::to_string(i) + "_per_motor_revolution_rad",
                          exact, finger.jointAngles(2.0 * M_PI * MotorVector::Unit(i))[i], 1e-15));
  }
  sink(worstOf(finger, [&](const JointVector& angles) {
    const MotorVector motors = finger.motorAngles(angles);
    const MotorVector again = finger.motorAngles(finger.jointAngles(motors));
    return base::Quantity{prefix + "motor_round_trip_rad", motors.norm(), again.norm(),
                          (again - motors).norm(), 1e-14};
  }));
}

/// How far the tip gets from the first joint: as far as the finger is straight, which is at the
/// lower limit of the driven joint before the last.
base::Quantity reach(FingerKinematics& finger, const Anthropometry& known,
                     const std::string& prefix) {
  JointVector straightest = finger.jointAngles(finger.motorAngles(finger.lowerLimits()));
  double farthest = 0.0;
  forEachConfiguration(finger, [&](const JointVector& angles) {
    farthest = base::largerOrNaN(
        farthest, (finger.fingertip(angles).translation() - known.first_joint).norm());
  });
  const double exact = planarTip(known, straightest).norm();
  return base::relativeTo(exact, prefix + "reach_m", exact, farthest, 1e-13);
}

void validateKinematics(const std::string& urdf, Finger which, const Sink& sink) {
  const std::string prefix = "exoskeleton/" + std::string(name(which)) + "/";
  const Anthropometry known = anthropometry(which);
  FingerKinematics finger(urdf, which);
  sink(jacobian(finger, prefix));
  sink(powerBalance(finger, prefix));
  sink(closedForm(finger, known, prefix));
  coupling(finger, known, prefix, sink);
  transmission(finger, prefix, sink);
  sink(reach(finger, known, prefix));
}

void validatePinch(const std::string& urdf, const Sink& sink) {
  for (const Meeting meeting : {Meeting::kTips, Meeting::kPads}) {
    const std::string prefix =
        std::string("exoskeleton/pinch/") + (meeting == Meeting::kTips ? "tips" : "pads") + "_";
    const double nowhere = std::numeric_limits<double>::quiet_NaN();
    const auto found = findPinch(urdf, meeting);
    const double distance = found ? found->distance : nowhere;
    const double angle = found ? found->angle / kDegree : nowhere;
    sink({prefix + "apart_m", 0.0, distance, distance, 1e-9});
    sink({prefix + "angle_deg", 0.0, angle, angle, 40.0});
  }
}

/// Of each force the pose with the largest static error.
void validateForces(const std::string& urdf, const Sink& sink) {
  const std::vector<double> forces = {0.05, 0.2, 1.0, 5.0};  // N
  const std::vector<StaticForce> all = staticForces(urdf, kForcePoses, forces);
  for (const Finger finger : kFingers) {
    for (const double force : forces) {
      std::ostringstream name;
      name << "exoskeleton/" << base::name(finger) << "/static_force_" << force << "_N";
      base::Quantity worst{name.str(), force, force, -1.0, kForceResolution};
      for (const StaticForce& one : all) {
        if (one.finger != finger || std::abs(one.commanded.norm() - force) > 1e-9) continue;
        base::keepWorse(worst,
                        {name.str(), force, one.measured.norm(), one.error(), kForceResolution});
      }
      if (worst.error < 0.0) throw std::logic_error(name.str() + ": no pose");
      sink(worst);
    }
  }
}

/// Stalls while the sample is held as the demo holds it. Up to 15 ms nothing that opens the hand
/// may be felt; from 19 ms on the force has to go to zero, and has to come back without a jump.
void validateStalls(const std::string& urdf, const base::PerFinger<Vector3d>& open,
                    const Sink& sink) {
  std::vector<int> stalls = {15, 19};  // ms
  if (!base::kSanitized) stalls = {5, 11, 15, 19, 25};
  std::vector<base::Time> durations;
  for (const int stall : stalls) durations.push_back(std::chrono::milliseconds(stall));
  for (const StalledPart part : kStalledParts) {
    const std::vector<StalledHold> holds =
        holdThroughStalls(urdf, open, kHold, kHoldStiffness, part, durations);
    for (std::size_t i = 0; i < stalls.size(); ++i) {
      const StalledHold& hold = holds[i];
      const std::string prefix =
          "exoskeleton/stall/" + std::to_string(stalls[i]) + "ms/" + name(part) + "_";
      const bool bridged = stalls[i] <= 15;
      if (bridged) sink({prefix + "least_felt_share", 1.0, hold.least, 1.0 - hold.least, 0.2});
      sink({prefix + "below_80_percent_ms", 0.0, hold.below, hold.below, bridged ? 5.0 : 60.0});
      sink({prefix + "jump_N", 0.0, hold.jump, hold.jump, bridged ? 0.3 : 0.6});
      sink({prefix + "overshoot_N", 0.0, hold.overshoot, hold.overshoot, 0.3});
    }
  }
}

/// With 3 N. What is felt after the motors are off is the finger's own way back, in which it takes
/// links and rotors along: the same as if they had been off at once.
void validateDeaths(const std::string& urdf, const base::PerFinger<Vector3d>& open,
                    const Sink& sink) {
  const Death limit = dieInAHold(urdf, open, kDeathForce, DyingPart::kMotors);
  const auto death = [&](const std::string& which, DyingPart part, double allowed) {
    const Death found = dieInAHold(urdf, open, kDeathForce, part);
    const std::string prefix = "exoskeleton/death/" + which + "_";
    sink({prefix + "motors_on_ms", 0.0, found.motors_on, found.motors_on, allowed});
    if (allowed > kKnownDeath) return;
    sink({prefix + "force_left_after_20_ms_N", limit.force_left, found.force_left,
          std::max(0.0, found.force_left - limit.force_left), kForceLeft});
  };
  death("commander", DyingPart::kCommander, kKnownDeath);
  death("driver", DyingPart::kDriver, kKnownDeath);
  death("silent_commander", DyingPart::kSilentCommander, kSilentDeath);
  death("silent_driver", DyingPart::kSilentDriver, kSilentDeath);
}

/// N, the part of a force at a frequency (Hz): projected on sine and cosine over a second.
class FourierPart {
 public:
  explicit FourierPart(double frequency) : frequency_(frequency) {}

  void add(double time, double force) {
    const double phase = 2.0 * M_PI * frequency_ * time;
    sum_ += force * Eigen::Vector2d(std::cos(phase), std::sin(phase));
    ++samples_;
  }
  double amplitude() const { return 2.0 * sum_.norm() / samples_; }

 private:
  double frequency_;
  Eigen::Vector2d sum_ = Eigen::Vector2d::Zero();
  int samples_ = 0;
};

/// What the contactors shake the sensors by, by what they shake the force that is felt: 3 N, pushed
/// on the fingers. The sensor's resolution is allowed; without a notch.
void validateVibration(const std::string& urdf, const base::PerFinger<Vector3d>& open,
                       const Sink& sink) {
  ExoskeletonLoop loop(urdf, 1);
  for (const Finger finger : kFingers) loop.device().setTarget(finger, open[finger]);
  loop.makeReady();
  loop.commandForce(Vector3d(0.0, 0.0, kDeathForce));
  loop.run(std::chrono::seconds(2));
  for (const bool shaken : {false, true}) {
    loop.device().shakeSensors(shaken);
    loop.run(std::chrono::seconds(1));
    base::PerFinger<std::vector<FourierPart>> parts;
    for (const Finger finger : kFingers) parts[finger] = {FourierPart(40.0), FourierPart(320.0)};
    loop.run(std::chrono::seconds(1), [&](const ExoskeletonLoop& now) {
      for (const Finger finger : kFingers) {
        for (FourierPart& part : parts[finger]) {
          part.add(base::seconds(now.now()), now.sample(finger).contact_force.norm());
        }
      }
    });
    for (const int i : {0, 1}) {
      const double felt = base::largerOrNaN(parts[Finger::kIndex][i].amplitude(),
                                            parts[Finger::kThumb][i].amplitude());
      sink({std::string("exoskeleton/vibration/") + (shaken ? "shaken" : "still") + "_felt_at_" +
                (i == 0 ? "40" : "320") + "_Hz_N",
            0.0, felt, felt, kForceResolution});
    }
  }
}

/// Without contact, in a hand that turns: what is felt of the links is at most kFeltWeight, also by
/// feed-forward alone where a force sensor fails. Without anything against it, it is their weight,
/// which the emulator computes by itself and KDL for the oracle; friction carries some of it.
void validateWeight(const std::string& urdf, const base::PerFinger<Vector3d>& open,
                    const Sink& sink) {
  const auto held = feltWeight(urdf, open, {true, true});
  const auto by_feed_forward = feltWeight(urdf, open, {true, false});
  const auto by_feedback = feltWeight(urdf, open, {false, true});
  const auto by_nothing = feltWeight(urdf, open, {false, false});
  for (const Finger finger : kFingers) {
    const std::string prefix = "exoskeleton/weight/" + std::string(name(finger)) + "/";
    const auto felt = [&](const char* which, double force, double allowed) {
      sink({prefix + which, 0.0, force, force, allowed});
    };
    felt("still_felt_N", held[finger].still, kFeltWeight);
    felt("turning_felt_N", held[finger].turning, kFeltWeight);
    felt("still_by_feed_forward_felt_N", by_feed_forward[finger].still, kFeltWeight);
    felt("turning_by_feed_forward_felt_N", by_feed_forward[finger].turning, kFeltWeight);
    felt("still_by_feedback_felt_N", by_feedback[finger].still, kFeltWeight);
    felt("turning_by_feedback_felt_N", by_feedback[finger].turning, kFeltWeight);
    const FeltWeight& all = by_nothing[finger];
    const auto not_held = [&](const char* which, double force) {
      sink({prefix + which, all.weight, force, std::abs(force - all.weight), kFriction});
    };
    not_held("still_not_held_felt_N", all.still);
    not_held("turning_not_held_felt_N", all.turning);
  }
}

}  // namespace

void validateExoskeleton(const std::string& config_directory, const Sink& sink) {
  const std::string urdf = shippedUrdf(config_directory);
  for (const Finger finger : kFingers) validateKinematics(urdf, finger, sink);
  validatePinch(urdf, sink);
  validateForces(urdf, sink);
  const base::PerFinger<Vector3d> open =
      exoskeleton::loadHandPath(config_directory + "/paths/pinch.yaml").at(kOpenFor).fingertips;
  validateStalls(urdf, open, sink);
  validateDeaths(urdf, open, sink);
  validateVibration(urdf, open, sink);
  validateWeight(urdf, open, sink);
}

}  // namespace haptex::oracles
