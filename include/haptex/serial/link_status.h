// What a driver knows of its line to a device.
#pragma once

#include <cstdint>

#include "haptex/serial/frame_parser.h"

namespace haptex::serial {

enum class LinkStatus {
  kConnecting,       ///< Hello is repeated, no Identity yet
  kConnected,        ///< states arrive
  kTimedOut,         ///< was connected, and no state came for the timeout; Hello is repeated
  kVersionMismatch,  ///< the device answers in another protocol version; Hello is repeated
};

/// In plain words, for diagnostics.
const char* describe(LinkStatus status);

/// Counts since the construction, no units.
struct LinkStatistics {
  ParserStatistics received;             ///< good, corrupt and unknown frames, bytes of garbage
  std::uint64_t meaningless_frames = 0;  ///< the checksum was right, but a field means nothing
  std::uint64_t lost_states = 0;         ///< gaps in the sequence numbers of states
  std::uint64_t repeated_states = 0;     ///< same or older sequence number: duplicated or reordered
  std::uint64_t timeouts = 0;            ///< transitions to kTimedOut
  std::uint64_t version_mismatches = 0;  ///< answers in another version
  std::uint64_t handshakes = 0;          ///< transitions to kConnected
};

}  // namespace haptex::serial
