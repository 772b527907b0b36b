// Extreme cases as a study in parts.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "haptex/studies/extreme_case.h"
#include "haptex/studies/jobs/study.h"

namespace haptex::studies {

/// Which cases: successive ones, each drawn from a seed of its own.
struct ExtremesSettings {
  std::size_t cases = 0;  ///< > 0
  std::uint64_t seed = 1;
  /// Whether the cloth collides with itself (drawSelfCollidingCases()).
  bool self_colliding = false;
};

/// A unit is a case, seed + unit, or of those that collide with themselves the one so many after
/// the first. Its record has, with tabs between: seed, kind and method as in toText(); the failure;
/// growth; return error; steps; rejected steps; settling steps; slow, other_rest and unsettled as 0
/// or 1; and of a failed case the message of an exception and the case that it shrinks to.
class ExtremesStudy final : public Study {
 public:
  /// @throws std::invalid_argument naming the number, without cases, or with so many that seeds end
  explicit ExtremesStudy(const ExtremesSettings& settings);

  std::string name() const override {
    return settings_.self_colliding ? "self_colliding" : "extremes";
  }
  std::size_t unitCount() const override { return settings_.cases; }
  StudyInputs inputs() const override;
  std::string run(std::size_t unit) const override;
  void summarise(const std::vector<std::string>& records, std::ostream& out) const override;

 private:
  ExtremeCase caseOf(std::size_t unit) const;

  ExtremesSettings settings_;
  std::vector<std::uint64_t> seeds_;  // of those that collide with themselves
};

}  // namespace haptex::studies
