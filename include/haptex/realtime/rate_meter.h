// How often something happens, for people.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "haptex/base/clock.h"

namespace haptex::realtime {

/// Events per second of a count, over the last second or so.
class RateMeter {
 public:
  /// @returns Hz; NaN within the first second
  double update(std::uint64_t count, base::Time now);

 private:
  std::optional<base::Time> begin_;
  std::uint64_t count_ = 0;
  double rate_ = 0.0;
  bool known_ = false;
};

/// For example "cloth 80 Hz". @param rate Hz; NaN if it is not known yet
std::string rateLine(const char* name, double rate);

}  // namespace haptex::realtime
