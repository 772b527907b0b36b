#include "haptex/cloth/forces/membrane_friction.h"

#include <cmath>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace haptex::cloth {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

void refuse(const char* name, double value, const char* allowed) {
  std::ostringstream message;
  message << name << " is " << value << "; it must be " << allowed;
  throw std::invalid_argument(message.str());
}

const material::Fabric& checked(const material::Fabric& fabric) {
  const auto resilience = [](const char* name, double value) {
    if (!(value >= material::TensileResilience::kLeast && value <= 1.0)) {
      refuse(name, value, "from 0.1 to 1");
    }
  };
  const auto width = [](const char* name, double value) {
    if (!std::isfinite(value) || value < 0.0) refuse(name, value, "finite and at least 0");
  };
  resilience("the resilience of the weft", fabric.resilience->weft);
  resilience("the resilience of the warp", fabric.resilience->warp);
  width("the hysteresis of shear at 0.5 degrees", fabric.shear_hysteresis->at_half_degree);
  width("the hysteresis of shear at 5 degrees", fabric.shear_hysteresis->at_five_degrees);
  return fabric;
}

}  // namespace

material::Fabric elasticShare(material::Fabric fabric) {
  const auto& [weft, warp] = *fabric.resilience;
  fabric.weft.elastic = fabric.weft.elastic.scaledBy(1.0 - ThreadFriction::share(weft));
  fabric.warp.elastic = fabric.warp.elastic.scaledBy(1.0 - ThreadFriction::share(warp));
  return fabric;
}

MembraneFriction::MembraneFriction(std::vector<MembraneElement> elements,
                                   const material::Fabric& fabric)
    : elements_(std::move(elements)),
      threads_{{{checked(fabric).weft.elastic, fabric.resilience->weft},
                {fabric.warp.elastic, fabric.resilience->warp}}},
      shear_(*fabric.shear_hysteresis) {}

bool MembraneFriction::isZero(const material::Fabric& fabric) {
  return fabric.resilience->weft == 1.0 && fabric.resilience->warp == 1.0 &&
         fabric.shear_hysteresis->at_half_degree == 0.0 &&
         fabric.shear_hysteresis->at_five_degrees == 0.0;
}

void MembraneFriction::bind(const linear::SymmetricBlockMatrix& matrix) {
  bindElements(matrix, elements_);
}

std::vector<std::vector<int>> MembraneFriction::memoryOwners() const {
  std::vector<std::vector<int>> owners;
  for (const MembraneElement& element : elements_) {
    owners.insert(owners.end(), 3, {element.particles.begin(), element.particles.end()});
  }
  return owners;
}

void MembraneFriction::forget(const Positions& positions, double* memory) const {
  for (const MembraneElement& element : elements_) {
    const MembraneStrain strain = greenStrain(element, positions);
    *memory++ = threads_[0].forgotten(strain[0]);
    *memory++ = threads_[1].forgotten(strain[1]);
    *memory++ = shear_.forgotten(strain[2]);
  }
}

void MembraneFriction::remember(const Positions& positions, double* memory) const {
  for (const MembraneElement& element : elements_) {
    const MembraneStrain strain = greenStrain(element, positions);
    memory[0] = threads_[0].follow(strain[0], memory[0]);
    memory[1] = threads_[1].follow(strain[1], memory[1]);
    memory[2] = shear_.follow(strain[2], memory[2]);
    memory += 3;
  }
}

MembraneFriction::Response MembraneFriction::respond(const MembraneStrain& strain,
                                                     const double* memory) const {
  const FrictionResponse weft = threads_[0].respond(strain[0], memory[0]);
  const FrictionResponse warp = threads_[1].respond(strain[1], memory[1]);
  const FrictionResponse shear = shear_.respond(strain[2], memory[2]);
  return {{weft.stress, warp.stress, shear.stress},
          {weft.tangent, warp.tangent, shear.tangent},
          {weft.secant, warp.secant, shear.secant},
          weft.energy + warp.energy + shear.energy};
}

double MembraneFriction::energy(const ForceState& state) const {
  double energy = 0.0;
  const double* memory = state.memory;
  for (const MembraneElement& element : elements_) {
    energy += element.area * respond(greenStrain(element, state.positions), memory).energy;
    memory += 3;
  }
  return energy;
}

void MembraneFriction::addForces(const ForceState& state, std::vector<Vector3d>& forces) const {
  const double* memory = state.memory;
  for (const MembraneElement& element : elements_) {
    const ElementFrame at = elementFrame(element, state.positions);
    const Vector3d stress = -element.area * respond(greenStrain(at), memory).stress;
    addScattered(element, stress[0] * at.weft + stress[2] * at.warp,
                 stress[1] * at.warp + stress[2] * at.weft,
                 [&](int particle) -> Vector3d& { return forces[particle]; });
    memory += 3;
  }
}

/// rhs -= factor times the area times what the stress pulls on the frame.
void MembraneFriction::addTractions(const MembraneElement& element, const ElementFrame& frame,
                                    const Vector3d& stress, double factor,
                                    linear::BlockVector& rhs) const {
  const Vector3d load = -factor * element.area * stress;
  addScattered(element, load[0] * frame.weft + load[2] * frame.warp,
               load[1] * frame.warp + load[2] * frame.weft,
               [&](int particle) { return rhs.col(particle); });
}

void MembraneFriction::assembleLinearised(const ForceState& state, const StageTimes& times,
                                          linear::SymmetricBlockMatrix& matrix,
                                          linear::BlockVector& rhs) const {
  const double* memory = state.memory;
  for (const MembraneElement& element : elements_) {
    const ElementFrame at = elementFrame(element, state.positions);
    const ElementFrame rate = elementFrame(element, state.velocities);
    const MembraneStrain ahead = greenStrain(at) + times.ahead * greenStrainRate(at, rate);
    const Response response = respond(ahead, memory);
    const Vector3d geometric = projectStress(response.stress);
    addTangent(element, at, response.secant, 0.0, geometric, element.area * times.a * times.a,
               matrix);
    addTractions(element, at, response.stress, times.a, rhs);
    addTractions(element, rate, geometric, times.a * times.ahead, rhs);
    memory += 3;
  }
}

void MembraneFriction::assembleNewton(const ForceState& state, const Vector3d* /*held*/, double a,
                                      Hessian hessian, linear::SymmetricBlockMatrix& matrix,
                                      linear::BlockVector& rhs) const {
  const bool exact = hessian == Hessian::kExact;
  const double* memory = state.memory;
  for (const MembraneElement& element : elements_) {
    const ElementFrame at = elementFrame(element, state.positions);
    const Response response = respond(greenStrain(at), memory);
    addTangent(element, at, exact ? response.tangent : response.secant, 0.0,
               exact ? response.stress : projectStress(response.stress), element.area * a * a,
               matrix);
    addTractions(element, at, response.stress, a, rhs);
    memory += 3;
  }
}

void MembraneFriction::addJacobian(const ForceState& state, JacobianRows& rows) const {
  const double* memory = state.memory;
  const auto jacobian = [&](const MembraneElement& element) {
    const ElementFrame at = elementFrame(element, state.positions);
    const std::ptrdiff_t place = &element - elements_.data();
    const Response response = respond(greenStrain(at), memory + 3 * place);
    ElementJacobian result;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        const Matrix3d g_i = strainGradients(element, at, i), g_j = strainGradients(element, at, j);
        result.by_velocity[i][j].setZero();
        result.by_position[i][j] =
            -element.area *
            (g_i * response.tangent.asDiagonal() * g_j.transpose() +
             geometricStiffness(element, response.stress, i, j) * Matrix3d::Identity());
      }
    }
    return result;
  };
  addElementJacobians(elements_, jacobian, rows);
}

}  // namespace haptex::cloth
