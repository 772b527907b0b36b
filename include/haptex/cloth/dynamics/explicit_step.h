// Explicit steps: they evaluate forces and solve nothing.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "haptex/cloth/dynamics/cloth.h"
#include "haptex/cloth/dynamics/step.h"

namespace haptex::cloth {

/// Explicit Euler, midpoint, classical Runge-Kutta of order 4, and the two-step Euler of Provot
/// 1997, which moves the particles with the velocities at the end of the step. Stable only while
/// the step is short against the period of the fastest vibration of the mesh; what that is, is not
/// checked.
///
/// Allocates nothing after construction.
class ExplicitStep {
 public:
  /// @param method not implicit
  ExplicitStep(const Cloth& cloth, IntegrationMethod method);

  /// Attached particles have the position and the velocity of their path at each stage.
  /// @param time_step s, finite and > 0
  /// @param end       positions and velocities at the end of the step; not begin
  void advance(const Cloth& cloth, const ClothState& begin, double time_step, ClothState& end);

 private:
  void moveToStage(const Cloth& cloth, const ClothState& begin, const ClothState& previous,
                   double interval);

  IntegrationMethod method_;
  ClothState stage_;  // empty where the only stage is the beginning
  std::vector<Eigen::Vector3d> forces_;
};

}  // namespace haptex::cloth
