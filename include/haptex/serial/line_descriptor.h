// What a serial port and a pseudo-terminal have in common: an open file of the operating system
// that is read and written without waiting.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include "haptex/serial/bytes.h"

namespace haptex::serial {

/// Of a serial line to a device, see docs/serial_protocol.md. A pseudo-terminal ignores it.
constexpr int kBaudRate = 921600;

/// Closes the file when destroyed. read() and write() do not allocate.
class LineDescriptor {
 public:
  /// More bytes than this are not written at once.
  static constexpr std::size_t kLongestWrite = 4096;

  /// Owns the descriptor. Negative: nothing is open.
  explicit LineDescriptor(int descriptor) : descriptor_(descriptor) {}
  ~LineDescriptor();
  LineDescriptor(const LineDescriptor&) = delete;
  LineDescriptor& operator=(const LineDescriptor&) = delete;

  int get() const { return descriptor_; }

  struct Result {
    std::size_t count = 0;
    bool gone = false;  ///< nobody is at the other end
  };
  Result read(std::uint8_t* buffer, std::size_t capacity);

  struct Written {
    bool accepted = false;
    bool gone = false;  ///< nobody is at the other end
  };
  /// All or nothing: where the system takes a part only, the rest is kept and written before
  /// anything else.
  Written write(Bytes bytes);

  /// Forgets what is kept.
  void forget() { kept_ = {}; }

 private:
  Result writeSome(Bytes bytes);

  int descriptor_;
  std::array<std::uint8_t, kLongestWrite> rest_{};
  Bytes kept_;  // of rest_
};

/// Raw, 8 data bits, no parity, 1 stop bit, no flow control, kBaudRate.
/// @throws std::runtime_error naming the path and what the system says
void makeRaw(int descriptor, const std::string& path);

/// @throws std::runtime_error "path: what: " and what errno means
[[noreturn]] void throwSystemError(const std::string& path, const std::string& what);

}  // namespace haptex::serial
