#include "haptex/simulation/quality_controller.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace haptex::simulation {
namespace {

constexpr double kSmoothing = 0.25;      // weight of the last cycle
constexpr double kHighShare = 0.95;      // of the cycles that the next quality has to keep
constexpr double kMinRecorded = 10.0;    // cycles
constexpr double kMaxRecorded = 1000.0;  // cycles

[[noreturn]] void refuse(const char* name, double value, const char* allowed) {
  std::ostringstream message;
  message << name << " = " << value << ": allowed are " << allowed;
  throw std::invalid_argument(message.str());
}

bool isPositive(double value) { return std::isfinite(value) && value > 0.0; }

std::size_t recordedCycles(double cycle) {
  return static_cast<std::size_t>(std::clamp(1.0 / cycle, kMinRecorded, kMaxRecorded));
}

}  // namespace

QualityController::QualityController(std::vector<double> costs, double budget, double cycle,
                                     std::size_t first)
    : costs_(std::move(costs)),
      budget_(budget),
      cycle_(cycle),
      running_(first),
      waits_(costs_.size(), kShortestWait),
      try_again_(costs_.size(), 0.0) {
  double before = 0.0;
  for (const double cost : costs_) {
    if (!isPositive(cost) || cost <= before) refuse("cost", cost, "finite, ascending times > 0 s");
    before = cost;
  }
  if (std::isnan(budget) || budget <= 0.0) refuse("budget", budget, "times > 0 s");
  if (!isPositive(cycle)) refuse("cycle", cycle, "finite times > 0 s");
  if (first >= costs_.size()) {
    refuse("first", static_cast<double>(first), "numbers of a quality that there is");
  }
  recorded_.resize(recordedCycles(cycle));
  sorted_.resize(recorded_.size());
}

std::size_t QualityController::record(double step_seconds, int cycles) {
  elapsed_ += std::max(cycles * cycle_, step_seconds);
  const double seconds = step_seconds / cycles;
  const double ratio = seconds / costs_[running_];
  recorded_[next_] = {seconds, ratio};
  next_ = (next_ + 1) % recorded_.size();
  count_ = std::min(count_ + 1, recorded_.size());

  forgivable_ = std::min(forgivable_ + kForgivenShare, kMaxForgiven);
  const bool missed = seconds > budget_;
  const bool forgiven = missed && forgivable_ >= 1.0;
  if (forgiven) {
    forgivable_ -= 1.0;
    return running_;
  }
  load_ += kSmoothing * (ratio - load_);
  if (missed || expectedSeconds(running_) > kNear * budget_) {
    stepDown();
  } else {
    stepUpIfSafe();
  }
  return running_;
}

bool QualityController::runsCheapest() const { return running_ == 0 || std::isinf(budget_); }

void QualityController::relieve() {
  if (!runsCheapest()) leave(0);
}

void QualityController::stepDown() {
  if (running_ == 0) return;
  std::size_t quality = running_ - 1;
  while (quality > 0 && expectedSeconds(quality) > kTarget * budget_) --quality;
  leave(quality);
}

void QualityController::leave(std::size_t quality) {
  const bool lasted = elapsed_ - changed_at_ >= kTrial;
  if (lasted) waits_[running_] = kShortestWait;
  try_again_[running_] = elapsed_ + waits_[running_];
  waits_[running_] = std::min(2.0 * waits_[running_], kLongestWait);
  change(quality);
}

void QualityController::stepUpIfSafe() {
  const std::size_t above = running_ + 1;
  if (above >= costs_.size() || elapsed_ - changed_at_ < kHold) return;
  if (std::isinf(budget_) || elapsed_ < try_again_[above]) return;
  if (highRatio() * costs_[above] <= kTarget * budget_) change(above);
}

/// That no more than a twentieth of the recorded ratios exceeds.
double QualityController::highRatio() {
  const auto end = sorted_.begin() + static_cast<std::ptrdiff_t>(count_);
  std::transform(recorded_.begin(), recorded_.begin() + static_cast<std::ptrdiff_t>(count_),
                 sorted_.begin(), [](const Recorded& cycle) { return cycle.ratio; });
  const auto place = static_cast<std::ptrdiff_t>(kHighShare * static_cast<double>(count_ - 1));
  std::nth_element(sorted_.begin(), sorted_.begin() + place, end);
  return sorted_[static_cast<std::size_t>(place)];
}

void QualityController::change(std::size_t quality) {
  running_ = quality;
  changed_at_ = elapsed_;
  ++changes_;
}

CycleTimes QualityController::times() const {
  CycleTimes times;
  times.cycles = count_;
  times.smoothed = count_ > 0 ? expectedSeconds(running_) : 0.0;
  std::size_t within = 0;
  for (std::size_t i = 0; i < count_; ++i) {
    times.worst = std::max(times.worst, recorded_[i].seconds);
    within += recorded_[i].seconds <= budget_ ? 1 : 0;
  }
  if (count_ > 0) times.within_budget = static_cast<double>(within) / static_cast<double>(count_);
  return times;
}

}  // namespace haptex::simulation
