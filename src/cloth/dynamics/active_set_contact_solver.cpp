#include "haptex/cloth/dynamics/active_set_contact_solver.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

// The rounds of a system. StageSolver calls
//   begin()         once per stage: each contact starts from what its particle's did in the last;
//   beginSystem()   with the free system A dv = b, once per linear solve or Newton iteration;
//   prepareRound()  a fresh copy of it; what sticks is prescribed, what slips gets its friction as a
//                   force on the right-hand side and the resistance of its direction on the diagonal;
//   confine()       takes the normals of what slips out of the unknowns;
//   compareLoads()  after the solve: r = A dv - b of the free system are the impulses that the
//                   constraints had to exert, r / a the forces N n + T. Until the friction of what
//                   slips was that of these N, prepareLoads() and addLoads() change it;
//   update()        says who lets go (N < 0), slips (|T| > mu N) or sticks again (the slip has come
//                   round to where friction pushes),
// until nothing changes.
namespace haptex::cloth {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

constexpr double kPenetration = 1e-9;     // m, not worth another round
constexpr double kLoadTolerance = 1e-7;   // of the loads of all contacts together
constexpr double kBeyond = 1e-7;          // of the limit of friction, of all contacts together
constexpr int kSearchRounds = 10;
constexpr int kRatioRounds = 6;

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
      loads_(Eigen::VectorXd::Zero(pattern.size())),
      results_(Eigen::VectorXd::Zero(pattern.size())),
      friction_(pattern.size(), 3 * pattern.size()),
      memory_(pattern.size()) {
  entries_.reserve(pattern.size());
  reactions_.reserve(pattern.size());
}

void ActiveSetContactSolver::begin(const Cloth& cloth, const Stage& stage, const Velocities& guess,
                                   const std::vector<char>& attached) {
  a_ = stage.a;
  entries_.clear();
  reactions_.assign(cloth.contacts().size(), {});
  for (std::size_t i = 0; i < cloth.contacts().size(); ++i) {
    if (!attached[cloth.contacts()[i].particle]) {
      entries_.push_back(entryOf(cloth, stage, static_cast<int>(i)));
    }
  }
  ++stages_;
  if (entries_.empty()) return;
  attached_ = attached;
  loads_.setZero();
  results_.setZero();
  // What was not there in the last stage knows nothing.
  for (Entry& entry : entries_) {
    if (entry.stage == stages_ - 1) continue;
    static_cast<Memory&>(entry) = Memory{};
    const Vector3d relative = guess[entry.particle] - entry.target;
    const double gap = entry.normal.dot(relative);
    if (gap < 0.0) close(gap, relative - gap * entry.normal, entry);
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
  entry.force = entry.ratio = entry.before = Vector3d::Zero();
  // The plane may have turned.
  if (entry.state == State::kSlips && entry.friction > 0.0) {
    const Vector3d along =
        entry.direction - entry.normal * entry.normal.dot(entry.direction);
    if (along.norm() > 0.0) entry.direction = along.normalized();
  }
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
    entry.changes = 0;
  }
}

bool ActiveSetContactSolver::prepareRound(linear::SymmetricBlockMatrix& matrix,
                                          linear::BlockVector& rhs, std::vector<char>& fixed,
                                          linear::BlockVector& prescribed) {
  ++rounds_;
  matrix = free_matrix_;
  rhs = free_rhs_;
  fixed = attached_;
  std::fill(confined_.begin(), confined_.end(), 0);
  for (std::size_t k = 0; k < entries_.size(); ++k) {
    Entry& entry = entries_[k];
    loads_[k] = 0.0;
    if (phase_ == Phase::kForces) {
      rhs.col(entry.particle) += a_ * entry.force;
      continue;
    }
    if (phase_ == Phase::kSearch) entry.ratio = entry.friction * entry.direction;
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
  const double resistance = lateralResistance(entry);
  const Vector3d& d = entry.direction;
  rhs.col(i) -= a_ * resistance * lateralSlip(entry, velocity);
  matrix.diagonal(i) +=
      a_ * resistance * (Matrix3d::Identity() - n * n.transpose() - d * d.transpose());
}

/// How much the friction of what slips resists a turn of the slip (N.s/m): the second derivative of
/// mu N |s| across s. Slips that friction changes within the stage are no measure of it.
double ActiveSetContactSolver::lateralResistance(const Entry& entry) const {
  const double limit = entry.friction * entry.load;
  if (!(limit > 0.0)) return 0.0;
  return limit / std::max(entry.speed, a_ * limit / entry.mass);
}

/// Across the normal and the slip of the round before (m/s).
Vector3d ActiveSetContactSolver::lateralSlip(const Entry& entry, const Vector3d& velocity) const {
  const Vector3d slip = velocity - entry.target;
  return slip - entry.normal * entry.normal.dot(slip) -
         entry.direction * entry.direction.dot(slip);
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
  for (std::size_t k = 0; k < entries_.size(); ++k) {
    const Entry& entry = entries_[k];
    if (!confined_[entry.particle] || entry.friction == 0.0) continue;
    results_[k] = entry.normal.dot(residual_.col(entry.particle)) / a_;
  }
  Eigen::Map<Eigen::VectorXd> change_numbers(change.data(), change.size());
  Eigen::Map<Eigen::VectorXd> numbers(solution.data(), solution.size());
  friction_.add(results_, change_numbers, loads_, numbers);
}

bool ActiveSetContactSolver::update(const linear::BlockVector& solution) {
  if (phase_ == Phase::kForces) {
    finish();
    return false;
  }
  free_matrix_.multiply(solution, residual_);
  residual_ -= free_rhs_;
  for (Entry& entry : entries_) {
    entry.force = residual_.col(entry.particle) / a_;
    if (entry.state == State::kOpen) entry.force.setZero();
  }
  const bool again = phase_ == Phase::kSearch ? search(solution) : holdRatios(solution);
  if (!again) finish();
  return again;
}

bool ActiveSetContactSolver::search(const linear::BlockVector& solution) {
  constexpr double kTurnTolerance = 1e-3;  // of the friction of all contacts together
  bool changed = false;
  double limit = 0.0, turned = 0.0, beyond = 0.0;
  int opened = 0, closed = 0, slipped = 0, stuck = 0;
  for (Entry& entry : entries_) {
    const Vector3d velocity = guess_.col(entry.particle) + solution.col(entry.particle);
    const State before = entry.state;
    const Memory old = entry;
    const Vector3d exerted = entry.force - entry.normal * entry.normal.dot(entry.force);
    judge(velocity, entry);
    if (entry.state != before) {
      ++entry.changes;
      opened += entry.state == State::kOpen;
      closed += before == State::kOpen;
      slipped += before == State::kSticks && entry.state == State::kSlips;
      stuck += before == State::kSlips && entry.state == State::kSticks;
    }
    changed = changed || entry.state != before;
    if (entry.state == State::kOpen || entry.friction == 0.0 || before == State::kOpen) continue;
    limit += entry.friction * entry.load;
    beyond += std::max(0.0, exerted.norm() - entry.friction * entry.load);
    if (entry.state == State::kSlips) {
      turned += (entry.friction * entry.load * entry.direction - exerted).norm();
    }
    (void)old;
  }
  static const bool debug = std::getenv("HAPTEX_CONTACTS") != nullptr;
  if (debug)
    std::fprintf(stderr, "  round %d: opened %d closed %d slipped %d stuck %d limit %g turned %g beyond %g\n",
                 rounds_, opened, closed, slipped, stuck, limit, turned, beyond);
  const bool again = changed || turned > kTurnTolerance * limit;
  if (again && rounds_ < kSearchRounds) return true;
  if (!again && beyond <= kBeyond * limit) return false;
  takeRatios();
  return true;
}

/// What the contact does in the next round.
void ActiveSetContactSolver::judge(const Vector3d& velocity, Entry& entry) const {
  const Vector3d relative = velocity - entry.target;
  const double gap = entry.normal.dot(relative);
  const Vector3d slip = relative - gap * entry.normal;
  if (entry.state == State::kOpen) {
    if (a_ * gap < -kPenetration) close(gap, slip, entry);
    return;
  }
  entry.load = entry.normal.dot(entry.force);
  if (!(entry.load >= 0.0)) {  // it would pull
    static_cast<Memory&>(entry) = Memory{};
    return;
  }
  if (entry.friction == 0.0) return;
  const Vector3d tangential = entry.force - entry.load * entry.normal;
  if (entry.state == State::kSticks) {
    if (tangential.norm() <= entry.friction * entry.load) return;
    entry.state = State::kSlips;
    entry.direction = tangential.normalized();
    entry.speed = 0.0;
    return;
  }
  entry.speed = slip.norm();
  if (slip.dot(entry.direction) <= 0.0) {
    if (entry.speed > 0.0) entry.direction = -slip / entry.speed;
  } else {
    entry.state = State::kSticks;
  }
}

/// A contact that is passed: the projection of -(slip, gap) onto the cone sticks inside of it.
void ActiveSetContactSolver::close(double gap, const Vector3d& slip, Entry& entry) const {
  entry.load = 0.0;
  entry.speed = slip.norm();
  const bool sticks = entry.friction > 0.0 && entry.speed <= entry.friction * -gap;
  entry.state = sticks ? State::kSticks : State::kSlips;
  entry.direction.setZero();
  if (entry.speed > 0.0) entry.direction = -slip / entry.speed;
}

/// From here on all that push slip with the ratios that the last round found.
void ActiveSetContactSolver::takeRatios() {
  phase_ = Phase::kRatios;
  rounds_ = 0;
  for (Entry& entry : entries_) {
    if (entry.state == State::kOpen) continue;
    const double load = entry.normal.dot(entry.force);
    const Vector3d tangential = entry.force - load * entry.normal;
    const double limit = entry.friction * load;
    if (!(load > 0.0)) {  // it has just closed
      entry.ratio = entry.friction * entry.direction;
      entry.load = 0.0;
    } else {
      entry.ratio = tangential / load;
      if (tangential.norm() > limit) entry.ratio *= limit / tangential.norm();
    }
    entry.state = State::kSlips;
  }
}

bool ActiveSetContactSolver::holdRatios(const linear::BlockVector& solution) {
  bool again = false, pulls = false;
  double limit = 0.0;
  for (const Entry& entry : entries_) limit = std::max(limit, entry.normal.dot(entry.force));
  int opened = 0, closed = 0;
  for (Entry& entry : entries_) {
    if (entry.state == State::kOpen) {
      const Vector3d velocity = guess_.col(entry.particle) + solution.col(entry.particle);
      const Vector3d relative = velocity - entry.target;
      const double gap = entry.normal.dot(relative);
      if (a_ * gap >= -kPenetration || rounds_ > kRatioRounds / 2) continue;
      close(gap, relative - gap * entry.normal, entry);
      entry.ratio = entry.friction * entry.direction;
      entry.state = State::kSlips;
      again = true;
      ++closed;
      continue;
    }
    entry.load = entry.normal.dot(entry.force);
    if (entry.load >= -1e-9 * limit) continue;
    pulls = again = true;
    ++opened;
    if (rounds_ < kRatioRounds) {
      static_cast<Memory&>(entry) = Memory{};
      entry.force.setZero();
    }
  }
  static const bool debug = std::getenv("HAPTEX_CONTACTS") != nullptr;
  if (debug) std::fprintf(stderr, "  ratios %d: opened %d closed %d\n", rounds_, opened, closed);
  if (!again) return false;
  if (rounds_ < kRatioRounds) return true;
  if (!pulls) return false;
  clip();
  phase_ = Phase::kForces;
  return true;
}

/// Brings all forces into their cones.
void ActiveSetContactSolver::clip() {
  for (Entry& entry : entries_) {
    const double load = entry.normal.dot(entry.force);
    if (!(load > 0.0)) {
      entry.force.setZero();
      continue;
    }
    Vector3d tangential = entry.force - load * entry.normal;
    const double size = tangential.norm(), limit = entry.friction * load;
    if (size > limit) tangential *= limit / size;
    entry.force = load * entry.normal + tangential;
    entry.load = load;
  }
}

/// For the next stage, and for who asks what the contact did.
void ActiveSetContactSolver::finish() {
  clip();
  phase_ = Phase::kFinished;
  for (Entry& entry : entries_) {
    ContactReaction& reaction = reactions_[entry.contact];
    reaction.force = entry.force;
    reaction.state = entry.state;
    memory_[entry.particle] = entry;
    memory_[entry.particle].stage = stages_;
  }
}

double ActiveSetContactSolver::potential(const Velocities& velocities) const {
  constexpr double kPenalty = 2.0;  // of what enters a body, over what brings it out
  double potential = 0.0;
  for (const Entry& entry : entries_) {
    const double load = entry.normal.dot(entry.force);
    if (!(load > 0.0)) continue;
    const Vector3d relative = velocities[entry.particle] - entry.target;
    const double gap = entry.normal.dot(relative);
    const double slip = (relative - gap * entry.normal).norm();
    potential += a_ * load * (entry.friction * slip + kPenalty * std::max(0.0, -gap));
  }
  return potential;
}

double ActiveSetContactSolver::descent(const linear::BlockVector& solution) const {
  constexpr double kPenalty = 2.0;
  double descent = free_rhs_.cwiseProduct(solution).sum();
  for (const Entry& entry : entries_) {
    const double load = entry.normal.dot(entry.force);
    if (!(load > 0.0)) continue;
    for (const double share : {0.0, 1.0}) {
      const Vector3d relative =
          guess_.col(entry.particle) + share * solution.col(entry.particle) - entry.target;
      const double gap = entry.normal.dot(relative);
      const double slip = (relative - gap * entry.normal).norm();
      descent += (1.0 - 2.0 * share) * a_ * load *
                 (entry.friction * slip + kPenalty * std::max(0.0, -gap));
    }
  }
  return descent;
}

void ActiveSetContactSolver::shorten(double share) {
  for (Entry& entry : entries_) {
    entry.force = (1.0 - share) * entry.before + share * entry.force;
    reactions_[entry.contact].force = entry.force;
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

bool ActiveSetContactSolver::enter(const Velocities& velocities) const {
  return std::any_of(entries_.begin(), entries_.end(), [&](const Entry& entry) {
    const Vector3d relative = velocities[entry.particle] - entry.target;
    return !(a_ * entry.normal.dot(relative) >= -2.0 * kPenetration);
  });
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
