#include "haptex/exoskeleton/device_end.h"

#include <algorithm>

namespace haptex::exoskeleton {

DeviceEnd::DeviceEnd(const Identity& identity) : identity_(identity) {}

void DeviceEnd::receive(const std::uint8_t* bytes, std::size_t count, Time now) {
  if (count == 0) return;
  // Else the first bytes of a dead driver's last command would wait for something to complete them.
  if (now - last_bytes_ >= kMotorsOff) parser_.discard();
  last_bytes_ = now;
  Bytes rest{bytes, count};
  while (const Frame* frame = parser_.next(rest)) {
    if (frame->type == FrameType::kHello) takeHello(*frame);
    if (frame->type == FrameType::kCommand) takeCommand(*frame, now);
  }
}

void DeviceEnd::takeHello(const Frame& frame) {
  const auto hello = decodeHello(frame);
  if (!hello) return;
  to_answer_ = true;
  if (hello->version != identity_.version) return;
  greeted_ = true;
  command_number_ = frame.sequence;
}

void DeviceEnd::takeCommand(const Frame& frame, Time now) {
  if (!greeted_ || numbersAhead(frame.sequence, command_number_) == 0) return;
  // After a Hello the command of a dead driver may still come twice, with a number that looks new.
  if (last_command_ && frame.sequence == obeyed_number_) return;
  const auto command = decodeCommand(frame);
  if (!command) return;
  share_then_ = watchdogShare(now);
  last_command_ = now;
  command_ = *command;
  command_number_ = obeyed_number_ = frame.sequence;
}

Bytes DeviceEnd::answer() {
  if (!to_answer_) return {};
  to_answer_ = false;
  return encode(identity_, state_number_, outgoing_);
}

double DeviceEnd::watchdogShare(Time now) const {
  if (!last_command_) return 0.0;
  constexpr double kRamp = seconds(kMotorsOff - kRampStart);
  const double rising = share_then_ + seconds(now - *last_command_) / kRamp;
  const double falling = seconds(*last_command_ + kMotorsOff - now) / kRamp;
  return std::clamp(std::min(rising, falling), 0.0, 1.0);
}

DeviceCommand DeviceEnd::command(Time now) {
  const bool off = !last_command_ || now - *last_command_ >= kMotorsOff;
  if (off || command_.mode == DriveMode::kOff) return {};
  DeviceCommand command = command_;
  const double share = watchdogShare(now);
  for (const Finger finger : kFingers) command.torques[finger] *= share;
  return command;
}

Bytes DeviceEnd::report(DeviceState state, Time now) {
  if (!greeted_) return {};
  state.last_command = command_number_;
  state.mode = command(now).mode;
  state.watchdog_tripped =
      command_.mode != DriveMode::kOff && last_command_ && now - *last_command_ >= kMotorsOff;
  return encode(state, ++state_number_, outgoing_);
}

}  // namespace haptex::exoskeleton
