#include "haptex/large/strip.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace haptex::large {

using Eigen::Vector3d;

Strip::Strip(const Sheet& sheet, const Rows& rows)
    : cloth_(clothOf(sheet, rows)),
      motion_(cloth_),
      begin_(cloth_.initialState()),
      base_(begin_),
      result_(begin_),
      guess_positions_(begin_.positions),
      guess_velocities_(begin_.velocities),
      held_particles_(cloth_.particleCount()),
      unchanged_(linear::BlockVector::Zero(3, static_cast<int>(cloth_.particleCount()))),
      held_(cloth_.forces().heldSize()) {
  for (std::size_t i = 0; i < held_particles_.size(); ++i) {
    held_particles_[i] = cloth_.isAttached(static_cast<int>(i));
  }
}

void Strip::beginTrapezoid(double h) {
  first_ = (2.0 - std::sqrt(2.0)) * h;
  second_ = h - first_;
  a_ = 0.5 * first_;
  ahead_ = first_;
  base_.memory = begin_.memory;
  base_.time = begin_.time + first_;
  const bool goes_on = motion_.leadsTo(begin_);
  cloth::ForceState at_begin = begin_.ofForces();
  cloth::StrainPast strains;
  past_ = {};
  if (goes_on) {
    strains = motion_.strains();
    at_begin.past = &strains;
    past_ = motion_.strainsAfter(begin_, a_);
  }
  predicted_ = goes_on ? motion_.predictAfter(begin_, first_) : nullptr;
  guess_positions_ = begin_.positions;
  guess_velocities_ = begin_.velocities;
  // Forces first, in the place of the velocities.
  std::fill(base_.velocities.begin(), base_.velocities.end(), Vector3d::Zero());
  cloth_.forces().addForces(at_begin, base_.velocities);
  for (std::size_t i = 0; i < cloth_.particleCount(); ++i) {
    base_.positions[i] = begin_.positions[i] + a_ * begin_.velocities[i];
    base_.velocities[i] = begin_.velocities[i] + a_ / cloth_.masses()[i] * base_.velocities[i];
  }
}

void Strip::beginBdf2() {
  const double ratio = second_ / first_;
  const double divisor = 1.0 + 2.0 * ratio;
  const double of_before = ratio * ratio / divisor;
  for (std::size_t i = 0; i < cloth_.particleCount(); ++i) {
    const Vector3d way = result_.positions[i] - begin_.positions[i];
    base_.positions[i] = result_.positions[i] + of_before * way;
    base_.velocities[i] =
        result_.velocities[i] + of_before * (result_.velocities[i] - begin_.velocities[i]);
    guess_velocities_[i] = way / first_;
  }
  guess_positions_ = result_.positions;
  a_ = second_ * (1.0 + ratio) / divisor;
  ahead_ = second_;
  base_.time = begin_.time + first_ + second_;
  motion_.takeBdf2(begin_, begin_.time, first_, guess_positions_, of_before, a_);
  past_ = motion_.strains();
  predicted_ = motion_.predict(begin_, guess_positions_, first_, second_);
}

void Strip::endStep() {
  result_.time = base_.time;
  result_.memory = base_.memory;
  cloth_.remember(result_);
  motion_.end(result_);
  std::swap(begin_, result_);
}

bool Strip::predict() {
  if (predicted_ == nullptr) return false;
  for (std::size_t i = 0; i < held_particles_.size(); ++i) {
    result_.positions[i] = isHeld(static_cast<int>(i)) ? begin_.positions[i] : (*predicted_)[i];
    result_.velocities[i] = (result_.positions[i] - base_.positions[i]) / a_;
  }
  return true;
}

void Strip::linearise(linear::SymmetricBlockMatrix& matrix, linear::BlockVector& rhs) const {
  addInertia(guess_velocities_, matrix, rhs);
  cloth_.forces().assembleLinearised(of(guess_positions_, guess_velocities_), {a_, ahead_}, matrix,
                                     rhs);
  eliminate(matrix, rhs);
}

void Strip::takeLinearised(const linear::BlockVector& solution) {
  for (std::size_t i = 0; i < held_particles_.size(); ++i) {
    result_.velocities[i] = guess_velocities_[i] + solution.col(static_cast<int>(i));
    result_.positions[i] = base_.positions[i] + a_ * result_.velocities[i];
  }
}

void Strip::hold() {
  cloth::ForceState state = of(result_.positions, result_.velocities);
  if (past_.count > 0) state.past = &past_;
  cloth_.forces().hold({base_.positions, state, a_, false}, held_.data());
}

void Strip::assembleNewton(cloth::Hessian hessian, linear::SymmetricBlockMatrix& matrix,
                           linear::BlockVector& rhs) const {
  addInertia(result_.velocities, matrix, rhs);
  cloth_.forces().assembleNewton(of(result_.positions, result_.velocities), held_.data(), a_,
                                 hessian, matrix, rhs);
  eliminate(matrix, rhs);
}

double Strip::potential(const cloth::ClothState& at) const {
  return cloth_.forces().incrementalPotential(of(at.positions, at.velocities), held_.data(), a_);
}

/// At the end of the stage, with what forces remember from the beginning of the step.
cloth::ForceState Strip::of(const cloth::Positions& positions,
                            const cloth::Velocities& velocities) const {
  return {positions, velocities, base_.time, base_.memory.data()};
}

void Strip::addInertia(const cloth::Velocities& velocities, linear::SymmetricBlockMatrix& matrix,
                       linear::BlockVector& rhs) const {
  matrix.setZero();
  for (int i = 0; i < matrix.size(); ++i) {
    const double mass = cloth_.masses()[i];
    matrix.diagonal(i).diagonal().setConstant(mass);
    rhs.col(i) = -mass * (velocities[i] - base_.velocities[i]);
  }
}

void Strip::eliminate(linear::SymmetricBlockMatrix& matrix, linear::BlockVector& rhs) const {
  matrix.eliminate(held_particles_, unchanged_, rhs);
}

}  // namespace haptex::large
