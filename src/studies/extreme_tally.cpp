#include "haptex/studies/extreme_tally.h"

#include "haptex/base/quantity.h"

namespace haptex::studies {

void ExtremeTally::Counts::add(const ExtremeOutcome& outcome) {
  ++cases;
  failures += outcome.failure != ExtremeFailure::kNone;
  other_rests += outcome.other_rest;
  slow += outcome.slow;
  unsettled += outcome.unsettled;
  rejected += outcome.rejected;
  growth = base::largerOrNaN(growth, outcome.growth);
  if (outcome.other_rest || outcome.unsettled) return;
  return_error = base::largerOrNaN(return_error, outcome.return_error);
}

void ExtremeTally::Counts::print(const std::string& name, const Print& print) const {
  print(name + "cases", static_cast<double>(cases), "cases");
  print(name + "failures", static_cast<double>(failures), "cases");
  print(name + "other_rests", static_cast<double>(other_rests), "cases");
  print(name + "slow_returns", static_cast<double>(slow), "cases");
  if (unsettled > 0) print(name + "unsettled", static_cast<double>(unsettled), "cases");
  print(name + "rejected_steps", static_cast<double>(rejected), "steps");
  print(name + "worst_growth", growth, "of_energy");
  print(name + "worst_return_error", return_error, "of_extent");
}

void ExtremeTally::add(const ExtremeCase& extreme, const ExtremeOutcome& outcome) {
  if (!cloth::isImplicit(extreme.method)) {
    explicit_.add(outcome);
    return;
  }
  implicit_.add(outcome);
  by_kind_[nameOf(extreme.kind)].add(outcome);
}

void ExtremeTally::print(const std::string& name, const Print& print) const {
  implicit_.print(name, print);
  for (const auto& [kind, counts] : by_kind_) counts.print(name + kind + "/", print);
  if (explicit_.cases > 0) explicit_.print(name + "explicit_integrators/", print);
}

}  // namespace haptex::studies
