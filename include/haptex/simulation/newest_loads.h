// The newest contact forces, from those who send them to the loop that steps the cloth.
#pragma once

#include <mutex>
#include <vector>

#include "haptex/base/clock.h"
#include "haptex/cloth/forces/point_loads.h"

namespace haptex::simulation {

/// Keeps the newest loads until others come or they are too old. Neither side waits for the other's
/// work: the lock is held for a swap of vectors. By any thread.
class NewestLoads {
 public:
  using Time = base::Time;
  /// How long loads act when nothing follows: a sender that died lets go.
  static constexpr Time kLifetime = std::chrono::milliseconds(100);

  /// @param now on the steady clock
  void set(std::vector<cloth::PointLoad> loads, Time now);
  /// No loads from now on.
  void clear();

  /// @param loads replaced if the return value is true
  /// @returns whether the loads have changed since the last call that returned true
  bool take(std::vector<cloth::PointLoad>& loads, Time now);

 private:
  std::mutex mutex_;  // guards the following
  std::vector<cloth::PointLoad> newest_;
  bool changed_ = false;
  bool acting_ = false;  // newest_ has come and has not been ended for its age
  Time come_{0};
};

}  // namespace haptex::simulation
