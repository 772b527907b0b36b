// What the driver's loop needs of a serial port that may come and go.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "haptex/base/clock.h"
#include "haptex/serial/bytes.h"

namespace haptex::serial {

using base::Time;

/// A port of the operating system (PortKeeper), or one that is simulated. By the loop only, unless
/// said otherwise; nothing waits but awaitBytes().
class PortAccess {
 public:
  virtual ~PortAccess() = default;

  /// Takes over a port that has been opened. @returns whether there is a new one
  virtual bool takeNew() = 0;
  /// Whether there is a port, which may have been closed since.
  virtual bool isThere() const = 0;
  /// Whether a read or a write found it closed.
  virtual bool isClosed() const = 0;
  /// It was found closed: from now on there is none.
  virtual void discard() = 0;

  /// Of the port that is there. @returns how many bytes came, at most `capacity`
  virtual std::size_t read(std::uint8_t* buffer, std::size_t capacity) = 0;
  /// All bytes or none. @returns false if the line does not take them now
  virtual bool write(Bytes bytes) = 0;
  /// @returns false if none came until then, of the steady clock
  virtual bool awaitBytes(Time until) = 0;

  /// By any thread: why there is no port, naming it; empty while there is one.
  virtual std::string trouble() const = 0;
  /// By any thread.
  virtual const std::string& path() const = 0;
};

}  // namespace haptex::serial
