// The exoskeleton in any pose: where its tips are, and which torques hold a force there.
#include <Eigen/LU>
#include <algorithm>

#include "haptex/exoskeleton/control/finger_kinematics.h"
#include "haptex/oracles/checks/random_checks.h"
#include "haptex/oracles/exact/finger_geometry.h"

namespace haptex::oracles {
namespace {

using Eigen::Vector3d;
using exoskeleton::FingerKinematics;
using exoskeleton::JointVector;
using exoskeleton::MotorVector;

}  // namespace

void randomPose(const std::string& config_directory, Random& random, const Sink& sink) {
  const std::string urdf = shippedUrdf(config_directory);
  for (const base::Finger which : base::kFingers) {
    FingerKinematics finger(urdf, which);
    const Anthropometry known = anthropometry(which);
    const MotorVector lowest = finger.motorAngles(finger.lowerLimits());
    const MotorVector highest = finger.motorAngles(finger.upperLimits());
    for (int i = 0; i < 4; ++i) {
      MotorVector motors;
      for (int k = 0; k < exoskeleton::kMotors; ++k) {
        const auto [low, high] = std::minmax(lowest[k], highest[k]);
        motors[k] = random.uniform(low, high);
      }
      const JointVector angles = finger.jointAngles(motors);
      CaseName text("exoskeleton", std::string("pose/") + name(which));
      text.with("motor_0", motors[0]).with("motor_1", motors[1]).with("motor_2", motors[2]);
      const Vector3d exact = closedFormTip(known, angles);
      const double apart = (finger.fingertip(angles).translation() - exact).norm();
      sink({text.text() + "/tip_m", exact.norm(), exact.norm() + apart, apart, 1e-14});
      // Virtual work: torques times a turn of the motors are the force times the tip's way, which
      // the closed form tells by differences, whose error is below 1e-9.
      const Vector3d force = random.uniform(0.05, 5.0) * random.direction();
      const MotorVector torques = finger.motorJacobian(angles).transpose() * force;
      constexpr double kStep = 1e-3;  // rad, of motors
      MotorVector held;
      for (int k = 0; k < exoskeleton::kMotors; ++k) {
        const MotorVector turn = kStep * MotorVector::Unit(k);
        const Vector3d way = closedFormTip(known, finger.jointAngles(motors + turn)) -
                             closedFormTip(known, finger.jointAngles(motors - turn));
        held[k] = force.dot(way) / (2.0 * kStep);
      }
      const double scale = force.norm() * finger.motorJacobian(angles).norm();
      sink({text.text() + "/torque_Nm", held.norm(), torques.norm(),
            (torques - held).norm() / scale, 1e-7});
    }
  }
}

}  // namespace haptex::oracles
