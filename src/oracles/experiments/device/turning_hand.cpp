#include "haptex/oracles/experiments/device/turning_hand.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <random>
#include <stdexcept>

#include "haptex/exoskeleton/control/finger_kinematics.h"
#include "haptex/oracles/experiments/exoskeleton_loop.h"

namespace haptex::oracles {

using namespace exoskeleton;
using Eigen::AngleAxisd;
using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

constexpr Time kTold = std::chrono::milliseconds(10);  // how often the driver is told
constexpr int kToldLate = 2;                           // of these
constexpr int kTurn = 100, kSettle = 30, kRest = 30;   // of these: 1 s, 0.3 s, 0.3 s
constexpr double kTurnAngle = M_PI / 2.0;              // rad

class TurningHand {
 public:
  TurningHand(const std::string& urdf, const PerFinger<Vector3d>& fingertips,
              const WeightHeld& held, unsigned seed)
      : held_(held),
        kinematics_{
            {FingerKinematics(urdf, Finger::kIndex), FingerKinematics(urdf, Finger::kThumb)}},
        loop_(urdf, 1),
        generator_(seed) {
    for (const Finger finger : kFingers) loop_.device().setTarget(finger, fingertips[finger]);
    loop_.makeReady();
    for (const Finger finger : kFingers) {
      loop_.device().saturateSensor(finger, !held.by_feedback);
    }
    for (int i = 0; i < kTurn; ++i) live(nullptr);
  }

  PerFinger<FeltWeight> run() {
    for (int i = 0; i < kTurns; ++i) {
      const Vector3d axis = direction();
      const Matrix3d start = rotation_;
      for (int step = 1; step <= kTurn; ++step) {
        rotation_ = AngleAxisd(step * kTurnAngle / kTurn, axis) * start;
        live(&FeltWeight::turning);
      }
      for (int step = 0; step < kSettle; ++step) live(nullptr);
      for (int step = 0; step < kRest; ++step) live(&FeltWeight::still);
      weigh();
    }
    if (loop_.controller().operatingState().mode != Mode::kEnabled) {
      throw std::runtime_error("turning hand: " + loop_.controller().fault());
    }
    return felt_;
  }

 private:
  Vector3d direction() {
    std::normal_distribution<double> component;
    const double x = component(generator_), y = component(generator_), z = component(generator_);
    return Vector3d(x, y, z).normalized();
  }

  // For kTold; what is felt counts for `part`, if for anything.
  void live(double FeltWeight::*part) {
    loop_.turnHand(rotation_);
    if (held_.by_feed_forward) loop_.tellOrientation(late_, loop_.now() - kToldLate * kTold);
    late_ = less_late_;
    less_late_ = rotation_;
    loop_.run(kTold, [&](const ExoskeletonLoop& now) {
      if (part == nullptr) return;
      for (const Finger finger : kFingers) {
        const double force = now.sample(finger).contact_force.norm();
        felt_[finger].*part = std::max(felt_[finger].*part, force);
      }
    });
  }

  void weigh() {
    for (const Finger finger : kFingers) {
      FingerKinematics& kinematics = kinematics_[finger];
      const JointVector joints = loop_.controller().measured(finger).joint_angles;
      const MotorVector torques = kinematics.motorWeight(joints) * gravityIn(rotation_);
      const Vector3d force =
          kinematics.motorJacobian(joints).transpose().fullPivLu().solve(torques);
      felt_[finger].weight = std::max(felt_[finger].weight, force.norm());
    }
  }

  const WeightHeld held_;
  PerFinger<FingerKinematics> kinematics_;
  ExoskeletonLoop loop_;
  std::mt19937 generator_;
  Matrix3d rotation_ = Matrix3d::Identity(), less_late_ = rotation_, late_ = rotation_;
  PerFinger<FeltWeight> felt_;
};

}  // namespace

PerFinger<FeltWeight> feltWeight(const std::string& urdf, const PerFinger<Vector3d>& fingertips,
                                 const WeightHeld& held, unsigned seed) {
  return TurningHand(urdf, fingertips, held, seed).run();
}

}  // namespace haptex::oracles
