// Chooses the lengths of steps by what they miss.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "haptex/cloth/dynamics/cloth.h"
#include "haptex/cloth/dynamics/step.h"

namespace haptex::cloth {

/// Steps between two lengths, as long as an error allows.
struct AdaptiveSteps {
  double shortest = 0.0;  ///< s, > 0
  double longest = 0.0;   ///< s, >= shortest
  double error = 0.0;     ///< m, > 0: what a step may miss of the place of a free particle
};

/// What a step misses, and from it how long the next one may be.
///
/// The estimate of the error is how far the way of a free particle is from the integral of its
/// velocity, at most: with v at the ends of this step (h) and of the one before (h'), through which
/// a parabola goes,
///   error = |x1 - x0 - h (v0 + v1)/2 + h^3 d/6|,
///   d = ((v1 - v0)/h - (v0 - v')/h') / (h + h'),
/// or d = 0 without a step before. To the leading order that is the error of x in one step of
/// methods of order 1 and 2 from exact values: the error of their v counts with one more h. It
/// costs no evaluation of forces, and sees impacts, which change velocities at once. Steps of
/// methods of higher order are better than it says.
///
/// Lengths follow the elementary controller h (0.9 allowed/error)^(1/(order + 1)), between a fifth
/// and twice the last one (Hairer, Norsett, Wanner: Solving Ordinary Differential Equations I,
/// 1993, II.4; BDF-2 is stable up to 1 + sqrt 2). Nothing allocates after construction.
class StepLengthControl {
 public:
  /// @throws std::invalid_argument unless all three of AdaptiveSteps are finite and as said there
  StepLengthControl(const Cloth& cloth, IntegrationMethod method, const AdaptiveSteps& steps);

  /// The next step's length (s): `left` by the least whole number of steps that the controller
  /// allows, but none shorter than the shortest, if `left` is not.
  double lengthWithin(double left) const;

  /// Of a step from one state to the next, of the length that lengthWithin(left) gave.
  /// @return whether the next one may go on from `end`: the error is allowed, or no shorter step
  ///   is. Otherwise the step has to be repeated from `begin` by lengthWithin(left).
  bool judge(const Cloth& cloth, const ClothState& begin, const ClothState& end, double left);
  /// The same of a step that has failed. @return whether it is to be repeated by a shorter one
  bool shorten(double left);

  double error() const { return error_; }  ///< m, of the last judge(); 0: it could not tell
  bool missed() const { return error_ > steps_.error; }

 private:
  double estimate(const Cloth& cloth, const ClothState& begin, const ClothState& end,
                  double length) const;

  AdaptiveSteps steps_;
  int order_;
  double next_;                          // s
  double error_ = 0.0;                   // m
  double before_length_ = 0.0;           // s, of the last step that was taken; 0: none was
  double taken_until_ = 0.0;             // s, simulated, where that ended
  std::vector<Eigen::Vector3d> before_;  // m/s, where that began
};

}  // namespace haptex::cloth
