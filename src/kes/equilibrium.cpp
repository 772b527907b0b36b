#include "haptex/kes/equilibrium.h"

#include <algorithm>
#include <stdexcept>

#include "haptex/base/quantity.h"

namespace haptex::kes {

cloth::StepSettings solvedSettings(double newton_tolerance) {
  cloth::StepSettings settings;
  settings.solver = linear::LinearSolverMethod::kCholesky;
  settings.tolerance = 1e-9;
  settings.newton_iterations = 100;
  settings.newton_tolerance = newton_tolerance;
  return settings;
}

Equilibrium::Equilibrium(const cloth::Cloth& cloth) : integrator_(cloth, solvedSettings(1e-13)) {}

void Equilibrium::settle(const cloth::Cloth& cloth, cloth::ClothState& state, double first_step) {
  constexpr double kLongestStep = 60.0;  // s
  constexpr int kMaxSteps = 60;
  double time_step = first_step;
  state.velocities.assign(cloth.particleCount(), Eigen::Vector3d::Zero());
  for (int i = 0; i < kMaxSteps; ++i) {
    integrator_.step(cloth, state, time_step);
    // Without velocities: viscosity may balance for a while what is no equilibrium.
    state.velocities.assign(cloth.particleCount(), Eigen::Vector3d::Zero());
    cloth.computeForces(state, forces_);
    if (isBalanced(cloth)) return;
    time_step = std::max(first_step, std::min(2.0 * time_step, kLongestStep));
  }
  throw std::runtime_error("no static equilibrium was found");
}

bool Equilibrium::isBalanced(const cloth::Cloth& cloth) const {
  constexpr double kUnbalanced = 1e-9;  // of the largest force
  constexpr double kNoForce = 1e-11;    // N, near the rounding of the stiffest elements
  double largest = 0.0, largest_free = 0.0;
  for (std::size_t i = 0; i < forces_.size(); ++i) {
    const double force = forces_[i].norm();
    largest = base::largerOrNaN(largest, force);
    if (!cloth.attachments()[i]) largest_free = base::largerOrNaN(largest_free, force);
  }
  return largest_free <= std::max(kUnbalanced * largest, kNoForce);
}

}  // namespace haptex::kes
