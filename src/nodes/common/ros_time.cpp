#include "haptex/nodes/common/ros_time.h"

#include <algorithm>
#include <cstdint>

#include "haptex/realtime/steady_clock.h"

namespace haptex::nodes {

using base::Time;

ros::Time rosTimeOf(Time time) {
  // Between the two clocks another thread may run: then they are read again.
  constexpr int kAttempts = 3;
  constexpr Time kAtOnce = std::chrono::microseconds(50);
  ros::Time now;
  Time age{0};
  for (int i = 0; i < kAttempts; ++i) {
    const Time before = realtime::steadyNow();
    now = ros::Time::now();
    const Time after = realtime::steadyNow();
    age = before - time;
    if (after - before < kAtOnce) break;
  }
  const auto nanoseconds = static_cast<std::uint64_t>(std::max<std::int64_t>(age.count(), 0));
  if (now.toNSec() < nanoseconds) return now;  // a simulation that has just begun
  return ros::Time().fromNSec(now.toNSec() - nanoseconds);
}

Time between(const ros::Time& earlier, const ros::Time& later) {
  return Time(static_cast<std::int64_t>(later.toNSec()) -
              static_cast<std::int64_t>(earlier.toNSec()));
}

Time ageOf(const ros::Time& stamp) {
  if (stamp.isZero()) return Time::zero();
  return std::max(Time::zero(), between(stamp, ros::Time::now()));
}

}  // namespace haptex::nodes
