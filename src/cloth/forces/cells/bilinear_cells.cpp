#include "haptex/cloth/forces/cells/bilinear_cells.h"

#include <algorithm>
#include <cmath>

#include "haptex/cloth/forces/element_assembly.h"

namespace haptex::cloth {
namespace {

using Eigen::Matrix3d;
using Eigen::RowVector4d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kSoftPart = 0.1;  // of the smallest slope
/// The two particles of each of the six distances.
constexpr std::array<std::array<int, 2>, 6> kEnds = {
    {{1, 0}, {2, 0}, {2, 1}, {3, 0}, {3, 1}, {3, 2}}};

using Distances = Eigen::Matrix<double, 3, 6>;   // m, of the first end from the second
using Gradients = Eigen::Matrix<double, 12, 6>;  // of the six strains by the particles, 1/m

Distances distancesIn(const BilinearCell& cell, const std::vector<Vector3d>& points) {
  Distances result;
  for (int e = 0; e < 6; ++e) {
    result.col(e) = points[cell.particles[kEnds[e][0]]] - points[cell.particles[kEnds[e][1]]];
  }
  return result;
}

CellStrain strainOf(const BilinearCell& cell, const Distances& at) {
  const CellStrain squares = at.colwise().squaredNorm().transpose();
  return cell.by_squares * (squares - cell.rest_squares);
}

Vector3d meanStrain(const BilinearCell& cell, const Positions& positions) {
  return strainOf(cell, distancesIn(cell, positions)).head<3>();
}

Vector3d pastStrain(const BilinearCell& cell, const StrainPast& past) {
  return past.strain([&](const Positions& positions) { return meanStrain(cell, positions); });
}

/// 1/s
CellStrain rateOf(const BilinearCell& cell, const Distances& at, const Distances& opening) {
  return 2.0 * (cell.by_squares * at.cwiseProduct(opening).colwise().sum().transpose());
}

Gradients gradientsOf(const BilinearCell& cell, const Distances& at) {
  Gradients result = Gradients::Zero();
  for (int e = 0; e < 6; ++e) {
    const Eigen::Matrix<double, 3, 6> part = 2.0 * at.col(e) * cell.by_squares.col(e).transpose();
    result.middleRows<3>(3 * kEnds[e][0]) += part;
    result.middleRows<3>(3 * kEnds[e][1]) -= part;
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
    target(cell.particles[kEnds[e][0]]) -= pull;
    target(cell.particles[kEnds[e][1]]) += pull;
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
    const auto [i, j] = kEnds[e];
    const double turning = factor * pulls[e];
    Matrix3d& block = matrix.lower(cell.slots[e]);
    block.noalias() +=
        scaled.middleRows<3>(3 * i).lazyProduct(gradients.middleRows<3>(3 * j).transpose());
    block.diagonal().array() -= turning;
    matrix.diagonal(cell.particles[i]).diagonal().array() += turning;
    matrix.diagonal(cell.particles[j]).diagonal().array() += turning;
  }
}

/// Whether the tensor [[s0, s2], [s2, s1]] is positive semidefinite.
bool isTension(const Vector3d& stress) {
  return stress[0] + stress[1] >= 0.0 && stress[0] * stress[1] >= stress[2] * stress[2];
}

/// m^2, of the soft part.
double reducedArea(const BilinearCell& cell) {
  return cell.area * cell.first_share * (1.0 - cell.first_share);
}

/// A triangle within a cell: derivatives along weft and warp as weights of the cell's corners.
struct Part {
  RowVector4d weft = RowVector4d::Zero(), warp = RowVector4d::Zero();
  double area;
};

Part partOf(const std::array<Vector2d, 4>& rest, const std::array<int, 3>& corners) {
  const RestTriangle triangle =
      restTriangle({rest[corners[0]], rest[corners[1]], rest[corners[2]]});
  Part part;
  for (int i = 0; i < 3; ++i) {
    part.weft[corners[i]] = triangle.weft_weights[i];
    part.warp[corners[i]] = triangle.warp_weights[i];
  }
  part.area = triangle.area;
  return part;
}

/// The coefficients of the squares in the strains of the derivatives along weft and warp, by rows.
Eigen::Matrix<double, 3, 6> coefficientsOf(const RowVector4d& weft, const RowVector4d& warp) {
  Eigen::Matrix<double, 3, 6> result;
  for (int e = 0; e < 6; ++e) {
    const auto [i, j] = kEnds[e];
    result.col(e) << -0.5 * weft[i] * weft[j], -0.5 * warp[i] * warp[j],
        -0.5 * (weft[i] * warp[j] + warp[i] * weft[j]);
  }
  return result;
}

}  // namespace

BilinearCell restCell(const TrianglePair& pair) {
  std::array<int, 4> order = {0, 1, 2, 3};
  std::sort(order.begin(), order.end(),
            [&](int i, int j) { return pair.particles[i] < pair.particles[j]; });
  BilinearCell cell{};
  cell.slots.fill(-1);
  std::array<Vector2d, 4> rest;
  std::array<int, 4> place;  // of the pair's particles
  for (int i = 0; i < 4; ++i) {
    cell.particles[i] = pair.particles[order[i]];
    rest[i] = pair.rest[order[i]];
    place[order[i]] = i;
  }
  const auto [a, b, c, d] = place;
  const std::array<Part, 4> parts = {partOf(rest, {a, b, c}), partOf(rest, {b, a, d}),
                                     partOf(rest, {c, d, a}), partOf(rest, {d, c, b})};
  cell.area = parts[0].area + parts[1].area;
  cell.first_share = parts[0].area / cell.area;
  const RowVector4d weft =
      (parts[0].area * parts[0].weft + parts[1].area * parts[1].weft) / cell.area;
  const RowVector4d warp =
      (parts[0].area * parts[0].warp + parts[1].area * parts[1].warp) / cell.area;
  cell.by_squares.topRows<3>() = 2.0 / 3.0 * coefficientsOf(weft, warp);
  for (const Part& part : parts) {
    cell.by_squares.topRows<3>() +=
        part.area / (6.0 * cell.area) * coefficientsOf(part.weft, part.warp);
  }
  cell.by_squares.bottomRows<3>() =
      coefficientsOf(parts[0].weft, parts[0].warp) - coefficientsOf(parts[1].weft, parts[1].warp);
  for (int e = 0; e < 6; ++e) {
    cell.rest_squares[e] = (rest[kEnds[e][0]] - rest[kEnds[e][1]]).squaredNorm();
  }
  return cell;
}

/// Derivatives of a cell's energy by its strains, J.
struct BilinearCells::Response {
  CellStrain load;
  CellStrain slope;

  /// Makes the slopes >= 0, and returns loads whose pulls are positive semidefinite. The form of
  /// the mean strain has a sixth of each triangle's, and the differences are those of both.
  CellStrain project(const BilinearCell& cell) {
    slope = slope.cwiseMax(0.0);
    const Vector3d mean = load.head<3>(), soft = load.tail<3>();
    if (isTension(mean) && isTension(cell.first_share / 6.0 * mean + soft) &&
        isTension((1.0 - cell.first_share) / 6.0 * mean - soft)) {
      return load;
    }
    CellStrain result = CellStrain::Zero();
    result.head<3>() = projectStress(mean);
    return result;
  }
};

BilinearCells::BilinearCells(const std::vector<TrianglePair>& pairs, const material::Fabric& fabric,
                             bool viscosity)
    : elastic_{fabric.weft.elastic, fabric.warp.elastic, fabric.shear.elastic},
      viscous_{fabric.weft.viscous, fabric.warp.viscous, fabric.shear.viscous},
      viscosity_(viscosity) {
  cells_.reserve(pairs.size());
  for (const TrianglePair& pair : pairs) cells_.push_back(restCell(pair));
  double smallest = elastic_[0].evaluate(0.0).slope;
  for (const auto& curve : elastic_) smallest = std::min(smallest, curve.evaluate(0.0).slope);
  soft_modulus_ = kSoftPart * std::max(smallest, 0.0);
}

std::vector<std::array<int, 2>> BilinearCells::pairs() const {
  std::vector<std::array<int, 2>> result;
  for (const BilinearCell& cell : cells_) {
    for (const auto& [i, j] : kEnds) result.push_back({cell.particles[j], cell.particles[i]});
  }
  return result;
}

void BilinearCells::bind(const linear::SymmetricBlockMatrix& matrix) {
  for (BilinearCell& cell : cells_) {
    for (int e = 0; e < 6; ++e) {
      cell.slots[e] = matrix.slot(cell.particles[kEnds[e][0]], cell.particles[kEnds[e][1]]);
    }
  }
}

BilinearCells::Response BilinearCells::respond(const BilinearCell& cell,
                                               const CellStrain& strain) const {
  Response response;
  for (int m = 0; m < 3; ++m) {
    const material::CurveValue value = elastic_[m].evaluate(strain[m]);
    response.load[m] = cell.area * value.stress;
    response.slope[m] = cell.area * value.slope;
  }
  const double soft = reducedArea(cell) * soft_modulus_;
  response.load.tail<3>() = soft * strain.tail<3>();
  response.slope.tail<3>().setConstant(soft);
  return response;
}

/// Adds the stresses of a rate that changes with the strain by 1/a.
void BilinearCells::addViscous(const BilinearCell& cell, const Vector3d& rate, double a,
                               Response& response) const {
  for (int m = 0; m < 3; ++m) {
    const material::CurveValue value = viscous_[m].evaluate(rate[m]);
    response.load[m] += cell.area * value.stress;
    response.slope[m] += cell.area * value.slope / a;
  }
}

double BilinearCells::elasticEnergy(const BilinearCell& cell, const CellStrain& strain) const {
  double density = 0.0;
  for (int m = 0; m < 3; ++m) density += elastic_[m].energy(strain[m]);
  return cell.area * density +
         0.5 * reducedArea(cell) * soft_modulus_ * strain.tail<3>().squaredNorm();
}

void BilinearCells::addForces(const ForceState& state, std::vector<Vector3d>& forces) const {
  for (const BilinearCell& cell : cells_) {
    const Distances at = distancesIn(cell, state.positions);
    const CellStrain strain = strainOf(cell, at);
    Response response = respond(cell, strain);
    if (viscosity_ && state.past != nullptr) {
      const Vector3d since = strain.head<3>() - pastStrain(cell, *state.past);
      addViscous(cell, since / state.past->a, state.past->a, response);
    } else if (viscosity_) {
      const CellStrain rate = rateOf(cell, at, distancesIn(cell, state.velocities));
      addViscous(cell, rate.head<3>(), 1.0, response);
    }
    addPulls(cell, pullsOf(cell, response.load), at,
             [&](int particle) -> Vector3d& { return forces[particle]; });
  }
}

double BilinearCells::energy(const ForceState& state) const {
  double energy = 0.0;
  for (const BilinearCell& cell : cells_) {
    energy += elasticEnergy(cell, strainOf(cell, distancesIn(cell, state.positions)));
  }
  return energy;
}

void BilinearCells::assembleLinearised(const ForceState& state, const StageTimes& times,
                                       linear::SymmetricBlockMatrix& matrix,
                                       linear::BlockVector& rhs) const {
  for (const BilinearCell& cell : cells_) {
    const Distances at = distancesIn(cell, state.positions);
    const Distances opening = distancesIn(cell, state.velocities);
    const CellStrain rate = rateOf(cell, at, opening);
    Response response = respond(cell, strainOf(cell, at));
    const CellStrain increment = times.ahead * response.slope.cwiseMax(0.0).cwiseProduct(rate);
    if (viscosity_) addViscous(cell, rate.head<3>(), times.a, response);
    const CellStrain turning = pullsOf(cell, response.project(cell));
    addTangent(cell, gradientsOf(cell, at), response.slope, turning, times.a * times.a, matrix);
    const auto target = [&](int particle) { return rhs.col(particle); };
    addPulls(cell, times.a * pullsOf(cell, response.load + increment), at, target);
    addPulls(cell, times.a * times.ahead * turning, opening, target);
  }
}

void BilinearCells::hold(const NewtonStart& start, Vector3d* held) const {
  for (std::size_t c = 0; c < cells_.size(); ++c) {
    const BilinearCell& cell = cells_[c];
    if (start.at.past != nullptr) {
      held[c] = pastStrain(cell, *start.at.past);
      continue;
    }
    const Distances at = distancesIn(cell, start.at.positions);
    const CellStrain rate = rateOf(cell, at, distancesIn(cell, start.at.velocities));
    held[c] = strainOf(cell, at).head<3>() - start.a * rate.head<3>();
  }
}

void BilinearCells::assembleNewton(const ForceState& state, const Vector3d* held, double a,
                                   Hessian hessian, linear::SymmetricBlockMatrix& matrix,
                                   linear::BlockVector& rhs) const {
  for (std::size_t c = 0; c < cells_.size(); ++c) {
    const BilinearCell& cell = cells_[c];
    const Distances at = distancesIn(cell, state.positions);
    const CellStrain strain = strainOf(cell, at);
    Response response = respond(cell, strain);
    if (viscosity_) addViscous(cell, (strain.head<3>() - held[c]) / a, a, response);
    const CellStrain pulls = pullsOf(cell, response.load);
    const CellStrain turning =
        hessian == Hessian::kExact ? pulls : pullsOf(cell, response.project(cell));
    addTangent(cell, gradientsOf(cell, at), response.slope, turning, a * a, matrix);
    addPulls(cell, a * pulls, at, [&](int particle) { return rhs.col(particle); });
  }
}

double BilinearCells::incrementalPotential(const ForceState& state, const Vector3d* held,
                                           double a) const {
  double potential = 0.0;
  for (std::size_t c = 0; c < cells_.size(); ++c) {
    const BilinearCell& cell = cells_[c];
    const CellStrain strain = strainOf(cell, distancesIn(cell, state.positions));
    potential += elasticEnergy(cell, strain);
    for (int m = 0; viscosity_ && m < 3; ++m) {
      potential += cell.area * a * viscous_[m].energy((strain[m] - held[c][m]) / a);
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
      addViscous(cell, rateOf(cell, at, opening).head<3>(), 1.0, response);
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
      for (const auto& [i, j] : {kEnds[e], {kEnds[e][1], kEnds[e][0]}}) {
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
