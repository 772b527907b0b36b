#include "haptex/cloth/dynamics/cloth.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "haptex/base/quoted.h"

namespace haptex::cloth {
namespace {

std::uint64_t nextRevision() {
  static std::atomic<std::uint64_t> last{0};
  return ++last;
}

void requireDensity(const material::Fabric& fabric) {
  if (!std::isfinite(fabric.areal_density) || fabric.areal_density <= 0.0) {
    std::ostringstream message;
    message << "areal density of fabric " << base::quoted(fabric.name) << " is "
            << fabric.areal_density << " kg/m2; it must be finite and greater than 0";
    throw std::invalid_argument(message.str());
  }
}

std::vector<material::Fabric> alone(material::Fabric fabric) {
  std::vector<material::Fabric> fabrics;
  fabrics.push_back(std::move(fabric));
  return fabrics;
}

/// @param fabrics that the triangles name, at least
std::vector<double> lumpedMasses(const mesh::ClothMesh& mesh,
                                 const std::vector<material::Fabric>& fabrics) {
  return shareOut(restElements(mesh), mesh.rest_coordinates.size(), [&](std::size_t triangle) {
    return fabrics[mesh.fabricOf(triangle)].areal_density;
  });
}

}  // namespace

Eigen::Vector3d AttachmentPath::position(double time) const {
  if (time < start_time) return start;
  if (time >= start_time + duration) return start + displacement;
  const double s = (time - start_time) / duration;
  if (at_constant_speed) return start + s * displacement;
  return start + s * s * s * (10.0 + s * (-15.0 + 6.0 * s)) * displacement;
}

Eigen::Vector3d AttachmentPath::velocity(double time) const {
  // The time of the last moment is a sum of substeps.
  const double end = start_time + (1.0 + 1e-9) * duration;
  if (at_constant_speed && duration > 0.0 && time >= start_time && time <= end) {
    return displacement / duration;
  }
  if (time < start_time || time >= start_time + duration) return Eigen::Vector3d::Zero();
  const double s = (time - start_time) / duration;
  return 30.0 * s * s * (1.0 - s) * (1.0 - s) / duration * displacement;
}

Cloth::Cloth(mesh::ClothMesh mesh, material::Fabric fabric, const ModelledEffects& effects)
    : Cloth(std::move(mesh), alone(std::move(fabric)), effects) {}

Cloth::Cloth(mesh::ClothMesh mesh, std::vector<material::Fabric> fabrics,
             const ModelledEffects& effects)
    : revision_(nextRevision()),
      mesh_(std::move(mesh)),
      effects_(effects),
      attachments_(mesh_.rest_coordinates.size()) {
  requireSound(mesh_);
  ties_ = std::make_unique<Ties>(mesh_);
  if (effects.self_collision && !ties_->empty()) {
    throw std::invalid_argument(
        "self_collision is modelled, and " + std::to_string(ties_->resolved().size()) +
        " particles are tied: allowed is one of both; edges that are merged need no ties");
  }
  takeFabrics(std::move(fabrics));
  if (!effects.contacts) return;
  contacts_.reserve(particleCount());
  touched_.resize(particleCount());
}

/// Makes all that depends on the fabrics; user-defined forces and point loads stay.
void Cloth::takeFabrics(std::vector<material::Fabric> fabrics) {
  for (const material::Fabric& fabric : fabrics) requireDensity(fabric);
  auto forces = std::make_unique<ForceSum>();
  if (!ties_->empty()) forces->setTies(*ties_);
  ForceSum of_fabrics;
  addFabricForces(mesh_, fabrics, effects_, of_fabrics);
  std::vector<double> masses = lumpedMasses(mesh_, fabrics);
  ties_->gather(masses);
  auto constant = std::make_unique<ConstantForces>(masses, effects_.gravity);
  if (constant_ != nullptr) constant->copyUserForces(*constant_);
  ConstantForces& added = forces->add(std::move(constant));
  const Fasteners* fasteners = nullptr;
  if (!effects_.fasteners.empty()) {
    const double thickness =
        effects_.self_collision ? of_fabrics.find<SelfContact>()->layers().thickness() : 0.0;
    fasteners =
        &forces->add(std::make_unique<Fasteners>(effects_.fasteners, masses.size(), thickness));
  }
  forces->addAll(std::move(of_fabrics));
  PointLoads* loads = nullptr;
  if (effects_.point_loads) loads = &forces->add(std::make_unique<PointLoads>(mesh_));
  if (point_loads_ != nullptr) loads->set(point_loads_->loads());
  const linear::SymmetricBlockMatrix matrix(static_cast<int>(masses.size()), mesh_.triangles,
                                            forces->pairs());
  forces->bind(matrix);
  ties_->bind(matrix);
  // Nothing throws from here on.
  pattern_size_ = matrix.lowerCount();
  fabrics_ = std::move(fabrics);
  masses_ = std::move(masses);
  forces_ = std::move(forces);
  constant_ = &added;
  fasteners_ = fasteners;
  point_loads_ = loads;
  self_contact_ = forces_->find<SelfContact>();
  if (obstacles_) self_contact_->setObstacles(obstacles_);
}

linear::SymmetricBlockMatrix Cloth::pattern() const {
  return {static_cast<int>(particleCount()), mesh_.triangles, forces_->pairs()};
}

ClothState Cloth::initialState() const {
  ClothState state;
  state.positions = mesh_.initial_positions;
  ties_->place(state.time, state.positions);
  state.velocities.assign(particleCount(), Eigen::Vector3d::Zero());
  forget(state);
  return state;
}

void Cloth::forget(ClothState& state) const {
  requireParticles(state);
  std::vector<double> fastened;
  if (fasteners_ != nullptr && !state.memory.empty()) {
    fastened.assign(state.memory.begin(),
                    state.memory.begin() + static_cast<std::ptrdiff_t>(fasteners_->memorySize()));
  }
  state.memory.resize(forces_->memorySize());
  forces_->forget(state.positions, state.memory.data());
  std::copy(fastened.begin(), fastened.end(), state.memory.begin());
}

void Cloth::remember(ClothState& state) const {
  requireState(state);
  forces_->remember(state.positions, state.memory.data());
}

void Cloth::setFabric(material::Fabric fabric) {
  std::vector<material::Fabric> fabrics = fabrics_;
  fabrics.front() = std::move(fabric);
  setMaterial(std::move(fabrics), effects_.gravity, effects_.air);
}

void Cloth::setMaterial(std::vector<material::Fabric> fabrics, const Eigen::Vector3d& gravity,
                        const std::optional<Air>& air) {
  if (fabrics.size() != fabrics_.size()) {
    throw std::invalid_argument("there are " + std::to_string(fabrics.size()) +
                                " fabrics: allowed are " + std::to_string(fabrics_.size()) +
                                ", as many as the cloth has");
  }
  if (air.has_value() != effects_.air.has_value()) {
    throw std::invalid_argument(effects_.air
                                    ? "the cloth is modelled with air; there is none"
                                    : "the cloth is modelled without air; none can be set");
  }
  const ModelledEffects before = effects_;
  effects_.gravity = gravity;
  effects_.air = air;
  try {
    takeFabrics(std::move(fabrics));
  } catch (...) {
    effects_ = before;
    throw;
  }
  revision_ = nextRevision();
}

void Cloth::computeForces(const ClothState& state, std::vector<Eigen::Vector3d>& forces) const {
  requireState(state);
  forces.assign(particleCount(), Eigen::Vector3d::Zero());
  forces_->addForces(state.ofForces(), forces);
}

double Cloth::potentialEnergy(const ClothState& state, linear::ThreadPool* pool) const {
  requireState(state);
  return forces_->energy(state.ofForces(pool));
}

double Cloth::kineticEnergy(const ClothState& state) const {
  requireState(state);
  double energy = 0.0;
  for (std::size_t i = 0; i < particleCount(); ++i) {
    energy += 0.5 * masses_[i] * state.velocities[i].squaredNorm();
  }
  return energy;
}

Eigen::Vector3d Cloth::momentum(const ClothState& state) const {
  requireState(state);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < particleCount(); ++i) sum += masses_[i] * state.velocities[i];
  return sum;
}

std::vector<JacobianBlock> Cloth::jacobian(const ClothState& state,
                                           const std::vector<int>& particles) const {
  requireState(state);
  for (const int particle : particles) requireParticle(particle);
  JacobianRows rows(particles);
  forces_->addJacobian(state.ofForces(), rows);
  return rows.blocks();
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
  constant_->set(particle, force);
  revision_ = nextRevision();
}

void Cloth::setPointLoads(const std::vector<PointLoad>& loads) {
  if (!effects_.point_loads && !loads.empty()) {
    throw std::invalid_argument("the cloth is modelled without point loads; none can be set");
  }
  if (point_loads_ == nullptr) return;
  point_loads_->set(loads);
  revision_ = nextRevision();
}

void Cloth::setContacts(const std::vector<ParticleContact>& contacts) {
  setContacts(contacts, bodies_);
}

void Cloth::setContacts(const std::vector<ParticleContact>& contacts, const RigidBodies& bodies) {
  if (!effects_.contacts) {
    throw std::invalid_argument("the cloth is modelled without contacts; none can be set");
  }
  cloth::requireSound(contacts, touched_, bodies_.bodies.size());
  if (bodies.bodies.size() != bodies_.bodies.size() ||
      bodies.contacts.size() > bodies_.contacts.capacity()) {
    std::ostringstream message;
    message << bodies.bodies.size() << " bodies with " << bodies.contacts.size()
            << " contacts cannot be set; reserved are " << bodies_.bodies.size() << " with "
            << bodies_.contacts.capacity();
    throw std::invalid_argument(message.str());
  }
  contacts_.assign(contacts.begin(), contacts.end());
  if (&bodies == &bodies_) return;
  bodies_.bodies.assign(bodies.bodies.begin(), bodies.bodies.end());
  bodies_.contacts.assign(bodies.contacts.begin(), bodies.contacts.end());
}

void Cloth::reserveBodies(std::size_t bodies, std::size_t contacts) {
  if (!effects_.contacts || effects_.self_collision) {
    throw std::invalid_argument(effects_.contacts
                                    ? "a cloth that collides with itself knows no rigid bodies"
                                    : "the cloth is modelled without contacts; it knows no bodies");
  }
  bodies_.bodies.resize(bodies);
  bodies_.contacts.reserve(contacts);
}

void Cloth::setObstacles(std::vector<mesh::Obstacle> obstacles) {
  if (self_contact_ == nullptr) {
    throw std::invalid_argument(
        "the cloth does not collide with itself, so obstacles act on it by "
        "contacts alone (setContacts())");
  }
  obstacles_.reset();
  if (!obstacles.empty()) obstacles_ = std::make_shared<ObstacleSurfaces>(std::move(obstacles));
  self_contact_->setObstacles(obstacles_);
  revision_ = nextRevision();
}

void Cloth::moveObstacles(double begin, double end) {
  if (obstacles_ && !obstacles_->move(begin, end)) revision_ = nextRevision();
}

void Cloth::closeSeams(const ClothState& state, double speed) {
  requireParticles(state);
  ties_->closeFrom(state.positions, state.time, speed);
}

void Cloth::requireAttachable(int particle) const {
  requireParticle(particle);
  for (const mesh::Tie& tie : mesh_.ties) {
    if (tie.particle != particle) continue;
    throw std::invalid_argument("particle " + std::to_string(particle) +
                                " is sewn to the edge from particle " +
                                std::to_string(tie.ends[0]) + " to " + std::to_string(tie.ends[1]) +
                                " and goes with it: allowed is to attach those");
  }
}

void Cloth::attach(int particle, const AttachmentPath& path) {
  requireAttachable(particle);
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
  if (state.memory.size() != forces_->memorySize()) {
    std::ostringstream message;
    message << "the state remembers " << state.memory.size() << " numbers; the forces of the cloth "
            << "remember " << forces_->memorySize();
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
