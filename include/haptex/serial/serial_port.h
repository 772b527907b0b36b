// A serial line of the operating system, read and written without waiting.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "haptex/serial/bytes.h"
#include "haptex/serial/line_descriptor.h"

namespace haptex::serial {

/// Closed when destroyed. read() and write() do not allocate.
class SerialPort {
 public:
  /// Opens a device (/dev/ttyUSB0) or a pseudo-terminal: raw, 8 data bits, no parity, 1 stop bit,
  /// no flow control, exclusive. Bytes that came before are dropped.
  /// @throws std::runtime_error naming the port and what the system says, for example that there is
  ///   none of that name, that it is not a serial port or that another SerialPort has it open
  explicit SerialPort(const std::string& path);

  /// Reads what is there, at most `capacity` bytes. @returns how many, 0 if none or closed
  std::size_t read(std::uint8_t* buffer, std::size_t capacity);

  /// Writes all bytes or none. @returns false if the line does not take them now: what cannot be
  /// sent in time is of no use later. More than LineDescriptor::kLongestWrite are never taken.
  bool write(Bytes bytes);

  /// True once a read or write found the line gone (unplugged, other end closed). Stays so: a new
  /// SerialPort has to be made.
  bool closed() const { return closed_; }

  /// To wait for bytes with poll(2).
  int descriptor() const { return line_.get(); }

 private:
  LineDescriptor line_;
  bool closed_ = false;
};

}  // namespace haptex::serial
