// A serial line in simulated time, and the port at the driver's end of it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>
#include <utility>
#include <vector>

#include "haptex/base/clock.h"
#include "haptex/serial/fault_injector.h"
#include "haptex/serial/port_access.h"

namespace haptex::oracles {

/// One direction of a serial line: what a FaultInjector lets through arrives byte by byte, 10 bits
/// each.
class SimulatedLine {
 public:
  /// @param layout of the frames @param baud_rate bits per second
  SimulatedLine(unsigned seed, const serial::FrameLayout& layout, int baud_rate)
      : faults_(seed, layout), baud_rate_(baud_rate) {}

  void send(serial::Bytes frame, base::Time now) { faults_.send(frame, now); }
  /// To be called in every step: what the injector lets through starts on its way.
  void advance(base::Time now);
  /// What has arrived since the last call.
  const std::vector<std::uint8_t>& arrived(base::Time now);
  /// Loses what is on its way.
  void clear() { on_its_way_.clear(); }

  serial::FaultInjector& faults() { return faults_; }

 private:
  serial::FaultInjector faults_;
  int baud_rate_;
  base::Time free_at_{0};
  std::deque<std::pair<base::Time, std::uint8_t>> on_its_way_;
  std::vector<std::uint8_t> arrived_;
};

/// The driver's end of two of them.
class SimulatedPort final : public serial::PortAccess {
 public:
  SimulatedPort(SimulatedLine& to_device, SimulatedLine& to_driver, const base::Time& now,
                const bool& open)
      : to_device_(to_device), to_driver_(to_driver), now_(now), open_(open) {}

  bool takeNew() override {
    if (is_there_ || !open_) return false;
    return is_there_ = true;
  }
  bool isThere() const override { return is_there_; }
  bool isClosed() const override { return !open_; }
  void discard() override {
    is_there_ = false;
    buffer_.clear();
  }
  std::size_t read(std::uint8_t* buffer, std::size_t capacity) override;
  bool write(serial::Bytes bytes) override {
    if (open_) to_device_.send(bytes, now_);
    return open_;
  }
  bool awaitBytes(base::Time) override { return false; }
  std::string trouble() const override { return is_there_ ? "" : "the simulated port is closed"; }
  const std::string& path() const override { return path_; }

 private:
  static constexpr std::size_t kBuffer = 65536;  // bytes that Linux keeps; what comes then is lost

  SimulatedLine& to_device_;
  SimulatedLine& to_driver_;
  const base::Time& now_;
  const bool& open_;
  const std::string path_ = "simulated";
  std::vector<std::uint8_t> buffer_;
  bool is_there_ = false;
};

}  // namespace haptex::oracles
