// What ActiveSetContactSolver makes of the solution of a round.
#include <algorithm>
#include <cmath>

#include "haptex/cloth/dynamics/active_set_contact_solver.h"

namespace haptex::cloth {

using Eigen::Vector3d;

namespace {

constexpr double kLeastSmoothing = 1e-6;  // m/s: in a step nobody sees what creeps more slowly
constexpr double kSharper = 0.3;          // smoothing after smoothed friction has converged
constexpr double kSticking = 0.5;         // of the smoothing: what is slower sticks then
constexpr double kLeastShare = 1e-3;      // of the way to the solution of a round
constexpr int kSearchRounds = 15;
constexpr int kStickingRounds = 3;  // of those, for what creeps at the least smoothing to stick
constexpr int kStalledRounds = 2;   // in a row that got nowhere: none will
constexpr int kRatioRounds = 6;

}  // namespace

/// Of what slips (m/s); 0 if nothing does.
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

/// From which on friction of what slips is mu N, to begin with (m/s).
double ActiveSetContactSolver::smoothingOfSlips() const {
  constexpr double kOfMean = 0.1;
  return std::max(kLeastSmoothing, kOfMean * meanSlip());
}

bool ActiveSetContactSolver::update(const linear::BlockVector& solution) {
  if (phase_ == Phase::kForces) {
    takeForces();
    finish();
    return false;
  }
  free_matrix_.multiply(solution, residual_);
  residual_ -= free_rhs_;
  for (Entry& entry : entries_) {
    entry.force = residual_.col(entry.particle) / a_;
    if (entry.state == State::kOpen) entry.force.setZero();
  }
  takeForces();
  const bool again = phase_ == Phase::kSearch ? search(solution) : holdRatios(solution);
  if (!again) finish();
  return again;
}

/// The bodies', too.
void ActiveSetContactSolver::takeForces() {
  if (bodies_.empty()) return;
  bodies_.takeForces(entries_, a_);
  bodies_.place(entries_);
}

/// How far from the accepted solution towards the new one the potential of the new loads falls.
double ActiveSetContactSolver::searchLine(const linear::BlockVector& solution) {
  constexpr int kBisections = 30;
  constexpr double kFlat = 1e-3;  // of the slope where the way starts
  constexpr double kPenalty = 2.0;
  for (Entry& entry : entries_) {
    if (entry.state == State::kOpen) continue;
    const Vector3d velocity = guess_.col(entry.particle) + solution.col(entry.particle);
    entry.change = relativeMotion(entry, velocity).slip - entry.slip;
  }
  if (rounds_ == 1 || last_) return 1.0;
  accepted_ = solution - accepted_;
  free_matrix_.multiply(accepted_, product_);
  double curvature = product_.cwiseProduct(accepted_).sum();
  double slope = residual_.cwiseProduct(accepted_).sum() - curvature;
  if (!bodies_.empty()) {
    const double of_bodies = bodies_.curvature();
    curvature += of_bodies;
    slope += bodies_.slope() - of_bodies;
  }
  accepted_ = solution - accepted_;
  // What has closed goes out of the body on the way: more than its normal force is worth that.
  double entered = 0.0;
  for (const Entry& entry : entries_) {
    if (!entry.fresh || entry.state == State::kOpen) continue;
    const double out =
        entry.normal.dot(solution.col(entry.particle) - accepted_.col(entry.particle)) -
        bodies_.bodyPart(entry);
    const double load = std::max(0.0, entry.normal.dot(entry.force));
    entered += a_ * kPenalty * load * std::max(0.0, out);
  }
  const auto slope_at = [&](double share) {
    double sum = slope - entered + share * curvature;
    for (const Entry& entry : entries_) {
      if (entry.state == State::kOpen) continue;
      const double load = std::max(0.0, entry.normal.dot(entry.force));
      const Vector3d slip = entry.slip + share * entry.change;
      sum -= a_ * frictionAt(entry, slip, load, smoothing_).dot(entry.change);
    }
    return sum;
  };
  if (slope_at(1.0) <= kFlat * std::abs(slope_at(0.0))) return 1.0;
  double low = 0.0, high = 1.0;
  for (int i = 0; i < kBisections; ++i) {
    const double middle = 0.5 * (low + high);
    (slope_at(middle) > 0.0 ? high : low) = middle;
  }
  return std::max(low, kLeastShare);
}

bool ActiveSetContactSolver::search(const linear::BlockVector& solution) {
  constexpr double kTolerance = 1e-3;  // of the friction of all contacts together
  constexpr double kBeyond = 1e-6;     // likewise, of what is outside of the cones
  const double share = searchLine(solution);
  bool changed = false, creeps = false;
  double limit = 0.0, off = 0.0, beyond = 0.0;
  accepted_ += share * (solution - accepted_);
  if (!bodies_.empty()) {
    bodies_.accept(share);
    bodies_.place(entries_);
  }
  for (Entry& entry : entries_) {
    const State before = entry.state;
    const Vector3d exerted = entry.force - entry.normal * entry.normal.dot(entry.force);
    if (before != State::kOpen) entry.slip += share * entry.change;
    if (before == State::kSticks) {
      if (share < 1.0 && entry.slip.norm() > kSticking * smoothing_) {
        entry.state = State::kSlips;  // it does not stick yet
      } else {
        entry.slip.setZero();
      }
    }
    judge(guess_.col(entry.particle) + accepted_.col(entry.particle), a_, smoothing_, entry);
    entry.fresh = before == State::kOpen && entry.state != State::kOpen;
    changed = changed || entry.state != before;
    if (entry.state == State::kOpen || entry.friction == 0.0 || before == State::kOpen) continue;
    limit += entry.friction * entry.load;
    beyond += std::max(0.0, exerted.norm() - entry.friction * entry.load);
    if (entry.state != State::kSlips) continue;
    off += (frictionAt(entry, entry.slip, entry.load, smoothing_) - exerted).norm();
    creeps = creeps || entry.slip.norm() <= smoothing_;
  }
  const bool converged = !changed && off <= kTolerance * limit && beyond <= kBeyond * limit;
  if (converged && (last_ || !creeps)) return false;
  if (converged && left_smoothing_ > 0.0 && smoothing_ <= kLeastSmoothing) {
    last_ = true;  // the last system has shown that what creeps does not all stick
    return false;
  }
  if (last_ || isSpent(share)) {
    if (last_ || !goBack()) takeRatios();
    return true;
  }
  if (converged) {
    // At first what is far from its limit, because what is near may follow its neighbours.
    const double sticking = (kept_smoothing_ > 0.0 ? 1.0 : kSticking) * smoothing_;
    kept_ = entries_;
    kept_smoothing_ = smoothing_;
    kept_round_ = rounds_;
    const double mean = meanSlip();
    if (left_smoothing_ > 0.0 && smoothing_ > mean) {
      // What creeps does not all stick, as the last system has shown. Linear, so a round or two.
      smoothing_ = std::max(kLeastSmoothing, std::min(kSharper * smoothing_, mean));
      return true;
    }
    for (Entry& entry : entries_) {
      if (entry.state != State::kSlips || entry.slip.norm() > sticking) continue;
      entry.state = State::kSticks;
      entry.fresh = true;
    }
    smoothing_ = std::max(kLeastSmoothing, kSharper * smoothing_);
  } else if (rounds_ <= 2 && left_smoothing_ == 0.0) {
    smoothing_ = std::max(smoothing_, smoothingOfSlips());
  }
  return true;
}

/// Whether the search ends with what it has. @param share of the way that the round has gone
bool ActiveSetContactSolver::isSpent(double share) {
  stalled_rounds_ = share <= 2.0 * kLeastShare ? stalled_rounds_ + 1 : 0;
  const bool finest = kept_smoothing_ > 0.0 && kept_smoothing_ <= kLeastSmoothing;
  return rounds_ >= kSearchRounds || stalled_rounds_ >= kStalledRounds ||
         (finest && rounds_ >= kept_round_ + kStickingRounds);
}

/// To the smoothed friction that had converged, for a last round.
bool ActiveSetContactSolver::goBack() {
  if (!(kept_smoothing_ > 0.0)) return false;
  entries_ = kept_;
  smoothing_ = kept_smoothing_;
  for (Entry& entry : entries_) entry.fresh = true;
  last_ = true;
  return true;
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
      entry.ratio = frictionAt(entry, entry.slip, 1.0, smoothing_);
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
  for (Entry& entry : entries_) {
    if (entry.state == State::kOpen) {
      const Vector3d velocity = guess_.col(entry.particle) + solution.col(entry.particle);
      const RelativeMotion motion = relativeMotion(entry, velocity);
      if (a_ * motion.gap >= -kContactPenetration || rounds_ > kRatioRounds / 2) continue;
      close(motion, entry);
      entry.ratio = frictionAt(entry, entry.slip, 1.0, smoothing_);
      entry.state = State::kSlips;
      again = true;
      continue;
    }
    entry.load = entry.normal.dot(entry.force);
    if (entry.load >= -1e-9 * limit) continue;
    pulls = again = true;
    if (rounds_ < kRatioRounds) {
      static_cast<ContactMemory&>(entry) = ContactMemory{};
      entry.force.setZero();
    }
  }
  if (!again) return false;
  if (rounds_ < kRatioRounds) return true;
  if (!pulls) return false;
  for (Entry& entry : entries_) bringIntoCone(entry);
  phase_ = Phase::kForces;
  return true;
}

}  // namespace haptex::cloth
