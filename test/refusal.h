// What a call that has to refuse says.
#pragma once

#include <stdexcept>
#include <string>

namespace haptex::test {

constexpr const char* kNotRefused = "(not refused)";

/// The message of the exception that the call throws. Another exception goes on to the test, which
/// fails by it. @returns kNotRefused if there is none
template <typename Exception = std::invalid_argument, typename Call>
std::string refusalOf(const Call& call) {
  try {
    call();
  } catch (const Exception& refusal) {
    return refusal.what();
  }
  return kNotRefused;
}

}  // namespace haptex::test
