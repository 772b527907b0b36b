// The serial line of an emulated device: a pseudo-terminal with faults in both directions.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "haptex/base/clock.h"
#include "haptex/serial/bytes.h"
#include "haptex/serial/emulator_fault.h"
#include "haptex/serial/fault_injector.h"
#include "haptex/serial/frame.h"
#include "haptex/serial/pseudo_terminal.h"

namespace haptex::serial {

using base::Time;

/// Counts since the construction, no units.
struct LineStatistics {
  std::uint64_t bytes_in = 0;    ///< read from the port, before faults
  std::uint64_t bytes_out = 0;   ///< written to the port, after faults
  std::uint64_t bytes_lost = 0;  ///< not taken by the port: nobody reads at the other end
  std::uint64_t ports = 0;       ///< opened
};

/// Not thread-safe. Allocates nothing while no port is opened, as far as FaultInjector does not.
class EmulatedLine {
 public:
  /// How long to wait before trying again to open a port that could not be opened.
  static constexpr Time kRetryPeriod = std::chrono::milliseconds(100);

  /// @param link symbolic link to the port, see PseudoTerminal
  /// @param layout of the frames
  /// @throws std::runtime_error as PseudoTerminal
  EmulatedLine(const std::string& link, const FrameLayout& layout);

  /// A fault of kind kLine or kClosedPort.
  void inject(const EmulatorFault& fault, Time now);

  /// What comes out of the line at the device's end. Opens the port if its time has come. Valid
  /// until the next call.
  Bytes receive(Time now);

  /// A frame goes from the device into the line; it may be empty.
  void send(Bytes frame, Time now);

  /// Writes to the port what has come out of the line at its end.
  void flush(Time now);

  bool open() const { return terminal_ != nullptr; }
  /// Whether a driver has the port open, as a device sees it by DTR.
  bool isConnected() const { return open() && terminal_->isConnected(); }
  /// Why the port could not be opened again, empty if nothing went wrong.
  const std::string& trouble() const { return trouble_; }
  const LineStatistics& statistics() const { return statistics_; }

 private:
  void sendSingly(Bytes bytes, Time now);
  void reopen(Time now);

  std::string link_;
  FrameLayout layout_;
  std::unique_ptr<PseudoTerminal> terminal_;  // none while the port is closed
  Time reopen_at_{0};
  std::string trouble_;
  FaultInjector to_device_;
  FaultInjector from_device_;
  std::vector<std::uint8_t> buffer_;
  LineStatistics statistics_;
};

}  // namespace haptex::serial
