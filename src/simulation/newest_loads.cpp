#include "haptex/simulation/newest_loads.h"

#include <utility>

namespace haptex::simulation {

void NewestLoads::set(std::vector<cloth::PointLoad> loads, Time now) {
  const std::lock_guard<std::mutex> lock(mutex_);
  newest_.swap(loads);  // the old ones are freed after the lock
  changed_ = true;
  acting_ = true;
  come_ = now;
}

void NewestLoads::clear() {
  std::vector<cloth::PointLoad> old;
  const std::lock_guard<std::mutex> lock(mutex_);
  newest_.swap(old);
  changed_ = true;
  acting_ = false;
}

bool NewestLoads::take(std::vector<cloth::PointLoad>& loads, Time now) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (acting_ && now - come_ >= kLifetime) {
    newest_.clear();
    changed_ = true;
    acting_ = false;
  }
  if (!changed_) return false;
  loads.swap(newest_);
  changed_ = false;
  return true;
}

}  // namespace haptex::simulation
