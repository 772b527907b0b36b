#include "haptex/cloth/forces/cells/bilinear_cells.h"

#include <algorithm>
#include <cmath>

#include "haptex/cloth/forces/membrane_kernel.h"
#include "haptex/linear/shared_rows.h"

namespace haptex::cloth {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

using Distances = Eigen::Matrix<double, 3, 6>;   // m, of the first end from the second
using Gradients = Eigen::Matrix<double, 12, 6>;  // of the six strains by the particles, 1/m

Distances distancesIn(const BilinearCell& cell, const std::vector<Vector3d>& points) {
  Distances result;
  for (int e = 0; e < 6; ++e) {
    result.col(e) =
        points[cell.particles[kCellDistances[e][0]]] - points[cell.particles[kCellDistances[e][1]]];
  }
  return result;
}

CellStrain strainOf(const BilinearCell& cell, const Distances& at) {
  const CellStrain squares = at.colwise().squaredNorm().transpose();
  return cell.by_squares * (squares - cell.rest_squares);
}

CellStrain pastStrain(const BilinearCell& cell, const StrainPast& past) {
  return past.strain(
      [&](const Positions& positions) { return strainOf(cell, distancesIn(cell, positions)); });
}

/// 1/s
CellStrain rateOf(const BilinearCell& cell, const Distances& at, const Distances& opening) {
  return 2.0 * (cell.by_squares * at.cwiseProduct(opening).colwise().sum().transpose());
}

Gradients gradientsOf(const BilinearCell& cell, const Distances& at) {
  Gradients result = Gradients::Zero();
  for (int e = 0; e < 6; ++e) {
    const Eigen::Matrix<double, 3, 6> part = 2.0 * at.col(e) * cell.by_squares.col(e).transpose();
    result.middleRows<3>(3 * kCellDistances[e][0]) += part;
    result.middleRows<3>(3 * kCellDistances[e][1]) -= part;
  }
  return result;
}

/// How the distances pull under energies' derivatives by the strains: each like a spring of that
/// stiffness (N/m) and no length. @param loads J, of the whole cell
CellStrain pullsOf(const BilinearCell& cell, const CellStrain& loads) {
  return 2.0 * (cell.by_squares.transpose() * loads);
}

template <typename Target>
void addPulls(const BilinearCell& cell, const CellStrain& pulls, const Distances& distances,
              Target&& target) {
  for (int e = 0; e < 6; ++e) {
    const Vector3d pull = pulls[e] * distances.col(e);
    target(cell.particles[kCellDistances[e][0]]) -= pull;
    target(cell.particles[kCellDistances[e][1]]) += pull;
  }
}

/// Adds factor (gradients diag(slopes) gradients^T + what springs with these pulls have).
void addTangent(const BilinearCell& cell, const Gradients& gradients, const CellStrain& slopes,
                const CellStrain& pulls, double factor, linear::SymmetricBlockMatrix& matrix) {
  const Gradients scaled = gradients * (factor * slopes).asDiagonal();
  for (int i = 0; i < 4; ++i) {
    matrix.diagonal(cell.particles[i]).noalias() +=
        scaled.middleRows<3>(3 * i).lazyProduct(gradients.middleRows<3>(3 * i).transpose());
  }
  for (int e = 0; e < 6; ++e) {
    const auto [i, j] = kCellDistances[e];
    const double turning = factor * pulls[e];
    Matrix3d& block = matrix.lower(cell.slots[e]);
    block.noalias() +=
        scaled.middleRows<3>(3 * i).lazyProduct(gradients.middleRows<3>(3 * j).transpose());
    block.diagonal().array() -= turning;
    matrix.diagonal(cell.particles[i]).diagonal().array() += turning;
    matrix.diagonal(cell.particles[j]).diagonal().array() += turning;
  }
}

/// The strains that hold() has stored for a cell.
Eigen::Map<const CellStrain> heldStrain(const Vector3d* held, std::size_t cell) {
  return Eigen::Map<const CellStrain>(held[2 * cell].data());
}

}  // namespace

/// Derivatives of a cell's energy by its strains, J.
struct BilinearCells::Response {
  CellStrain load;
  CellStrain slope;
};

BilinearCells::BilinearCells(const std::vector<TrianglePair>& pairs, const material::Fabric& fabric,
                             bool viscosity)
    : elastic_{fabric.weft.elastic, fabric.warp.elastic, fabric.shear.elastic},
      viscous_{fabric.weft.viscous, fabric.warp.viscous, fabric.shear.viscous},
      viscosity_(viscosity) {
  cells_.reserve(pairs.size());
  Vector3d moduli;
  for (int m = 0; m < 3; ++m) moduli[m] = elastic_[m].evaluate(0.0).slope;
  for (const TrianglePair& pair : pairs) cells_.push_back(restCell(pair, moduli));
}

std::vector<std::array<int, 2>> BilinearCells::pairs() const {
  std::vector<std::array<int, 2>> result;
  for (const BilinearCell& cell : cells_) {
    for (const auto& [i, j] : kCellDistances)
      result.push_back({cell.particles[j], cell.particles[i]});
  }
  return result;
}

void BilinearCells::bind(const linear::SymmetricBlockMatrix& matrix) {
  for (BilinearCell& cell : cells_) {
    for (int e = 0; e < 6; ++e) {
      cell.slots[e] =
          matrix.slot(cell.particles[kCellDistances[e][0]], cell.particles[kCellDistances[e][1]]);
    }
  }
  std::vector<kernels::BilinearBatch> batches;
  if (kernels::canAddBatches()) {
    for (std::size_t c = 0; c + kernels::kBatch <= cells_.size(); c += kernels::kBatch) {
      batches.push_back(kernels::batchOf(&cells_[c]));
    }
  }
  batches_.assign(std::move(batches));
}

kernels::MembraneLaw BilinearCells::law(bool viscosity) const {
  return {&elastic_, viscosity ? &viscous_ : nullptr, 0.0};
}

BilinearCells::Response BilinearCells::respond(const BilinearCell& cell,
                                               const CellStrain& strain) const {
  Response response;
  for (int m = 0; m < 6; ++m) {
    const material::CurveValue value = elastic_[m % 3].evaluate(strain[m]);
    response.load[m] = 0.5 * cell.area * value.stress;
    response.slope[m] = 0.5 * cell.area * value.slope;
  }
  return response;
}

/// Adds the stresses of a rate that changes with the strain by 1/a.
void BilinearCells::addViscous(const BilinearCell& cell, const CellStrain& rate, double a,
                               Response& response) const {
  for (int m = 0; m < 6; ++m) {
    const material::CurveValue value = viscous_[m % 3].evaluate(rate[m]);
    response.load[m] += 0.5 * cell.area * value.stress;
    response.slope[m] += 0.5 * cell.area * value.slope / a;
  }
}

double BilinearCells::elasticEnergy(const BilinearCell& cell, const CellStrain& strain) const {
  double density = 0.0;
  for (int m = 0; m < 6; ++m) density += elastic_[m % 3].energy(strain[m]);
  return 0.5 * cell.area * density;
}

void BilinearCells::addForces(const ForceState& state, std::vector<Vector3d>& forces) const {
  for (const BilinearCell& cell : cells_) {
    const Distances at = distancesIn(cell, state.positions);
    const CellStrain strain = strainOf(cell, at);
    Response response = respond(cell, strain);
    if (viscosity_ && state.past != nullptr) {
      const CellStrain since = strain - pastStrain(cell, *state.past);
      addViscous(cell, since / state.past->a, state.past->a, response);
    } else if (viscosity_) {
      const CellStrain rate = rateOf(cell, at, distancesIn(cell, state.velocities));
      addViscous(cell, rate, 1.0, response);
    }
    addPulls(cell, pullsOf(cell, response.load), at,
             [&](int particle) -> Vector3d& { return forces[particle]; });
  }
}

double BilinearCells::energy(const ForceState& state) const {
  double energy = kernels::potential(batches_, state, nullptr, 0.0, law(false));
  for (std::size_t c = batchedCount(); c < cells_.size(); ++c) {
    energy +=
        elasticEnergy(cells_[c], strainOf(cells_[c], distancesIn(cells_[c], state.positions)));
  }
  return energy;
}

void BilinearCells::assembleLinearised(const ForceState& state, const StageTimes& times,
                                       linear::SymmetricBlockMatrix& matrix,
                                       linear::BlockVector& rhs) const {
  kernels::addStep(batches_, state, times, law(viscosity_), matrix, rhs);
  for (std::size_t c = batchedCount(); c < cells_.size(); ++c) {
    const BilinearCell& cell = cells_[c];
    const Distances at = distancesIn(cell, state.positions);
    const Distances opening = distancesIn(cell, state.velocities);
    const CellStrain rate = rateOf(cell, at, opening);
    Response response = respond(cell, strainOf(cell, at));
    const CellStrain increment = times.ahead * response.slope.cwiseMax(0.0).cwiseProduct(rate);
    if (viscosity_) addViscous(cell, rate, times.a, response);
    const CellStrain turning = projectPulls(pullsOf(cell, response.load));
    addTangent(cell, gradientsOf(cell, at), response.slope.cwiseMax(0.0), turning,
               times.a * times.a, matrix);
    const auto target = [&](int particle) { return rhs.col(particle); };
    addPulls(cell, times.a * pullsOf(cell, response.load + increment), at, target);
    addPulls(cell, times.a * times.ahead * turning, opening, target);
  }
}

void BilinearCells::hold(const NewtonStart& start, Vector3d* held) const {
  linear::shareRows(start.at.pool, static_cast<int>(cells_.size()), [&](int begin, int end) {
    for (int c = begin; c < end; ++c) {
      const BilinearCell& cell = cells_[c];
      Eigen::Map<CellStrain> strain(held[2 * c].data());
      if (start.at.past != nullptr) {
        strain = pastStrain(cell, *start.at.past);
        continue;
      }
      const Distances at = distancesIn(cell, start.at.positions);
      strain =
          strainOf(cell, at) - start.a * rateOf(cell, at, distancesIn(cell, start.at.velocities));
    }
  });
}

void BilinearCells::assembleNewton(const ForceState& state, const Vector3d* held, double a,
                                   Hessian hessian, linear::SymmetricBlockMatrix& matrix,
                                   linear::BlockVector& rhs) const {
  kernels::addNewton(batches_, state, held, a, hessian, law(viscosity_), matrix, rhs);
  for (std::size_t c = batchedCount(); c < cells_.size(); ++c) {
    const BilinearCell& cell = cells_[c];
    const Distances at = distancesIn(cell, state.positions);
    const CellStrain strain = strainOf(cell, at);
    Response response = respond(cell, strain);
    if (viscosity_) addViscous(cell, (strain - heldStrain(held, c)) / a, a, response);
    const CellStrain pulls = pullsOf(cell, response.load);
    const bool exact = hessian == Hessian::kExact;
    if (!exact) response.slope = response.slope.cwiseMax(0.0);
    addTangent(cell, gradientsOf(cell, at), response.slope, exact ? pulls : projectPulls(pulls),
               a * a, matrix);
    addPulls(cell, a * pulls, at, [&](int particle) { return rhs.col(particle); });
  }
}

double BilinearCells::incrementalPotential(const ForceState& state, const Vector3d* held,
                                           double a) const {
  double potential = kernels::potential(batches_, state, held, a, law(viscosity_));
  for (std::size_t c = batchedCount(); c < cells_.size(); ++c) {
    const BilinearCell& cell = cells_[c];
    const CellStrain strain = strainOf(cell, distancesIn(cell, state.positions));
    potential += elasticEnergy(cell, strain);
    const CellStrain since = strain - heldStrain(held, c);
    for (int m = 0; viscosity_ && m < 6; ++m) {
      potential += 0.5 * cell.area * a * viscous_[m % 3].energy(since[m] / a);
    }
  }
  return potential;
}

void BilinearCells::addJacobian(const ForceState& state, JacobianRows& rows) const {
  for (const BilinearCell& cell : cells_) {
    if (std::none_of(cell.particles.begin(), cell.particles.end(),
                     [&](int particle) { return rows.asksFor(particle); })) {
      continue;
    }
    const Distances at = distancesIn(cell, state.positions);
    Response response = respond(cell, strainOf(cell, at));
    const CellStrain elastic = response.slope;
    const Gradients gradients = gradientsOf(cell, at);
    Gradients of_rates = Gradients::Zero();
    if (viscosity_) {
      const Distances opening = distancesIn(cell, state.velocities);
      addViscous(cell, rateOf(cell, at, opening), 1.0, response);
      of_rates = gradientsOf(cell, opening);
    }
    const CellStrain viscous = response.slope - elastic;
    const Eigen::Matrix<double, 12, 12> by_velocity =
        -gradients * viscous.asDiagonal() * gradients.transpose();
    Eigen::Matrix<double, 12, 12> by_position =
        -gradients * (elastic.asDiagonal() * gradients.transpose() +
                      viscous.asDiagonal() * of_rates.transpose());
    const CellStrain pulls = pullsOf(cell, response.load);
    for (int e = 0; e < 6; ++e) {
      for (const auto& [i, j] : {kCellDistances[e], {kCellDistances[e][1], kCellDistances[e][0]}}) {
        by_position.block<3, 3>(3 * i, 3 * j).diagonal().array() += pulls[e];
        by_position.block<3, 3>(3 * i, 3 * i).diagonal().array() -= pulls[e];
      }
    }
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < 4; ++j) {
        rows.add(cell.particles[i], cell.particles[j], by_position.block<3, 3>(3 * i, 3 * j),
                 by_velocity.block<3, 3>(3 * i, 3 * j));
      }
    }
  }
}

}  // namespace haptex::cloth
