// Keeps a serial port open: what may take long happens on a thread of its own.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "haptex/base/clock.h"
#include "haptex/realtime/semaphore.h"
#include "haptex/serial/port_access.h"
#include "haptex/serial/serial_port.h"

namespace haptex::serial {

using base::Time;

/// Opens the port, and again every kRetryPeriod after it was found closed or absent. Opening and
/// closing a port may take long, so its user, the loop, does neither.
class PortKeeper final : public PortAccess {
 public:
  static constexpr Time kRetryPeriod = std::chrono::milliseconds(500);

  /// Starts trying at once.
  explicit PortKeeper(const std::string& path);
  ~PortKeeper() override;
  PortKeeper(const PortKeeper&) = delete;
  PortKeeper& operator=(const PortKeeper&) = delete;

  bool takeNew() override;
  bool isThere() const override { return port_ != nullptr; }
  bool isClosed() const override { return port_ && port_->closed(); }
  void discard() override;
  std::size_t read(std::uint8_t* buffer, std::size_t capacity) override {
    return port_->read(buffer, capacity);
  }
  bool write(Bytes bytes) override { return port_->write(bytes); }
  bool awaitBytes(Time until) override;
  std::string trouble() const override;
  const std::string& path() const override { return path_; }

 private:
  void run();
  void open();
  void setTrouble(const std::string& trouble);

  const std::string path_;
  std::unique_ptr<SerialPort> port_;  // the loop's

  // Between the loop and the thread, each owned by whoever takes it out.
  std::atomic<SerialPort*> opened_{nullptr};
  std::atomic<SerialPort*> discarded_{nullptr};
  std::atomic<bool> wanted_{true};

  mutable std::mutex trouble_mutex_;  // guards the next; never taken by the loop
  std::string trouble_;

  realtime::Semaphore stopped_;
  std::thread thread_;
};

}  // namespace haptex::serial
