// Texts that are wrong somewhere.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>

#include "haptex/base/repeatable_random.h"

namespace haptex::garment {

inline std::size_t below(base::RepeatableRandom& random, std::size_t count) {
  return static_cast<std::size_t>(random.below(static_cast<int>(count)));
}

// One of the numbers in a text becomes another one.
inline void replaceNumber(std::string& text, base::RepeatableRandom& random) {
  const std::array<const char*, 12> others = {"nan", "1e308", "-1e308", "-1",   "0",  "1e-320",
                                              "",    "1e999", "0.3",    "1e-9", "99", "2147483648"};
  const std::size_t begin = text.find_first_of("0123456789", below(random, text.size()));
  if (begin == std::string::npos) return;
  const std::size_t end = text.find_first_not_of("0123456789.-", begin);
  text.replace(begin, std::min(end, text.size()) - begin, others[below(random, others.size())]);
}

inline void mutate(std::string& text, base::RepeatableRandom& random) {
  if (text.empty()) return;
  const std::size_t at = below(random, text.size());
  const std::size_t length = 1 + below(random, std::min<std::size_t>(40, text.size() - at));
  switch (below(random, 7)) {
    case 0:
      text.erase(at, length);
      break;
    case 1:
      text.insert(at, text.substr(below(random, text.size()), length));
      break;
    case 2:
      text[at] = static_cast<char>(below(random, 256));
      break;
    case 3:
      text.resize(at);
      break;
    case 4:
      text.insert(at, std::string(length, "[{(:,-\"0"[below(random, 8)]));
      break;
    default:
      replaceNumber(text, random);
      break;
  }
}

// With one to three mutations, the same for the same seed.
inline std::string malformedText(std::string text, std::uint64_t seed) {
  base::RepeatableRandom random(seed);
  const std::size_t mutations = 1 + below(random, 3);
  for (std::size_t i = 0; i < mutations; ++i) mutate(text, random);
  return text;
}

}  // namespace haptex::garment
