#include "haptex/cloth/forces/bending/bending_friction.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace haptex::cloth {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

/// At which the elastic moment is half of 2HB (1/m).
double frictionCurvature(double rigidity, double hysteresis) {
  return hysteresis > 0.0 ? 0.5 * hysteresis / rigidity : 0.0;
}

void requireHysteresis(const char* name, double value, double rigidity) {
  if (!std::isfinite(value) || value < 0.0 || (value > 0.0 && rigidity == 0.0)) {
    std::ostringstream message;
    message << "the hysteresis of bending along " << name << " is " << value
            << " N; it must be finite and at least 0, and 0 where the rigidity is";
    throw std::invalid_argument(message.str());
  }
}

}  // namespace

BendingFriction::BendingFriction(const mesh::ClothMesh& mesh, const std::vector<Hinge>& hinges,
                                 const std::vector<HingeCorner>& corners,
                                 const material::BendingRigidity& rigidity,
                                 const material::BendingHysteresis& hysteresis)
    : hinges_(mesh, hinges, corners,
              Vector2d(frictionCurvature(rigidity.weft, hysteresis.weft),
                       frictionCurvature(rigidity.warp, hysteresis.warp))) {
  requireHysteresis("weft", hysteresis.weft, rigidity.weft);
  requireHysteresis("warp", hysteresis.warp, rigidity.warp);
  for (const NormalHinges::NormalHinge& hinge : hinges_.hinges()) {
    const double yield = hinge.stiffness * std::abs(hinge.bend);
    elements_.push_back({yield / (hinge.length * kYieldCurvature), yield});
  }
}

void BendingFriction::bind(const linear::SymmetricBlockMatrix& matrix) {
  first_slot_.clear();
  slots_.clear();
  const std::vector<NormalHinges::Corner>& corners = hinges_.corners();
  for (const NormalHinges::NormalHinge& hinge : hinges_.hinges()) {
    first_slot_.push_back(static_cast<int>(slots_.size()));
    for (int i = hinge.begin; i < hinge.end; ++i) {
      for (int j = hinge.begin; j < i; ++j) {
        const bool coupled = corners[i].weight * corners[j].weight != 0.0;
        const auto [first, second] = std::minmax(corners[i].particle, corners[j].particle);
        slots_.push_back(coupled ? matrix.slot(second, first) : -1);
      }
    }
  }
}

std::vector<std::vector<int>> BendingFriction::memoryOwners() const {
  std::vector<std::vector<int>> owners;
  for (const NormalHinges::NormalHinge& hinge : hinges_.hinges()) {
    std::vector<int>& corners = owners.emplace_back();
    for (int i = hinge.begin; i < hinge.end; ++i) {
      corners.push_back(hinges_.corners()[i].particle);
    }
  }
  return owners;
}

void BendingFriction::forget(const Positions& positions, double* plastic) const {
  for (std::size_t h = 0; h < elements_.size(); ++h) {
    plastic[h] = hinges_.frame(hinges_.hinges()[h], positions).bend();
  }
}

void BendingFriction::remember(const Positions& positions, double* plastic) const {
  for (std::size_t h = 0; h < elements_.size(); ++h) {
    const double bend = hinges_.frame(hinges_.hinges()[h], positions).bend();
    const double most = elements_[h].yield / elements_[h].spring;
    plastic[h] = std::clamp(plastic[h], bend - most, bend + most);
  }
}

BendingFriction::Friction BendingFriction::frictionOf(const Element& element, double stretch) {
  const double force = element.spring * stretch;
  if (std::abs(force) > element.yield) {
    return {std::copysign(element.yield, force), 0.0, element.yield / std::abs(stretch)};
  }
  return {force, element.spring, element.spring};  // NaN stays NaN, and the step is refused
}

double BendingFriction::energy(const ForceState& state) const {
  double energy = 0.0;
  for (std::size_t h = 0; h < elements_.size(); ++h) {
    const Element& element = elements_[h];
    const double stretch =
        hinges_.frame(hinges_.hinges()[h], state.positions).bend() - state.memory[h];
    const double force = frictionOf(element, stretch).force;
    energy += force * (stretch - 0.5 * force / element.spring);
  }
  return energy;
}

void BendingFriction::addForces(const ForceState& state, std::vector<Vector3d>& forces) const {
  for (std::size_t h = 0; h < elements_.size(); ++h) {
    const NormalHinges::NormalHinge& hinge = hinges_.hinges()[h];
    const NormalHinges::Frame at = hinges_.frame(hinge, state.positions);
    const double force = frictionOf(elements_[h], at.bend() - state.memory[h]).force;
    for (int i = hinge.begin; i < hinge.end; ++i) {
      const NormalHinges::Corner& corner = hinges_.corners()[i];
      forces[corner.particle] -= force * NormalHinges::gradient(at, corner);
    }
  }
}

void BendingFriction::assembleLinearised(const ForceState& state, const StageTimes& times,
                                         linear::SymmetricBlockMatrix& matrix,
                                         linear::BlockVector& rhs) const {
  for (std::size_t h = 0; h < elements_.size(); ++h) {
    const NormalHinges::Frame at = hinges_.frame(hinges_.hinges()[h], [&](int i) -> Vector3d {
      return state.positions[i] + times.ahead * state.velocities[i];
    });
    const Friction friction = frictionOf(elements_[h], at.bend() - state.memory[h]);
    addLinearised(h, at, friction.force, friction.secant, times.a, matrix, rhs);
  }
}

void BendingFriction::assembleNewton(const ForceState& state, const Vector3d* /*held*/, double a,
                                     Hessian hessian, linear::SymmetricBlockMatrix& matrix,
                                     linear::BlockVector& rhs) const {
  const bool exact = hessian == Hessian::kExact;
  for (std::size_t h = 0; h < elements_.size(); ++h) {
    const NormalHinges::Frame at = hinges_.frame(hinges_.hinges()[h], state.positions);
    const Friction friction = frictionOf(elements_[h], at.bend() - state.memory[h]);
    addLinearised(h, at, friction.force, exact ? friction.tangent : friction.secant, a, matrix,
                  rhs);
  }
}

/// matrix += a^2 stiffness g g^T without the turning of the normal, rhs -= a force times the
/// bend's exact gradient.
void BendingFriction::addLinearised(std::size_t hinge, const NormalHinges::Frame& at, double force,
                                    double stiffness, double a,
                                    linear::SymmetricBlockMatrix& matrix,
                                    linear::BlockVector& rhs) const {
  const NormalHinges::NormalHinge& of = hinges_.hinges()[hinge];
  const Matrix3d along = a * a * stiffness * at.normal * at.normal.transpose();
  int pair = first_slot_[hinge];
  for (int i = of.begin; i < of.end; ++i) {
    const NormalHinges::Corner& row = hinges_.corners()[i];
    rhs.col(row.particle) -= a * force * NormalHinges::gradient(at, row);
    matrix.diagonal(row.particle) += row.weight * row.weight * along;
    for (int j = of.begin; j < i; ++j, ++pair) {
      if (slots_[pair] < 0) continue;
      matrix.lower(slots_[pair]) += row.weight * hinges_.corners()[j].weight * along;
    }
  }
}

void BendingFriction::addJacobian(const ForceState& state, JacobianRows& rows) const {
  for (std::size_t h = 0; h < elements_.size(); ++h) {
    const NormalHinges::NormalHinge& hinge = hinges_.hinges()[h];
    const NormalHinges::Frame at = hinges_.frame(hinge, state.positions);
    if (at.area == 0.0) continue;
    const Friction friction = frictionOf(elements_[h], at.bend() - state.memory[h]);
    for (int i = hinge.begin; i < hinge.end; ++i) {
      const NormalHinges::Corner& row = hinges_.corners()[i];
      const Vector3d row_gradient = NormalHinges::gradient(at, row);
      for (int j = hinge.begin; j < hinge.end; ++j) {
        const NormalHinges::Corner& column = hinges_.corners()[j];
        rows.add(row.particle, column.particle,
                 -friction.tangent * row_gradient * NormalHinges::gradient(at, column).transpose() -
                     friction.force * NormalHinges::hessian(at, row, column));
      }
    }
  }
}

}  // namespace haptex::cloth
