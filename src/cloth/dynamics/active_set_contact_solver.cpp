#include "haptex/cloth/dynamics/active_set_contact_solver.h"

#include <algorithm>
#include <cmath>

// The rounds of a stage. StageSolver calls
//   begin()         once: each contact starts from what its particle's did in the last stage, a new
//                   one sticks if the guess enters the body and is open otherwise;
//   prepareRound()  a fresh copy of the free system A dv = b; what sticks is prescribed, what slips
//                   gets its friction as a force on the right-hand side and the resistance of its
//                   direction on the diagonal;
//   confine()       takes the normals of what slips out of the unknowns;
//   update()        after the solve: r = A dv - b of the free system are the impulses that the
//                   constraints had to exert, r / a the forces N n + T. They say who lets go (N <
//                   0), slips (|T| > mu N) or sticks again (the slip has come round to where
//                   friction pushes).
// until nothing changes. Compare the primal-dual active sets of Hintermueller, Ito and Kunisch,
// SIAM J. Optim. 13 (2003), and for friction that is given from round to round Necas, Jarusek and
// Haslinger, Boll. Un. Mat. Ital. 17-B (1980).
namespace haptex::cloth {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

constexpr double kPenetration = 1e-9;  // m, not worth another round
constexpr double kRest = 1e-5;         // m/s, slower than that nothing slips
constexpr int kSwitches = 4;           // rounds in which contacts switch between stick and slip
constexpr int kOpenings = 6;           // rounds in which contacts open

}  // namespace

ActiveSetContactSolver::ActiveSetContactSolver(const linear::SymmetricBlockMatrix& pattern)
    : guess_(3, pattern.size()),
      free_matrix_(pattern),
      free_rhs_(3, pattern.size()),
      residual_(3, pattern.size()),
      attached_(pattern.size(), 0),
      confined_(pattern.size(), 0),
      normals_(3, pattern.size()),
      values_(3, pattern.size()),
      memory_(pattern.size()) {
  entries_.reserve(pattern.size());
  reactions_.reserve(pattern.size());
}

void ActiveSetContactSolver::begin(const Cloth& cloth, const Stage& stage, const Velocities& guess,
                                   const std::vector<char>& attached,
                                   const linear::SymmetricBlockMatrix& matrix,
                                   const linear::BlockVector& rhs) {
  a_ = stage.a;
  entries_.clear();
  reactions_.assign(cloth.contacts().size(), {});
  for (std::size_t i = 0; i < cloth.contacts().size(); ++i) {
    if (!attached[cloth.contacts()[i].particle]) {
      entries_.push_back(entryOf(cloth, stage, static_cast<int>(i)));
    }
  }
  ++stages_;
  rounds_ = 0;
  if (entries_.empty()) return;
  for (int i = 0; i < matrix.size(); ++i) guess_.col(i) = guess[i];
  attached_ = attached;
  free_matrix_ = matrix;
  free_rhs_ = rhs;
  // What crept to rest sticks; what was not there in the last stage knows nothing.
  for (Entry& entry : entries_) {
    const bool remembered = entry.stage == stages_ - 1;
    if (entry.creeps && entry.speed < kRest) entry.state = State::kSticks;
    entry.creeps = false;
    if (remembered) continue;
    const bool enters = entry.normal.dot(guess[entry.particle] - entry.target) < 0.0;
    static_cast<Memory&>(entry) = Memory{};
    if (enters) entry.state = entry.friction > 0.0 ? State::kSticks : State::kSlips;
  }
}

/// With what is remembered of the particle.
ActiveSetContactSolver::Entry ActiveSetContactSolver::entryOf(const Cloth& cloth,
                                                              const Stage& stage, int index) const {
  const ParticleContact& contact = cloth.contacts()[index];
  const Vector3d place =
      contact.place + (stage.end - contact.end) * contact.velocity - contact.gap * contact.normal;
  Entry entry;
  static_cast<Memory&>(entry) = memory_[contact.particle];
  entry.contact = index;
  entry.particle = contact.particle;
  entry.normal = contact.normal;
  entry.body = contact.velocity;
  // With it the stage goes its share of the way: x* + a v = x* + share (place - x*).
  entry.target = stage.share / stage.a * (place - stage.base.positions[contact.particle]);
  entry.friction = contact.friction;
  entry.mass = cloth.masses()[contact.particle];
  return entry;
}

bool ActiveSetContactSolver::prepareRound(linear::SymmetricBlockMatrix& matrix,
                                          linear::BlockVector& rhs, std::vector<char>& fixed,
                                          linear::BlockVector& prescribed) {
  ++rounds_;
  matrix = free_matrix_;
  rhs = free_rhs_;
  fixed = attached_;
  std::fill(confined_.begin(), confined_.end(), 0);
  for (const Entry& entry : entries_) {
    constrain(entry, guess_.col(entry.particle), matrix, rhs, fixed, prescribed);
  }
  return std::find(fixed.begin(), fixed.end(), 1) != fixed.end();
}

/// @param velocity of the linearisation @returns whether it violates the constraint
bool ActiveSetContactSolver::constrain(const Entry& entry, const Vector3d& velocity,
                                       linear::SymmetricBlockMatrix& matrix,
                                       linear::BlockVector& rhs, std::vector<char>& fixed,
                                       linear::BlockVector& prescribed) {
  const int i = entry.particle;
  const Vector3d change = entry.target - velocity;
  if (entry.state == State::kSticks) {
    fixed[i] = 1;
    prescribed.col(i) = change;
    return a_ * change.norm() > kPenetration;
  }
  if (entry.state == State::kOpen) return false;
  confined_[i] = 1;
  normals_.col(i) = entry.normal;
  values_.col(i) = entry.normal * entry.normal.dot(change);
  addFriction(entry, velocity, matrix, rhs);
  return a_ * values_.col(i).norm() > kPenetration;
}

/// How much the friction of what slips resists a turn of the slip (N.s/m): the second derivative of
/// mu N |s| across s. Slips that friction changes within the stage are no measure of it.
/// What creeps is resisted so in every direction.
double ActiveSetContactSolver::lateralResistance(const Entry& entry) const {
  const double limit = entry.friction * entry.load;
  if (!(limit > 0.0)) return 0.0;
  const double least = entry.creeps ? 0.01 * kRest : a_ * limit / entry.mass;
  return limit / std::max(entry.speed, least);
}

/// Across the normal, and unless it creeps across the slip of the round before (m/s).
Vector3d ActiveSetContactSolver::lateralSlip(const Entry& entry, const Vector3d& velocity) const {
  const Vector3d slip = velocity - entry.target;
  const Vector3d tangential = slip - entry.normal * entry.normal.dot(slip);
  return entry.creeps ? tangential
                      : Vector3d(tangential - entry.direction * entry.direction.dot(slip));
}

void ActiveSetContactSolver::addFriction(const Entry& entry, const Vector3d& velocity,
                                         linear::SymmetricBlockMatrix& matrix,
                                         linear::BlockVector& rhs) const {
  if (entry.friction == 0.0) return;
  const double resistance = lateralResistance(entry);
  const Vector3d& n = entry.normal;
  const Vector3d d = entry.creeps ? Vector3d(0.0, 0.0, 0.0) : entry.direction;
  rhs.col(entry.particle) +=
      a_ * (entry.friction * entry.load * d - resistance * lateralSlip(entry, velocity));
  matrix.diagonal(entry.particle) +=
      a_ * resistance * (Matrix3d::Identity() - n * n.transpose() - d * d.transpose());
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

bool ActiveSetContactSolver::update(const linear::BlockVector& solution, bool last) {
  constexpr double kFrictionTolerance = 1e-3;  // of the friction of all contacts together
  // What the free system lacks is what the constraints exert.
  free_matrix_.multiply(solution, residual_);
  residual_ -= free_rhs_;
  bool changed = false;
  double friction = 0.0, change = 0.0;
  for (Entry& entry : entries_) {
    const Vector3d velocity = guess_.col(entry.particle) + solution.col(entry.particle);
    const Vector3d force = residual_.col(entry.particle) / a_;
    const Entry before = entry;
    judge(velocity, force, entry);
    changed = changed || entry.state != before.state;
    if (entry.state == State::kSlips) {
      friction += entry.friction * entry.load;
      change += frictionChange(entry, before);
    }
    if (last) entry.state = before.state;
    keep(entry, before.state, force);
  }
  return changed || change > kFrictionTolerance * friction;
}

/// How far friction in this round was from what it is by the round's solution (N).
double ActiveSetContactSolver::frictionChange(const Entry& entry, const Entry& before) const {
  const double limit = entry.friction * entry.load;
  if (!entry.creeps) {
    return entry.friction * (entry.load * entry.direction - before.load * before.direction).norm();
  }
  if (!before.creeps) return limit;
  const double exerted = lateralResistance(before) * entry.speed;
  return entry.speed < kRest ? std::max(0.0, exerted - limit) : std::abs(exerted - limit);
}

/// For the next stage, and for who asks what the contact did.
void ActiveSetContactSolver::keep(const Entry& entry, State state, const Vector3d& force) {
  reactions_[entry.contact].state = state;
  reactions_[entry.contact].force = state == State::kOpen ? Vector3d(0.0, 0.0, 0.0) : force;
  memory_[entry.particle] = entry;
  memory_[entry.particle].stage = stages_;
}

/// What the contact does in the next round.
/// @param force that the contact had to exert in this one, N
void ActiveSetContactSolver::judge(const Vector3d& velocity, const Vector3d& force,
                                   Entry& entry) const {
  const Vector3d relative = velocity - entry.target;
  if (entry.state == State::kOpen) {
    if (a_ * entry.normal.dot(relative) >= -kPenetration) return;
    entry.state = entry.friction > 0.0 ? State::kSticks : State::kSlips;
    return;
  }
  entry.load = entry.normal.dot(force);
  if (entry.load < 0.0 && rounds_ > kOpenings) entry.load = 0.0;
  if (!(entry.load >= 0.0)) {  // it would pull
    static_cast<Memory&>(entry) = Memory{};
    return;
  }
  if (entry.friction == 0.0) return;
  // Stick to slip: friction goes on in the direction in which it held. Slip to stick: the slip
  // points where friction pushes, so friction has stopped it and more. What goes on switching
  // between the two creeps instead, see the header.
  const Vector3d tangential = force - entry.load * entry.normal;
  const Vector3d slip = relative - entry.normal * entry.normal.dot(relative);
  if (entry.state == State::kSticks) {
    if (tangential.norm() <= entry.friction * entry.load) return;
    entry.state = State::kSlips;
    entry.direction = tangential.normalized();
    entry.speed = 0.0;
    return;
  }
  entry.speed = slip.norm();
  if (entry.creeps || slip.dot(entry.direction) <= 0.0) {
    if (entry.speed > 0.0) entry.direction = -slip / entry.speed;
  } else if (rounds_ <= kSwitches) {
    entry.state = State::kSticks;
  } else {
    entry.creeps = true;
  }
}

bool ActiveSetContactSolver::addNewton(const Velocities& velocities,
                                       linear::SymmetricBlockMatrix& matrix,
                                       linear::BlockVector& rhs, std::vector<char>& fixed,
                                       linear::BlockVector& prescribed) {
  // The right-hand side of a Newton iteration is minus the residual itself: the contacts' forces
  // can be read off before the solve.
  fixed = attached_;
  std::fill(confined_.begin(), confined_.end(), 0);
  bool changed = false;
  ++rounds_;
  for (Entry& entry : entries_) {
    const Vector3d force = -rhs.col(entry.particle) / a_;
    const State before = entry.state;
    judge(velocities[entry.particle], force, entry);
    keep(entry, entry.state, force);
    changed = changed || entry.state != before;
    const bool violated =
        constrain(entry, velocities[entry.particle], matrix, rhs, fixed, prescribed);
    changed = changed || violated;
  }
  return changed;
}

bool ActiveSetContactSolver::enter(const Velocities& velocities) const {
  return std::any_of(entries_.begin(), entries_.end(), [&](const Entry& entry) {
    const Vector3d relative = velocities[entry.particle] - entry.target;
    return !(a_ * entry.normal.dot(relative) >= -2.0 * kPenetration);
  });
}

double ActiveSetContactSolver::frictionPotential(const Velocities& velocities) const {
  double potential = 0.0;
  for (const Entry& entry : entries_) {
    if (entry.state != State::kSlips || entry.friction == 0.0) continue;
    const Vector3d& velocity = velocities[entry.particle];
    potential +=
        a_ * (0.5 * lateralResistance(entry) * lateralSlip(entry, velocity).squaredNorm() -
              (entry.creeps ? 0.0 : entry.friction * entry.load) * entry.direction.dot(velocity));
  }
  return potential;
}

void ActiveSetContactSolver::settle(Velocities& velocities) const {
  for (const Entry& entry : entries_) {
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
