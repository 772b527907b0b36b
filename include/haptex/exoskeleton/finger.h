// The two fingers of the exoskeleton and the sizes of their vectors.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

namespace haptex::exoskeleton {

enum class Finger { kIndex, kThumb };

constexpr std::array<Finger, 2> kFingers{Finger::kIndex, Finger::kThumb};

/// "index" or "thumb": prefix of its topics and of its frames and joints in the URDF.
constexpr const char* name(Finger finger) { return finger == Finger::kIndex ? "index" : "thumb"; }

/// Joints of a finger, from the palm to the tip, of which the last is coupled to the one before.
constexpr int kJoints = 4;
/// Motors of a finger. Motor i drives joint i.
constexpr int kMotors = 3;

using JointVector = Eigen::Matrix<double, kJoints, 1>;
using MotorVector = Eigen::Matrix<double, kMotors, 1>;

/// A value for each finger.
template <typename T>
struct PerFinger {
  std::array<T, kFingers.size()> values{};

  T& operator[](Finger finger) { return values[static_cast<std::size_t>(finger)]; }
  const T& operator[](Finger finger) const { return values[static_cast<std::size_t>(finger)]; }
};

}  // namespace haptex::exoskeleton
