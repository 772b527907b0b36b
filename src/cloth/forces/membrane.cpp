#include "haptex/cloth/forces/membrane.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "haptex/cloth/forces/element_assembly.h"
#include "haptex/linear/shared_rows.h"
#include "haptex/material/contraction.h"

namespace haptex::cloth {

using Eigen::Matrix3d;
using Eigen::Vector3d;

struct Membrane::Frame : ElementFrame {
  MembraneStrain strain() const { return greenStrain(*this); }
  MembraneStrain rate(const Frame& derivative) const { return greenStrainRate(*this, derivative); }
};

struct Membrane::Response {
  Vector3d stress;
  Vector3d slope;
  double coupling = 0.0;  // of the weft's stress and the warp's strain, and the other way round
};

namespace {

kernels::MembraneBatch batchOf(const MembraneElement* elements) {
  kernels::MembraneBatch batch;
  for (int lane = 0; lane < kernels::kBatch; ++lane) {
    const MembraneElement& element = elements[lane];
    batch.area[lane] = element.area;
    for (int i = 0; i < 3; ++i) {
      batch.particles[i][lane] = element.particles[i];
      batch.slots[i][lane] = element.slots[i];
    }
    for (int i = 1; i < 3; ++i) {
      batch.weft_weights[i - 1][lane] = element.weft_weights[i];
      batch.warp_weights[i - 1][lane] = element.warp_weights[i];
    }
  }
  return batch;
}

Vector3d clampedToNonNegative(const Vector3d& slope) { return slope.cwiseMax(0.0); }

MembraneStrain pastStrain(const MembraneElement& element, const StrainPast& past) {
  return past.strain([&](const Positions& positions) { return greenStrain(element, positions); });
}

/// Makes the tangent [[slope0, coupling], [coupling, slope1]] and the slope of the shear positive
/// semidefinite.
void projectMaterial(Vector3d& slope, double& coupling) {
  if (coupling == 0.0) {
    slope = clampedToNonNegative(slope);
    return;
  }
  const Vector3d projected = projectStress({slope[0], slope[1], coupling});
  slope = {projected[0], projected[1], std::max(0.0, slope[2])};
  coupling = projected[2];
}

}  // namespace

Membrane::Membrane(std::vector<MembraneElement> elements, const material::Fabric& fabric,
                   bool viscosity, bool contraction)
    : elements_(std::move(elements)),
      elastic_{fabric.weft.elastic, fabric.warp.elastic, fabric.shear.elastic},
      viscous_{fabric.weft.viscous, fabric.warp.viscous, fabric.shear.viscous},
      viscosity_(viscosity),
      coupling_(contraction ? material::contractionModulus(fabric) : 0.0) {}

void Membrane::bind(const linear::SymmetricBlockMatrix& matrix) {
  bindElements(matrix, elements_);
  std::vector<kernels::MembraneBatch> batches;
  if (kernels::canAddBatches()) {
    for (std::size_t t = 0; t + kernels::kBatch <= elements_.size(); t += kernels::kBatch) {
      batches.push_back(batchOf(&elements_[t]));
    }
  }
  batches_.assign(std::move(batches));
}

Membrane::Frame Membrane::frame(const MembraneElement& element,
                                const std::vector<Vector3d>& points) {
  return {elementFrame(element, points)};
}

Membrane::Response Membrane::respond(const Curves& curves, const MembraneStrain& strain) {
  const material::CurveValue weft = curves[0].evaluate(strain[0]);
  const material::CurveValue warp = curves[1].evaluate(strain[1]);
  const material::CurveValue shear = curves[2].evaluate(strain[2]);
  return {{weft.stress, warp.stress, shear.stress}, {weft.slope, warp.slope, shear.slope}};
}

Membrane::Response Membrane::respondElastic(const MembraneStrain& strain) const {
  Response response = respond(elastic_, strain);
  response.stress[0] += coupling_ * strain[1];
  response.stress[1] += coupling_ * strain[0];
  response.coupling = coupling_;
  return response;
}

kernels::MembraneLaw Membrane::law(bool viscosity) const {
  return {&elastic_, viscosity ? &viscous_ : nullptr, coupling_};
}

/// Energy per rest area (J/m^2).
double Membrane::elasticDensity(const MembraneStrain& strain) const {
  double density = coupling_ * strain[0] * strain[1];
  for (int m = 0; m < 3; ++m) density += elastic_[m].energy(strain[m]);
  return density;
}

/// Rate of strain (1/s). @param at frame of the positions
MembraneStrain Membrane::rateIn(const MembraneElement& element, const ForceState& state,
                                const Frame& at) {
  if (state.past == nullptr) return at.rate(frame(element, state.velocities));
  return (at.strain() - pastStrain(element, *state.past)) / state.past->a;
}

void Membrane::addForces(const ForceState& state, std::vector<Vector3d>& forces) const {
  for (const MembraneElement& element : elements_) {
    const Frame at = frame(element, state.positions);
    Vector3d stress = respondElastic(at.strain()).stress;
    if (viscosity_) stress += respond(viscous_, rateIn(element, state, at)).stress;
    stress *= -element.area;
    addScattered(element, stress[0] * at.weft + stress[2] * at.warp,
                 stress[1] * at.warp + stress[2] * at.weft,
                 [&](int particle) -> Vector3d& { return forces[particle]; });
  }
}

double Membrane::energy(const ForceState& state) const {
  const Positions& positions = state.positions;
  double energy = kernels::potential(batches_, state, nullptr, 0.0, law(false));
  for (std::size_t t = batchedCount(); t < elements_.size(); ++t) {
    energy += elements_[t].area * elasticDensity(frame(elements_[t], positions).strain());
  }
  return energy;
}

void Membrane::assembleLinearised(const ForceState& state, const StageTimes& times,
                                  linear::SymmetricBlockMatrix& matrix,
                                  linear::BlockVector& rhs) const {
  const Positions& positions = state.positions;
  const Velocities& velocities = state.velocities;
  kernels::addStep(batches_, state, times, law(viscosity_), matrix, rhs);
  for (std::size_t t = batchedCount(); t < elements_.size(); ++t) {
    if (viscosity_) {
      assembleElement<true>(elements_[t], positions, velocities, times, matrix, rhs);
    } else {
      assembleElement<false>(elements_[t], positions, velocities, times, matrix, rhs);
    }
  }
}

template <bool kViscous>
void Membrane::assembleElement(const MembraneElement& element, const Positions& positions,
                               const Velocities& velocities, const StageTimes& times,
                               linear::SymmetricBlockMatrix& matrix,
                               linear::BlockVector& rhs) const {
  const Frame at = frame(element, positions);
  const Frame derivative = frame(element, velocities);
  const MembraneStrain rate = at.rate(derivative);
  auto [stress, slope, coupling] = respondElastic(at.strain());
  projectMaterial(slope, coupling);
  const Vector3d stress_increment =
      times.ahead * (slope.cwiseProduct(rate) + coupling * Vector3d(rate[1], rate[0], 0.0));
  if constexpr (kViscous) {
    const Response viscous = respond(viscous_, rate);
    stress += viscous.stress;
    slope += clampedToNonNegative(viscous.slope) / times.a;
  }
  const Vector3d geometric = projectStress(stress);
  addTangent(element, at, slope, coupling, geometric, element.area * times.a * times.a, matrix);

  const double factor = -element.area * times.a;
  const Vector3d end = factor * (stress + stress_increment);
  const Vector3d turning = factor * times.ahead * geometric;
  addScattered(element,
               end[0] * at.weft + end[2] * at.warp + turning[0] * derivative.weft +
                   turning[2] * derivative.warp,
               end[1] * at.warp + end[2] * at.weft + turning[1] * derivative.warp +
                   turning[2] * derivative.weft,
               [&](int particle) { return rhs.col(particle); });
}

void Membrane::assembleNewton(const ForceState& state, const Vector3d* held, double a,
                              Hessian hessian, linear::SymmetricBlockMatrix& matrix,
                              linear::BlockVector& rhs) const {
  kernels::addNewton(batches_, state, held, a, hessian, law(viscosity_), matrix, rhs);
  for (std::size_t t = batchedCount(); t < elements_.size(); ++t) {
    const MembraneElement& element = elements_[t];
    const Frame at = frame(element, state.positions);
    const MembraneStrain strain = at.strain();
    auto [stress, slope, coupling] = respondElastic(strain);
    if (viscosity_) {
      const Response viscous = respond(viscous_, (strain - held[t]) / a);
      stress += viscous.stress;
      slope += viscous.slope / a;
    }
    const bool exact = hessian == Hessian::kExact;
    if (!exact) projectMaterial(slope, coupling);
    addTangent(element, at, slope, coupling, exact ? stress : projectStress(stress),
               element.area * a * a, matrix);
    stress *= -element.area * a;
    addScattered(element, stress[0] * at.weft + stress[2] * at.warp,
                 stress[1] * at.warp + stress[2] * at.weft,
                 [&](int particle) { return rhs.col(particle); });
  }
}

double Membrane::incrementalPotential(const ForceState& state, const Vector3d* held,
                                      double a) const {
  double potential = kernels::potential(batches_, state, held, a, law(viscosity_));
  for (std::size_t t = batchedCount(); t < elements_.size(); ++t) {
    const MembraneStrain strain = frame(elements_[t], state.positions).strain();
    double density = elasticDensity(strain);
    for (int m = 0; viscosity_ && m < 3; ++m) {
      density += a * viscous_[m].energy((strain[m] - held[t][m]) / a);
    }
    potential += elements_[t].area * density;
  }
  return potential;
}

void Membrane::hold(const NewtonStart& start, Vector3d* held) const {
  linear::shareRows(start.at.pool, static_cast<int>(elements_.size()), [&](int begin, int end) {
    for (int t = begin; t < end; ++t) {
      if (start.at.past != nullptr) {
        held[t] = pastStrain(elements_[t], *start.at.past);
        continue;
      }
      const Frame at = frame(elements_[t], start.at.positions);
      held[t] = at.strain() - start.a * at.rate(frame(elements_[t], start.at.velocities));
    }
  });
}

void Membrane::addJacobian(const ForceState& state, JacobianRows& rows) const {
  addElementJacobians(
      elements_,
      [&](const MembraneElement& element) {
        return exactJacobian(element, state.positions, state.velocities);
      },
      rows);
}

ElementJacobian Membrane::exactJacobian(const MembraneElement& element, const Positions& positions,
                                        const Velocities& velocities) const {
  const Frame at = frame(element, positions);
  auto [stress, slope, coupling] = respondElastic(at.strain());
  Matrix3d tangent = slope.asDiagonal();
  tangent(0, 1) = tangent(1, 0) = coupling;
  Vector3d viscous_slope = Vector3d::Zero();
  Frame derivative{{Vector3d::Zero(), Vector3d::Zero()}};
  if (viscosity_) {
    derivative = frame(element, velocities);
    const Response viscous = respond(viscous_, at.rate(derivative));
    stress += viscous.stress;
    viscous_slope = viscous.slope;
  }
  // The derivative of a strain by the position is also that of its rate by the velocity.
  ElementJacobian result;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const Matrix3d g_i = -element.area * strainGradients(element, at, i);
      const Matrix3d g_j = strainGradients(element, at, j);
      const double geometric = -element.area * geometricStiffness(element, stress, i, j);
      result.by_velocity[i][j] = g_i * viscous_slope.asDiagonal() * g_j.transpose();
      result.by_position[i][j] =
          g_i * tangent * g_j.transpose() +
          g_i * viscous_slope.asDiagonal() * strainGradients(element, derivative, j).transpose() +
          geometric * Matrix3d::Identity();
    }
  }
  return result;
}

}  // namespace haptex::cloth
