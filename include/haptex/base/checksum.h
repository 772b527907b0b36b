// A number that tells whether texts are the same.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace haptex::base {

constexpr std::uint64_t kChecksumOfNothing = 14695981039346656037u;

/// FNV-1a with 64 bits: texts that differ by accident have different ones. It keeps nobody from
/// making two that have the same.
/// @param before the checksum of what comes before the text
constexpr std::uint64_t checksum(std::string_view text, std::uint64_t before = kChecksumOfNothing) {
  for (const char letter : text) {
    before = (before ^ static_cast<unsigned char>(letter)) * 1099511628211u;
  }
  return before;
}

/// 16 hexadecimal digits.
inline std::string digitsOf(std::uint64_t checksum) {
  std::string digits(16, '0');
  for (std::size_t i = digits.size(); i-- > 0; checksum >>= 4) {
    digits[i] = "0123456789abcdef"[checksum & 15u];
  }
  return digits;
}

}  // namespace haptex::base
