// Random numbers that are the same on every machine.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <random>

namespace haptex::base {

/// Random numbers that are the same with every standard library: the engine is specified by the
/// standard, distributions are not.
class RepeatableRandom {
 public:
  explicit RepeatableRandom(std::uint64_t seed) : engine_(seed) {}

  double uniform(double low, double high);  ///< in [low, high)
  /// Uniform in the logarithm, both > 0.
  double logarithmic(double low, double high);
  int below(int count);  ///< 0 to count - 1, count > 0
  bool chance(double probability) { return uniform(0.0, 1.0) < probability; }
  /// Both uniform in [low, high), y drawn first. Not Vector2d(uniform(), uniform()): compilers
  /// evaluate arguments in any order.
  Eigen::Vector2d inSquare(double low, double high);
  Eigen::Vector3d direction();  ///< unit, uniform on the sphere

 private:
  std::mt19937_64 engine_;
};

}  // namespace haptex::base
