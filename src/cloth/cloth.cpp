#include "haptex/cloth/cloth.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>
#include <stdexcept>

namespace haptex::cloth {
namespace {

void requireDensity(const material::Fabric& fabric) {
  if (!std::isfinite(fabric.areal_density) || fabric.areal_density <= 0.0) {
    std::ostringstream message;
    message << "areal density of fabric '" << fabric.name << "' is " << fabric.areal_density
            << " kg/m2; it must be finite and greater than 0";
    throw std::invalid_argument(message.str());
  }
}

const ClothMesh& requireSoundAndReturn(const ClothMesh& mesh) {
  requireSound(mesh);
  return mesh;
}

std::vector<double> lumpedMasses(const Membrane& membrane, std::size_t particles, double density) {
  std::vector<double> masses(particles, 0.0);
  for (const MembraneElement& element : membrane.elements()) {
    for (int particle : element.particles) masses[particle] += density * element.area / 3.0;
  }
  return masses;
}

/// Nothing if bending is not modelled.
std::optional<Bending> bendingOf(const ClothMesh& mesh, const material::Fabric& fabric,
                                 const ModelledEffects& effects) {
  if (!effects.bending) return std::nullopt;
  if (!fabric.bending) {
    throw std::invalid_argument("bending is modelled and fabric '" + fabric.name +
                                "' has no bending rigidity: add the key bending");
  }
  return Bending(mesh, *fabric.bending);
}

}  // namespace

Eigen::Vector3d AttachmentPath::position(double time) const {
  if (time < start_time) return start;
  if (time >= start_time + duration) return start + displacement;
  const double s = (time - start_time) / duration;
  return start + s * s * s * (10.0 + s * (-15.0 + 6.0 * s)) * displacement;
}

Eigen::Vector3d AttachmentPath::velocity(double time) const {
  if (time < start_time || time >= start_time + duration) return Eigen::Vector3d::Zero();
  const double s = (time - start_time) / duration;
  return 30.0 * s * s * (1.0 - s) * (1.0 - s) / duration * displacement;
}

Cloth::Cloth(ClothMesh mesh, material::Fabric fabric, const ModelledEffects& effects)
    : mesh_(std::move(mesh)),
      fabric_(std::move(fabric)),
      effects_(effects),
      membrane_(requireSoundAndReturn(mesh_), fabric_, effects.viscosity),
      bending_(bendingOf(mesh_, fabric_, effects)),
      external_forces_(mesh_.rest_coordinates.size(), Eigen::Vector3d::Zero()),
      attachments_(mesh_.rest_coordinates.size()) {
  requireDensity(fabric_);
  if (!effects.gravity.allFinite()) {
    throw std::invalid_argument("gravity has a component that is not finite");
  }
  masses_ = lumpedMasses(membrane_, mesh_.rest_coordinates.size(), fabric_.areal_density);
  bindBending();
  point_loads_.reserve(kMostPointLoads);
  checked_loads_.reserve(kMostPointLoads);
}

SymmetricBlockMatrix Cloth::pattern() const {
  const int count = static_cast<int>(particleCount());
  if (!bending_) return {count, mesh_.triangles};
  return {count, mesh_.triangles, bending_->pairs()};
}

void Cloth::bindBending() {
  if (!bending_) return;
  const SymmetricBlockMatrix matrix = pattern();
  membrane_.bind(matrix);
  bending_->bind(matrix);
}

ClothState Cloth::initialState() const {
  ClothState state;
  state.positions = mesh_.initial_positions;
  state.velocities.assign(particleCount(), Eigen::Vector3d::Zero());
  return state;
}

void Cloth::setFabric(material::Fabric fabric) {
  requireDensity(fabric);
  bending_ = bendingOf(mesh_, fabric, effects_);
  bindBending();
  membrane_.setFabric(fabric);
  masses_ = lumpedMasses(membrane_, particleCount(), fabric.areal_density);
  fabric_ = std::move(fabric);
}

void Cloth::requireParticle(int particle) const {
  if (particle < 0 || particle >= static_cast<int>(particleCount())) {
    std::ostringstream message;
    message << "particle " << particle << " does not exist; the cloth has particles 0 to "
            << particleCount() - 1;
    throw std::invalid_argument(message.str());
  }
}

void Cloth::setExternalForce(int particle, const Eigen::Vector3d& force) {
  requireParticle(particle);
  if (!force.allFinite()) {
    throw std::invalid_argument("the force on particle " + std::to_string(particle) +
                                " has a component that is not finite");
  }
  external_forces_[particle] = force;
}

void Cloth::setPointLoads(const std::vector<PointLoad>& loads) {
  if (loads.size() > kMostPointLoads) {
    throw std::invalid_argument("there are " + std::to_string(loads.size()) +
                                " point loads; allowed are " + std::to_string(kMostPointLoads));
  }
  checked_loads_.clear();
  for (std::size_t i = 0; i < loads.size(); ++i) {
    checked_loads_.push_back(checkedLoad(loads[i], i, mesh_.triangles.size()));
  }
  std::swap(point_loads_, checked_loads_);
}

void Cloth::attach(int particle, const AttachmentPath& path) {
  requireParticle(particle);
  const bool finite = path.start.allFinite() && path.displacement.allFinite() &&
                      std::isfinite(path.start_time) && std::isfinite(path.duration);
  if (!finite || path.duration < 0.0) {
    std::ostringstream message;
    message << "the path of particle " << particle << " from (" << path.start.transpose()
            << ") m by (" << path.displacement.transpose() << ") m in " << path.duration
            << " s is not allowed; numbers must be finite and the duration at least 0";
    throw std::invalid_argument(message.str());
  }
  attachments_[particle] = path;
}

void Cloth::release(int particle) {
  requireParticle(particle);
  if (!attachments_[particle]) {
    throw std::invalid_argument("particle " + std::to_string(particle) + " is not attached");
  }
  attachments_[particle].reset();
}

void Cloth::releaseAll() { std::fill(attachments_.begin(), attachments_.end(), std::nullopt); }

bool Cloth::isAttached(int particle) const {
  requireParticle(particle);
  return attachments_[particle].has_value();
}

void Cloth::requireState(const ClothState& state) const {
  if (state.positions.size() != particleCount() || state.velocities.size() != particleCount()) {
    std::ostringstream message;
    message << "the state has " << state.positions.size() << " positions and "
            << state.velocities.size() << " velocities; the cloth has " << particleCount()
            << " particles";
    throw std::invalid_argument(message.str());
  }
}

void Cloth::computeForces(const ClothState& state, std::vector<Eigen::Vector3d>& forces) const {
  requireState(state);
  forces.resize(particleCount());
  for (std::size_t i = 0; i < particleCount(); ++i) {
    forces[i] = external_forces_[i] + masses_[i] * effects_.gravity;
  }
  membrane_.addForces(state.positions, state.velocities, forces);
  if (bending_) bending_->addForces(state.positions, forces);
  addPointForces(point_loads_, mesh_.triangles, state.positions, forces);
}

double Cloth::potentialEnergy(const ClothState& state) const {
  requireState(state);
  double energy = membrane_.elasticEnergy(state.positions) +
                  pointLoadEnergy(point_loads_, mesh_.triangles, state.positions);
  if (bending_) energy += bending_->energy(state.positions);
  for (std::size_t i = 0; i < particleCount(); ++i) {
    energy -= (external_forces_[i] + masses_[i] * effects_.gravity).dot(state.positions[i]);
  }
  return energy;
}

double Cloth::kineticEnergy(const ClothState& state) const {
  requireState(state);
  double energy = 0.0;
  for (std::size_t i = 0; i < particleCount(); ++i) {
    energy += 0.5 * masses_[i] * state.velocities[i].squaredNorm();
  }
  return energy;
}

void Cloth::addPointLoadJacobian(const std::map<int, std::vector<std::size_t>>& rows_of_particle,
                                 std::vector<JacobianRow>& rows) const {
  for (const PointLoad& load : point_loads_) {
    const std::array<int, 3>& corners = mesh_.triangles[load.triangle];
    for (int i = 0; i < 3; ++i) {
      const auto asked = rows_of_particle.find(corners[i]);
      if (asked == rows_of_particle.end()) continue;
      for (std::size_t r : asked->second) {
        for (int j = 0; j < 3; ++j) {  // the membrane has made the block
          rows[r].at(corners[j]).by_position -= load.weights[i] * load.weights[j] * load.stiffness;
        }
      }
    }
  }
}

void Cloth::addBendingJacobian(const std::map<int, std::vector<std::size_t>>& rows_of_particle,
                               std::vector<JacobianRow>& rows) const {
  const auto add = [&](int row, int column, double stiffness) {
    const auto asked = rows_of_particle.find(row);
    if (asked == rows_of_particle.end()) return;
    const Eigen::Matrix3d block = stiffness * Eigen::Matrix3d::Identity();
    for (std::size_t r : asked->second) {
      rows[r].at(row).by_position += block;
      const JacobianBlock empty{row, column, Eigen::Matrix3d::Zero(), Eigen::Matrix3d::Zero()};
      rows[r].emplace(column, empty).first->second.by_position -= block;
    }
  };
  for (const Bending::Coupling& coupling : bending_->couplings()) {
    add(coupling.row, coupling.column, coupling.stiffness);
    add(coupling.column, coupling.row, coupling.stiffness);
  }
}

std::vector<JacobianBlock> Cloth::jacobian(const ClothState& state,
                                           const std::vector<int>& particles) const {
  requireState(state);
  std::vector<JacobianRow> rows(particles.size());
  std::map<int, std::vector<std::size_t>> rows_of_particle;
  for (std::size_t r = 0; r < particles.size(); ++r) {
    requireParticle(particles[r]);
    rows_of_particle[particles[r]].push_back(r);
  }
  for (const MembraneElement& element : membrane_.elements()) {
    for (int i = 0; i < 3; ++i) {
      const auto asked = rows_of_particle.find(element.particles[i]);
      if (asked == rows_of_particle.end()) continue;
      const Membrane::Jacobian jacobian =
          membrane_.exactJacobian(element, state.positions, state.velocities);
      for (std::size_t r : asked->second) {
        for (int j = 0; j < 3; ++j) {
          JacobianBlock empty{element.particles[i], element.particles[j], Eigen::Matrix3d::Zero(),
                              Eigen::Matrix3d::Zero()};
          JacobianBlock& block = rows[r].emplace(element.particles[j], empty).first->second;
          block.by_position += jacobian.by_position[i][j];
          block.by_velocity += jacobian.by_velocity[i][j];
        }
      }
    }
  }
  if (bending_) addBendingJacobian(rows_of_particle, rows);
  addPointLoadJacobian(rows_of_particle, rows);
  std::vector<JacobianBlock> blocks;
  for (const auto& row : rows) {
    for (const auto& entry : row) blocks.push_back(entry.second);
  }
  return blocks;
}

}  // namespace haptex::cloth
