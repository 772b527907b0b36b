// Faults that the emulator can be asked for, by name.
#pragma once

#include <string>

#include "haptex/exoskeleton/emulator/fault_injector.h"
#include "haptex/exoskeleton/finger.h"

namespace haptex::exoskeleton {

/// A fault to be: what srv/InjectFault.srv asks for.
struct EmulatorFault {
  enum class Kind {
    kLine,             ///< `line_fault` of the directions
    kClosedPort,       ///< the port is gone, and a new one is there after the duration
    kSaturatedSensor,  ///< the force sensors of both fingers read the end of their range
  };
  static constexpr double kLongest = 3600.0;  ///< s

  Kind kind = Kind::kLine;
  LineFault line_fault = LineFault::kDrop;
  bool to_device = false;
  bool from_device = false;
  double probability = 0.0;  ///< no unit; 0 ends the fault
  Time duration{0};

  /// @throws std::invalid_argument naming what is not allowed, its value, and what is allowed
  static EmulatorFault parse(const std::string& fault, const std::string& direction,
                             double probability, double duration);
};

/// For example "drop to_device" or "closed_port".
std::string describe(const EmulatorFault& fault);

}  // namespace haptex::exoskeleton
