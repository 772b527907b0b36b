#include "haptex/exoskeleton/protocol/firmware_model.h"

#include <algorithm>

namespace haptex::exoskeleton {
namespace {

// s. A lag behind the driver is made up for by this much: its clock may be faster, and commands
// that keep changing must not leave the torques behind for long.
constexpr double kShortPeriod = 0.95 * seconds(FirmwareModel::kCommandPeriod);

}  // namespace

FirmwareModel::FirmwareModel(const Identity& identity) : identity_(identity) {}

void FirmwareModel::receive(const std::uint8_t* bytes, std::size_t count, Time now) {
  link_.receive(bytes, count, now,
                [&](const Frame& frame, int ahead) { return obey(frame, ahead, now); });
}

bool FirmwareModel::obey(const Frame& frame, int ahead, Time now) {
  const auto command = decodeCommand(frame);
  if (!command) return false;
  approach(*command, ahead, now);
  last_command_ = now;
  ramp_start_ = now + kRampStart;
  command_ = *command;
  return true;
}

// The driver took a period for each change of at most its slew limit. A line that is on its way
// keeps its speed: a steady command is reached in time, and one that moves on no faster than it
// does itself.
void FirmwareModel::approach(const DeviceCommand& command, int ahead, Time now) {
  const PerFinger<MotorVector> present = torques(now);
  const Time rise = last_command_ ? kReturn : kRamp;
  const double fallen = (1.0 - watchdogShare(now)) * seconds(rise);
  double left = fallen;
  if (last_command_) left += std::max(0.0, seconds(reached_ - lineEnd(now)));
  double duration = fallen;  // at least: the first command of a driver may be any
  for (const Finger finger : kFingers) {
    const MotorVector& last = command_.torques[finger];
    const MotorVector& next = command.torques[finger];
    const double way = (next - present[finger]).norm();
    if (way == 0.0) continue;
    const double line_speed = left > 0.0 ? (last - present[finger]).norm() / left : 0.0;
    const double driver_speed = (next - last).norm() / (ahead * seconds(kCommandPeriod));
    duration = std::max(duration, way / std::max(line_speed, driver_speed));
  }
  duration = std::min(duration, left + ahead * kShortPeriod);
  from_ = present;
  reached_ = now + std::chrono::round<Time>(std::chrono::duration<double>(duration));
}

void FirmwareModel::hangUp(Time now) { ramp_start_ = std::min(ramp_start_, now); }

Bytes FirmwareModel::answer() { return link_.answer(identity_); }

double FirmwareModel::watchdogShare(Time now) const {
  if (!last_command_) return 0.0;
  return std::clamp(seconds(ramp_start_ + kRamp - now) / seconds(kRamp), 0.0, 1.0);
}

bool FirmwareModel::isOff(Time now) const { return !last_command_ || now >= ramp_start_ + kRamp; }

Time FirmwareModel::lineEnd(Time now) const { return std::min(now, ramp_start_); }

PerFinger<MotorVector> FirmwareModel::torques(Time now) const {
  double way = 1.0;
  if (last_command_) {
    const Time until = lineEnd(now);
    if (until < reached_) {
      way = seconds(until - *last_command_) / seconds(reached_ - *last_command_);
    }
  }
  PerFinger<MotorVector> torques;
  for (const Finger finger : kFingers) {
    const MotorVector& from = from_[finger];
    torques[finger] = watchdogShare(now) * (from + way * (command_.torques[finger] - from));
  }
  return torques;
}

DeviceCommand FirmwareModel::command(Time now) {
  if (isOff(now) || command_.mode == DriveMode::kOff) return {};
  DeviceCommand command;
  command.mode = command_.mode;
  command.torques = torques(now);
  return command;
}

Bytes FirmwareModel::report(DeviceState state, Time now) {
  state.last_command = link_.lastCommand();
  state.mode = command(now).mode;
  state.watchdog_tripped = command_.mode != DriveMode::kOff && last_command_ && isOff(now);
  return link_.report(state);
}

}  // namespace haptex::exoskeleton
