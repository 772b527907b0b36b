// Faults that an emulator can be asked for, by name.
#pragma once

#include <string>
#include <vector>

#include "haptex/base/clock.h"
#include "haptex/serial/fault_injector.h"

namespace haptex::serial {

using base::Time;

/// A fault to be: what srv/InjectFault.srv asks for.
struct EmulatorFault {
  enum class Kind {
    kLine,        ///< `line_fault` of the directions
    kClosedPort,  ///< the port is gone, and a new one is there after the duration
    kDevice,      ///< `device_fault`
  };
  static constexpr double kLongest = 3600.0;  ///< s

  Kind kind = Kind::kLine;
  LineFault line_fault = LineFault::kDrop;
  const char* device_fault = nullptr;  ///< one of those that the emulator has of its own
  bool to_device = false;
  bool from_device = false;
  double probability = 0.0;  ///< no unit; 0 ends the fault
  Time duration{0};

  /// @param direction "to_device", "from_device" or "both"
  /// @param probability 0 to 1, no unit @param duration s, above 0 and at most kLongest
  /// @param of_device names of the faults that the emulator has beside those of the line
  /// @throws std::invalid_argument naming what is not allowed, its value, and what is allowed
  static EmulatorFault parse(const std::string& fault, const std::string& direction,
                             double probability, double duration,
                             const std::vector<const char*>& of_device = {});
};

/// For example "drop to_device" or "closed_port".
std::string describe(const EmulatorFault& fault);

/// What to answer to who asked for it: "drop to_device for 1.5 s", or "drop to_device is over".
std::string answerTo(const EmulatorFault& fault);

}  // namespace haptex::serial
