#include "haptex/cloth/forces/constant_forces.h"

#include <algorithm>
#include <stdexcept>

namespace haptex::cloth {

using Eigen::Vector3d;

ConstantForces::ConstantForces(std::vector<double> masses, const Vector3d& gravity)
    : masses_(std::move(masses)), gravity_(gravity), set_(masses_.size(), Vector3d::Zero()) {
  if (!gravity.allFinite()) {
    throw std::invalid_argument("gravity has a component that is not finite");
  }
}

void ConstantForces::set(int particle, const Vector3d& force) { set_[particle] = force; }

void ConstantForces::addForces(const ForceState& /*state*/, std::vector<Vector3d>& forces) const {
  for (std::size_t i = 0; i < masses_.size(); ++i) forces[i] += force(i);
}

double ConstantForces::energy(const ForceState& state) const {
  double energy = 0.0;
  for (std::size_t i = 0; i < masses_.size(); ++i) energy -= force(i).dot(state.positions[i]);
  return energy;
}

void ConstantForces::assembleLinearised(const ForceState& /*state*/, const StageTimes& times,
                                        linear::SymmetricBlockMatrix& /*matrix*/,
                                        linear::BlockVector& rhs) const {
  for (std::size_t i = 0; i < masses_.size(); ++i) {
    rhs.col(static_cast<Eigen::Index>(i)) += times.a * force(i);
  }
}

void ConstantForces::hold(const NewtonStart& start, Vector3d* held) const {
  std::copy(start.base.begin(), start.base.end(), held);
}

double ConstantForces::incrementalPotential(const ForceState& state, const Vector3d* held,
                                            double /*a*/) const {
  double potential = 0.0;
  for (std::size_t i = 0; i < masses_.size(); ++i) {
    potential -= force(i).dot(state.positions[i] - held[i]);
  }
  return potential;
}

}  // namespace haptex::cloth
