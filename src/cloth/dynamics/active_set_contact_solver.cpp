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
constexpr double kLeastSmoothing = 1e-7;  // m/s
constexpr double kSmoothing = 0.1;        // of the mean slip
constexpr int kSearchRounds = 15;
constexpr int kRatioRounds = 6;

}  // namespace

ActiveSetContactSolver::ActiveSetContactSolver(const linear::SymmetricBlockMatrix& pattern)
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
    entry.fresh = false;
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
  entry.force = entry.ratio = entry.before = entry.change = Vector3d::Zero();
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
  last_ = false;
  smoothing_ = std::max(kLeastSmoothing, kSmoothing * meanSlip());
}

double ActiveSetContactSolver::meanSlip() const {
  double sum = 0.0;
  int count = 0;
  for (const Entry& entry : entries_) {
    if (entry.state != State::kSlips) continue;
    sum += entry.slip.norm();
    ++count;
  }
  return count > 0 ? sum / count : 0.0;
}

/// What friction does at a slip: its limit beyond smoothing_, and in proportion up to there.
Vector3d ActiveSetContactSolver::frictionAt(const Entry& entry, const Vector3d& slip,
                                            double load) const {
  return -entry.friction * load / std::max(slip.norm(), smoothing_) * slip;
}

/// The second derivative of its potential by the slip (N.s/m).
Matrix3d ActiveSetContactSolver::resistance(const Entry& entry) const {
  const double speed = entry.slip.norm();
  Matrix3d tangential = Matrix3d::Identity() - entry.normal * entry.normal.transpose();
  if (speed > smoothing_) tangential -= entry.slip * entry.slip.transpose() / (speed * speed);
  return entry.friction * entry.load / std::max(speed, smoothing_) * tangential;
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
    if (phase_ == Phase::kSearch) entry.ratio = frictionAt(entry, entry.slip, 1.0);
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
  const Matrix3d resisted = resistance(entry);
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
  for (std::size_t k = 0; k < entries_.size(); ++k) {
    const Entry& entry = entries_[k];
    if (!confined_[entry.particle] || entry.friction == 0.0) continue;
    results_[k] = entry.normal.dot(residual_.col(entry.particle)) / a_;
  }
  Eigen::Map<Eigen::VectorXd> change_numbers(change.data(), change.size());
  Eigen::Map<Eigen::VectorXd> numbers(solution.data(), solution.size());
  friction_.add(results_, change_numbers, loads_, numbers);
}

bool ActiveSetContactSolver::update(linear::BlockVector& solution) {
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

/// How far from the accepted solution towards the new one the potential of the new loads falls.
double ActiveSetContactSolver::searchLine(const linear::BlockVector& solution) {
  constexpr int kBisections = 30;
  bool comparable = rounds_ > 1;
  for (Entry& entry : entries_) {
    if (entry.state == State::kOpen) continue;
    const Vector3d relative =
        guess_.col(entry.particle) + solution.col(entry.particle) - entry.target;
    entry.change = relative - entry.normal * entry.normal.dot(relative) - entry.slip;
    comparable = comparable && !entry.fresh;
  }
  if (!comparable) return 1.0;
  accepted_ = solution - accepted_;
  free_matrix_.multiply(accepted_, product_);
  const double curvature = product_.cwiseProduct(accepted_).sum();
  const double slope = residual_.cwiseProduct(accepted_).sum() - curvature;
  accepted_ = solution - accepted_;
  const auto slopeAt = [&](double share) {
    double sum = slope + share * curvature;
    for (const Entry& entry : entries_) {
      if (entry.state != State::kSlips) continue;
      const double load = std::max(0.0, entry.normal.dot(entry.force));
      const Vector3d slip = entry.slip + share * entry.change;
      sum -= a_ * frictionAt(entry, slip, load).dot(entry.change);
    }
    return sum;
  };
  if (slopeAt(1.0) <= 0.0) return 1.0;
  double low = 0.0, high = 1.0;
  for (int i = 0; i < kBisections; ++i) {
    const double middle = 0.5 * (low + high);
    (slopeAt(middle) > 0.0 ? high : low) = middle;
  }
  return std::max(low, 1e-3);
}

bool ActiveSetContactSolver::search(linear::BlockVector& solution) {
  constexpr double kTolerance = 1e-3;  // of the friction of all contacts together
  const double share = searchLine(solution);
  bool changed = false, smooth = false;
  double limit = 0.0, off = 0.0, beyond = 0.0;
  int opened = 0, closed = 0, slipped = 0, inside = 0;
  accepted_ += share * (solution - accepted_);
  for (Entry& entry : entries_) {
    const State before = entry.state;
    const Vector3d exerted = entry.force - entry.normal * entry.normal.dot(entry.force);
    entry.fresh = false;
    if (before == State::kSlips) entry.slip += share * entry.change;
    judge(guess_.col(entry.particle) + accepted_.col(entry.particle), entry);
    entry.fresh = before == State::kOpen && entry.state != State::kOpen;
    opened += entry.state == State::kOpen && before != State::kOpen;
    closed += entry.fresh;
    slipped += before == State::kSticks && entry.state == State::kSlips;
    changed = changed || entry.state != before;
    if (entry.state == State::kOpen || entry.friction == 0.0 || before == State::kOpen) continue;
    limit += entry.friction * entry.load;
    beyond += std::max(0.0, exerted.norm() - entry.friction * entry.load);
    if (entry.state != State::kSlips) continue;
    off += (frictionAt(entry, entry.slip, entry.load) - exerted).norm();
    if (entry.slip.norm() <= smoothing_) ++inside;
  }
  smooth = inside > 0;
  static const bool debug = std::getenv("HAPTEX_CONTACTS") != nullptr;
  if (debug)
    std::fprintf(stderr,
                 "  round %d: share %.3g opened %d closed %d slipped %d inside %d eps %g mean slip %g limit %g off %g "
                 "beyond %g\n",
                 rounds_, share, opened, closed, slipped, inside, smoothing_, meanSlip(), limit, off, beyond);
  const bool again = changed || share < 1.0 || off > kTolerance * limit;
  if (last_) {
    if (!changed && beyond <= kBeyond * limit) return false;
    takeRatios();
    return true;
  }
  if (!again && !smooth && beyond <= kBeyond * limit) return false;
  if (again && rounds_ < kSearchRounds) {
    if (rounds_ <= 2) smoothing_ = std::max(smoothing_, kSmoothing * meanSlip());
    return true;
  }
  if (!again && smooth && rounds_ < kSearchRounds &&
      smoothing_ > std::max(kLeastSmoothing, 1e-4 * meanSlip())) {
    smoothing_ = std::max(kLeastSmoothing, 0.1 * smoothing_);
    return true;
  }
  if (again) {
    takeRatios();
    return true;
  }
  // What creeps sticks.
  last_ = true;
  for (Entry& entry : entries_) {
    if (entry.state == State::kSlips && entry.friction > 0.0 && entry.slip.norm() <= smoothing_) {
      entry.state = State::kSticks;
    }
  }
  return true;
}

/// What the contact does in the next round.
void ActiveSetContactSolver::judge(const Vector3d& velocity, Entry& entry) const {
  if (entry.state == State::kOpen) {
    const Vector3d relative = velocity - entry.target;
    const double gap = entry.normal.dot(relative);
    if (a_ * gap < -kPenetration) close(gap, relative - gap * entry.normal, entry);
    return;
  }
  entry.load = entry.normal.dot(entry.force);
  if (!(entry.load >= 0.0)) {  // it would pull
    static_cast<Memory&>(entry) = Memory{};
    return;
  }
  if (entry.friction == 0.0 || entry.state == State::kSlips) return;
  const Vector3d tangential = entry.force - entry.load * entry.normal;
  const double size = tangential.norm();
  if (size <= (1.0 + 1e-9) * entry.friction * entry.load) return;
  entry.state = State::kSlips;
  entry.slip = -1.001 * smoothing_ / size * tangential;
}

/// A contact that is passed: the projection of -(slip, gap) onto the cone sticks inside of it.
void ActiveSetContactSolver::close(double gap, const Vector3d& slip, Entry& entry) const {
  entry.load = 0.0;
  const bool sticks = entry.friction > 0.0 && slip.norm() <= entry.friction * -gap;
  entry.state = sticks ? State::kSticks : State::kSlips;
  entry.slip = slip;
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
      entry.ratio = frictionAt(entry, entry.slip, 1.0);
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
      entry.ratio = frictionAt(entry, entry.slip, 1.0);
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
