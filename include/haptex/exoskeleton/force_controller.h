// Makes one finger's motors give the desired force at the fingertip.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>

#include "haptex/exoskeleton/finger.h"
#include "haptex/exoskeleton/safety_chain.h"

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
  /// The desired force is on its way to zero because of the watchdog or a fault: it is followed
  /// without smoothing, which would make it outlive them.
  bool stopping = false;
  Eigen::Matrix3d jacobian = Eigen::Matrix3d::Zero();  ///< m/rad, of the motors
  MotorVector motor_velocities = MotorVector::Zero();  ///< rad/s
};

/// Explicit force control: torques = J^T (r + c) - D w, with
///   r, the feed-forward: the desired force through two low-pass filters of kSmoothing, because a
///     step would make device, pulp and finger ring at 30 to 70 Hz;
///   c, the correction: the integral of what is expected to be measured minus what is measured,
///     low-pass filtered, of norm at most kMaximumCorrection;
///   D, damping by the motors' velocities w.
///
/// Expected is r after kLatency and two filters of kResponse, the mean response of device and
/// finger, so that the integral does not wind up while a change is on its way. What is left of the
/// difference in transients is the finger's own dynamics: the integral slows down by the factor
/// 1 + |r - slow r| / kLargeChange while r changes.
///
/// Gains: the loop was designed for an effective mass of the device at the fingertip from 9 to
/// 350 g (its lightest and, short of singular poses, heaviest direction), a finger of 100 to
/// 1500 N/m and 3 ms of delay. The largest gain of the sensitivity 1/(1+L) over all of these is
/// 1.6 with kIntegral = 40 1/s and D / inertia = 50 1/s, a gain margin of 2.7 or more; without the
/// damping no more than 10 1/s would do. The integral takes what the feed-forward does not know:
/// friction, the weight of the links, errors of motors and kinematics.
///
/// To be called once per millisecond. Not thread-safe, does not allocate.
class ForceController {
 public:
  static constexpr double kPeriod = 0.001;       ///< s
  static constexpr double kSmoothing = 0.004;    ///< s
  static constexpr std::size_t kLatency = 3;     ///< periods, from torque to its measured effect
  static constexpr double kResponse = 0.004;     ///< s
  static constexpr double kIntegral = 40.0;      ///< 1/s
  static constexpr double kErrorFilter = 0.005;  ///< s
  static constexpr double kSlow = 0.03;          ///< s, twice, of the slow r
  static constexpr double kLargeChange = 0.1;    ///< N
  /// N m s/rad on each motor axis, D: 50 1/s of a motor's inertia with its share of the links, 2e-7
  /// to 3e-7 kg m^2.
  static constexpr double kDamping = 1.2e-5;
  /// N. The links weigh 0.25 N, friction is up to 0.1 N, and 10 % of an error of the motors' torque
  /// constant are 0.5 N at the largest force. The person feels no more than this if the feedback
  /// is wrong.
  static constexpr double kMaximumCorrection = 1.0;
  /// s, in which the correction fades when there is no feedback, and comes back.
  static constexpr double kFade = 0.02;
  /// s, in which release() takes the correction to zero.
  static constexpr double kRelease = 0.005;

  ForceController() { reset(); }

  /// Starts over from no force.
  void reset();

  /// One period. @returns N m, finite, each at most what a force of kMaximumForce +
  ///   kMaximumCorrection needs and what a DeviceCommand can say
  MotorVector tick(const ForceInput& input);

  /// Instead of tick(), before the motors are switched off: the feedback fades within kRelease,
  /// whatever is measured, while the desired force goes to zero.
  MotorVector release(const ForceInput& input);
  /// True once release() gives no torques any more.
  bool released() const { return released_; }

  const Eigen::Vector3d& correction() const { return correction_; }  ///< N
  /// Periods with feed-forward only, because the sensor did not work.
  std::uint64_t feedForwardOnly() const { return feed_forward_only_; }

 private:
  void feedForward(const ForceInput& input);
  void integrate(const Eigen::Vector3d& measured);
  MotorVector torques(const ForceInput& input, double damping);

  Eigen::Vector3d half_smooth_, smooth_;              // N, the feed-forward
  std::array<Eigen::Vector3d, kLatency> on_its_way_;  // N, ring of feed-forwards
  std::size_t oldest_ = 0;
  Eigen::Vector3d half_expected_, expected_;       // N
  Eigen::Vector3d half_slow_, slow_;               // N
  Eigen::Vector3d error_, integral_, correction_;  // N
  double share_ = 1.0;         // of the integral that is used: 0 without feedback
  double release_left_ = 1.0;  // of the correction and damping during release()
  bool torque_limited_ = false;
  bool released_ = true;
  std::uint64_t feed_forward_only_ = 0;
};

}  // namespace haptex::exoskeleton
