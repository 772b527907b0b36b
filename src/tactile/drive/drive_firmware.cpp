#include "haptex/tactile/drive/drive_firmware.h"

#include <algorithm>

namespace haptex::tactile {

using base::Finger;
using base::kFingers;
using base::seconds;
using serial::Bytes;
using serial::Frame;

void DriveFirmware::receive(const std::uint8_t* bytes, std::size_t count, Time now) {
  link_.receive(bytes, count, now,
                [&](const Frame& frame, int /*ahead*/) { return obey(frame, now); });
}

bool DriveFirmware::obey(const Frame& frame, Time now) {
  const auto command = decodeDriveCommand(frame);
  if (!command) return false;
  from_ = drive(now);
  command_ = *command;
  last_command_ = now;
  ramp_start_ = now + kRampStart;
  ++obeyed_;
  moving_ = false;
  for (const Finger finger : kFingers) {
    for (int i = 0; i < kContactors; ++i) {
      for (const Channel channel : {k40, k320}) {
        moving_ =
            moving_ || from_[finger][i][channel] > 0.0 || command_.drive[finger][i][channel] > 0.0;
      }
    }
  }
  return true;
}

void DriveFirmware::hangUp(Time now) { ramp_start_ = std::min(ramp_start_, now); }

Bytes DriveFirmware::report(Time now) {
  return link_.report(DriveState{link_.lastCommand(), watchdogTripped(now)});
}

PerChannel<double> DriveFirmware::drive(Finger finger, int contactor, Time now) const {
  if (!last_command_) return {};
  // The way to the command stops where the watchdog starts.
  const Time until = std::min(now, ramp_start_);
  const double way = std::clamp(seconds(until - *last_command_) / seconds(kDrivePeriod), 0.0, 1.0);
  const double share = std::clamp(seconds(ramp_start_ + kRamp - now) / seconds(kRamp), 0.0, 1.0);
  PerChannel<double> drive;
  for (const Channel channel : {k40, k320}) {
    const double from = from_[finger][contactor][channel];
    drive[channel] = share * (from + way * (command_.drive[finger][contactor][channel] - from));
  }
  return drive;
}

base::PerFinger<ArrayDrive> DriveFirmware::drive(Time now) const {
  base::PerFinger<ArrayDrive> all;
  for (const Finger finger : kFingers) {
    for (int i = 0; i < kContactors; ++i) all[finger][i] = drive(finger, i, now);
  }
  return all;
}

}  // namespace haptex::tactile
