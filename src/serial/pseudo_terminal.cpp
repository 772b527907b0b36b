#include "haptex/serial/pseudo_terminal.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <stdexcept>

#include "haptex/base/quoted.h"

namespace haptex::serial {
namespace {

int open() {
  const int descriptor = ::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) throwSystemError("pseudo-terminal", "cannot be made");
  return descriptor;
}

std::string otherEnd(int descriptor) {
  if (::grantpt(descriptor) != 0 || ::unlockpt(descriptor) != 0) {
    throwSystemError("pseudo-terminal", "cannot be unlocked");
  }
  std::array<char, 64> name{};
  errno = ::ptsname_r(descriptor, name.data(), name.size());
  if (errno != 0) throwSystemError("pseudo-terminal", "has no name");
  return name.data();
}

// Before anybody has closed the other end the system does not tell that nobody has it open.
void openAndClose(const std::string& path) {
  const LineDescriptor other(::open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  if (other.get() < 0) throwSystemError(path, "cannot be opened");
}

void makeLink(const std::string& link, const std::string& path) {
  struct stat status {};
  if (::lstat(link.c_str(), &status) == 0) {
    if (!S_ISLNK(status.st_mode)) {
      throw std::runtime_error(base::shortened(link) +
                               ": exists and is not a symbolic link, so it stays");
    }
    if (::unlink(link.c_str()) != 0) throwSystemError(link, "cannot be replaced");
  }
  if (::symlink(path.c_str(), link.c_str()) != 0) {
    throwSystemError(link, "cannot be made a symbolic link");
  }
}

bool leadsTo(const std::string& link, const std::string& path) {
  std::array<char, 64> target{};
  const ssize_t length = ::readlink(link.c_str(), target.data(), target.size());
  return length >= 0 && path == std::string(target.data(), static_cast<std::size_t>(length));
}

bool nobodyAtOtherEnd(int descriptor) {
  pollfd state{descriptor, 0, 0};
  return ::poll(&state, 1, 0) > 0 && (state.revents & POLLHUP) != 0;
}

}  // namespace

PseudoTerminal::PseudoTerminal(const std::string& link)
    : line_(open()), path_(otherEnd(line_.get())), link_(link) {
  makeRaw(line_.get(), path_);
  openAndClose(path_);
  if (!link_.empty()) makeLink(link_, path_);
}

PseudoTerminal::~PseudoTerminal() {
  if (!link_.empty() && leadsTo(link_, path_)) ::unlink(link_.c_str());
}

std::size_t PseudoTerminal::read(std::uint8_t* buffer, std::size_t capacity) {
  return line_.read(buffer, capacity).count;
}

bool PseudoTerminal::isConnected() const { return !nobodyAtOtherEnd(line_.get()); }

bool PseudoTerminal::write(Bytes bytes) {
  if (!isConnected()) {
    line_.forget();
    return true;
  }
  return line_.write(bytes).accepted;
}

}  // namespace haptex::serial
