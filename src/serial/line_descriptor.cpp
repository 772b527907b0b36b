#include "haptex/serial/line_descriptor.h"

#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>

#include "haptex/base/quoted.h"

namespace haptex::serial {

LineDescriptor::~LineDescriptor() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

LineDescriptor::Result LineDescriptor::read(std::uint8_t* buffer, std::size_t capacity) {
  if (capacity == 0) return {};
  ssize_t count = 0;
  do {
    count = ::read(descriptor_, buffer, capacity);
  } while (count < 0 && errno == EINTR);
  if (count > 0) return {static_cast<std::size_t>(count), false};
  // A terminal that is to wait for one byte but not to block says 0 only after a hang-up.
  return {0, count == 0 || (errno != EAGAIN && errno != EWOULDBLOCK)};
}

LineDescriptor::Result LineDescriptor::writeSome(Bytes bytes) {
  ssize_t count = 0;
  do {
    count = ::write(descriptor_, bytes.data, bytes.size);
  } while (count < 0 && errno == EINTR);
  if (count >= 0) return {static_cast<std::size_t>(count), false};
  return {0, errno != EAGAIN && errno != EWOULDBLOCK};
}

LineDescriptor::Written LineDescriptor::write(Bytes bytes) {
  if (bytes.size > kLongestWrite) return {};
  if (!kept_.empty()) {
    const Result written = writeSome(kept_);
    if (written.gone) return {false, true};
    kept_ = {kept_.data + written.count, kept_.size - written.count};
    if (!kept_.empty()) return {};
  }
  if (bytes.empty()) return {true, false};
  const Result written = writeSome(bytes);
  if (written.count == 0) return {false, written.gone};
  const std::size_t left = bytes.size - written.count;
  std::copy_n(bytes.data + written.count, left, rest_.data());
  kept_ = {rest_.data(), left};
  return {true, false};
}

void makeRaw(int descriptor, const std::string& path) {
  termios settings{};
  if (::tcgetattr(descriptor, &settings) != 0) throwSystemError(path, "not a serial port");
  ::cfmakeraw(&settings);
  settings.c_cflag &= ~static_cast<tcflag_t>(CSTOPB | CRTSCTS);
  // HUPCL: a driver that ends drops DTR, so that the firmware needs not wait for its watchdog.
  settings.c_cflag |= CLOCAL | CREAD | HUPCL;
  settings.c_iflag &= ~static_cast<tcflag_t>(IXOFF | IXANY);
  settings.c_cc[VMIN] = 1;
  settings.c_cc[VTIME] = 0;
  static_assert(kBaudRate == 921600);
  ::cfsetspeed(&settings, B921600);
  if (::tcsetattr(descriptor, TCSANOW, &settings) != 0) throwSystemError(path, "cannot be set up");
  // tcsetattr is content with setting a part.
  termios actual{};
  if (::tcgetattr(descriptor, &actual) != 0) throwSystemError(path, "not a serial port");
  if (::cfgetospeed(&actual) != B921600 || ::cfgetispeed(&actual) != B921600) {
    throw std::runtime_error(base::shortened(path) + ": cannot do " + std::to_string(kBaudRate) +
                             " baud");
  }
}

void throwSystemError(const std::string& path, const std::string& what) {
  throw std::runtime_error(base::shortened(path) + ": " + what + ": " + std::strerror(errno));
}

}  // namespace haptex::serial
