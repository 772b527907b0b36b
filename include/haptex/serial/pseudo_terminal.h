// A pseudo-terminal: a serial line without hardware. The emulator keeps the one end, the driver
// opens the other by its path.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "haptex/serial/bytes.h"
#include "haptex/serial/line_descriptor.h"

namespace haptex::serial {

class PseudoTerminal {
 public:
  /// Makes a raw pseudo-terminal and, if `link` is not empty, a symbolic link of that name to its
  /// other end; an existing symbolic link is replaced, anything else is not. Beside the link lies
  /// LINK.lock, locked as long as this object lives.
  /// @throws std::runtime_error naming what failed; also if another object, of this or another
  ///   process, has the link
  explicit PseudoTerminal(const std::string& link = "");
  /// Removes the lock, and the link unless it has come to lead elsewhere.
  ~PseudoTerminal();
  PseudoTerminal(const PseudoTerminal&) = delete;
  PseudoTerminal& operator=(const PseudoTerminal&) = delete;

  /// Path of the other end, /dev/pts/N.
  const std::string& path() const { return path_; }

  /// As SerialPort, without waiting. Nothing arrives while nobody has the other end open, and what
  /// is written then is lost, as on a wire that leads nowhere.
  std::size_t read(std::uint8_t* buffer, std::size_t capacity);
  bool write(Bytes bytes);

  /// Whether somebody has the other end open.
  bool isConnected() const;

  int descriptor() const { return line_.get(); }

 private:
  /// LINK.lock, open and locked, which is removed with it. Nothing without a link.
  class LinkLock {
   public:
    explicit LinkLock(const std::string& link);
    ~LinkLock();
    LinkLock(const LinkLock&) = delete;
    LinkLock& operator=(const LinkLock&) = delete;

   private:
    std::string path_;
    LineDescriptor file_;
  };

  LinkLock lock_;
  LineDescriptor line_;
  std::string path_;
  std::string link_;
};

}  // namespace haptex::serial
