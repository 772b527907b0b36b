#include "haptex/oracles/experiments/lines/simulated_line.h"

#include <algorithm>
#include <chrono>

namespace haptex::oracles {
namespace {

constexpr int kSerialBits = 10;  // of a byte: start, eight data, stop

}  // namespace

void SimulatedLine::advance(base::Time now) {
  const base::Time byte_time =
      std::chrono::nanoseconds(std::chrono::nanoseconds::period::den * kSerialBits / baud_rate_);
  const serial::Bytes bytes = faults_.arrived(now);
  for (std::size_t i = 0; i < bytes.size; ++i) {
    free_at_ = std::max(free_at_, now) + byte_time;
    on_its_way_.emplace_back(free_at_, bytes.data[i]);
  }
}

const std::vector<std::uint8_t>& SimulatedLine::arrived(base::Time now) {
  arrived_.clear();
  while (!on_its_way_.empty() && on_its_way_.front().first <= now) {
    arrived_.push_back(on_its_way_.front().second);
    on_its_way_.pop_front();
  }
  return arrived_;
}

std::size_t SimulatedPort::read(std::uint8_t* buffer, std::size_t capacity) {
  const std::vector<std::uint8_t>& bytes = to_driver_.arrived(now_);
  const std::size_t kept = std::min(bytes.size(), kBuffer - std::min(kBuffer, buffer_.size()));
  buffer_.insert(buffer_.end(), bytes.begin(), bytes.begin() + kept);
  const std::size_t count = std::min(buffer_.size(), capacity);
  std::copy_n(buffer_.begin(), count, buffer);
  buffer_.erase(buffer_.begin(), buffer_.begin() + count);
  return count;
}

}  // namespace haptex::oracles
