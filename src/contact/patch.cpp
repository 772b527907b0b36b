#include "haptex/contact/patch.h"

#include <algorithm>
#include <cmath>

#include "haptex/cloth/forces/element_assembly.h"
#include "haptex/contact/patch_forces.h"

namespace haptex::contact {
namespace {

using base::Finger;
using base::kFingers;
using Eigen::Vector3d;

// How the difference between two patches fades. What becomes rim had a place of its own, off the
// large-scale cloth; what becomes free had been held by it. A hold that weakens by a constant
// factor per step lets go at an even pace whatever the fabric's stiffness is.
constexpr double kDetourTime = 0.05;   // s, to 1/e
constexpr double kTetherTime = 0.005;  // s, to 1/e
constexpr double kFirstTether = 1e4;   // N/m
constexpr double kLastTether = 1e-3;   // N/m, then none

// 1/s, of the springs that hold the coarse part of a patch near the large-scale cloth, damped
// critically. They give way while the hand takes the patch along: Without them the large-scale
// cloth creeps for tens of seconds to where the patch is, because a patch this wide is softer than
// the loads are.
constexpr double kTieRate = 60.0;

// s: the next matrix of longer steps has little in common with the last one.
constexpr double kLongestKept = 4e-3;

/// A third of each adjacent triangle (m^2), per particle; of one fabric's, if it is given.
std::vector<double> areasOf(const mesh::ClothMesh& mesh, std::optional<int> fabric = std::nullopt) {
  return cloth::shareOut(cloth::restElements(mesh, fabric), mesh.rest_coordinates.size(),
                         [](std::size_t) { return 1.0; });
}

/// kg, per particle.
std::vector<double> massesOf(const mesh::ClothMesh& mesh,
                             const std::vector<material::Fabric>& fabrics) {
  std::vector<double> masses(mesh.rest_coordinates.size(), 0.0);
  for (std::size_t f = 0; f < fabrics.size(); ++f) {
    const std::vector<double> areas = areasOf(mesh, static_cast<int>(f));
    for (std::size_t i = 0; i < masses.size(); ++i) {
      masses[i] += fabrics[f].areal_density * areas[i];
    }
  }
  return masses;
}

/// N/m, to the large-scale cloth, of the particles of a cut that no refined element has.
std::vector<double> tiesOf(const RefinedCut& cut, const std::vector<double>& masses) {
  std::vector<double> ties;
  for (const double mass : masses) ties.push_back(mass * kTieRate * kTieRate);
  const std::size_t refined = static_cast<std::size_t>(cut.refined_count) << (2 * cut.refinement);
  for (std::size_t t = 0; t < refined; ++t) {
    for (const int particle : cut.mesh.triangles[t]) ties[particle] = 0.0;
  }
  return ties;
}

linear::SymmetricBlockMatrix leadingPattern(const linear::SymmetricBlockMatrix& matrix, int size) {
  std::vector<std::array<int, 2>> pairs;
  for (int i = 0; i < size; ++i) {
    for (int s = matrix.rowBegin(i); s < matrix.rowBegin(i + 1); ++s) {
      pairs.push_back({matrix.column(s), i});
    }
  }
  return {size, {}, pairs};
}

}  // namespace

Patch::Patch(const mesh::ClothMesh& coarse, RefinedCut cut,
             const std::vector<material::Fabric>& fabrics, const cloth::ModelledEffects& effects,
             const std::vector<ContactLaw>& laws, const PlacedObstacles* obstacles)
    : Patch(coarse, cut, fabrics, effects, laws, obstacles,
            forcesOn(coarse, cut, fabrics, effects)) {}

Patch::Patch(const mesh::ClothMesh& coarse, RefinedCut& cut,
             const std::vector<material::Fabric>& fabrics, const cloth::ModelledEffects& effects,
             const std::vector<ContactLaw>& laws, const PlacedObstacles* obstacles,
             PatchForces forces)
    : cut_(std::move(cut)),
      effects_(effects),
      forces_(std::move(forces.sum)),
      areas_(areasOf(cut_.mesh)),
      masses_(massesOf(cut_.mesh, fabrics)),
      matrix_(static_cast<int>(cut_.supports.size()), cut_.mesh.triangles, forces.pairs),
      solver_(leadingPattern(matrix_, cut_.free_count)),
      contacts_{{SphereContact(laws, cut_.fabrics, cut_.free_count),
                 SphereContact(laws, cut_.fabrics, cut_.free_count)}},
      rhs_(3, cut_.supports.size()),
      solution_(3, cut_.free_count) {
  forces_.bind(matrix_);
  if (effects.self_collision) {
    const auto thickest = std::max_element(
        laws.begin(), laws.end(),
        [](const auto& a, const auto& b) { return a.halfThickness() < b.halfThickness(); });
    layers_.emplace(coarse, cut_, 2.0 * thickest->halfThickness(), areas_);
  }
  if (obstacles != nullptr && !obstacles->bodies().empty()) {
    obstacles_.emplace(*obstacles, fabrics, cut_.fabrics, laws.front().tangentialStiffness(),
                       cut_.free_count);
  }
  const std::size_t count = cut_.supports.size();
  for (int owner : cut_.owners) corners_.push_back(coarse.triangles[owner]);
  state_.positions.assign(count, Vector3d::Zero());
  state_.velocities.assign(count, Vector3d::Zero());
  predicted_ = state_.positions;
  detours_ = state_.positions;
  tethers_.assign(count, 0.0);
  ties_ = tiesOf(cut_, masses_);
  contact_forces_.assign(count, 0.0);
  for (auto& touched : linearised_.values) touched.reserve(cut_.free_count);
  for (auto& responses : responses_.values) {
    for (linear::BlockVector& response : responses) response.setZero(3, cut_.free_count);
  }
}

Vector3d Patch::placeOnCloth(int particle, const LargeScaleMotion& motion) const {
  const std::array<int, 3>& corners = corners_[particle];
  const Vector3d& weights = cut_.weights[particle];
  return weights[0] * motion.position(corners[0]) + weights[1] * motion.position(corners[1]) +
         weights[2] * motion.position(corners[2]);
}

Particles Patch::particlesAt(const std::vector<Vector3d>& positions, Finger finger) const {
  const bool single = !layers_ || layers_->isSingle();
  return {positions, state_.velocities, areas(), cut_.free_count,
          single ? nullptr : &layers_->before(finger)};
}

Particles Patch::atObstacles(const std::vector<Vector3d>& positions) const {
  return {positions, state_.velocities, areas_, cut_.free_count};
}

void Patch::start(const LargeScaleMotion& motion) {
  for (std::size_t i = 0; i < particleCount(); ++i) {
    state_.positions[i] = placeOnCloth(static_cast<int>(i), motion);
    state_.velocities[i].setZero();
    detours_[i].setZero();
    tethers_[i] = 0.0;
    contact_forces_[i] = 0.0;
  }
  if (layers_) layers_->clear();
  if (obstacles_) {
    obstacles_->clear();
    obstacles_->commit(atObstacles(state_.positions));
  }
  for (const Finger finger : kFingers) {
    contacts_[finger].clear();
    linearised_[finger].clear();
    for (linear::BlockVector& response : responses_[finger]) response.setZero();
  }
}

void Patch::goOnFrom(const Patch& other, const LargeScaleMotion& motion) {
  start(motion);
  const bool touches = !other.contacts_[Finger::kIndex].touched().empty() ||
                       !other.contacts_[Finger::kThumb].touched().empty();
  auto theirs = other.cut_.order.begin();
  for (int i : cut_.order) {
    const Support& support = cut_.supports[i];
    while (theirs != other.cut_.order.end() && other.cut_.supports[*theirs] < support) ++theirs;
    const bool shared = theirs != other.cut_.order.end() && other.cut_.supports[*theirs] == support;
    const bool is_free = i < cut_.free_count;
    if (!shared) {
      const bool was_held = is_free && !placeOn(other, i, motion);
      if (touches && was_held) tethers_[i] = kFirstTether;
      continue;
    }
    const int k = *theirs;
    const bool was_free = k < other.cut_.free_count;
    state_.positions[i] = other.state_.positions[k];
    state_.velocities[i] = other.state_.velocities[k];
    detours_[i] = other.detours_[k];
    if (!is_free) {
      detours_[i] = state_.positions[i] - placeOnCloth(i, motion);
    } else if (was_free) {
      if (layers_) layers_->adopt(i, *other.layers_, k);
      if (obstacles_) obstacles_->adopt(i, *other.obstacles_, k);
      tethers_[i] = other.tethers_[k];
      for (const Finger finger : kFingers)
        contacts_[finger].adoptAnchor(i, other.contacts_[finger], k);
    } else if (touches) {
      tethers_[i] = kFirstTether;
    }
  }
}

/// Where the other patch has the element of a particle that it has not, if it has it: whole, but
/// refined here.
/// @returns whether the element was free to move there
bool Patch::placeOn(const Patch& other, int particle, const LargeScaleMotion& motion) {
  Vector3d position = Vector3d::Zero(), velocity = Vector3d::Zero();
  bool was_free = false;
  for (int k = 0; k < 3; ++k) {
    const int corner = cornerIn(other.cut_, corners_[particle][k]);
    if (corner < 0) return false;
    was_free = was_free || corner < other.cut_.free_count;
    position += cut_.weights[particle][k] * other.state_.positions[corner];
    velocity += cut_.weights[particle][k] * other.state_.velocities[corner];
  }
  state_.positions[particle] = position;
  state_.velocities[particle] = velocity;
  detours_[particle] = position - placeOnCloth(particle, motion);
  return was_free;
}

void Patch::tie(int particle, const LargeScaleMotion& motion, double h) {
  const double stiffness = ties_[particle];
  const double damping = 2.0 * stiffness / kTieRate;
  const std::array<int, 3>& corners = corners_[particle];
  Vector3d velocity = Vector3d::Zero();  // of its place on the cloth
  for (int k = 0; k < 3; ++k) {
    velocity += cut_.weights[particle][k] * motion.velocity(corners[k]);
  }
  const Vector3d& own = state_.velocities[particle];
  const Vector3d off = state_.positions[particle] + h * own - placeOnCloth(particle, motion);
  rhs_.col(particle) -= h * (stiffness * off + damping * (own - velocity));
  matrix_.diagonal(particle).diagonal().array() += h * h * stiffness + h * damping;
}

void Patch::assemble(const LargeScaleMotion& motion, double h) {
  const int count = static_cast<int>(particleCount());
  const double detour_left = std::exp(-h / kDetourTime);
  const double tether_left = std::exp(-h / kTetherTime);
  matrix_.setZero();
  for (int i = 0; i < cut_.free_count; ++i) {
    matrix_.diagonal(i).diagonal().setConstant(masses_[i]);
    rhs_.col(i) = h * masses_[i] * effects_.gravity;
    if (ties_[i] > 0.0) tie(i, motion, h);
    if (tethers_[i] == 0.0) continue;
    detours_[i] *= detour_left;
    const Vector3d end = state_.positions[i] + h * state_.velocities[i];
    rhs_.col(i) -= h * tethers_[i] * (end - placeOnCloth(i, motion) - detours_[i]);
    matrix_.diagonal(i).diagonal().array() += h * h * tethers_[i];
    tethers_[i] = tethers_[i] > kLastTether ? tether_left * tethers_[i] : 0.0;
  }
  for (int i = cut_.free_count; i < count; ++i) {
    detours_[i] *= detour_left;
    const Vector3d end = placeOnCloth(i, motion) + detours_[i];
    state_.velocities[i] = (end - state_.positions[i]) / h;
  }
  forces_.assembleLinearised(state_.ofForces(), {h, h}, matrix_, rhs_);
}

void Patch::add(const TouchedParticle& touched, double h) {
  rhs_.col(touched.particle) += h * touched.force();
  matrix_.diagonal(touched.particle) += h * h * touched.stiffness + h * touched.damping;
}

void Patch::addContact(const base::PerFinger<const Fingertip*>& fingertips, double h) {
  for (int i = 0; i < cut_.free_count; ++i) {
    predicted_[i] = state_.positions[i] + h * state_.velocities[i];
  }
  for (const Finger finger : kFingers) {
    linearised_[finger].clear();
    if (!fingertips[finger]) continue;
    for (const TouchedParticle& touched :
         contacts_[finger].evaluate(particlesAt(predicted_, finger), *fingertips[finger])) {
      linearised_[finger].push_back(touched);
      add(touched, h);
    }
  }
  if (!obstacles_) return;
  for (const TouchedParticle& touched : obstacles_->evaluate(atObstacles(predicted_))) {
    add(touched, h);
  }
}

bool Patch::solve(double h) {
  if (h > kLongestKept) return solver_.solveDirectly(matrix_, rhs_, solution_);
  const bool held = cut_.free_count < static_cast<int>(particleCount());
  const Vector3d guess = held ? Vector3d(Vector3d::Zero()) : effects_.gravity;
  return solver_.solve(matrix_, rhs_, guess, solution_);
}

bool Patch::advance(const LargeScaleMotion& motion,
                    const base::PerFinger<const Fingertip*>& fingertips, double h) {
  state_.time = motion.time();
  if (layers_) layers_->update(motion, fingertips, h);
  assemble(motion, h);
  addContact(fingertips, h);
  if (!solve(h)) return false;
  for (int i = 0; i < cut_.free_count; ++i) state_.velocities[i] += solution_.col(i);
  for (std::size_t i = 0; i < particleCount(); ++i) {
    state_.positions[i] += h * state_.velocities[i];
    contact_forces_[i] = 0.0;
  }
  if (obstacles_) obstacles_->commit(atObstacles(state_.positions));
  for (const Finger finger : kFingers) {
    if (!fingertips[finger]) {
      contacts_[finger].clear();
      continue;
    }
    for (const TouchedParticle& touched :
         contacts_[finger].commit(particles(finger), *fingertips[finger])) {
      contact_forces_[touched.particle] += touched.force().norm();
    }
  }
  return true;
}

const linear::BlockVector& Patch::respond(Finger finger, int direction) {
  rhs_.leftCols(cut_.free_count).setZero();
  for (const TouchedParticle& touched : linearised_[finger]) {
    rhs_.col(touched.particle) = touched.tangent.col(direction);
  }
  linear::BlockVector& response = responses_[finger][direction];
  solver_.improve(matrix_, rhs_, response);
  return response;
}

}  // namespace haptex::contact
