#include "haptex/realtime/rate_meter.h"

#include <cmath>
#include <cstdio>
#include <limits>

namespace haptex::realtime {

double RateMeter::update(std::uint64_t count, base::Time now) {
  if (!begin_) {
    begin_ = now;
    count_ = count;
  }
  const double elapsed = base::seconds(now - *begin_);
  if (elapsed >= 1.0) {
    rate_ = static_cast<double>(count - count_) / elapsed;
    known_ = true;
    begin_ = now;
    count_ = count;
  }
  return known_ ? rate_ : std::numeric_limits<double>::quiet_NaN();
}

std::string rateLine(const char* name, double rate) {
  if (!std::isfinite(rate)) return std::string(name) + " ...";
  char line[64];
  std::snprintf(line, sizeof(line), "%s %.0f Hz", name, rate);
  return line;
}

}  // namespace haptex::realtime
