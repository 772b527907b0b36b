// Finds the frames in a stream of bytes in which anything may happen.
#pragma once

#include <cstddef>
#include <cstdint>

#include "haptex/serial/frame.h"

namespace haptex::serial {

/// Counts since the construction, no units. A corrupt frame, an impossible length and an unknown
/// type are also what garbage looks like that contains the sync bytes.
struct ParserStatistics {
  std::uint64_t good_frames = 0;
  std::uint64_t corrupt_frames = 0;      ///< the checksum was wrong: damaged, or another version
  std::uint64_t impossible_lengths = 0;  ///< beyond the longest frame, or not that of the type
  std::uint64_t unknown_types = 0;       ///< no type, or none for this end of the line
  std::uint64_t garbage_bytes = 0;       ///< that belong to no good frame
};

/// After anything that is not a good frame the search goes on with the byte behind its first, so
/// no good frame is lost to a damaged one before it. Holds at most the protocol's longest
/// frame, never allocates.
class FrameParser {
 public:
  FrameParser(LineEnd end, const FrameLayout& layout) : end_(end), layout_(layout) {}

  /// Takes bytes from the front of `bytes` until a frame is complete. @returns the frame, valid
  /// until the next call, or nullptr once all bytes are taken:
  ///   while (const Frame* frame = parser.next(bytes)) ...
  const Frame* next(Bytes& bytes);

  /// Forgets an unfinished frame.
  void discard();

  /// Bytes of an unfinished frame.
  std::size_t pending() const { return size_ - finished_; }

  const ParserStatistics& statistics() const { return statistics_; }

 private:
  void drop(std::size_t count);
  void dropGarbage(FrameVerdict verdict);

  LineEnd end_;
  FrameLayout layout_;
  FrameBuffer buffer_{};
  std::size_t size_ = 0;
  std::size_t finished_ = 0;  // bytes at the front of the buffer that were handed out as a frame
  Frame frame_;
  ParserStatistics statistics_;
};

}  // namespace haptex::serial
