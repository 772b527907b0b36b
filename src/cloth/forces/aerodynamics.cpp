#include "haptex/cloth/forces/aerodynamics.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "haptex/base/require.h"
#include "haptex/cloth/forces/cross_matrix.h"

namespace haptex::cloth {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

void requireCoefficient(const char* name, double value) {
  if (!std::isfinite(value) || value < 0.0) {
    base::refuse("the ", name, " coefficient of the air is ", value,
                 "; it must be finite and at least 0");
  }
}

const Air& requireSound(const Air& air) {
  requireCoefficient("normal", air.coefficients.normal);
  requireCoefficient("tangential", air.coefficients.tangential);
  requireCoefficient("lift", air.coefficients.lift);
  if (!air.wind.mean.allFinite()) base::refuse("the wind has a component that is not finite");
  for (std::size_t i = 0; i < air.wind.gusts.size(); ++i) {
    const Gust& gust = air.wind.gusts[i];
    if (!gust.velocity.allFinite() || !std::isfinite(gust.phase)) {
      base::refuse("gust ", i, " of the wind has a number that is not finite");
    }
    if (!std::isfinite(gust.frequency) || gust.frequency < 0.0) {
      base::refuse("gust ", i, " of the wind has the frequency ", gust.frequency,
                   " Hz; it must be finite and at least 0");
    }
  }
  return air;
}

/// Normal times area (m^2) of a triangle.
Vector3d areaVector(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  return 0.5 * (b - a).cross(c - a);
}

Vector3d areaVector(const MembraneElement& element, const Positions& positions) {
  const auto& [a, b, c] = element.particles;
  return areaVector(positions[a], positions[b], positions[c]);
}

Vector3d meanVelocity(const MembraneElement& element, const Velocities& velocities) {
  const auto& [a, b, c] = element.particles;
  return (velocities[a] + velocities[b] + velocities[c]) / 3.0;
}

/// How the air flows past a triangle. All zero where it has no area.
struct Flow {
  Flow(const Vector3d& area_vector, const Vector3d& relative)
      : area(area_vector.norm()),
        normal(area > 0.0 ? Vector3d(area_vector / area) : Vector3d::Zero()),
        across(area > 0.0 ? normal.dot(relative) : 0.0),
        sliding(area > 0.0 ? Vector3d(relative - across * normal) : Vector3d::Zero()),
        along(sliding.norm()),
        speed(std::sqrt(across * across + along * along)),
        pressure(0.5 * kAirDensity * area) {}

  double area;       // m^2
  Vector3d normal;   // n
  double across;     // m, m/s
  Vector3d sliding;  // q t, m/s
  double along;      // q, m/s
  double speed;      // s, m/s
  double pressure;   // rho A / 2, kg/m

  /// t, or zero.
  Vector3d tangent() const { return along > 0.0 ? Vector3d(sliding / along) : Vector3d::Zero(); }
  Vector3d drag(const AirCoefficients& c) const {
    return -pressure *
           (c.normal * std::abs(across) * across * normal + c.tangential * along * sliding);
  }
  Vector3d lift(const AirCoefficients& c) const {
    if (speed == 0.0) return Vector3d::Zero();
    return -pressure * c.lift * across / speed * (along * along * normal - across * sliding);
  }
  /// Of which the drag is the negative gradient by the velocity (W).
  double dragPotential(const AirCoefficients& c) const {
    return pressure / 3.0 *
           (c.normal * std::abs(across) * across * across + c.tangential * along * along * along);
  }
};

/// The symmetric matrix with the entries nn, tt, nt in the plane of n and t and the principal value
/// `binormal` across it.
Matrix3d inFlowFrame(const Flow& flow, const Vector3d& in_plane, double binormal) {
  const Vector3d& n = flow.normal;
  const Vector3d t = flow.tangent();
  const Vector3d along_n = (in_plane[0] - binormal) * n + in_plane[2] * t;
  const Vector3d along_t = (in_plane[1] - binormal) * t + in_plane[2] * n;
  Matrix3d result = n * along_n.transpose() + t * along_t.transpose();
  result.diagonal().array() += binormal;
  return result;
}

/// Minus the derivative of the drag by the velocity: symmetric, positive semidefinite.
Matrix3d dragDamping(const Flow& flow, const AirCoefficients& c) {
  return flow.pressure *
         inFlowFrame(flow,
                     {2.0 * c.normal * std::abs(flow.across), 2.0 * c.tangential * flow.along, 0.0},
                     c.tangential * flow.along);
}

/// Minus the symmetric part of the derivative of the force by the velocity, projected to be
/// positive semidefinite.
Matrix3d projectedDamping(const Flow& flow, const AirCoefficients& c) {
  if (c.lift == 0.0 || flow.speed == 0.0) return dragDamping(flow, c);
  const double s = flow.speed, m = flow.across / s, q = flow.along / s;
  const double lift = c.lift * s;
  const Vector3d in_plane(2.0 * c.normal * std::abs(flow.across) + lift * q * q * q * q,
                          2.0 * c.tangential * flow.along - lift * m * m * m * m,
                          0.5 * lift * m * q * (m * m - q * q));
  const double binormal = c.tangential * flow.along - lift * m * m;
  return flow.pressure * inFlowFrame(flow, projectStress(in_plane), std::max(0.0, binormal));
}

/// Adds a times the damping of the element, which is alike for each pair of its corners.
void addDamping(const MembraneElement& element, const Matrix3d& block,
                linear::SymmetricBlockMatrix& matrix) {
  for (int particle : element.particles) matrix.diagonal(particle) += block;
  for (int slot : element.slots) matrix.lower(slot) += block;
}

/// dF/dw of the whole force.
Matrix3d derivativeByVelocity(const Flow& flow, const AirCoefficients& c) {
  const double m = flow.across, q = flow.along, s = flow.speed;
  if (s == 0.0) return Matrix3d::Zero();
  const double s3 = s * s * s;
  const Vector3d &n = flow.normal, t = flow.tangent();
  const Matrix3d in_plane = Matrix3d::Identity() - n * n.transpose();
  // F = -rho A / 2 (alpha m n + beta q t), and how alpha and beta change with m and q.
  const double alpha = c.normal * std::abs(m) + c.lift * q * q / s;
  const double beta = c.tangential * q - c.lift * m * m / s;
  const double alpha_m = std::copysign(c.normal, m) - c.lift * q * q * m / s3;
  const double alpha_q = c.lift * (2.0 * q / s - q * q * q / s3);
  const double beta_m = -c.lift * (2.0 * m / s - m * m * m / s3);
  const double beta_q = c.tangential + c.lift * m * m * q / s3;
  return -flow.pressure * (alpha * n * n.transpose() + beta * in_plane +
                           m * n * (alpha_m * n + alpha_q * t).transpose() +
                           flow.sliding * (beta_m * n + beta_q * t).transpose());
}

/// dF/dN, N = A n, at the same velocity.
Matrix3d derivativeByArea(const Flow& flow, const AirCoefficients& c) {
  const double m = flow.across, q = flow.along, s = flow.speed;
  if (s == 0.0 || flow.area == 0.0) return Matrix3d::Zero();
  const Vector3d &n = flow.normal, t = flow.tangent();
  const Matrix3d in_plane = Matrix3d::Identity() - n * n.transpose();
  const double alpha = c.normal * std::abs(m) + c.lift * q * q / s;
  const double beta = c.tangential * q - c.lift * m * m / s;
  // Turning the normal changes m by q t . dn; |w| stays.
  const double alpha_m = std::copysign(c.normal, m) - 2.0 * c.lift * m / s;
  const Vector3d turned =
      (alpha_m * m + alpha - beta) * n - c.tangential * m * t - 2.0 * c.lift * m / s * flow.sliding;
  return -0.5 * kAirDensity *
         ((alpha * m * n + beta * flow.sliding) * n.transpose() +
          turned * flow.sliding.transpose() + (alpha - beta) * m * in_plane);
}

}  // namespace

Vector3d Wind::velocity(double time) const {
  Vector3d sum = mean;
  for (const Gust& gust : gusts) {
    sum += std::sin(2.0 * M_PI * gust.frequency * time + gust.phase) * gust.velocity;
  }
  return sum;
}

bool Wind::isSteady() const {
  return std::all_of(gusts.begin(), gusts.end(), [](const Gust& gust) {
    return gust.frequency == 0.0 || gust.velocity.isZero(0.0);
  });
}

Aerodynamics::Aerodynamics(std::vector<MembraneElement> elements, const Air& air)
    : elements_(std::move(elements)), air_(requireSound(air)) {}

void Aerodynamics::bind(const linear::SymmetricBlockMatrix& matrix) {
  bindElements(matrix, elements_);
}

void Aerodynamics::addForces(const ForceState& state, std::vector<Vector3d>& forces) const {
  const Vector3d wind = air_.wind.velocity(state.time);
  for (const MembraneElement& element : elements_) {
    const Flow flow(areaVector(element, state.positions),
                    meanVelocity(element, state.velocities) - wind);
    const Vector3d share = (flow.drag(air_.coefficients) + flow.lift(air_.coefficients)) / 3.0;
    for (int particle : element.particles) forces[particle] += share;
  }
}

double Aerodynamics::drivingPower(const ForceState& state) const {
  const Vector3d wind = air_.wind.velocity(state.time);
  Vector3d force = Vector3d::Zero();
  for (const MembraneElement& element : elements_) {
    const Flow flow(areaVector(element, state.positions),
                    meanVelocity(element, state.velocities) - wind);
    force += flow.drag(air_.coefficients) + flow.lift(air_.coefficients);
  }
  return force.dot(wind);
}

void Aerodynamics::assembleLinearised(const ForceState& state, const StageTimes& times,
                                      linear::SymmetricBlockMatrix& matrix,
                                      linear::BlockVector& rhs) const {
  const Vector3d wind = air_.wind.velocity(state.time);
  for (const MembraneElement& element : elements_) {
    const auto place = [&](int corner) -> Vector3d {
      const int particle = element.particles[corner];
      return state.positions[particle] + times.ahead * state.velocities[particle];
    };
    const Flow flow(areaVector(place(0), place(1), place(2)),
                    meanVelocity(element, state.velocities) - wind);
    const Vector3d impulse =
        times.a / 3.0 * (flow.drag(air_.coefficients) + flow.lift(air_.coefficients));
    for (int particle : element.particles) rhs.col(particle) += impulse;
    addDamping(element, times.a / 9.0 * projectedDamping(flow, air_.coefficients), matrix);
  }
}

void Aerodynamics::hold(const NewtonStart& start, Vector3d* held) const {
  const Vector3d wind = air_.wind.velocity(start.at.time);
  held[0] = wind;
  for (std::size_t t = 0; t < elements_.size(); ++t) {
    const Vector3d area = areaVector(elements_[t], start.at.positions);
    const Flow flow(area, meanVelocity(elements_[t], start.at.velocities) - wind);
    held[1 + 2 * t] = area;
    held[2 + 2 * t] = start.passive ? Vector3d::Zero() : flow.lift(air_.coefficients);
  }
}

void Aerodynamics::assembleNewton(const ForceState& state, const Vector3d* held, double a,
                                  Hessian /*hessian*/, linear::SymmetricBlockMatrix& matrix,
                                  linear::BlockVector& rhs) const {
  const Vector3d& wind = held[0];
  for (std::size_t t = 0; t < elements_.size(); ++t) {
    const MembraneElement& element = elements_[t];
    const Vector3d &area = held[1 + 2 * t], &lift = held[2 + 2 * t];
    const Flow flow(area, meanVelocity(element, state.velocities) - wind);
    const Vector3d impulse = a / 3.0 * (flow.drag(air_.coefficients) + lift);
    for (int particle : element.particles) rhs.col(particle) += impulse;
    addDamping(element, a / 9.0 * dragDamping(flow, air_.coefficients), matrix);
  }
}

double Aerodynamics::incrementalPotential(const ForceState& state, const Vector3d* held,
                                          double a) const {
  const Vector3d& wind = held[0];
  double potential = 0.0;
  for (std::size_t t = 0; t < elements_.size(); ++t) {
    const Vector3d &area = held[1 + 2 * t], &lift = held[2 + 2 * t];
    const Vector3d velocity = meanVelocity(elements_[t], state.velocities);
    const Flow flow(area, velocity - wind);
    potential += flow.dragPotential(air_.coefficients) - lift.dot(velocity);
  }
  return a * potential;
}

void Aerodynamics::addJacobian(const ForceState& state, JacobianRows& rows) const {
  addElementJacobians(
      elements_,
      [&](const MembraneElement& element) {
        const Jacobian alike =
            exactJacobian(element, state.positions, state.velocities, state.time);
        ElementJacobian blocks;
        for (int i = 0; i < 3; ++i) {
          blocks.by_position[i] = alike.by_position;
          blocks.by_velocity[i].fill(alike.by_velocity);
        }
        return blocks;
      },
      rows);
}

Aerodynamics::Jacobian Aerodynamics::exactJacobian(const MembraneElement& element,
                                                   const Positions& positions,
                                                   const Velocities& velocities,
                                                   double time) const {
  const Flow flow(areaVector(element, positions),
                  meanVelocity(element, velocities) - air_.wind.velocity(time));
  Jacobian result;
  result.by_velocity = derivativeByVelocity(flow, air_.coefficients) / 9.0;
  const Matrix3d by_area = derivativeByArea(flow, air_.coefficients) / 3.0;
  for (int j = 0; j < 3; ++j) {
    const Vector3d opposite =
        positions[element.particles[(j + 2) % 3]] - positions[element.particles[(j + 1) % 3]];
    result.by_position[j] = by_area * crossMatrix(0.5 * opposite);
  }
  return result;
}

}  // namespace haptex::cloth
