#include "haptex/serial/frame_parser.h"

#include <algorithm>

namespace haptex::serial {

const Frame* FrameParser::next(Bytes& bytes) {
  drop(finished_);
  finished_ = 0;
  while (true) {
    const Inspection found = inspect({buffer_.data(), size_}, end_, layout_);
    if (found.verdict == FrameVerdict::kGood) {
      ++statistics_.good_frames;
      finished_ = found.size;
      frame_ = found.frame;
      return &frame_;
    }
    if (found.verdict != FrameVerdict::kUnfinished) {
      dropGarbage(found.verdict);
      continue;
    }
    if (bytes.empty()) return nullptr;
    // No more than the frame may need, so that what follows it stays where it is.
    const std::size_t count = std::min(found.size - size_, bytes.size);
    std::copy_n(bytes.data, count, buffer_.data() + size_);
    size_ += count;
    bytes = {bytes.data + count, bytes.size - count};
  }
}

void FrameParser::discard() {
  drop(finished_);
  finished_ = 0;
  statistics_.garbage_bytes += size_;
  size_ = 0;
}

void FrameParser::drop(std::size_t count) {
  std::copy(buffer_.data() + count, buffer_.data() + size_, buffer_.data());
  size_ -= count;
}

void FrameParser::dropGarbage(FrameVerdict verdict) {
  if (verdict == FrameVerdict::kCorrupt) ++statistics_.corrupt_frames;
  if (verdict == FrameVerdict::kImpossibleLength) ++statistics_.impossible_lengths;
  if (verdict == FrameVerdict::kUnknownType) ++statistics_.unknown_types;
  ++statistics_.garbage_bytes;
  drop(1);
}

}  // namespace haptex::serial
