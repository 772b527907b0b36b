#include "haptex/cloth/forces/force.h"

namespace haptex::cloth {

void Force::bind(const linear::SymmetricBlockMatrix& /*matrix*/) {}
void Force::forget(const Positions& /*positions*/, double* /*memory*/) const {}
void Force::remember(const Positions& /*positions*/, double* /*memory*/) const {}
double Force::drivingPower(const ForceState& /*state*/) const { return 0.0; }
void Force::hold(const NewtonStart& /*start*/, Eigen::Vector3d* /*held*/) const {}

void Force::assembleNewton(const ForceState& state, const Eigen::Vector3d* /*held*/, double a,
                           Hessian /*hessian*/, linear::SymmetricBlockMatrix& matrix,
                           linear::BlockVector& rhs) const {
  assembleLinearised(state, {a, 0.0}, matrix, rhs);
}

double Force::incrementalPotential(const ForceState& state, const Eigen::Vector3d* /*held*/,
                                   double /*a*/) const {
  return energy(state);
}

}  // namespace haptex::cloth
