#include "haptex/cloth/forces/bending_friction.h"

#include <algorithm>
#include <cmath>

namespace haptex::cloth {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

/// At which the elastic moment is half of 2HB (1/m).
double frictionCurvature(double rigidity, double hysteresis) {
  return hysteresis > 0.0 ? 0.5 * hysteresis / rigidity : 0.0;
}

}  // namespace

BendingFriction::BendingFriction(const mesh::ClothMesh& mesh, const std::vector<Hinge>& hinges,
                                 const std::vector<HingeCorner>& corners,
                                 const material::BendingRigidity& rigidity,
                                 const material::BendingHysteresis& hysteresis)
    : hinges_(mesh, hinges, corners,
              Vector2d(frictionCurvature(rigidity.weft, hysteresis.weft),
                       frictionCurvature(rigidity.warp, hysteresis.warp))) {
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

PlasticBends BendingFriction::withoutFriction(const Positions& positions) const {
  PlasticBends plastic;
  plastic.reserve(size());
  for (const NormalHinges::NormalHinge& hinge : hinges_.hinges()) {
    plastic.push_back(hinges_.frame(hinge, positions).bend());
  }
  return plastic;
}

void BendingFriction::yield(const Positions& positions, PlasticBends& plastic) const {
  for (std::size_t h = 0; h < size(); ++h) {
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

double BendingFriction::energy(const Positions& positions, const PlasticBends& plastic) const {
  double energy = 0.0;
  for (std::size_t h = 0; h < size(); ++h) {
    const Element& element = elements_[h];
    const double stretch = hinges_.frame(hinges_.hinges()[h], positions).bend() - plastic[h];
    const double force = frictionOf(element, stretch).force;
    energy += force * (stretch - 0.5 * force / element.spring);
  }
  return energy;
}

void BendingFriction::addForces(const Positions& positions, const PlasticBends& plastic,
                                std::vector<Vector3d>& forces) const {
  for (std::size_t h = 0; h < size(); ++h) {
    const NormalHinges::NormalHinge& hinge = hinges_.hinges()[h];
    const NormalHinges::Frame at = hinges_.frame(hinge, positions);
    const double force = frictionOf(elements_[h], at.bend() - plastic[h]).force;
    for (int i = hinge.begin; i < hinge.end; ++i) {
      const NormalHinges::Corner& corner = hinges_.corners()[i];
      forces[corner.particle] -= force * NormalHinges::gradient(at, corner);
    }
  }
}

void BendingFriction::addStep(const Positions& positions, const Velocities& velocities,
                              const PlasticBends& plastic, const StageTimes& times,
                              linear::SymmetricBlockMatrix& matrix,
                              linear::BlockVector& rhs) const {
  for (std::size_t h = 0; h < size(); ++h) {
    const NormalHinges::Frame at = hinges_.frame(hinges_.hinges()[h], [&](int i) -> Vector3d {
      return positions[i] + times.ahead * velocities[i];
    });
    const Friction friction = frictionOf(elements_[h], at.bend() - plastic[h]);
    addLinearised(h, at, friction.force, friction.secant, times.a, matrix, rhs);
  }
}

void BendingFriction::addNewton(const Positions& positions, const PlasticBends& plastic, double a,
                                Membrane::Hessian hessian, linear::SymmetricBlockMatrix& matrix,
                                linear::BlockVector& rhs) const {
  const bool exact = hessian == Membrane::Hessian::kExact;
  for (std::size_t h = 0; h < size(); ++h) {
    const NormalHinges::Frame at = hinges_.frame(hinges_.hinges()[h], positions);
    const Friction friction = frictionOf(elements_[h], at.bend() - plastic[h]);
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

void BendingFriction::jacobian(const Positions& positions, const PlasticBends& plastic,
                               const RestCurvature::BlockSink& sink) const {
  for (std::size_t h = 0; h < size(); ++h) {
    const NormalHinges::NormalHinge& hinge = hinges_.hinges()[h];
    const NormalHinges::Frame at = hinges_.frame(hinge, positions);
    if (at.area == 0.0) continue;
    const Friction friction = frictionOf(elements_[h], at.bend() - plastic[h]);
    for (int i = hinge.begin; i < hinge.end; ++i) {
      const NormalHinges::Corner& row = hinges_.corners()[i];
      const Vector3d row_gradient = NormalHinges::gradient(at, row);
      for (int j = hinge.begin; j < hinge.end; ++j) {
        const NormalHinges::Corner& column = hinges_.corners()[j];
        sink(row.particle, column.particle,
             -friction.tangent * row_gradient * NormalHinges::gradient(at, column).transpose() -
                 friction.force * NormalHinges::hessian(at, row, column));
      }
    }
  }
}

}  // namespace haptex::cloth
