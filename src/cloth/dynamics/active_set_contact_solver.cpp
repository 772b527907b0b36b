#include "haptex/cloth/dynamics/active_set_contact_solver.h"

#include <algorithm>
#include <cmath>

// The rounds of a system. StageSolver calls
//   begin()         once per stage: each contact starts from what its particle's did in the last;
//   beginSystem()   with the free system A dv = b, once per linear solve or Newton iteration;
//   prepareRound()  a fresh copy of it; what sticks is prescribed, what slips gets its friction as
//   a
//                   force on the right-hand side and the resistance of its direction on the
//                   diagonal;
//   confine()       takes the normals of what slips out of the unknowns;
//   prepareMode(), setResponse(), moveBodies()  if contacts hold to rigid bodies (BodyCoupling);
//   compareLoads()  after the solve: r = A dv - b of the free system are the impulses that the
//                   constraints had to exert, r / a the forces N n + T. Until the friction of what
//                   slips was that of these N, prepareLoads() and addLoads() change it;
//   update()        judges it (active_set_contact_rounds.cpp),
// until update() is content.
namespace haptex::cloth {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

constexpr double kLoadTolerance = 1e-6;  // of the loads of all contacts together

}  // namespace

ActiveSetContactSolver::ActiveSetContactSolver(const linear::SymmetricBlockMatrix& pattern,
                                               const RigidBodies& bodies)
    : guess_(3, pattern.size()),
      free_matrix_(pattern),
      free_rhs_(3, pattern.size()),
      residual_(3, pattern.size()),
      accepted_(3, pattern.size()),
      product_(3, pattern.size()),
      attached_(pattern.size(), 0),
      confined_(pattern.size(), 0),
      normals_(3, pattern.size()),
      values_(3, pattern.size()),
      loads_(Eigen::VectorXd::Zero(pattern.size())),
      results_(Eigen::VectorXd::Zero(pattern.size())),
      friction_(pattern.size(), 3 * pattern.size()),
      bodies_(bodies.bodies.size(), bodies.contacts.capacity(), pattern.size()),
      memory_(pattern.size()) {
  if (!bodies_.empty()) mode_.resize(3, pattern.size());
  entries_.reserve(pattern.size());
  kept_.reserve(pattern.size());
  reactions_.reserve(pattern.size());
}

void ActiveSetContactSolver::begin(const Cloth& cloth, const Stage& stage, const Velocities& guess,
                                   const std::vector<char>& attached) {
  a_ = stage.a;
  entries_.clear();
  if (!bodies_.empty()) bodies_.begin(cloth.bodies(), stage.a);
  reactions_.assign(cloth.contacts().size(), {});
  for (std::size_t i = 0; i < cloth.contacts().size(); ++i) {
    if (!attached[cloth.contacts()[i].particle]) {
      entries_.push_back(entryOf(cloth, stage, static_cast<int>(i)));
    }
  }
  ++stages_;
  if (entries_.empty()) {
    left_smoothing_ = 0.0;
    return;
  }
  attached_ = attached;
  loads_.setZero();
  results_.setZero();
  if (!bodies_.empty()) bodies_.place(entries_);
  // What was not there in the last stage knows nothing.
  for (Entry& entry : entries_) {
    if (entry.stage == stages_ - 1) continue;
    static_cast<ContactMemory&>(entry) = ContactMemory{};
    const RelativeMotion motion = relativeMotion(entry, guess[entry.particle]);
    if (a_ * motion.gap < -kContactPenetration) close(motion, entry);
  }
}

/// With what is remembered of the particle.
ActiveSetContactSolver::Entry ActiveSetContactSolver::entryOf(const Cloth& cloth,
                                                              const Stage& stage, int index) const {
  const ParticleContact& contact = cloth.contacts()[index];
  const Vector3d place =
      contact.place + (stage.end - contact.end) * contact.velocity - contact.gap * contact.normal;
  Entry entry;
  static_cast<ContactMemory&>(entry) = memory_[contact.particle];
  entry.contact = index;
  entry.particle = contact.particle;
  entry.normal = contact.normal;
  entry.body = contact.velocity;
  // With it the stage goes its share of the way: x* + a v = x* + share (place - x*).
  entry.target = stage.share / stage.a * (place - stage.base.positions[contact.particle]);
  entry.friction = contact.friction;
  if (contact.body >= 0) {
    entry.rigid = contact.body;
    entry.arm = contact.arm;
    entry.mass = cloth.masses()[contact.particle];
    entry.predicted_body = entry.body;
    entry.predicted_target = entry.target;
  }
  entry.slip -= entry.normal * entry.normal.dot(entry.slip);  // the plane may have turned
  return entry;
}

void ActiveSetContactSolver::beginSystem(const Velocities& velocities,
                                         const linear::SymmetricBlockMatrix& matrix,
                                         const linear::BlockVector& rhs) {
  for (int i = 0; i < matrix.size(); ++i) guess_.col(i) = velocities[i];
  free_matrix_ = matrix;
  free_rhs_ = rhs;
  phase_ = Phase::kSearch;
  rounds_ = 0;
  for (Entry& entry : entries_) {
    entry.before = entry.force;
    entry.fresh = false;
  }
  accepted_.setZero();
  if (!bodies_.empty()) bodies_.beginSystem();
  last_ = false;
  kept_smoothing_ = 0.0;
  stalled_rounds_ = 0;
  smoothing_ = std::max(smoothingOfSlips(), left_smoothing_);
}

bool ActiveSetContactSolver::prepareRound(linear::SymmetricBlockMatrix& matrix,
                                          linear::BlockVector& rhs, std::vector<char>& fixed,
                                          linear::BlockVector& prescribed) {
  ++rounds_;
  matrix = free_matrix_;
  rhs = free_rhs_;
  fixed = attached_;
  if (!bodies_.empty()) {
    bodies_.place(entries_);
    if (phase_ == Phase::kForces) {
      bodies_.endRounds();
    } else {
      bodies_.beginRound(entries_);
    }
  }
  std::fill(confined_.begin(), confined_.end(), 0);
  for (std::size_t k = 0; k < entries_.size(); ++k) {
    Entry& entry = entries_[k];
    loads_[k] = 0.0;
    if (phase_ == Phase::kForces) {
      rhs.col(entry.particle) += a_ * entry.force;
      continue;
    }
    if (phase_ == Phase::kSearch) entry.ratio = frictionAt(entry, entry.slip, 1.0, smoothing_);
    if (entry.state == State::kSlips) loads_[k] = entry.load;
    constrain(entry, matrix, rhs, fixed, prescribed);
  }
  return std::find(fixed.begin(), fixed.end(), 1) != fixed.end();
}

void ActiveSetContactSolver::constrain(const Entry& entry, linear::SymmetricBlockMatrix& matrix,
                                       linear::BlockVector& rhs, std::vector<char>& fixed,
                                       linear::BlockVector& prescribed) {
  const int i = entry.particle;
  const Vector3d velocity = guess_.col(i);
  const Vector3d change = entry.target - velocity;
  if (entry.state == State::kSticks) {
    fixed[i] = 1;
    prescribed.col(i) = change;
    return;
  }
  if (entry.state == State::kOpen) return;
  const Vector3d& n = entry.normal;
  confined_[i] = 1;
  normals_.col(i) = n;
  values_.col(i) = n * n.dot(change);
  if (entry.friction == 0.0) return;
  rhs.col(i) += a_ * entry.load * entry.ratio;
  if (phase_ != Phase::kSearch) return;
  const Matrix3d resisted = frictionResistance(entry, smoothing_);
  rhs.col(i) -= a_ * resisted * (velocity - entry.target - entry.slip);
  matrix.diagonal(i) += a_ * resisted;
}

void ActiveSetContactSolver::confine(linear::SymmetricBlockMatrix& matrix,
                                     linear::BlockVector& rhs) const {
  matrix.confine(confined_, normals_, values_, rhs);
}

void ActiveSetContactSolver::removeNormal(linear::BlockVector& solution) const {
  for (const Entry& entry : entries_) {
    if (!confined_[entry.particle]) continue;
    solution.col(entry.particle) -= entry.normal * entry.normal.dot(solution.col(entry.particle));
  }
}

void ActiveSetContactSolver::putNormal(linear::BlockVector& solution) const {
  removeNormal(solution);
  for (const Entry& entry : entries_) {
    if (confined_[entry.particle]) solution.col(entry.particle) += values_.col(entry.particle);
  }
}

void ActiveSetContactSolver::compareLoads(const linear::BlockVector& solution) {
  free_matrix_.multiply(solution, residual_);
  results_.setZero();
  for (std::size_t k = 0; k < entries_.size(); ++k) {
    const Entry& entry = entries_[k];
    if (!confined_[entry.particle] || entry.friction == 0.0) {
      loads_[k] = 0.0;
      continue;
    }
    const int i = entry.particle;
    results_[k] = entry.normal.dot(residual_.col(i) - free_rhs_.col(i)) / a_;
  }
  friction_.begin(loads_, results_);
}

bool ActiveSetContactSolver::prepareLoads(linear::BlockVector& rhs) const {
  if (!friction_.wantsDirection(kLoadTolerance)) return false;
  rhs.setZero();
  for (std::size_t k = 0; k < entries_.size(); ++k) {
    const Entry& entry = entries_[k];
    if (!confined_[entry.particle]) continue;
    rhs.col(entry.particle) = a_ * friction_.direction()[k] * entry.ratio;
  }
  return true;
}

void ActiveSetContactSolver::addLoads(linear::BlockVector& change, linear::BlockVector& solution) {
  free_matrix_.multiply(change, residual_);
  if (modes() > 0) {
    bodies_.respond(residual_, entries_, change);
    free_matrix_.multiply(change, residual_);
  }
  for (std::size_t k = 0; k < entries_.size(); ++k) {
    const Entry& entry = entries_[k];
    if (!confined_[entry.particle] || entry.friction == 0.0) continue;
    results_[k] = entry.normal.dot(residual_.col(entry.particle)) / a_;
  }
  Eigen::Map<Eigen::VectorXd> change_numbers(change.data(), change.size());
  Eigen::Map<Eigen::VectorXd> numbers(solution.data(), solution.size());
  friction_.add(results_, change_numbers, loads_, numbers);
}

/// With a contact that holds to a body go its particle, where it slips along the normal alone, and
/// friction's resistance.
void ActiveSetContactSolver::prepareMode(int mode, linear::BlockVector& rhs) {
  mode_.setZero();
  for (const Entry& entry : entries_) {
    if (entry.state == State::kOpen) continue;
    const Vector3d motion = bodies_.motion(mode, entry);
    const bool sticks = entry.state == State::kSticks;
    mode_.col(entry.particle) = sticks ? motion : Vector3d(entry.normal * entry.normal.dot(motion));
  }
  free_matrix_.multiply(mode_, rhs);
  rhs = -rhs;
  for (const Entry& entry : entries_) {
    if (entry.state == State::kOpen) continue;
    const int i = entry.particle;
    if (entry.state == State::kSticks) {
      rhs.col(i).setZero();
      continue;
    }
    if (phase_ == Phase::kSearch && entry.friction > 0.0) {
      rhs.col(i) += a_ * frictionResistance(entry, smoothing_) * bodies_.motion(mode, entry);
    }
    rhs.col(i) -= entry.normal * entry.normal.dot(rhs.col(i));
  }
  for (int i = 0; i < rhs.cols(); ++i) {
    if (attached_[i]) rhs.col(i).setZero();
  }
}

void ActiveSetContactSolver::setResponse(int mode, linear::BlockVector& response) {
  response += mode_;
  free_matrix_.multiply(response, residual_);
  bodies_.setResponse(mode, response, residual_, entries_);
}

void ActiveSetContactSolver::moveBodies(linear::BlockVector& solution) {
  free_matrix_.multiply(solution, residual_);
  residual_ -= free_rhs_;
  bodies_.solve(residual_, entries_, solution);
}

void ActiveSetContactSolver::moveBodies(double share) {
  if (bodies_.empty()) return;
  bodies_.go(share);
  bodies_.place(entries_);
}

/// For the next stage, and for who asks what the contact did.
void ActiveSetContactSolver::finish() {
  moveBodies(1.0);
  left_smoothing_ = last_ ? smoothing_ : 0.0;
  phase_ = Phase::kFinished;
  for (Entry& entry : entries_) {
    bringIntoCone(entry);
    ContactReaction& reaction = reactions_[entry.contact];
    reaction.force = entry.force;
    reaction.state = entry.state;
    reaction.velocity = entry.body;
    memory_[entry.particle] = entry;
    memory_[entry.particle].stage = stages_;
  }
}

double ActiveSetContactSolver::potentialOf(const Entry& entry, const Vector3d& velocity) const {
  constexpr double kPenalty = 2.0;  // of what enters a body, over what brings it out
  const double load = entry.normal.dot(entry.force);
  if (!(load > 0.0)) return 0.0;
  const RelativeMotion motion = relativeMotion(entry, velocity);
  return a_ * load * (entry.friction * motion.slip.norm() + kPenalty * std::max(0.0, -motion.gap));
}

double ActiveSetContactSolver::potential(const Velocities& velocities) const {
  double potential = 0.0;
  for (const Entry& entry : entries_) potential += potentialOf(entry, velocities[entry.particle]);
  return bodies_.empty() ? potential : potential + bodies_.potential();
}

double ActiveSetContactSolver::descent(const linear::BlockVector& solution) const {
  double descent = free_rhs_.cwiseProduct(solution).sum();
  if (!bodies_.empty()) descent += bodies_.descent();
  for (const Entry& entry : entries_) {
    const Vector3d after = guess_.col(entry.particle) + solution.col(entry.particle);
    Vector3d before = guess_.col(entry.particle);
    if (entry.rigid >= 0) before += bodies_.way(entry);  // relative to the body as it goes now
    descent += potentialOf(entry, before) - potentialOf(entry, after);
  }
  return descent;
}

void ActiveSetContactSolver::shorten(double share) {
  moveBodies(share);
  for (Entry& entry : entries_) {
    entry.force = (1.0 - share) * entry.before + share * entry.force;
    reactions_[entry.contact].force = entry.force;
    reactions_[entry.contact].velocity = entry.body;
    if (entry.force.isZero(0.0)) reactions_[entry.contact].state = State::kOpen;
  }
}

double ActiveSetContactSolver::residualNorm(const linear::BlockVector& rhs) const {
  double squared = 0.0;
  for (int i = 0; i < rhs.cols(); ++i) {
    if (!attached_[i]) squared += rhs.col(i).squaredNorm();
  }
  for (const Entry& entry : entries_) {
    const Vector3d of_cloth = rhs.col(entry.particle);
    squared += (of_cloth + a_ * entry.force).squaredNorm() - of_cloth.squaredNorm();
  }
  return std::sqrt(std::max(0.0, squared));
}

bool ActiveSetContactSolver::enter(const Velocities& velocities, double depth) const {
  return std::any_of(entries_.begin(), entries_.end(), [&](const Entry& entry) {
    return !(a_ * relativeMotion(entry, velocities[entry.particle]).gap >= -depth);
  });
}

void ActiveSetContactSolver::settle(Velocities& velocities) {
  if (!bodies_.empty()) bodies_.settle(entries_, reactions_, velocities);
  for (const Entry& entry : entries_) {
    if (entry.rigid >= 0) continue;
    Vector3d& velocity = velocities[entry.particle];
    const State state = reactions_[entry.contact].state;
    if (state == State::kSticks) velocity = entry.body;
    if (state == State::kSlips) {
      velocity += entry.normal * entry.normal.dot(entry.body - velocity);
    }
  }
}

bool ActiveSetContactSolver::holding() const {
  return std::any_of(reactions_.begin(), reactions_.end(), [](const ContactReaction& reaction) {
    return reaction.state != State::kOpen;
  });
}

}  // namespace haptex::cloth
