#include "haptex/cloth/forces/spring_lattice.h"

#include <algorithm>

namespace haptex::cloth {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Kind = LatticeSpring::Kind;
using material::CurveValue;

Vector3d extent(const LatticeSpring& spring, const std::vector<Vector3d>& points) {
  return points[spring.second] - points[spring.first];
}

double strainOf(const LatticeSpring& spring, const Vector3d& extent) {
  return 0.5 * (extent.squaredNorm() * spring.inverse_rest_square - 1.0);
}

double pastStrain(const LatticeSpring& spring, const StrainPast& past) {
  return past.strain(
      [&](const Positions& positions) { return strainOf(spring, extent(spring, positions)); });
}

double rateOf(const LatticeSpring& spring, const Vector3d& extent, const Vector3d& opening) {
  return extent.dot(opening) * spring.inverse_rest_square;
}

/// The Hessian of a spring's energy by its extent.
Matrix3d tangent(const LatticeSpring& spring, const Vector3d& extent, const CurveValue& value) {
  const double factor = spring.area * spring.inverse_rest_square;
  Matrix3d result = factor * value.slope * spring.inverse_rest_square * extent * extent.transpose();
  result.diagonal().array() += factor * value.stress;
  return result;
}

/// The nearest positive semidefinite matrix: its eigenvalues across and along the spring clamped.
Matrix3d projectedTangent(const LatticeSpring& spring, const Vector3d& extent,
                          const CurveValue& value) {
  const double square = extent.squaredNorm();
  const double factor = spring.area * spring.inverse_rest_square;
  const double across = factor * std::max(value.stress, 0.0);
  const double along =
      factor * std::max(value.stress + value.slope * spring.inverse_rest_square * square, 0.0);
  Matrix3d result = Matrix3d::Zero();
  if (square > 0.0) result = ((along - across) / square) * extent * extent.transpose();
  result.diagonal().array() += across;
  return result;
}

void addBlock(const LatticeSpring& spring, const Matrix3d& block,
              linear::SymmetricBlockMatrix& matrix) {
  matrix.diagonal(spring.first) += block;
  matrix.diagonal(spring.second) += block;
  matrix.lower(spring.slot) -= block;
}

}  // namespace

CurveValue SpringLattice::Law::respond(const LatticeSpring& spring, double strain) const {
  const double scale = spring.scale;
  switch (spring.kind) {
    case Kind::kWeft:
    case Kind::kWarp: {
      const CurveValue own = curves[spring.kind == Kind::kWeft ? 0 : 1].evaluate(strain);
      const CurveValue up = curves[2].evaluate(scale * strain);
      const CurveValue down = curves[2].evaluate(-scale * strain);
      return {own.stress - 0.5 * scale * (up.stress - down.stress),
              own.slope - 0.5 * scale * scale * (up.slope + down.slope)};
    }
    case Kind::kShear: {
      const CurveValue shear = curves[2].evaluate(scale * strain);
      return {scale * shear.stress, scale * scale * shear.slope};
    }
    default: {
      const double modulus = scale * rigidity[spring.kind == Kind::kWeftBend ? 0 : 1];
      return {modulus * std::min(strain, 0.0), strain < 0.0 ? modulus : 0.0};
    }
  }
}

double SpringLattice::Law::energy(const LatticeSpring& spring, double strain) const {
  const double scale = spring.scale;
  switch (spring.kind) {
    case Kind::kWeft:
    case Kind::kWarp:
      return curves[spring.kind == Kind::kWeft ? 0 : 1].energy(strain) -
             0.5 * (curves[2].energy(scale * strain) + curves[2].energy(-scale * strain));
    case Kind::kShear:
      return curves[2].energy(scale * strain);
    default: {
      const double shortening = std::min(strain, 0.0);
      return 0.5 * scale * rigidity[spring.kind == Kind::kWeftBend ? 0 : 1] * shortening *
             shortening;
    }
  }
}

SpringLattice::SpringLattice(const mesh::ClothMesh& mesh, const material::Fabric& fabric,
                             bool viscosity, bool bend)
    : springs_(findLatticeSprings(mesh, bend)), viscosity_(viscosity) {
  if (bend) {
    const material::BendingRigidity& rigidity = fabric.bending.value();
    elastic_.rigidity = {rigidity.weft, rigidity.warp};
  }
  elastic_.curves = {fabric.weft.elastic, fabric.warp.elastic, fabric.shear.elastic};
  viscous_.curves = {fabric.weft.viscous, fabric.warp.viscous, fabric.shear.viscous};
}

std::vector<std::array<int, 2>> SpringLattice::pairs() const {
  std::vector<std::array<int, 2>> result;
  for (const LatticeSpring& spring : springs_) result.push_back({spring.first, spring.second});
  return result;
}

void SpringLattice::bind(const linear::SymmetricBlockMatrix& matrix) {
  for (LatticeSpring& spring : springs_) spring.slot = matrix.slot(spring.second, spring.first);
}

void SpringLattice::addForces(const ForceState& state, std::vector<Vector3d>& forces) const {
  for (const LatticeSpring& spring : springs_) {
    const Vector3d at = extent(spring, state.positions);
    double stress = elastic_.respond(spring, strainOf(spring, at)).stress;
    if (viscosity_) {
      const double rate =
          state.past != nullptr
              ? (strainOf(spring, at) - pastStrain(spring, *state.past)) / state.past->a
              : rateOf(spring, at, extent(spring, state.velocities));
      stress += viscous_.respond(spring, rate).stress;
    }
    const Vector3d pull = spring.area * spring.inverse_rest_square * stress * at;
    forces[spring.first] += pull;
    forces[spring.second] -= pull;
  }
}

double SpringLattice::energy(const ForceState& state) const {
  double energy = 0.0;
  for (const LatticeSpring& spring : springs_) {
    energy +=
        spring.area * elastic_.energy(spring, strainOf(spring, extent(spring, state.positions)));
  }
  return energy;
}

void SpringLattice::assembleLinearised(const ForceState& state, const StageTimes& times,
                                       linear::SymmetricBlockMatrix& matrix,
                                       linear::BlockVector& rhs) const {
  for (const LatticeSpring& spring : springs_) {
    const Vector3d at = extent(spring, state.positions);
    const Vector3d opening = extent(spring, state.velocities);
    CurveValue value = elastic_.respond(spring, strainOf(spring, at));
    double viscous_slope = 0.0;
    if (viscosity_) {
      const CurveValue viscous = viscous_.respond(spring, rateOf(spring, at, opening));
      value.stress += viscous.stress;
      viscous_slope = std::max(viscous.slope, 0.0);
    }
    // The damping acts along the spring alone, so that it is semidefinite by itself.
    const Matrix3d stiffness = projectedTangent(spring, at, value);
    const Matrix3d damping = tangent(spring, at, {0.0, viscous_slope});
    addBlock(spring, times.a * times.a * stiffness + times.a * damping, matrix);
    const Vector3d impulse =
        times.a * (spring.area * spring.inverse_rest_square * value.stress * at +
                   times.ahead * (stiffness * opening));
    rhs.col(spring.first) += impulse;
    rhs.col(spring.second) -= impulse;
  }
}

void SpringLattice::assembleNewton(const ForceState& state, const Vector3d* held, double a,
                                   Hessian hessian, linear::SymmetricBlockMatrix& matrix,
                                   linear::BlockVector& rhs) const {
  for (std::size_t s = 0; s < springs_.size(); ++s) {
    const LatticeSpring& spring = springs_[s];
    const Vector3d at = extent(spring, state.positions);
    const double strain = strainOf(spring, at);
    CurveValue value = elastic_.respond(spring, strain);
    if (viscosity_) {
      const double rate = (strain - held[s / 3][s % 3]) / a;
      const CurveValue viscous = viscous_.respond(spring, rate);
      value.stress += viscous.stress;
      value.slope += viscous.slope / a;
    }
    const bool exact = hessian == Hessian::kExact;
    addBlock(spring,
             a * a * (exact ? tangent(spring, at, value) : projectedTangent(spring, at, value)),
             matrix);
    const Vector3d impulse = a * spring.area * spring.inverse_rest_square * value.stress * at;
    rhs.col(spring.first) += impulse;
    rhs.col(spring.second) -= impulse;
  }
}

double SpringLattice::incrementalPotential(const ForceState& state, const Vector3d* held,
                                           double a) const {
  double potential = 0.0;
  for (std::size_t s = 0; s < springs_.size(); ++s) {
    const LatticeSpring& spring = springs_[s];
    const double strain = strainOf(spring, extent(spring, state.positions));
    double density = elastic_.energy(spring, strain);
    if (viscosity_) {
      density += a * viscous_.energy(spring, (strain - held[s / 3][s % 3]) / a);
    }
    potential += spring.area * density;
  }
  return potential;
}

void SpringLattice::hold(const NewtonStart& start, Vector3d* held) const {
  for (std::size_t s = 0; s < springs_.size(); ++s) {
    const LatticeSpring& spring = springs_[s];
    double& strain = held[s / 3][static_cast<Eigen::Index>(s % 3)];
    if (start.at.past != nullptr) {
      strain = pastStrain(spring, *start.at.past);
      continue;
    }
    const Vector3d at = extent(spring, start.at.positions);
    const Vector3d opening = extent(spring, start.at.velocities);
    strain = strainOf(spring, at) - start.a * rateOf(spring, at, opening);
  }
}

void SpringLattice::addJacobian(const ForceState& state, JacobianRows& rows) const {
  for (const LatticeSpring& spring : springs_) {
    if (!rows.asksFor(spring.first) && !rows.asksFor(spring.second)) continue;
    const auto [by_position, by_velocity] =
        exactJacobian(spring, state.positions, state.velocities);
    for (const auto& [row, other] :
         {std::pair(spring.first, spring.second), std::pair(spring.second, spring.first)}) {
      rows.add(row, row, by_position, by_velocity);
      rows.add(row, other, -by_position, -by_velocity);
    }
  }
}

SpringLattice::Jacobian SpringLattice::exactJacobian(const LatticeSpring& spring,
                                                     const Positions& positions,
                                                     const Velocities& velocities) const {
  const Vector3d at = extent(spring, positions);
  CurveValue value = elastic_.respond(spring, strainOf(spring, at));
  double viscous_slope = 0.0;
  Vector3d opening = Vector3d::Zero();
  if (viscosity_) {
    opening = extent(spring, velocities);
    const CurveValue viscous = viscous_.respond(spring, rateOf(spring, at, opening));
    value.stress += viscous.stress;
    viscous_slope = viscous.slope;
  }
  // The strain rate depends on the position, too.
  const Matrix3d rate_by_position = viscous_slope * spring.area * spring.inverse_rest_square *
                                    spring.inverse_rest_square * at * opening.transpose();
  return {-tangent(spring, at, value) - rate_by_position,
          -tangent(spring, at, {0.0, viscous_slope})};
}

}  // namespace haptex::cloth
