// The emulated person's fingertips as one gesture: they close on what is between them, and open.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "haptex/base/finger.h"

namespace haptex::nodes {

/// Moves the targets of both fingertips along the line between them, their middle where it is.
/// Reads no clock. By one thread.
class Grasp {
 public:
  using Fingertips = base::PerFinger<Eigen::Vector3d>;  ///< targets of the centres, m, in hand_base

  /// Between the centres (m): the round ends, of 7.5 and 9 mm, then press 1 mm into each other.
  static constexpr double kClosed = 0.0155;
  static constexpr double kFarthest = 0.12;  ///< m, likewise
  static constexpr double kSpeed = 0.04;     ///< m/s, of the distance

  /// From now on they close to kClosed.
  void close(const Fingertips& now);
  /// From now on they open to where they were when they began to close.
  /// @returns false, and nothing happens, if they have not been closed
  bool open();
  /// Somebody else moves them from now on.
  void end() { wanted_.reset(); }

  /// Where they are to be after a while (s); nothing if nothing is to be done.
  std::optional<Fingertips> after(double duration, const Fingertips& now);

  /// With another distance between them (m), which is limited to kClosed and kFarthest. Where they
  /// are in one place they stay.
  static Fingertips atDistance(double distance, const Fingertips& now);
  static double distanceOf(const Fingertips& now);

 private:
  std::optional<double> wanted_;  // m
  std::optional<double> opened_;  // m, before they closed
};

}  // namespace haptex::nodes
