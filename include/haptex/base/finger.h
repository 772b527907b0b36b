// The two fingers that touch.
#pragma once

#include <array>
#include <cstddef>

namespace haptex::base {

enum class Finger { kIndex, kThumb };

constexpr std::array<Finger, 2> kFingers{Finger::kIndex, Finger::kThumb};

/// "index" or "thumb": prefix of its topics and of its frames and joints in the URDF.
constexpr const char* name(Finger finger) { return finger == Finger::kIndex ? "index" : "thumb"; }

/// A value for each finger.
template <typename T>
struct PerFinger {
  std::array<T, kFingers.size()> values{};

  T& operator[](Finger finger) { return values[static_cast<std::size_t>(finger)]; }
  const T& operator[](Finger finger) const { return values[static_cast<std::size_t>(finger)]; }
};

}  // namespace haptex::base
