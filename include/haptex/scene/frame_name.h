// Names that become part of a topic: of frames that carry particles, and of fasteners.
#pragma once

#include <cstddef>
#include <string>

namespace haptex::scene {

constexpr char kFrameNames[] = "a letter, then letters, digits and _, up to 200 characters";
constexpr std::size_t kLongestFrameName = 200;  ///< bytes
/// Whether a name is one of kFrameNames and not longer than kLongestFrameName.
bool isFrameName(const std::string& name);

}  // namespace haptex::scene
