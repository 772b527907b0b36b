#include "haptex/serial/port_keeper.h"

#include <poll.h>

#include <algorithm>
#include <exception>

#include "haptex/realtime/steady_clock.h"

namespace haptex::serial {

PortKeeper::PortKeeper(const std::string& path)
    : path_(path), trouble_(path + " has not been opened yet"), thread_([this] { run(); }) {}

PortKeeper::~PortKeeper() {
  stopped_.post();
  thread_.join();
  delete opened_.load();
  delete discarded_.load();
}

bool PortKeeper::takeNew() {
  if (opened_.load(std::memory_order_relaxed) == nullptr) return false;
  port_.reset(opened_.exchange(nullptr, std::memory_order_acquire));
  return true;
}

void PortKeeper::discard() {
  discarded_.store(port_.release(), std::memory_order_relaxed);
  wanted_.store(true, std::memory_order_release);
}

bool PortKeeper::awaitBytes(Time until) {
  pollfd file{port_->descriptor(), POLLIN, 0};
  const timespec patience = realtime::toTimespec(std::max(Time{0}, until - realtime::steadyNow()));
  return ::ppoll(&file, 1, &patience, nullptr) > 0;
}

std::string PortKeeper::trouble() const {
  const std::lock_guard<std::mutex> lock(trouble_mutex_);
  if (wanted_ && trouble_.empty()) return path_ + " was closed: unplugged, or its other end ended";
  return trouble_;
}

void PortKeeper::run() {
  do {
    // Until it is wanted the loop keeps its hands off discarded_.
    if (wanted_.load(std::memory_order_acquire)) open();
  } while (!stopped_.waitFor(kRetryPeriod));
}

void PortKeeper::open() {
  delete discarded_.exchange(nullptr, std::memory_order_relaxed);
  try {
    auto port = std::make_unique<SerialPort>(path_);
    setTrouble("");
    // Before the port is handed over, for the loop may give it back at once.
    wanted_.store(false, std::memory_order_relaxed);
    opened_.store(port.release(), std::memory_order_release);
  } catch (const std::exception& error) {
    setTrouble(error.what());
  }
}

void PortKeeper::setTrouble(const std::string& trouble) {
  const std::lock_guard<std::mutex> lock(trouble_mutex_);
  trouble_ = trouble;
}

}  // namespace haptex::serial
