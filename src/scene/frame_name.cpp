#include "haptex/scene/frame_name.h"

#include <algorithm>

namespace haptex::scene {

bool isFrameName(const std::string& name) {
  if (name.empty() || name.size() > kLongestFrameName) return false;
  // Not by std::isalpha(), which depends on the locale.
  const auto is_letter = [](char c) { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z'); };
  return is_letter(name[0]) && std::all_of(name.begin(), name.end(), [&](char c) {
           return is_letter(c) || (c >= '0' && c <= '9') || c == '_';
         });
}

}  // namespace haptex::scene
