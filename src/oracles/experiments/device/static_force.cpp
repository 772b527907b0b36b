#include "haptex/oracles/experiments/device/static_force.h"

#include <chrono>
#include <random>
#include <stdexcept>

#include "haptex/oracles/experiments/exoskeleton_loop.h"

namespace haptex::oracles {

using namespace exoskeleton;
using Eigen::Vector3d;

namespace {

constexpr Time kSettle = std::chrono::seconds(2), kWindow = std::chrono::milliseconds(500);
constexpr Time kMove = std::chrono::seconds(1);  // from pose to pose
constexpr double kMargin = 0.05;                 // of the range of each motor, to the limits
constexpr double kSafelyConditioned = 2.0 * kSingular;

struct Pose {
  Vector3d target, direction;
};

/// Draws poses of one finger.
class Poses {
 public:
  Poses(const std::string& urdf, Finger finger, unsigned seed)
      : reach_(urdf, finger), kinematics_(urdf, finger), generator_(seed) {}

  /// @param force N, the largest one
  Pose draw(double force) {
    for (;;) {
      const MotorVector angles = randomAngles();
      const Pose pose = {kinematics_.fingertip(kinematics_.jointAngles(angles)).translation(),
                         direction()};
      const FingerMechanics person;
      const double yields =
          force * (1.0 / person.fingertip_stiffness + 1.0 / person.pulp_stiffness);
      if (allowed(angles) && allows(pose.target + yields * pose.direction, angles)) return pose;
    }
  }

 private:
  MotorVector randomAngles() {
    std::uniform_real_distribution<double> share(kMargin, 1.0 - kMargin);
    MotorVector angles;
    for (int i = 0; i < kMotors; ++i) {
      angles[i] =
          reach_.lowest()[i] + share(generator_) * (reach_.highest()[i] - reach_.lowest()[i]);
    }
    return angles;
  }

  Vector3d direction() {
    std::normal_distribution<double> component;
    const double x = component(generator_), y = component(generator_), z = component(generator_);
    return Vector3d(x, y, z).normalized();
  }

  bool allows(const Vector3d& place, const MotorVector& start) {
    const FingertipReach::Place found = reach_.nearest(place, start);
    return (found.position - place).norm() < 1e-5 && allowed(found.motor_angles);
  }

  bool allowed(const MotorVector& angles) {
    const MotorVector margin = kMargin * (reach_.highest() - reach_.lowest());
    const bool inside = ((angles - reach_.lowest()).array() >= 0.9 * margin.array()).all() &&
                        ((reach_.highest() - angles).array() >= 0.9 * margin.array()).all();
    const Configuration configuration = kinematics_.configuration(kinematics_.jointAngles(angles));
    return inside && configuration.smallest_singular_value > kSafelyConditioned;
  }

  FingertipReach reach_;
  FingerKinematics kinematics_;
  std::mt19937 generator_;
};

}  // namespace

std::vector<StaticForce> staticForces(const std::string& urdf, int poses,
                                      const std::vector<double>& forces, unsigned seed) {
  PerFinger<Poses> draws{{Poses(urdf, Finger::kIndex, seed), Poses(urdf, Finger::kThumb, seed)}};
  ExoskeletonLoop loop(urdf, 1);
  loop.makeReady();
  std::vector<StaticForce> all;
  for (int i = 0; i < poses; ++i) {
    PerFinger<Pose> pose;
    for (const Finger finger : kFingers) {
      pose[finger] = draws[finger].draw(kMaxForce);
      loop.device().setTarget(finger, pose[finger].target);
    }
    loop.commandForce(Vector3d::Zero());
    loop.run(kMove);
    for (const double force : forces) {
      loop.setCommander([&](Finger finger, Time) {
        ForceCommand command;
        command.force = force * pose[finger].direction;
        return command;
      });
      loop.run(kSettle);
      PerFinger<Vector3d> sum{{Vector3d::Zero(), Vector3d::Zero()}};
      int count = 0;
      loop.run(kWindow, [&](const ExoskeletonLoop& now) {
        ++count;
        for (const Finger finger : kFingers) sum[finger] += now.sample(finger).contact_force;
      });
      if (loop.controller().operatingState().mode != Mode::kEnabled) {
        throw std::runtime_error("static force: " + loop.controller().fault());
      }
      for (const Finger finger : kFingers) {
        all.push_back({finger, force * pose[finger].direction, sum[finger] / count});
      }
    }
  }
  return all;
}

}  // namespace haptex::oracles
