// Where a cloth was lately, for the methods that combine several instants.
#pragma once

#include <array>

#include "haptex/cloth/dynamics/cloth.h"

namespace haptex::cloth {

/// The instants of the last step of TR-BDF2 or BDF-2. Two things follow from them.
///
/// Rates of strain. A method that takes velocities from positions by a formula takes rates from
/// strains by the same one: e' = (e - e*) / a where v = (x - x*) / a. They are of the second order,
/// and zero under every rigid motion. The velocities of a turning cloth are not: v has an error of
/// the third order in the angle per step along the threads, which stiff viscous threads answer with
/// forces larger than the cloth's weight.
///
/// A prediction of the next positions by parabolas. What turns by an angle per step goes round with
/// it to the second order, where along a straight line it would be stretched by half its square.
///
/// Allocates nothing after construction.
class RecentMotion {
 public:
  explicit RecentMotion(const Cloth& cloth);

  /// Takes over the formula of a BDF-2 stage,
  ///   a e' = e - (1 + of_before) e(middle) + of_before e(before).
  /// @param first s, from `before` to `middle` @param middle its positions are copied
  void takeBdf2(const ClothState& before, double first, const Positions& middle, double of_before,
                double a);
  /// After a step taken anew, which need not have converged: what its strains have changed by is no
  /// rate to go on with. The next step starts with none, e' = e - e(end).
  void startAnew(const ClothState& end);
  /// The step with this formula has led here.
  void end(const ClothState& state);
  void forget() { count_ = 0; }

  /// Whether the last step ended in this state.
  bool leadsTo(const ClothState& state) const {
    return count_ > 0 && time_ == state.time && last_ == state.positions;
  }

  /// Of the formula. It refers to this object.
  StrainPast strains() const;
  /// Of the trapezoidal rule over 2 a from the end of the last step on,
  ///   e* = e(begin) + a e'(begin).
  /// It refers to this object and to `begin`. @param begin leadsTo() it
  StrainPast strainsAfter(const ClothState& begin, double a) const;

  /// @param begin leadsTo() it @param ahead s
  /// @return where the cloth will be (m); null if one instant is all that is known
  const Positions* predictAfter(const ClothState& begin, double ahead);
  /// The same from two positions and the velocities of the earlier one.
  /// @param first s, from `before` to `middle` @param second s, on to the prediction
  const Positions* predict(const ClothState& before, const Positions& middle, double first,
                           double second);

 private:
  std::array<Positions, 2> positions_;  // m, the newer first
  std::array<double, 2> times_{};       // s, simulated
  std::array<double, 2> weights_{};     // StrainPast
  int count_ = 0;                       // of them; 0: nothing is known
  double a_ = 0.0;                      // s
  Positions last_;                      // m, at the end of the step
  double time_ = 0.0;                   // s, simulated, which was then
  Positions predicted_;                 // m
};

}  // namespace haptex::cloth
