#include "haptex/serial/fault_injector.h"

#include <algorithm>
#include <chrono>
#include <stdexcept>
#include <string>
#include <utility>

namespace haptex::serial {
namespace {

constexpr std::size_t kMaxDroppedBytes = 4, kMaxFlippedBits = 8, kMaxGarbage = 64;
constexpr Time kLongestDelay = std::chrono::milliseconds(20);

}  // namespace

const std::vector<LineFault>& lineFaults() {
  static const std::vector<LineFault> faults = {
      LineFault::kDrop,     LineFault::kDropBytes,    LineFault::kDuplicate, LineFault::kFlip,
      LineFault::kTruncate, LineFault::kDelay,        LineFault::kReorder,   LineFault::kGarbage,
      LineFault::kOversize, LineFault::kWrongVersion, LineFault::kStall};
  return faults;
}

const char* name(LineFault fault) {
  switch (fault) {
    case LineFault::kDrop:
      return "drop";
    case LineFault::kDropBytes:
      return "drop_bytes";
    case LineFault::kDuplicate:
      return "duplicate";
    case LineFault::kFlip:
      return "flip";
    case LineFault::kTruncate:
      return "truncate";
    case LineFault::kDelay:
      return "delay";
    case LineFault::kReorder:
      return "reorder";
    case LineFault::kGarbage:
      return "garbage";
    case LineFault::kOversize:
      return "oversize";
    case LineFault::kWrongVersion:
      return "wrong_version";
    case LineFault::kStall:
      return "stall";
  }
  return "unknown";
}

FaultInjector::FaultInjector(unsigned seed, const FrameLayout& layout)
    : generator_(seed), layout_(layout) {}

void FaultInjector::set(LineFault fault, double probability, Time end) {
  if (!(probability >= 0.0 && probability <= 1.0)) {
    throw std::invalid_argument("probability of " + std::string(name(fault)) + " = " +
                                std::to_string(probability) + ": allowed is 0 to 1");
  }
  if (fault == LineFault::kStall) {
    probability = std::bernoulli_distribution(probability)(generator_) ? 1.0 : 0.0;
  }
  settings_[static_cast<std::size_t>(fault)] = {probability, end};
}

bool FaultInjector::isOn(LineFault fault, Time now) const {
  const Setting& setting = settings_[static_cast<std::size_t>(fault)];
  return setting.probability > 0.0 && now < setting.end;
}

bool FaultInjector::meets(LineFault fault, Time now) {
  return isOn(fault, now) &&
         std::bernoulli_distribution(settings_[static_cast<std::size_t>(fault)].probability)(
             generator_);
}

std::size_t FaultInjector::draw(std::size_t least, std::size_t most) {
  return std::uniform_int_distribution<std::size_t>(least, most)(generator_);
}

std::uint8_t FaultInjector::drawByte() { return static_cast<std::uint8_t>(draw(0, 255)); }

void FaultInjector::damage(std::vector<std::uint8_t>& bytes, Time now) {
  if (meets(LineFault::kWrongVersion, now)) {
    FrameBuffer buffer;
    const Bytes other =
        inVersion({bytes.data(), bytes.size()}, layout_.version + 1, layout_, buffer);
    bytes.assign(other.data, other.data + other.size);
  }
  if (meets(LineFault::kFlip, now)) {
    std::vector<std::size_t> bits(8 * bytes.size());
    for (std::size_t i = 0; i < bits.size(); ++i) bits[i] = i;
    std::shuffle(bits.begin(), bits.end(), generator_);  // so that none is flipped back
    bits.resize(std::min(draw(1, kMaxFlippedBits), bits.size()));
    for (const std::size_t bit : bits) bytes[bit / 8] ^= static_cast<std::uint8_t>(1 << bit % 8);
  }
  if (meets(LineFault::kDropBytes, now)) {
    const std::size_t count = std::min(draw(1, kMaxDroppedBytes), bytes.size());
    for (std::size_t i = 0; i < count; ++i) bytes.erase(bytes.begin() + draw(0, bytes.size() - 1));
  }
  if (meets(LineFault::kTruncate, now) && !bytes.empty()) bytes.resize(draw(0, bytes.size() - 1));
}

std::vector<std::uint8_t> FaultInjector::noiseBefore(Time now) {
  std::vector<std::uint8_t> noise;
  if (meets(LineFault::kGarbage, now)) {
    noise.resize(draw(1, kMaxGarbage));
    for (std::uint8_t& byte : noise) byte = drawByte();
  }
  if (meets(LineFault::kOversize, now)) {
    FrameBuffer buffer;
    const std::size_t longest = kFrameOverhead + layout_.longestPayload();
    const auto length = static_cast<std::uint8_t>(draw(longest + 1, 255));
    const Bytes start = oversizeStart(length, drawByte(), buffer);
    noise.insert(noise.end(), start.data, start.data + start.size);
  }
  return noise;
}

void FaultInjector::enqueue(std::vector<std::uint8_t> bytes, Time now) {
  if (meets(LineFault::kDelay, now)) {
    const Time delay =
        std::chrono::milliseconds(draw(1, kLongestDelay / std::chrono::milliseconds(1)));
    last_arrival_ = std::max(last_arrival_, now + delay);
  }
  last_arrival_ = std::max(last_arrival_, now);
  line_.push_back({last_arrival_, std::move(bytes)});
}

void FaultInjector::send(Bytes frame, Time now) {
  // Nothing on a line is late for longer.
  if (isOn(LineFault::kStall, now) || now - held_since_ > kLongestDelay) held_back_.clear();
  if (frame.empty() || isOn(LineFault::kStall, now) || meets(LineFault::kDrop, now)) return;
  std::vector<std::uint8_t> bytes = noiseBefore(now);
  const int copies = meets(LineFault::kDuplicate, now) ? 2 : 1;
  for (int i = 0; i < copies; ++i) {
    std::vector<std::uint8_t> copy(frame.data, frame.data + frame.size);
    damage(copy, now);
    bytes.insert(bytes.end(), copy.begin(), copy.end());
  }
  if (held_back_.empty() && meets(LineFault::kReorder, now)) {
    held_back_ = std::move(bytes);
    held_since_ = now;
    return;
  }
  enqueue(std::move(bytes), now);
  if (!held_back_.empty()) enqueue(std::exchange(held_back_, {}), now);
}

Bytes FaultInjector::arrived(Time now) {
  arrived_.clear();
  if (isOn(LineFault::kStall, now)) return {};
  while (!line_.empty() && line_.front().arrival <= now) {
    const std::vector<std::uint8_t>& bytes = line_.front().bytes;
    arrived_.insert(arrived_.end(), bytes.begin(), bytes.end());
    line_.pop_front();
  }
  return {arrived_.data(), arrived_.size()};
}

}  // namespace haptex::serial
