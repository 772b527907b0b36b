#include "haptex/cloth/forces/corotational.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "haptex/cloth/forces/element_assembly.h"

namespace haptex::cloth {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
/// Changes of U and then of V, each along the axes of Polar::frame.
using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Gradients = Eigen::Matrix<double, 6, 3>;  // of the three strains, by column

/// [U V] = R S with orthonormal columns of R and S symmetric, in closed form:
///   S = (C + det I) / trace,  C = [U V]^T [U V],  R = ([U V] + [V x n, n x U]) / trace.
struct Polar {
  explicit Polar(const ElementFrame& f) {
    constexpr double kFlat = std::numeric_limits<double>::min();
    const Vector3d cross = f.weft.cross(f.warp);
    det = cross.norm();
    // A flattened element has no normal, one that is a point not even a trace: zero for both.
    const Vector3d normal = det > kFlat ? Vector3d(cross / det) : Vector3d::Zero();
    const double uu = f.weft.squaredNorm(), vv = f.warp.squaredNorm();
    trace = std::sqrt(uu + vv + 2.0 * det);
    inverse_trace = trace > kFlat ? 1.0 / trace : 0.0;
    weft = (uu + det) * inverse_trace;
    warp = (vv + det) * inverse_trace;
    off = f.weft.dot(f.warp) * inverse_trace;
    frame << (f.weft + f.warp.cross(normal)) * inverse_trace,
        (f.warp + normal.cross(f.weft)) * inverse_trace, normal;
  }

  MembraneStrain strain() const { return {weft - 1.0, warp - 1.0, 2.0 * off}; }

  Vector6d local(const ElementFrame& change) const {
    Vector6d result;
    result << frame.transpose() * change.weft, frame.transpose() * change.warp;
    return result;
  }

  /// The turn in the plane, w with R^T dF = w J S + dS, J = [0 -1; 1 0].
  Vector6d turn() const {
    Vector6d result = Vector6d::Zero();
    result[1] = inverse_trace;
    result[3] = -inverse_trace;
    return result;
  }

  Gradients gradients() const {
    const double a = weft * inverse_trace, b = off * inverse_trace, c = warp * inverse_trace;
    Gradients result = Gradients::Zero();
    result.col(0) << 1.0, b, 0.0, -b, 0.0, 0.0;
    result.col(1) << 0.0, -b, 0.0, b, 1.0, 0.0;
    result.col(2) << 0.0, 2.0 * c, 0.0, 2.0 * a, 0.0, 0.0;
    return result;
  }

  double det, trace, inverse_trace;
  double weft, warp, off;  // S11, S22, S12
  Matrix3d frame;          // columns: R, unit normal
};

/// The second derivative of stress . strain, the stress held fixed. By a turn w in the plane,
/// strains e and what the normals of U and V move by, m, it is
///   along_turn w^2 + 2 w coupling . e + m . normal m.
struct Geometric {
  Geometric(const Polar& p, const Vector3d& s) {
    const double a = p.weft, b = p.off, c = p.warp;
    // s . dS/dw for [U V] = wJS + dS, over the trace: what symmetry of S asks of the turn.
    const double moment = (s[2] * (a - c) + b * (s[1] - s[0])) * p.inverse_trace;
    along_turn = s[0] * a + s[1] * c + 2.0 * s[2] * b;
    coupling = {moment - s[2], moment + s[2], 0.5 * (s[0] - s[1])};
    const double inverse_det =
        1.0 / std::max(p.det, std::numeric_limits<double>::epsilon() * p.trace * p.trace +
                                  std::numeric_limits<double>::min());
    normal =
        inverse_det * Vector3d(s[0] * c - s[2] * b + moment * b, s[1] * a - s[2] * b - moment * b,
                               0.5 * (s[2] * p.trace - b * (s[0] + s[1]) - moment * (a - c)));
  }

  double along_turn;
  Vector3d coupling;
  Vector3d normal;  // entries 00, 11, 01
};

/// gradients diag(slope) gradients^T and the geometric part.
Matrix6d assemble(const Polar& polar, const Gradients& gradients, const Vector3d& slope,
                  const Geometric& geometric) {
  const Vector6d turn = polar.turn();
  const Vector6d coupling = gradients * geometric.coupling;
  Matrix6d result = gradients * slope.asDiagonal() * gradients.transpose() +
                    geometric.along_turn * turn * turn.transpose() + turn * coupling.transpose() +
                    coupling * turn.transpose();
  result(2, 2) += geometric.normal[0];
  result(5, 5) += geometric.normal[1];
  result(2, 5) += geometric.normal[2];
  result(5, 2) += geometric.normal[2];
  return result;
}

/// Makes assemble() positive semidefinite. With the turn w and the strains e as variables the form
/// in the plane is that exactly when along_turn >= sum coupling^2 / slope.
void project(Geometric& geometric, Vector3d& slope) {
  slope = slope.cwiseMax(0.0);
  geometric.along_turn = std::max(geometric.along_turn, 0.0);
  geometric.normal = projectStress(geometric.normal);
  double needed = 0.0;
  for (int m = 0; m < 3; ++m) {
    if (slope[m] > 0.0) {
      needed += geometric.coupling[m] * geometric.coupling[m] / slope[m];
    } else {
      geometric.coupling[m] = 0.0;
    }
  }
  if (needed > geometric.along_turn) geometric.coupling *= std::sqrt(geometric.along_turn / needed);
}

/// Adds factor * the tangent, given along the axes of the frame.
void addTangent(const MembraneElement& element, const Matrix3d& frame, const Matrix6d& tangent,
                double factor, linear::SymmetricBlockMatrix& matrix) {
  const auto turned = [&](int row, int column) -> Matrix3d {
    return factor * frame * tangent.block<3, 3>(row, column) * frame.transpose();
  };
  const Matrix3d weft = turned(0, 0), warp = turned(3, 3), across = turned(0, 3);
  const auto block = [&](int i, int j) -> Matrix3d {
    const double ru_i = element.weft_weights[i], ru_j = element.weft_weights[j];
    const double rv_i = element.warp_weights[i], rv_j = element.warp_weights[j];
    return ru_i * ru_j * weft + rv_i * rv_j * warp + ru_i * rv_j * across +
           rv_i * ru_j * across.transpose();
  };
  addElementBlocks(element, block, matrix);
}

template <typename Target>
void addTraction(const MembraneElement& element, const Matrix3d& frame, const Vector6d& traction,
                 Target&& target) {
  addScattered(element, frame * traction.head<3>(), frame * traction.tail<3>(), target);
}

/// The second derivative of the strains by two changes of U and V, contracted with one of them.
Gradients secondDerivative(const Polar& polar, const Gradients& gradients, const Vector6d& by) {
  Gradients result;
  for (int m = 0; m < 3; ++m) {
    const Geometric geometric(polar, Vector3d::Unit(m));
    result.col(m) = assemble(polar, gradients, Vector3d::Zero(), geometric) * by;
  }
  return result;
}

Vector3d slopesAtZero(const std::array<const material::StrainStressCurve*, 3>& curves) {
  return {curves[0]->evaluate(0.0).slope, curves[1]->evaluate(0.0).slope,
          curves[2]->evaluate(0.0).slope};
}

}  // namespace

Corotational::Corotational(std::vector<MembraneElement> elements, const material::Fabric& fabric,
                           bool viscosity)
    : elements_(std::move(elements)),
      elastic_(slopesAtZero({&fabric.weft.elastic, &fabric.warp.elastic, &fabric.shear.elastic})),
      viscous_(Vector3d::Zero()) {
  if (!viscosity) return;
  viscous_ = slopesAtZero({&fabric.weft.viscous, &fabric.warp.viscous, &fabric.shear.viscous});
}

MembraneStrain Corotational::strain(const MembraneElement& element,
                                    const Positions& positions) const {
  return Polar(elementFrame(element, positions)).strain();
}

MembraneStrain Corotational::strain(const MembraneElement& element, const StrainPast& past) const {
  return past.strain([&](const Positions& positions) { return strain(element, positions); });
}

void Corotational::bind(const linear::SymmetricBlockMatrix& matrix) {
  bindElements(matrix, elements_);
}

void Corotational::addForces(const ForceState& state, std::vector<Vector3d>& forces) const {
  for (const MembraneElement& element : elements_) {
    const Polar polar(elementFrame(element, state.positions));
    const Gradients gradients = polar.gradients();
    Vector3d rate;
    if (state.past != nullptr) {
      rate = (polar.strain() - strain(element, *state.past)) / state.past->a;
    } else {
      rate = gradients.transpose() * polar.local(elementFrame(element, state.velocities));
    }
    const Vector3d stress = elastic_.cwiseProduct(polar.strain()) + viscous_.cwiseProduct(rate);
    addTraction(element, polar.frame, -element.area * gradients * stress,
                [&](int particle) -> Vector3d& { return forces[particle]; });
  }
}

double Corotational::energy(const ForceState& state) const {
  double energy = 0.0;
  for (const MembraneElement& element : elements_) {
    const MembraneStrain e = strain(element, state.positions);
    energy += 0.5 * element.area * e.dot(elastic_.cwiseProduct(e));
  }
  return energy;
}

void Corotational::assembleLinearised(const ForceState& state, const StageTimes& times,
                                      linear::SymmetricBlockMatrix& matrix,
                                      linear::BlockVector& rhs) const {
  for (const MembraneElement& element : elements_) {
    const Polar polar(elementFrame(element, state.positions));
    const Gradients gradients = polar.gradients();
    const Vector6d motion = polar.local(elementFrame(element, state.velocities));
    const Vector3d rate = gradients.transpose() * motion;
    const Vector3d stress = elastic_.cwiseProduct(polar.strain()) + viscous_.cwiseProduct(rate);
    Geometric geometric(polar, stress);
    Vector3d slope = elastic_ + viscous_ / times.a;
    project(geometric, slope);
    const Matrix6d tangent = assemble(polar, gradients, slope, geometric);
    addTangent(element, polar.frame, tangent, element.area * times.a * times.a, matrix);
    // K is the elastic part of the tangent: without the viscous slopes.
    const Vector3d elastic = elastic_.cwiseMax(0.0);
    const Vector6d ahead =
        (tangent - gradients * (slope - elastic).asDiagonal() * gradients.transpose()) * motion;
    const Vector6d traction = gradients * stress + times.ahead * ahead;
    addTraction(element, polar.frame, -element.area * times.a * traction,
                [&](int particle) { return rhs.col(particle); });
  }
}

void Corotational::assembleNewton(const ForceState& state, const Vector3d* held, double a,
                                  Hessian hessian, linear::SymmetricBlockMatrix& matrix,
                                  linear::BlockVector& rhs) const {
  for (std::size_t t = 0; t < elements_.size(); ++t) {
    const MembraneElement& element = elements_[t];
    const Polar polar(elementFrame(element, state.positions));
    const Gradients gradients = polar.gradients();
    const MembraneStrain strain = polar.strain();
    const Vector3d stress =
        elastic_.cwiseProduct(strain) + viscous_.cwiseProduct(strain - held[t]) / a;
    Geometric geometric(polar, stress);
    Vector3d slope = elastic_ + viscous_ / a;
    if (hessian == Hessian::kProjected) project(geometric, slope);
    addTangent(element, polar.frame, assemble(polar, gradients, slope, geometric),
               element.area * a * a, matrix);
    addTraction(element, polar.frame, -element.area * a * gradients * stress,
                [&](int particle) { return rhs.col(particle); });
  }
}

double Corotational::incrementalPotential(const ForceState& state, const Vector3d* held,
                                          double a) const {
  double potential = 0.0;
  for (std::size_t t = 0; t < elements_.size(); ++t) {
    const MembraneStrain end = strain(elements_[t], state.positions);
    const MembraneStrain change = end - held[t];
    potential +=
        0.5 * elements_[t].area *
        (end.dot(elastic_.cwiseProduct(end)) + change.dot(viscous_.cwiseProduct(change)) / a);
  }
  return potential;
}

void Corotational::hold(const NewtonStart& start, Vector3d* held) const {
  for (std::size_t t = 0; t < elements_.size(); ++t) {
    if (start.at.past != nullptr) {
      held[t] = strain(elements_[t], *start.at.past);
      continue;
    }
    const Polar polar(elementFrame(elements_[t], start.at.positions));
    const Vector6d motion = polar.local(elementFrame(elements_[t], start.at.velocities));
    held[t] = polar.strain() - start.a * (polar.gradients().transpose() * motion);
  }
}

void Corotational::addJacobian(const ForceState& state, JacobianRows& rows) const {
  addElementJacobians(
      elements_,
      [&](const MembraneElement& element) {
        return exactJacobian(element, state.positions, state.velocities);
      },
      rows);
}

ElementJacobian Corotational::exactJacobian(const MembraneElement& element,
                                            const Positions& positions,
                                            const Velocities& velocities) const {
  const Polar polar(elementFrame(element, positions));
  const Gradients gradients = polar.gradients();
  const Vector6d motion = polar.local(elementFrame(element, velocities));
  const Vector3d stress =
      elastic_.cwiseProduct(polar.strain()) + viscous_.cwiseProduct(gradients.transpose() * motion);
  Matrix6d by_position = assemble(polar, gradients, elastic_, Geometric(polar, stress));
  // The strain rate depends on the position, too.
  by_position +=
      gradients * viscous_.asDiagonal() * secondDerivative(polar, gradients, motion).transpose();
  const Matrix6d by_velocity = gradients * viscous_.asDiagonal() * gradients.transpose();
  ElementJacobian result;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const auto share = [&](const Matrix6d& tangent) -> Matrix3d {
        const double ru_i = element.weft_weights[i], ru_j = element.weft_weights[j];
        const double rv_i = element.warp_weights[i], rv_j = element.warp_weights[j];
        const Matrix3d local = ru_i * ru_j * tangent.topLeftCorner<3, 3>() +
                               ru_i * rv_j * tangent.topRightCorner<3, 3>() +
                               rv_i * ru_j * tangent.bottomLeftCorner<3, 3>() +
                               rv_i * rv_j * tangent.bottomRightCorner<3, 3>();
        return -element.area * polar.frame * local * polar.frame.transpose();
      };
      result.by_position[i][j] = share(by_position);
      result.by_velocity[i][j] = share(by_velocity);
    }
  }
  return result;
}

}  // namespace haptex::cloth
