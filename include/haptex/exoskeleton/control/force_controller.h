// Makes one finger's motors give the desired force at the fingertip.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>

#include "haptex/exoskeleton/control/safety_chain.h"
#include "haptex/exoskeleton/finger.h"

namespace haptex::exoskeleton {

/// What the controller is told every period, in hand_base.
struct ForceInput {
  Eigen::Vector3d desired = Eigen::Vector3d::Zero();  ///< N, finite, from the safety chain
  Eigen::Vector3d measured =
      Eigen::Vector3d::Zero();  ///< N, by the device on the person, filtered by nobody
  /// A measurement came in this period. Without one the correction stays as it was.
  bool measured_now = false;
  /// The sensor is not at the end of its range and its value was finite.
  bool sensor_works = false;
  /// The device gets the torques. If not, there is nothing to learn from what it measures, and the
  /// correction fades: torques must not jump when the device obeys again.
  bool obeyed = true;
  Eigen::Matrix3d jacobian = Eigen::Matrix3d::Zero();  ///< m/rad, of the motors
  MotorVector motor_velocities = MotorVector::Zero();  ///< rad/s
  MotorVector weight = MotorVector::Zero();  ///< N m, finite, hold the links against gravity
};

/// Explicit force control: torques = J^T (r + c) + g - kDamping w with
///   r, the feed-forward: the desired force, in which SmoothCommand has left no steps;
///   c, the correction: kProportional e + kIntegral times the integral of e, of norm at most
///     kMaxCorrection, where e is what is expected to be measured minus what is measured, low-
///     pass filtered with kErrorFilter;
///   g, what holds the weight of the links, zero where the direction of gravity is not known;
///   w, the motors' velocities.
/// Friction, errors of motors, masses and kinematics are not modelled: the integral takes them.
///
/// Expected is r after kLatency and two filters of kResponse, the response of device and pulp to a
/// stiff finger, so that the integral does not wind up while a change is on its way. What softer
/// fingers lag behind that is left to their own dynamics: the integral slows down by the factor
/// 1 + |r - slow r| / kLargeChange while r changes.
///
/// The constants, and SmoothCommand::kSmoothing, were found by a search on the emulated fingers for
/// the largest bandwidth that keeps the overshoot of a 3 N step below 15 % in all poses and
/// directions, for fingers of 100 to 1500 N/m and a line of 3 ms. Measured there, away from
/// singular poses: a static error of at most 0.004 N and an overshoot of at most 7 %; -3 dB at 7 to
/// 45 Hz (median 14 to 30) for 1500 N/m, 6 to 10 Hz (median 8) for 400 N/m and 3 to 4 Hz for
/// 100 N/m: the device has to follow the give of the finger, against its own friction. The loop is
/// stable with three times the gains, and with 10 ms instead of 3.
///
/// r + c changes at most by kMaxSlew, whatever the sensor says; g comes and goes within kFade, as
/// the commands do, and is within the limits of the sum.
///
/// To be called once per millisecond. Not thread-safe, does not allocate.
class ForceController {
 public:
  static constexpr double kPeriod = 0.001;       ///< s
  static constexpr std::size_t kLatency = 3;     ///< periods, from torque to its measured effect
  static constexpr double kResponse = 0.003;     ///< s
  static constexpr double kProportional = 0.2;   ///< N/N
  static constexpr double kIntegral = 60.0;      ///< 1/s
  static constexpr double kErrorFilter = 0.006;  ///< s
  static constexpr double kSlow = 0.03;          ///< s, twice, of the slow r
  static constexpr double kLargeChange = 0.3;    ///< N
  /// N m s/rad on each motor axis: damps what the finger does not, the swinging of a curled finger
  /// to its side, where the device weighs 0.1 kg. 30 1/s of the inertia there, for velocities 8 ms
  /// old.
  static constexpr double kDamping = 4e-6;
  /// N. The links weigh 0.25 N, friction is up to 0.1 N, and 10 % of an error of the motors' torque
  /// constant are 0.5 N at the largest force. The person feels no more than this if the feedback
  /// is wrong.
  static constexpr double kMaxCorrection = 1.0;
  /// s, in which the correction fades when there is no feedback, and comes back.
  static constexpr double kFade = 0.02;
  /// s, in which release() takes the correction to zero, if the slew limit allows.
  static constexpr double kRelease = 0.005;

  ForceController() { reset(); }

  /// Starts over from no force.
  void reset();

  /// One period. @returns N m, finite, each at most what a force of kMaxForce +
  ///   kMaxCorrection needs and what a DeviceCommand can say
  MotorVector tick(const ForceInput& input);

  /// Instead of tick(), when commands have stopped or the motors are to be switched off: the
  /// feedback fades within kRelease, whatever is measured, while the desired force goes to zero.
  MotorVector release(const ForceInput& input);
  /// True once release() gives no torques any more.
  bool released() const { return released_; }

  const Eigen::Vector3d& correction() const { return correction_; }  ///< N
  /// Periods with feed-forward only, because the sensor did not work.
  std::uint64_t feedForwardOnly() const { return feed_forward_only_; }

 private:
  void expect(const ForceInput& input);
  void integrate(const Eigen::Vector3d& desired, const Eigen::Vector3d& measured);
  MotorVector torques(const ForceInput& input);

  std::array<Eigen::Vector3d, kLatency> on_its_way_;  // N, ring of feed-forwards
  std::size_t oldest_ = 0;
  Eigen::Vector3d half_expected_, expected_;       // N
  Eigen::Vector3d half_slow_, slow_;               // N
  Eigen::Vector3d error_, integral_, correction_;  // N
  Eigen::Vector3d force_;                          // N, what the torques stand for
  double share_ = 1.0;         // of the integral that is used: 0 without feedback
  double weight_share_ = 0.0;  // of the weight that is held
  double release_left_ = 1.0;  // of the correction and the weight during release()
  bool torque_limited_ = false;
  bool released_ = true;
  std::uint64_t feed_forward_only_ = 0;
};

}  // namespace haptex::exoskeleton
