#include "haptex/tactile/drive/drive_firmware.h"

#include <algorithm>

namespace haptex::tactile {

using base::Finger;
using base::kFingers;
using base::seconds;
using serial::Bytes;
using serial::Frame;
using serial::FrameType;

void DriveFirmware::receive(const std::uint8_t* bytes, std::size_t count, Time now) {
  if (count == 0) return;
  if (now - last_bytes_ >= kInterrupted) parser_.discard();
  last_bytes_ = now;
  Bytes rest{bytes, count};
  while (const Frame* frame = parser_.next(rest)) {
    if (frame->type == FrameType::kHello) handleHello(*frame);
    if (frame->type == FrameType::kCommand) handleCommand(*frame, now);
  }
}

void DriveFirmware::handleHello(const Frame& frame) {
  const auto hello = serial::decodeHello(frame);
  if (!hello) return;
  to_answer_ = true;
  if (hello->version != identity_.version) return;
  greeted_ = true;
  command_number_ = frame.sequence;
}

void DriveFirmware::handleCommand(const Frame& frame, Time now) {
  if (!greeted_ || serial::numbersAhead(frame.sequence, command_number_) == 0) return;
  // After a Hello the command of a dead driver may still come twice, with a number that looks new.
  if (last_command_ && frame.sequence == obeyed_number_) return;
  const auto command = decodeDriveCommand(frame);
  if (!command) return;
  from_ = drive(now);
  command_ = *command;
  last_command_ = now;
  ramp_start_ = now + kRampStart;
  command_number_ = obeyed_number_ = frame.sequence;
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
}

void DriveFirmware::hangUp(Time now) { ramp_start_ = std::min(ramp_start_, now); }

Bytes DriveFirmware::answer() {
  if (!to_answer_) return {};
  to_answer_ = false;
  return encode(identity_, state_number_, outgoing_);
}

Bytes DriveFirmware::report(Time now) {
  if (!greeted_) return {};
  return encode(DriveState{command_number_, watchdogTripped(now)}, ++state_number_, outgoing_);
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
