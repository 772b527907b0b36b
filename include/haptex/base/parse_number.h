// Numbers that texts from outside are.
#pragma once

#include <charconv>
#include <optional>
#include <string_view>
#include <system_error>

namespace haptex::base {

/// The number that all of the text is, as std::from_chars reads it: a point for decimals, no
/// blanks, no plus sign; "inf" and "nan" are numbers. None if it is something else or out of range.
template <typename Number>
std::optional<Number> parseNumber(std::string_view text) {
  Number number{};
  const char* const end = text.data() + text.size();
  const std::from_chars_result result = std::from_chars(text.data(), end, number);
  if (result.ec != std::errc() || result.ptr != end) return std::nullopt;
  return number;
}

/// Without a plus sign before it, which some files have.
inline std::string_view withoutPlus(std::string_view text) {
  return !text.empty() && text.front() == '+' ? text.substr(1) : text;
}

}  // namespace haptex::base
