#include "haptex/large/strip.h"

#include <utility>

namespace haptex::large {

Strip::Strip(const Sheet& sheet, const Rows& rows)
    : cloth_(clothOf(sheet, rows)),
      motion_(cloth_),
      begin_(cloth_.initialState()),
      base_(begin_),
      result_(begin_),
      held_particles_(cloth_.particleCount()),
      unchanged_(linear::BlockVector::Zero(3, static_cast<int>(cloth_.particleCount()))),
      held_(cloth_.forces().heldSize()) {
  for (std::size_t i = 0; i < held_particles_.size(); ++i) {
    held_particles_[i] = cloth_.isAttached(static_cast<int>(i));
  }
}

void Strip::beginTrapezoid(double h) {
  first_ = cloth::trapezoidPart(h);
  second_ = h - first_;
  ahead_ = first_;
  base_.memory = begin_.memory;
  base_.time = begin_.time + first_;
  stage_ = cloth::startTrapezoid(cloth_, begin_, first_, &motion_, base_);
  predicted_ = stage_.goes_on ? motion_.predictAfter(begin_, first_) : nullptr;
  result_.positions = begin_.positions;
  result_.velocities = begin_.velocities;
}

void Strip::beginBdf2() {
  ahead_ = second_;
  base_.time = begin_.time + first_ + second_;
  stage_ = cloth::startBdf2(begin_, result_, first_, second_, &motion_, base_, result_.velocities);
  predicted_ = motion_.predict(begin_, result_.positions, first_, second_);
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
    result_.velocities[i] = (result_.positions[i] - base_.positions[i]) / a();
  }
  return true;
}

void Strip::linearise(linear::SymmetricBlockMatrix& matrix, linear::BlockVector& rhs) const {
  cloth::setInertia(cloth_, base_, result_.velocities, nullptr, matrix, rhs);
  cloth_.forces().assembleLinearised(of(result_.positions, result_.velocities), {a(), ahead_},
                                     matrix, rhs);
  eliminate(matrix, rhs);
}

void Strip::takeLinearised(const linear::BlockVector& solution) {
  for (std::size_t i = 0; i < held_particles_.size(); ++i) {
    result_.velocities[i] += solution.col(static_cast<int>(i));
    result_.positions[i] = base_.positions[i] + a() * result_.velocities[i];
  }
}

void Strip::hold() {
  cloth::ForceState state = of(result_.positions, result_.velocities);
  if (stage_.past.count > 0) state.past = &stage_.past;
  cloth_.forces().hold({base_.positions, state, a(), false}, held_.data());
}

void Strip::assembleNewton(cloth::Hessian hessian, linear::SymmetricBlockMatrix& matrix,
                           linear::BlockVector& rhs) const {
  cloth::setInertia(cloth_, base_, result_.velocities, nullptr, matrix, rhs);
  cloth_.forces().assembleNewton(of(result_.positions, result_.velocities), held_.data(), a(),
                                 hessian, matrix, rhs);
  eliminate(matrix, rhs);
}

double Strip::potential(const cloth::ClothState& at) const {
  return cloth_.forces().incrementalPotential(of(at.positions, at.velocities), held_.data(), a());
}

/// At the end of the stage, with what forces remember from the beginning of the step.
cloth::ForceState Strip::of(const cloth::Positions& positions,
                            const cloth::Velocities& velocities) const {
  return {positions, velocities, base_.time, base_.memory.data()};
}

void Strip::eliminate(linear::SymmetricBlockMatrix& matrix, linear::BlockVector& rhs) const {
  matrix.eliminate(held_particles_, unchanged_, rhs);
}

}  // namespace haptex::large
