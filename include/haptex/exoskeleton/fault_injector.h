// A serial line that misbehaves on demand.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "haptex/exoskeleton/bytes.h"
#include "haptex/exoskeleton/clock.h"

namespace haptex::exoskeleton {

/// What can happen to the frames of one direction.
enum class LineFault {
  kDrop,          ///< the frame is lost
  kDropBytes,     ///< some bytes of it are lost
  kDuplicate,     ///< it arrives twice
  kFlip,          ///< some bits of it are flipped
  kTruncate,      ///< its end is lost
  kDelay,         ///< it arrives 1 to 20 ms late, and so do those behind it
  kReorder,       ///< it changes places with the next
  kGarbage,       ///< random bytes before it
  kOversize,      ///< before it the start of a frame whose length is beyond the longest one
  kWrongVersion,  ///< a well-formed frame of another protocol version takes its place
  kStall,         ///< nothing arrives while the fault lasts, and what was sent meanwhile is lost
};

/// All of them, and their names as a service call says them: "drop", "drop_bytes", "duplicate",
/// "flip", "truncate", "delay", "reorder", "garbage", "oversize", "wrong_version", "stall".
const std::vector<LineFault>& lineFaults();
const char* name(LineFault fault);

/// Reproducible: what happens comes from a seeded generator. Several faults may be on at once.
class FaultInjector {
 public:
  explicit FaultInjector(unsigned seed);

  /// Until `end` each frame meets the fault with this probability (0 switches it off).
  /// @throws std::invalid_argument naming the probability if it is not in [0, 1]
  void set(LineFault fault, double probability, Time end);

  /// A frame goes into the line.
  void send(Bytes frame, Time now);

  /// What has come out of the line by now. Valid until the next call.
  Bytes arrived(Time now);
};

}  // namespace haptex::exoskeleton
