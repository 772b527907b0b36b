#include "haptex/serial/emulator_fault.h"

#include <cmath>
#include <sstream>
#include <stdexcept>

#include "haptex/base/quoted.h"

namespace haptex::serial {
namespace {

using Kind = EmulatorFault::Kind;

constexpr char kClosedPort[] = "closed_port";
constexpr char kToDevice[] = "to_device";
constexpr char kFromDevice[] = "from_device";
constexpr char kBoth[] = "both";

void parseName(const std::string& name, const std::vector<const char*>& of_device,
               EmulatorFault& fault) {
  std::string allowed;
  for (const LineFault line_fault : lineFaults()) {
    if (name == serial::name(line_fault)) {
      fault.kind = Kind::kLine;
      fault.line_fault = line_fault;
      return;
    }
    allowed += std::string(serial::name(line_fault)) + ", ";
  }
  if (name == kClosedPort) {
    fault.kind = Kind::kClosedPort;
    return;
  }
  allowed += kClosedPort;
  for (const char* device_fault : of_device) {
    if (name == device_fault) {
      fault.kind = Kind::kDevice;
      fault.device_fault = device_fault;
      return;
    }
    allowed += std::string(", ") + device_fault;
  }
  throw std::invalid_argument("fault = " + base::quoted(name) + ": allowed are " + allowed);
}

void parseDirection(const std::string& direction, EmulatorFault& fault) {
  if (direction != kToDevice && direction != kFromDevice && direction != kBoth) {
    throw std::invalid_argument("direction = " + base::quoted(direction) + ": allowed are " +
                                kToDevice + ", " + kFromDevice + " and " + kBoth);
  }
  fault.to_device = direction != kFromDevice;
  fault.from_device = direction != kToDevice;
}

[[noreturn]] void refuse(const char* what, double value, const std::string& allowed) {
  std::ostringstream message;
  message << what << " = " << value << ": allowed are " << allowed;
  throw std::invalid_argument(message.str());
}

}  // namespace

EmulatorFault EmulatorFault::parse(const std::string& fault, const std::string& direction,
                                   double probability, double duration,
                                   const std::vector<const char*>& of_device) {
  EmulatorFault parsed;
  parseName(fault, of_device, parsed);
  parseDirection(direction, parsed);
  if (!std::isfinite(probability) || probability < 0.0 || probability > 1.0) {
    refuse("probability", probability, "numbers from 0 to 1");
  }
  if (!std::isfinite(duration) || duration <= 0.0 || duration > kLongest) {
    std::ostringstream longest;
    longest << "numbers above 0 and at most " << kLongest << " s";
    refuse("duration", duration, longest.str());
  }
  parsed.probability = probability;
  parsed.duration = std::chrono::duration_cast<Time>(std::chrono::duration<double>(duration));
  return parsed;
}

std::string describe(const EmulatorFault& fault) {
  if (fault.kind == Kind::kClosedPort) return kClosedPort;
  if (fault.kind == Kind::kDevice) return fault.device_fault;
  const char* direction = fault.to_device && fault.from_device ? kBoth
                          : fault.to_device                    ? kToDevice
                                                               : kFromDevice;
  return std::string(serial::name(fault.line_fault)) + " " + direction;
}

std::string answerTo(const EmulatorFault& fault) {
  std::ostringstream answer;
  answer << describe(fault);
  if (fault.probability == 0.0) {
    answer << " is over";
  } else {
    answer << " for " << base::seconds(fault.duration) << " s";
  }
  return answer.str();
}

}  // namespace haptex::serial
