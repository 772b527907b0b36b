// Keeps the computing time of a cycle inside a budget by the choice among qualities.
#pragma once

#include <cstddef>
#include <vector>

namespace haptex::simulation {

/// Computing times of the last cycles, which make about a second.
struct CycleTimes {
  std::size_t cycles = 0;      ///< that were looked at, no unit
  double smoothed = 0.0;       ///< s, over the last few
  double worst = 0.0;          ///< s
  double within_budget = 1.0;  ///< share of them, no unit
};

/// Is told what every cycle took and says by which of some qualities the next is computed. Without
/// clock, randomness or allocation: the same times lead to the same choices.
///
/// What a quality takes is its cost on the idle machine times the load, the smoothed ratio of the
/// two for the one that runs. Downwards it goes at once, to the most accurate that the load lets
/// into kTarget of the budget: when the smoothed time comes to kNear of the budget, or when a cycle
/// misses it that is not forgiven. A few misses are: any machine stumbles, and a cheaper quality
/// would not help. After kMaxForgiven in a row each further one needs 1 / kForgivenShare cycles.
/// What is forgiven does not count for the smoothed time.
///
/// Upwards it goes by one, when the quality has run for kHold and the next one would have kept
/// kTarget of the budget in 19 of 20 of the last cycles. A quality that had to be left is not tried
/// again for kShortestWait, and for twice as long after each further time that it did not last for
/// kTrial, up to kLongestWait.
class QualityController {
 public:
  static constexpr double kTarget = 0.8;  ///< of the budget, that a choice may take
  static constexpr double kNear = 0.9;    ///< of the budget
  static constexpr double kMaxForgiven = 2.0;
  static constexpr double kForgivenShare = 0.025;  ///< of the cycles, in the long run
  static constexpr double kHold = 0.5;             ///< s
  static constexpr double kTrial = 2.0;            ///< s
  static constexpr double kShortestWait = 1.0;     ///< s
  static constexpr double kLongestWait = 8.0;      ///< s

  /// @param costs  s of computing time per cycle on the idle machine, strictly ascending: from the
  ///   cheapest to the most accurate
  /// @param budget s per cycle; infinity: none, and the quality stays
  /// @param cycle  s between the beginnings of two cycles
  /// @param first  the quality to begin with
  /// @throws std::invalid_argument naming what is not so; costs and cycle finite and > 0, the
  ///   budget > 0
  QualityController(std::vector<double> costs, double budget, double cycle, std::size_t first);

  std::size_t size() const { return costs_.size(); }
  double budget() const { return budget_; }         ///< s
  std::size_t running() const { return running_; }  ///< for the next cycle
  std::size_t changes() const { return changes_; }  ///< since the construction
  /// What everything takes now by what it takes on the idle machine, no unit.
  double load() const { return load_; }
  /// Expected time of a cycle now, s. @param quality < size()
  double expectedSeconds(std::size_t quality) const { return load_ * costs_[quality]; }
  CycleTimes times() const;

  /// @param seconds computing time of the last step, by running(); finite, >= 0
  /// @param cycles  that the step took at once, > 0; each counts as having taken its share
  /// @returns running()
  std::size_t record(double seconds, int cycles = 1);

  /// Whether the cheapest runs, or there is no budget for which to change.
  bool runsCheapest() const;
  /// Goes to the cheapest at once, for a loop that else had to give up time.
  void relieve();

 private:
  struct Recorded {
    double seconds;
    double ratio;  // to the cost of the quality that ran
  };

  void stepDown();
  void leave(std::size_t quality);
  void stepUpIfSafe();
  double highRatio();
  void change(std::size_t quality);

  std::vector<double> costs_;  // s
  double budget_;              // s
  double cycle_;               // s
  std::size_t running_;
  std::size_t changes_ = 0;
  double load_ = 1.0;
  double elapsed_ = 0.0;            // s
  double changed_at_ = 0.0;         // s of elapsed_
  double forgivable_ = 0.0;         // misses
  std::vector<double> waits_;       // s, after the next failure of each quality
  std::vector<double> try_again_;   // s of elapsed_, each quality
  std::vector<Recorded> recorded_;  // a ring
  std::size_t next_ = 0;            // place in it
  std::size_t count_ = 0;           // in it
  std::vector<double> sorted_;      // of highRatio()
};

}  // namespace haptex::simulation
