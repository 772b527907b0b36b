#include "haptex/exoskeleton/emulator/emulator.h"

#include <algorithm>
#include <cstring>
#include <sstream>

namespace haptex::exoskeleton {
namespace {

using Kind = EmulatorFault::Kind;

constexpr unsigned kDeviceSeed = 3;
constexpr std::size_t kMaxFaults = 32;  // more than there are in both directions
constexpr int kSteps = static_cast<int>(EmulatedDevice::kRate * seconds(Emulator::kPeriod));

Identity identity() {
  Identity identity;
  identity.firmware = 1;
  identity.serial_number = 1;
  return identity;
}

/// The part of a fault that acts one way only.
EmulatorFault oneWay(EmulatorFault fault, bool to_device) {
  fault.to_device = to_device;
  fault.from_device = !to_device;
  return fault;
}

bool isSame(const EmulatorFault& first, const EmulatorFault& second) {
  if (first.kind != second.kind) return false;
  if (first.kind == Kind::kDevice) {
    return std::strcmp(first.device_fault, second.device_fault) == 0;
  }
  return first.kind != Kind::kLine ||
         (first.line_fault == second.line_fault && first.to_device == second.to_device);
}

std::string inWords(const EmulatorFault& fault, Time left) {
  std::ostringstream words;
  words << describe(fault);
  if (fault.kind == Kind::kLine) words << " with probability " << fault.probability;
  words.precision(3);
  words << " for " << seconds(left) << " s";
  return words.str();
}

}  // namespace

EmulatorFault parseFault(const std::string& fault, const std::string& direction, double probability,
                         double duration) {
  return EmulatorFault::parse(fault, direction, probability, duration,
                              {kSaturatedSensor, kShakenSensor});
}

Emulator::Emulator(const std::string& urdf, const std::string& link, Observer observer)
    : observer_(std::move(observer)),
      line_(link, kFrameLayout),
      device_(urdf, kDeviceSeed),
      firmware_(identity()) {
  active_faults_.reserve(kMaxFaults);
  shown_faults_.reserve(kMaxFaults);
  requested_faults_.reserve(kMaxFaults);
}

void Emulator::setTarget(Finger finger, const Eigen::Vector3d& target) {
  device_.setTarget(finger, target);
}

void Emulator::turnHand(const Eigen::Matrix3d& rotation) { device_.turnHand(rotation); }

void Emulator::advanceTo(Time now) {
  if (!started_) {
    started_ = true;
    due_ = now;
  }
  const Time lag = now - due_;
  {
    const std::unique_lock<std::mutex> lock(mutex_, std::try_to_lock);
    if (lock.owns_lock()) {
      status_.lag = lag;
      status_.largest_lag = std::max(status_.largest_lag, lag);
    }
  }
  if (lag > kMaxLag) {
    due_ = now - kMaxLag;
    skipped_ += lag - kMaxLag;
    ++skips_;
  }
  for (; due_ <= now; due_ += kPeriod) livePeriod(due_);
}

void Emulator::livePeriod(Time now) {
  takeRequests(now);
  const Bytes received = line_.receive(now);
  if (firmware_) {
    firmware_->receive(received.data, received.size, now);
    if (!line_.isConnected()) firmware_->hangUp(now);
    line_.send(firmware_->answer(), now);
  }
  stepMechanics(now);
  if (firmware_) report(now);
  line_.flush(now);
  showStatus(now);
  sample_.time = now;
  for (const Finger finger : kFingers) sample_.fingers[finger] = device_.truth(finger);
  observer_(sample_);
}

void Emulator::report(Time now) {
  const Bytes bytes = firmware_->report(stateSinceSwitchedOn(), now + kPeriod);
  line_.send(bytes, now);
  // What the firmware says of itself is to be read there only.
  const auto state = decodeState(serial::inspect(bytes, LineEnd::kDriver, kFrameLayout).frame);
  if (!state) return;
  if (state->watchdog_tripped && !last_report_.watchdog_tripped) ++watchdog_trips_;
  last_report_ = *state;
}

/// The firmware's watchdog goes on between two bytes, so it is asked at every step.
void Emulator::stepMechanics(Time now) {
  for (int step = 0; step < kSteps; ++step) {
    const DeviceCommand command =
        firmware_ ? firmware_->command(now + step * kPeriod / kSteps) : DeviceCommand{};
    device_.step(command);
  }
}

DeviceState Emulator::stateSinceSwitchedOn() {
  DeviceState state = device_.read();
  state.time -= first_time_;
  for (const Finger finger : kFingers) {
    auto& counts = state.fingers[finger].encoder_counts;
    for (std::size_t motor = 0; motor < counts.size(); ++motor) {
      counts[motor] -= first_counts_[finger][motor];
    }
  }
  return state;
}

void Emulator::takeRequests(Time now) {
  const std::unique_lock<std::mutex> lock(mutex_, std::try_to_lock);
  if (lock.owns_lock()) {
    for (const EmulatorFault& fault : requested_faults_) apply(fault, now);
    requested_faults_.clear();
    if (power_cycle_requested_) {
      power_cycle_requested_ = false;
      firmware_.reset();
      last_report_ = DeviceState{};
      switch_on_at_ = now + kOffTime;
    }
  }
  if (!firmware_ && now >= switch_on_at_) {
    firmware_.emplace(identity());
    const DeviceState state = device_.read();
    first_time_ = state.time;
    for (const Finger finger : kFingers) {
      first_counts_[finger] = state.fingers[finger].encoder_counts;
    }
  }
  if (sensor_saturated_ && now >= sensor_saturated_until_) saturateSensors(false);
  device_.shakeSensors(now < sensor_shaken_until_);
}

void Emulator::saturateSensors(bool saturated) {
  sensor_saturated_ = saturated;
  for (const Finger finger : kFingers) device_.saturateSensor(finger, saturated);
}

void Emulator::apply(const EmulatorFault& fault, Time now) {
  if (fault.kind != Kind::kDevice) {
    line_.inject(fault, now);
  } else if (std::strcmp(fault.device_fault, kShakenSensor) == 0) {
    sensor_shaken_until_ = fault.probability > 0.0 ? now + fault.duration : now;
  } else {
    sensor_saturated_until_ = now + fault.duration;
    saturateSensors(fault.probability > 0.0);
  }
  for (const bool to_device : {true, false}) {
    if (to_device ? fault.to_device : fault.from_device) note(oneWay(fault, to_device), now);
  }
}

/// Into the list of what is on.
void Emulator::note(const EmulatorFault& fault, Time now) {
  active_faults_.erase(std::remove_if(active_faults_.begin(), active_faults_.end(),
                                      [&](const ActiveFault& active) {
                                        return active.end <= now || isSame(active.fault, fault);
                                      }),
                       active_faults_.end());
  if (fault.probability > 0.0) active_faults_.push_back({fault, now + fault.duration});
}

void Emulator::showStatus(Time now) {
  const std::unique_lock<std::mutex> lock(mutex_, std::try_to_lock);
  if (!lock.owns_lock()) return;
  status_.skipped = skipped_;
  status_.skips = skips_;
  status_.watchdog_trips = watchdog_trips_;
  status_.mode = last_report_.mode;
  status_.powered = firmware_.has_value();
  status_.port_open = line_.open();
  status_.port_trouble = line_.trouble();
  status_.line = line_.statistics();
  shown_faults_ = active_faults_;
  shown_at_ = now;
}

void Emulator::inject(const EmulatorFault& fault) {
  const std::lock_guard<std::mutex> lock(mutex_);
  requested_faults_.push_back(fault);
}

void Emulator::cyclePower() {
  const std::lock_guard<std::mutex> lock(mutex_);
  power_cycle_requested_ = true;
}

EmulatorStatus Emulator::status() {
  const std::lock_guard<std::mutex> lock(mutex_);
  EmulatorStatus status = status_;
  for (const ActiveFault& active : shown_faults_) {
    if (active.end > shown_at_) {
      status.faults.push_back(inWords(active.fault, active.end - shown_at_));
    }
  }
  status_.largest_lag = Time{0};
  return status;
}

}  // namespace haptex::exoskeleton
