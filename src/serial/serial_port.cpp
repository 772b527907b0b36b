#include "haptex/serial/serial_port.h"

#include <fcntl.h>
#include <linux/serial.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <termios.h>
#include <unistd.h>

#include <cerrno>
#include <stdexcept>

#include "haptex/base/quoted.h"

namespace haptex::serial {
namespace {

// Documentation/admin-guide/devices.txt of Linux: the slaves of Unix98 pseudo-terminals.
constexpr unsigned kFirstPseudoTerminal = 136, kLastPseudoTerminal = 143;

int open(const std::string& path) {
  // Without waiting for a modem's carrier, and without becoming the terminal that Ctrl-C goes to.
  const int descriptor = ::open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) throwSystemError(path, "cannot be opened");
  return descriptor;
}

// Refuses a second driver. TIOCEXCL keeps out every other program, but not those of root, so that
// there is a lock as well. A pseudo-terminal gets the lock only: there TIOCEXCL would outlive a
// killed driver, and keep out its successor for as long as the emulator runs.
void makeExclusive(int descriptor, const struct stat& status, const std::string& path) {
  if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0) {
    if (errno == EWOULDBLOCK)
      throw std::runtime_error(base::shortened(path) + ": another program has it open");
    throwSystemError(path, "cannot be locked");
  }
  const unsigned kind = major(status.st_rdev);
  if (kind >= kFirstPseudoTerminal && kind <= kLastPseudoTerminal) return;
  if (::ioctl(descriptor, TIOCEXCL) != 0) throwSystemError(path, "cannot be had alone");
}

// USB adapters collect bytes for up to 16 ms otherwise. Where the kernel's driver has no such
// setting there is nothing to be set.
void askForLowLatency(int descriptor) {
  serial_struct settings{};
  if (::ioctl(descriptor, TIOCGSERIAL, &settings) != 0) return;
  settings.flags |= ASYNC_LOW_LATENCY;
  (void)::ioctl(descriptor, TIOCSSERIAL, &settings);
}

}  // namespace

SerialPort::SerialPort(const std::string& path) : line_(open(path)) {
  struct stat status {};
  if (::fstat(line_.get(), &status) != 0) throwSystemError(path, "cannot be examined");
  if (!S_ISCHR(status.st_mode) || ::isatty(line_.get()) == 0) {
    throw std::runtime_error(base::shortened(path) + ": not a serial port");
  }
  makeExclusive(line_.get(), status, path);
  makeRaw(line_.get(), path);
  askForLowLatency(line_.get());
  if (::tcflush(line_.get(), TCIOFLUSH) != 0) throwSystemError(path, "cannot be flushed");
}

std::size_t SerialPort::read(std::uint8_t* buffer, std::size_t capacity) {
  if (closed_) return 0;
  const LineDescriptor::Result result = line_.read(buffer, capacity);
  closed_ = result.gone;
  return result.count;
}

bool SerialPort::write(Bytes bytes) {
  if (closed_) return false;
  const LineDescriptor::Written written = line_.write(bytes);
  closed_ = written.gone;
  return written.accepted;
}

}  // namespace haptex::serial
