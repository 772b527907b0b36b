// How functions refuse numbers that lie outside of their domain.
#pragma once

#include <sstream>
#include <stdexcept>
#include <string>

namespace haptex::base {

/// @param where   the function, @param name the parameter
/// @param holds   whether the value is allowed; to be computed so that it is false for NaN
/// @param allowed for example "> 0 and <= 1000 m"
/// @throws std::invalid_argument "where: name is value; it must be allowed" unless `holds`
void require(bool holds, const char* where, const char* name, double value,
             const std::string& allowed);

/// @throws std::invalid_argument all parts as one text, numbers with up to twelve digits
template <typename... Parts>
[[noreturn]] void refuse(const Parts&... parts) {
  std::ostringstream message;
  message.precision(12);
  (message << ... << parts);
  throw std::invalid_argument(message.str());
}

/// A number in its shortest form of up to ten digits.
std::string shortNumber(double value);

}  // namespace haptex::base
