// Messages and bytes that the tests of the serial line share.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <random>
#include <vector>

#include "byte_fixtures.h"
#include "haptex/exoskeleton/finger.h"
#include "haptex/exoskeleton/protocol/serial_frame.h"
#include "haptex/serial/fault_injector.h"
#include "haptex/serial/frame_parser.h"

namespace haptex::exoskeleton {

using serial::append;
using serial::ByteVector;
using serial::checksum;
using serial::copy;
using serial::decodeHello;
using serial::FaultInjector;
using serial::FrameParser;
using serial::inspect;
using serial::kLineFaults;
using serial::LineFault;
using serial::lineFaults;
using serial::ParserStatistics;
using serial::view;

template <typename Message>
ByteVector frameOf(const Message& message, std::uint8_t sequence = 0) {
  FrameBuffer buffer;
  return copy(encode(message, sequence, buffer));
}

/// The frame that the bytes are, which have to outlive it.
inline Frame frameIn(const ByteVector& bytes, LineEnd end) {
  return inspect(view(bytes), end, kFrameLayout).frame;
}

/// Puts the checksum of its version behind bytes that were changed.
inline void seal(ByteVector& frame, std::uint8_t version = kProtocolVersion) {
  const std::uint16_t sum = checksum({frame.data() + 2, frame.size() - 4}, version);
  frame[frame.size() - 2] = static_cast<std::uint8_t>(sum);
  frame[frame.size() - 1] = static_cast<std::uint8_t>(sum >> 8);
}

/// A command of whole steps of torque, so that it survives the encoding.
inline DeviceCommand commandOf(DriveMode mode, int steps) {
  DeviceCommand command;
  command.mode = mode;
  for (const Finger finger : kFingers) {
    for (int motor = 0; motor < kMotors; ++motor) {
      command.torques[finger][motor] = kTorqueStep * (steps + motor);
    }
  }
  return command;
}

inline bool equal(const DeviceCommand& a, const DeviceCommand& b) {
  return a.mode == b.mode && a.torques[Finger::kIndex] == b.torques[Finger::kIndex] &&
         a.torques[Finger::kThumb] == b.torques[Finger::kThumb];
}

inline DeviceState stateAt(std::uint32_t time) {
  DeviceState state;
  state.time = time;
  state.fingers[Finger::kIndex].encoder_counts = {1, -2, 3};
  state.fingers[Finger::kThumb].encoder_counts = {-100000, 200000, -300000};
  state.fingers[Finger::kThumb].force = {0.5, -1.0, 2.0};
  return state;
}

inline DeviceState randomState(std::mt19937& generator) {
  DeviceState state;
  state.time = static_cast<std::uint32_t>(generator());
  state.last_command = static_cast<std::uint8_t>(generator());
  state.mode = static_cast<DriveMode>(generator() % 3);
  state.watchdog_tripped = generator() % 2 == 0;
  for (const Finger finger : kFingers) {
    FingerReading& reading = state.fingers[finger];
    for (std::int32_t& count : reading.encoder_counts) {
      count = static_cast<std::int32_t>(static_cast<std::uint32_t>(generator()));
    }
    for (int axis = 0; axis < 3; ++axis) {
      reading.force[axis] = kForceStep * (static_cast<int>(generator() % 65536) - 32768);
    }
    reading.force_saturated = generator() % 2 == 0;
  }
  return state;
}

inline DeviceCommand randomCommand(std::mt19937& generator) {
  DeviceCommand command;
  command.mode = static_cast<DriveMode>(generator() % 3);
  for (const Finger finger : kFingers) {
    for (int motor = 0; motor < kMotors; ++motor) {
      command.torques[finger][motor] =
          kTorqueStep * (static_cast<int>(generator() % 65536) - 32768);
    }
  }
  return command;
}

/// Bytes of all frames that a parser finds, handed to it `piece` bytes at a time.
inline std::vector<ByteVector> framesFoundBy(FrameParser& parser, const ByteVector& bytes,
                                             std::size_t piece = 1000000) {
  std::vector<ByteVector> found;
  for (std::size_t at = 0; at < bytes.size(); at += piece) {
    Bytes rest{bytes.data() + at, std::min(piece, bytes.size() - at)};
    while (const Frame* frame = parser.next(rest)) found.push_back(copy(frame->bytes));
  }
  return found;
}

constexpr Time milliseconds(long count) { return std::chrono::milliseconds(count); }
constexpr Time microseconds(long count) { return std::chrono::microseconds(count); }

}  // namespace haptex::exoskeleton
