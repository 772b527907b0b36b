// What the tests of the emulated device have in common.
#pragma once

#include <Eigen/Core>
#include <random>

#include "haptex/exoskeleton/emulator/emulated_finger.h"
#include "shipped_urdf.h"

namespace haptex::exoskeleton {

/// Within the limits, `margin` (share of the range) away from each.
inline MotorVector randomAngles(const EmulatedFinger& finger, std::mt19937& generator,
                                double margin = 0.0) {
  std::uniform_real_distribution<double> share(margin, 1.0 - margin);
  MotorVector angles;
  for (int i = 0; i < kMotors; ++i) {
    angles[i] = finger.lowest()[i] + share(generator) * (finger.highest()[i] - finger.lowest()[i]);
  }
  return angles;
}

inline Eigen::Vector3d randomDirection(std::mt19937& generator) {
  std::normal_distribution<double> component;
  Eigen::Vector3d direction;
  for (int i = 0; i < 3; ++i) direction[i] = component(generator);
  return direction.normalized();
}

}  // namespace haptex::exoskeleton
