// A serial line that misbehaves on demand.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <random>
#include <vector>

#include "haptex/base/clock.h"
#include "haptex/serial/bytes.h"
#include "haptex/serial/frame.h"

namespace haptex::serial {

using base::Time;

/// What can happen to the frames of one direction.
enum class LineFault {
  kDrop,          ///< the frame is lost
  kDropBytes,     ///< 1 to 4 bytes of it are lost
  kDuplicate,     ///< it arrives twice
  kFlip,          ///< 1 to 8 bits of it are flipped
  kTruncate,      ///< its end is lost
  kDelay,         ///< it arrives 1 to 20 ms late, and so do those behind it
  kReorder,       ///< it changes places with the next, and is lost if none follows in 20 ms
  kGarbage,       ///< 1 to 64 random bytes before it
  kOversize,      ///< before it the start of a frame whose length is beyond the longest one
  kWrongVersion,  ///< a well-formed frame of another protocol version takes its place
  kStall,         ///< nothing arrives while the fault lasts, and what was sent meanwhile is lost
};
constexpr std::size_t kLineFaults = 11;

/// All of them, and their names as a service call says them: "drop", "drop_bytes", "duplicate",
/// "flip", "truncate", "delay", "reorder", "garbage", "oversize", "wrong_version", "stall".
const std::vector<LineFault>& lineFaults();
const char* name(LineFault fault);

/// Reproducible: what happens comes from a seeded generator. Several faults may be on at once.
class FaultInjector {
 public:
  /// @param layout of the frames, for faults that make others of them
  FaultInjector(unsigned seed, const FrameLayout& layout);

  /// Until `end` each frame meets the fault with this probability (0 switches it off). A stall is
  /// there for all frames or for none: with this probability, decided now.
  /// @throws std::invalid_argument naming the probability if it is not in [0, 1]
  void set(LineFault fault, double probability, Time end);

  /// A frame goes into the line. The copies of a duplicated one are damaged independently.
  void send(Bytes frame, Time now);

  /// What has come out of the line by now. Valid until the next call.
  Bytes arrived(Time now);

 private:
  struct Setting {
    double probability = 0.0;
    Time end{};
  };
  struct InTransit {
    Time arrival{};
    std::vector<std::uint8_t> bytes;
  };

  bool isOn(LineFault fault, Time now) const;
  bool meets(LineFault fault, Time now);
  std::size_t draw(std::size_t least, std::size_t most);
  std::uint8_t drawByte();
  void damage(std::vector<std::uint8_t>& bytes, Time now);
  std::vector<std::uint8_t> noiseBefore(Time now);
  void enqueue(std::vector<std::uint8_t> bytes, Time now);

  std::mt19937 generator_;
  FrameLayout layout_;
  std::array<Setting, kLineFaults> settings_{};
  std::deque<InTransit> line_;
  std::vector<std::uint8_t> held_back_;  // by kReorder, until the next
  Time held_since_{};
  Time last_arrival_{};
  std::vector<std::uint8_t> arrived_;
};

}  // namespace haptex::serial
