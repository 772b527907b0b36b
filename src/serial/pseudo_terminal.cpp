#include "haptex/serial/pseudo_terminal.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/file.h>
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

/// Whether the path still leads to the file: who had the lock before removes it.
bool isAt(const std::string& path, int descriptor) {
  struct stat here {
  }, open{};
  return ::stat(path.c_str(), &here) == 0 && ::fstat(descriptor, &open) == 0 &&
         here.st_dev == open.st_dev && here.st_ino == open.st_ino;
}

/// The open lock, or -1 without a link.
int locked(const std::string& link) {
  if (link.empty()) return -1;
  const std::string path = link + ".lock";
  while (true) {
    const int descriptor = ::open(path.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0644);
    if (descriptor < 0) throwSystemError(link, "cannot be made a symbolic link");
    const bool done = ::flock(descriptor, LOCK_EX | LOCK_NB) == 0;
    if (done && isAt(path, descriptor)) return descriptor;
    ::close(descriptor);
    if (!done) {
      throw std::runtime_error(base::shortened(link) +
                               ": is the link of another emulator, which runs: give this one "
                               "another, or start it in another namespace");
    }
  }
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

PseudoTerminal::LinkLock::LinkLock(const std::string& link)
    : path_(link.empty() ? "" : link + ".lock"), file_(locked(link)) {}

PseudoTerminal::LinkLock::~LinkLock() {
  if (!path_.empty()) ::unlink(path_.c_str());
}

PseudoTerminal::PseudoTerminal(const std::string& link)
    : lock_(link), line_(open()), path_(otherEnd(line_.get())), link_(link) {
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
