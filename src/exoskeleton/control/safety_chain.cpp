#include "haptex/exoskeleton/control/safety_chain.h"

#include <algorithm>

#include "haptex/exoskeleton/protocol/firmware_model.h"

namespace haptex::exoskeleton {
namespace {

// m/s. No finger is faster; keeps the products of the passivity observer finite.
constexpr double kFastest = 10.0;
// How far the return has come for a device that got no command for dt (s).
Time returned(double dt) {
  const double left = seconds(FirmwareModel::kMotorsOff) - dt;
  const double share = std::clamp(left / seconds(FirmwareModel::kRamp), 0.0, 1.0);
  return std::chrono::duration_cast<Time>(std::chrono::duration<double>(share * kReturn));
}

// A ramp at exactly kMaxSlew must end in exactly zero, not in what rounding leaves of it.
constexpr double kRounding = 1.0 + 1e-12;

}  // namespace

using Eigen::Vector3d;

Vector3d finiteOrZero(const Vector3d& vector, bool& finite) {
  finite = vector.allFinite();
  return finite ? vector : Vector3d::Zero();
}

Vector3d saturated(const Vector3d& force, double limit) {
  const double largest = force.cwiseAbs().maxCoeff();
  if (largest <= limit && force.norm() <= limit) return force;
  const Vector3d direction = force / largest;  // first, because the norm of 1e300 overflows
  return direction * (limit / direction.norm());
}

Vector3d slewLimited(const Vector3d& target, const Vector3d& previous, double dt) {
  const double most = kMaxSlew * std::clamp(dt, 0.0, kLongestSlew);
  const Vector3d change = target - previous;
  const double size = change.norm();
  if (size <= most * kRounding) return target;
  return previous + change * (most / size);
}

double softStartGain(double since_start) { return std::clamp(since_start / kSoftStart, 0.0, 1.0); }

double returnGain(double since_return) { return std::clamp(since_return / kReturn, 0.0, 1.0); }

Vector3d rampedDown(const Vector3d& previous, Time before, Time now, Time end) {
  if (now >= end) return Vector3d::Zero();
  return previous * (seconds(end - now) / seconds(end - std::min(before, now)));
}

void SafetyChain::start(Time now) {
  started_ = true;
  start_ = now;
  command_seen_ = false;
  commands_expired_ = interrupted_ = false;  // there is nothing to come back from
  return_ = now - std::chrono::duration_cast<Time>(std::chrono::duration<double>(kReturn));
  passivity_.reset();
}

void SafetyChain::commandAccepted(Time now) {
  if (commands_expired_) interrupt();
  command_seen_ = true;
  last_command_ = now;
}

void SafetyChain::commanderDied(Time now) {
  const Time ramp =
      std::chrono::duration_cast<Time>(std::chrono::duration<double>(force_.norm() / kMaxSlew));
  last_command_ = std::min(last_command_, now + ramp - kCommandTimeout - kWatchdogRamp);
}

void SafetyChain::latchFault() {
  if (fault_latched_) return;
  fault_latched_ = true;
  fault_end_ = last_tick_ + kWatchdogRamp;
}

Vector3d SafetyChain::watchdog(const Vector3d& force, Time now, double dt) {
  const bool stopped = !command_seen_ || now > last_command_ + kCommandTimeout;
  if (stopped && !commands_stopped_ && !force_.isZero(0.0)) ++statistics_.watchdog_trips;
  commands_stopped_ = stopped;
  commands_expired_ = !command_seen_ || now >= commandsEnd();
  if (commands_expired_) return Vector3d::Zero();
  if (!stopped) return force;
  // Whatever `force` does, nobody vouches for it any more: if it cannot be followed within what is
  // left, straight on from what is rendered.
  const double left = kMaxSlew * seconds(commandsEnd() - now);
  const Vector3d followed = slewLimited(saturated(force, left), force_, dt);
  return followed.norm() <= left * kRounding ? followed : saturated(force_, left);
}

Vector3d SafetyChain::latchedFault(const Vector3d& force, Time now) const {
  if (!fault_latched_) return force;
  const Vector3d ramped = rampedDown(force_, last_tick_, now, fault_end_);
  const bool watchdog_is_ahead = commands_stopped_ && force.norm() < ramped.norm();
  return watchdog_is_ahead ? force : ramped;
}

const Vector3d& SafetyChain::tick(const Vector3d& wanted, const Vector3d& velocity, Time now) {
  if (!ticked_ || now < last_tick_) {
    ticked_ = true;
    last_tick_ = now;
    return force_;
  }
  const double dt = seconds(now - last_tick_);
  bool force_finite, velocity_finite;
  Vector3d force = finiteOrZero(wanted, force_finite);
  const Vector3d measured = saturated(finiteOrZero(velocity, velocity_finite), kFastest);
  if (!force_finite || !velocity_finite) ++statistics_.not_finite;

  const Vector3d within = saturated(force, kMaxForce);
  if (within != force) ++statistics_.saturated;

  slewed_ = slewLimited(within, slewed_, dt);
  if (slewed_ != within) ++statistics_.slew_limited;

  passivity_.observe(force_, measured, std::min(dt, kLongestSlew));
  force = passivity_.apply(slewed_, measured, std::min(dt, kLongestSlew));
  if (passivity_.damping() > 0.0) ++statistics_.passivity_limited;
  statistics_.observed_energy = passivity_.energy();

  return_ = std::max(return_, now - returned(dt));
  if (interrupted_) return_ = now;
  interrupted_ = false;
  force *=
      started_ ? softStartGain(seconds(now - start_)) * returnGain(seconds(now - return_)) : 0.0;
  force = latchedFault(watchdog(force, now, dt), now);

  force = slewLimited(saturated(finiteOrZero(force, force_finite), kMaxForce), force_, dt);
  force_ = saturated(force, kMaxForce);
  // When the commands return, the slew limit starts from what is rendered then.
  if (stopping()) slewed_ = force_;
  last_tick_ = now;
  return force_;
}

}  // namespace haptex::exoskeleton
