// The URDF of the package, as text.
#pragma once

#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>

namespace haptex::exoskeleton {

inline const std::string& shippedUrdf() {
  static const std::string text = [] {
    std::ifstream file(HAPTEX_SOURCE_DIRECTORY "/urdf/hand_exoskeleton.urdf");
    if (!file) throw std::runtime_error("cannot read urdf/hand_exoskeleton.urdf");
    std::ostringstream whole;
    whole << file.rdbuf();
    return whole.str();
  }();
  return text;
}

/// The text with the first `old_part` replaced.
inline std::string replaced(std::string text, const std::string& old_part,
                            const std::string& new_part) {
  const std::size_t at = text.find(old_part);
  if (at == std::string::npos) throw std::runtime_error("the URDF has no " + old_part);
  return text.replace(at, old_part.size(), new_part);
}

}  // namespace haptex::exoskeleton
