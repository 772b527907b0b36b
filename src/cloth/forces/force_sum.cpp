#include "haptex/cloth/forces/force_sum.h"

#include <algorithm>
#include <iterator>

namespace haptex::cloth {

void ForceSum::addAll(ForceSum&& other) {
  std::move(other.forces_.begin(), other.forces_.end(), std::back_inserter(forces_));
  other.forces_.clear();
}

/// Calls with each force and the state with its own memory.
template <typename Call>
void ForceSum::forEach(const ForceState& state, Call&& call) const {
  const double* memory = state.memory;
  for (const auto& force : forces_) {
    ForceState its = state;
    its.memory = memory;
    call(*force, its);
    if (memory != nullptr) memory += force->memorySize();
  }
}

std::vector<std::array<int, 2>> ForceSum::pairs() const {
  std::vector<std::array<int, 2>> all;
  for (const auto& force : forces_) {
    const std::vector<std::array<int, 2>> pairs = force->pairs();
    all.insert(all.end(), pairs.begin(), pairs.end());
  }
  if (ties_ == nullptr) return all;
  const std::vector<std::array<int, 2>> of_ties = ties_->pairs(all);
  all.insert(all.end(), of_ties.begin(), of_ties.end());
  return all;
}

void ForceSum::bind(const linear::SymmetricBlockMatrix& matrix) {
  for (const auto& force : forces_) force->bind(matrix);
}

std::size_t ForceSum::memorySize() const {
  std::size_t size = 0;
  for (const auto& force : forces_) size += force->memorySize();
  return size;
}

std::vector<std::vector<int>> ForceSum::memoryOwners() const {
  std::vector<std::vector<int>> all;
  for (const auto& force : forces_) {
    for (std::vector<int>& owners : force->memoryOwners()) all.push_back(std::move(owners));
  }
  return all;
}

void ForceSum::forget(const Positions& positions, double* memory) const {
  for (const auto& force : forces_) {
    force->forget(positions, memory);
    memory += force->memorySize();
  }
}

void ForceSum::remember(const Positions& positions, double* memory) const {
  for (const auto& force : forces_) {
    force->remember(positions, memory);
    memory += force->memorySize();
  }
}

void ForceSum::addForces(const ForceState& state, std::vector<Eigen::Vector3d>& forces) const {
  addUntiedForces(state, forces);
  if (ties_ != nullptr) ties_->gather(forces);
}

void ForceSum::addUntiedForces(const ForceState& state,
                               std::vector<Eigen::Vector3d>& forces) const {
  forEach(state, [&](const Force& force, const ForceState& its) { force.addForces(its, forces); });
}

void ForceSum::addDrivenForces(const ForceState& state,
                               std::vector<Eigen::Vector3d>& forces) const {
  forEach(state, [&](const Force& force, const ForceState& its) {
    if (force.isDriven()) force.addForces(its, forces);
  });
  if (ties_ != nullptr) ties_->gather(forces);
}

double ForceSum::energy(const ForceState& state) const {
  double sum = 0.0;
  forEach(state, [&](const Force& force, const ForceState& its) { sum += force.energy(its); });
  return sum;
}

void ForceSum::addJacobian(const ForceState& state, JacobianRows& rows) const {
  const auto add_to = [&](JacobianRows& sum) {
    forEach(state, [&](const Force& force, const ForceState& its) { force.addJacobian(its, sum); });
  };
  if (ties_ == nullptr) return add_to(rows);
  JacobianRows untied(ties_->rowsBehind(rows));
  add_to(untied);
  ties_->gather(untied.blocks(), rows);
}

bool ForceSum::isDriven() const {
  return std::any_of(forces_.begin(), forces_.end(),
                     [](const auto& force) { return force->isDriven(); });
}

bool ForceSum::changesWithTime() const {
  return std::any_of(forces_.begin(), forces_.end(),
                     [](const auto& force) { return force->changesWithTime(); });
}

double ForceSum::drivingPower(const ForceState& state) const {
  double sum = 0.0;
  forEach(state,
          [&](const Force& force, const ForceState& its) { sum += force.drivingPower(its); });
  return sum;
}

void ForceSum::assembleLinearised(const ForceState& state, const StageTimes& times,
                                  linear::SymmetricBlockMatrix& matrix,
                                  linear::BlockVector& rhs) const {
  forEach(state, [&](const Force& force, const ForceState& its) {
    force.assembleLinearised(its, times, matrix, rhs);
  });
  if (ties_ != nullptr) ties_->gather(matrix, rhs);
}

std::size_t ForceSum::heldSize() const {
  std::size_t size = 0;
  for (const auto& force : forces_) size += force->heldSize();
  return size;
}

void ForceSum::hold(const NewtonStart& start, Eigen::Vector3d* held) const {
  forEach(start.at, [&](const Force& force, const ForceState& its) {
    force.hold({start.base, its, start.a, start.passive}, held);
    held += force.heldSize();
  });
}

void ForceSum::assembleNewton(const ForceState& state, const Eigen::Vector3d* held, double a,
                              Hessian hessian, linear::SymmetricBlockMatrix& matrix,
                              linear::BlockVector& rhs) const {
  forEach(state, [&](const Force& force, const ForceState& its) {
    force.assembleNewton(its, held, a, hessian, matrix, rhs);
    held += force.heldSize();
  });
  if (ties_ != nullptr) ties_->gather(matrix, rhs);
}

double ForceSum::incrementalPotential(const ForceState& state, const Eigen::Vector3d* held,
                                      double a) const {
  double sum = 0.0;
  forEach(state, [&](const Force& force, const ForceState& its) {
    sum += force.incrementalPotential(its, held, a);
    held += force.heldSize();
  });
  return sum;
}

}  // namespace haptex::cloth
