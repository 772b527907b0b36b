#include "haptex/cloth/dynamics/cloth.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace haptex::cloth {
namespace {

std::uint64_t nextRevision() {
  static std::atomic<std::uint64_t> last{0};
  return ++last;
}

void requireDensity(const material::Fabric& fabric) {
  if (!std::isfinite(fabric.areal_density) || fabric.areal_density <= 0.0) {
    std::ostringstream message;
    message << "areal density of fabric '" << fabric.name << "' is " << fabric.areal_density
            << " kg/m2; it must be finite and greater than 0";
    throw std::invalid_argument(message.str());
  }
}

const mesh::ClothMesh& requireSoundAndReturn(const mesh::ClothMesh& mesh) {
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

void requireHysteresis(const material::Fabric& fabric, const ModelledEffects& effects) {
  if (!effects.bending) {
    throw std::invalid_argument("hysteresis of bending is modelled and bending is not");
  }
  if (effects.elasticity == Elasticity::kMassSpring) {
    throw std::invalid_argument(
        "hysteresis of bending is modelled, which bend springs do not know");
  }
  if (!fabric.bending_hysteresis) {
    throw std::invalid_argument("hysteresis of bending is modelled and fabric '" + fabric.name +
                                "' has none: add the key hysteresis to bending");
  }
}

const material::Fabric& requireModelled(const material::Fabric& fabric,
                                        const ModelledEffects& effects) {
  if (effects.contraction && effects.elasticity != Elasticity::kGreenLagrange) {
    throw std::invalid_argument(
        "contraction is modelled, which only Green-Lagrange elasticity knows");
  }
  if (effects.bending_hysteresis) requireHysteresis(fabric, effects);
  if (effects.contraction && !fabric.contraction) {
    throw std::invalid_argument("contraction is modelled and fabric '" + fabric.name +
                                "' has none: add the key contraction");
  }
  return fabric;
}

/// Nothing if bending is not modelled, or by springs.
std::optional<Bending> bendingOf(const mesh::ClothMesh& mesh, const material::Fabric& fabric,
                                 const ModelledEffects& effects) {
  if (!effects.bending) return std::nullopt;
  if (!fabric.bending) {
    throw std::invalid_argument("bending is modelled and fabric '" + fabric.name +
                                "' has no bending rigidity: add the key bending");
  }
  if (effects.elasticity == Elasticity::kMassSpring) return std::nullopt;
  return Bending(mesh, *fabric.bending, effects.bending_settings,
                 effects.bending_hysteresis ? fabric.bending_hysteresis : std::nullopt);
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

Cloth::Cloth(mesh::ClothMesh mesh, material::Fabric fabric, const ModelledEffects& effects)
    : revision_(nextRevision()),
      mesh_(std::move(mesh)),
      fabric_(std::move(fabric)),
      effects_(effects),
      membrane_(requireSoundAndReturn(mesh_), requireModelled(fabric_, effects), effects.viscosity,
                effects.contraction),
      bending_(bendingOf(mesh_, fabric_, effects)),
      air_(effects.air ? std::optional<Aerodynamics>(*effects.air) : std::nullopt),
      external_forces_(mesh_.rest_coordinates.size(), Eigen::Vector3d::Zero()),
      attachments_(mesh_.rest_coordinates.size()) {
  requireDensity(fabric_);
  if (!effects.gravity.allFinite()) {
    throw std::invalid_argument("gravity has a component that is not finite");
  }
  masses_ = lumpedMasses(membrane_, mesh_.rest_coordinates.size(), fabric_.areal_density);
  if (effects.elasticity == Elasticity::kMassSpring) {
    springs_.emplace(mesh_, fabric_, effects.viscosity, effects.bending);
  }
  bindPattern();
  if (effects.point_loads) point_loads_.reserve(kMaxPointLoads);
  if (!effects.contacts) return;
  contacts_.reserve(particleCount());
  touched_.resize(particleCount());
}

linear::SymmetricBlockMatrix Cloth::pattern() const {
  const int count = static_cast<int>(particleCount());
  if (springs_) return {count, mesh_.triangles, springs_->pairs()};
  if (!bending_) return {count, mesh_.triangles};
  return {count, mesh_.triangles, bending_->pairs()};
}

/// Makes what has slots in the matrix anew for the present fabric and pattern.
void Cloth::bindPattern() {
  if (bending_ || springs_) {
    const linear::SymmetricBlockMatrix matrix = pattern();
    membrane_.bind(matrix);
    if (bending_) bending_->bind(matrix);
    if (springs_) springs_->bind(matrix);
  }
  if (effects_.elasticity == Elasticity::kCorotational) {
    corotational_.emplace(membrane_.elements(), fabric_, effects_.viscosity);
  }
}

ClothState Cloth::initialState() const {
  ClothState state;
  state.positions = mesh_.initial_positions;
  state.velocities.assign(particleCount(), Eigen::Vector3d::Zero());
  forgetBending(state);
  return state;
}

void Cloth::forgetBending(ClothState& state) const {
  requireParticles(state);
  state.plastic_bends.clear();
  if (const BendingFriction* friction = bendingFriction()) {
    state.plastic_bends = friction->withoutFriction(state.positions);
  }
}

void Cloth::yieldBending(ClothState& state) const {
  requireState(state);
  if (bendingFriction()) bendingFriction()->yield(state.positions, state.plastic_bends);
}

void Cloth::setFabric(material::Fabric fabric) {
  requireDensity(fabric);
  requireModelled(fabric, effects_);
  revision_ = nextRevision();
  bending_ = bendingOf(mesh_, fabric, effects_);
  fabric_ = std::move(fabric);
  membrane_.setFabric(fabric_);
  if (springs_) springs_->setFabric(fabric_);
  bindPattern();
  masses_ = lumpedMasses(membrane_, particleCount(), fabric_.areal_density);
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
  revision_ = nextRevision();
}

void Cloth::setPointLoads(const std::vector<PointLoad>& loads) {
  if (!effects_.point_loads && !loads.empty()) {
    throw std::invalid_argument("the cloth is modelled without point loads; none can be set");
  }
  if (loads.size() > kMaxPointLoads) {
    throw std::invalid_argument("there are " + std::to_string(loads.size()) +
                                " point loads; allowed are " + std::to_string(kMaxPointLoads));
  }
  for (std::size_t i = 0; i < loads.size(); ++i) checkedLoad(loads[i], i, mesh_.triangles.size());
  revision_ = nextRevision();
  point_loads_.clear();
  for (std::size_t i = 0; i < loads.size(); ++i) {
    point_loads_.push_back(checkedLoad(loads[i], i, mesh_.triangles.size()));
  }
}

void Cloth::setContacts(const std::vector<ParticleContact>& contacts) {
  if (!effects_.contacts) {
    throw std::invalid_argument("the cloth is modelled without contacts; none can be set");
  }
  cloth::requireSound(contacts, touched_);
  contacts_.assign(contacts.begin(), contacts.end());
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
  requireParticles(state);
  const std::size_t bends = bendingFriction() ? bendingFriction()->size() : 0;
  if (state.plastic_bends.size() != bends) {
    std::ostringstream message;
    message << "the state has " << state.plastic_bends.size() << " plastic bends; the cloth has "
            << bends << " hinges with friction";
    throw std::invalid_argument(message.str());
  }
}

void Cloth::requireParticles(const ClothState& state) const {
  if (state.positions.size() != particleCount() || state.velocities.size() != particleCount()) {
    std::ostringstream message;
    message << "the state has " << state.positions.size() << " positions and "
            << state.velocities.size() << " velocities; the cloth has " << particleCount()
            << " particles";
    throw std::invalid_argument(message.str());
  }
}

}  // namespace haptex::cloth
