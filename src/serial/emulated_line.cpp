#include "haptex/serial/emulated_line.h"

#include <exception>

#include "haptex/serial/frame.h"

namespace haptex::serial {
namespace {

constexpr std::size_t kBufferSize = 4096;  // bytes, many periods' worth
constexpr unsigned kToDeviceSeed = 1;
constexpr unsigned kFromDeviceSeed = 2;

}  // namespace

EmulatedLine::EmulatedLine(const std::string& link, const FrameLayout& layout)
    : link_(link),
      layout_(layout),
      terminal_(std::make_unique<PseudoTerminal>(link)),
      to_device_(kToDeviceSeed, layout),
      from_device_(kFromDeviceSeed, layout),
      buffer_(kBufferSize) {
  statistics_.ports = 1;
}

void EmulatedLine::inject(const EmulatorFault& fault, Time now) {
  const Time end = now + fault.duration;
  if (fault.kind == EmulatorFault::Kind::kClosedPort) {
    if (fault.probability > 0.0) {
      terminal_.reset();
      reopen_at_ = end;
    } else if (!open()) {
      reopen_at_ = now;
    }
    return;
  }
  if (fault.to_device) to_device_.set(fault.line_fault, fault.probability, end);
  if (fault.from_device) from_device_.set(fault.line_fault, fault.probability, end);
}

Bytes EmulatedLine::receive(Time now) {
  if (!open() && now >= reopen_at_) reopen(now);
  if (open()) {
    const std::size_t count = terminal_->read(buffer_.data(), buffer_.size());
    statistics_.bytes_in += count;
    sendSingly({buffer_.data(), count}, now);
  }
  return to_device_.arrived(now);
}

/// Frame by frame, as faults meet them; what is between two frames goes as one piece.
void EmulatedLine::sendSingly(Bytes bytes, Time now) {
  const auto take = [&](std::size_t count) {
    if (count > 0) to_device_.send({bytes.data, count}, now);
    bytes = {bytes.data + count, bytes.size - count};
  };
  std::size_t between = 0;
  while (between < bytes.size) {
    const Inspection found =
        inspect({bytes.data + between, bytes.size - between}, LineEnd::kDevice, layout_);
    if (found.verdict != FrameVerdict::kGood) {
      ++between;
      continue;
    }
    take(between);
    take(found.size);
    between = 0;
  }
  take(between);
}

void EmulatedLine::send(Bytes frame, Time now) {
  if (!frame.empty()) from_device_.send(frame, now);
}

void EmulatedLine::flush(Time now) {
  const Bytes bytes = from_device_.arrived(now);
  if (bytes.empty()) return;
  const bool taken = open() && terminal_->write(bytes);
  (taken ? statistics_.bytes_out : statistics_.bytes_lost) += bytes.size;
}

void EmulatedLine::reopen(Time now) {
  try {
    terminal_ = std::make_unique<PseudoTerminal>(link_);
    ++statistics_.ports;
    trouble_.clear();
  } catch (const std::exception& error) {
    trouble_ = error.what();
    reopen_at_ = now + kRetryPeriod;
  }
}

}  // namespace haptex::serial
