// Whether a cloth has come to rest, so that its steps need not be computed.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "haptex/cloth/dynamics/cloth.h"

namespace haptex::cloth {

/// Watches the accepted steps of a cloth in windows of time. A window's way is the farthest that
/// any particle was from its place at the beginning of the window. Where the way falls by a factor
/// q < 1 from window to window, what a cloth that settles or creeps still has before it, all
/// windows together, is
///   way q / (1 - q).
/// The cloth rests when that sum, with the last window's way, is below kTolerance in kWindows
/// windows after each other, or when no particle has moved faster than kSlowest on average over
/// each of them.
///
/// What is not computed then would have moved no particle by more than kTolerance, as long as
/// nothing changes and the motion goes on to fall as it did. What swings more slowly than once in
/// some ten windows, or creeps more slowly than kSlowest, is taken for resting.
class RestDetector {
 public:
  /// m: where cloth that is touched pushes back with 1 N/mm, the difference is 0.001 N, a fifth of
  /// what the force sensors of the exoskeleton can tell.
  static constexpr double kTolerance = 1e-6;
  static constexpr double kSlowest = 1e-9;    ///< m/s: half the thickness of a fabric in two days
  static constexpr double kWindow = 1.0;      ///< s, at least, of simulated time
  static constexpr int kStepsPerWindow = 10;  ///< at least
  static constexpr int kWindows = 2;

  explicit RestDetector(std::size_t particle_count) : begin_(particle_count) {}

  /// After every accepted step. Allocates nothing.
  /// @param state with as many particles as the constructor was told
  void observe(const ClothState& state);
  bool resting() const { return quiet_windows_ >= kWindows; }
  /// Something has changed: all begins anew.
  void wake();

 private:
  void closeWindow(double seconds);

  bool begun_ = false;                  // there is a window
  std::vector<Eigen::Vector3d> begin_;  // m, positions at its beginning
  double begin_time_ = 0.0;             // s
  int steps_ = 0;                       // in it
  double way_squared_ = 0.0;            // m^2, in it so far
  std::optional<double> last_way_;      // m, of the one before
  int quiet_windows_ = 0;
};

/// Whether nothing outside the cloth will set it in motion from now on: its attachments have come
/// to the ends of their paths, and the wind is steady.
bool isUndisturbed(const Cloth& cloth, double time);

}  // namespace haptex::cloth
