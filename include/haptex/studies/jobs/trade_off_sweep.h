// Speed against accuracy for many fabrics as a study in parts: of it what no machine decides.
#pragma once

#include <string>
#include <vector>

#include "haptex/studies/jobs/study.h"
#include "haptex/studies/trade_off_points.h"

namespace haptex::studies {

struct TradeOffSweepSettings {
  std::size_t fabrics = 0;  ///< the first of sweptFabrics(), > 0
  std::string config;       ///< the directory of the package's files
  std::vector<TradeOffPoint> points = tradeOffPoints();
  ReferenceSettings reference;
};

/// All fabrics of config/fabrics by name, after those of tradeOffFabrics().
/// @throws std::filesystem::filesystem_error naming a directory that cannot be read
std::vector<std::string> sweptFabrics(const std::string& config);

/// A unit is a case, in the order of tradeOffCases(). Its record has, with tabs between: motion and
/// fabric; the reference's own errors in position (m), force (N) and energy (J); and of every point
/// that can follow the motion its name, its three errors, whether it was stable as 0 or 1, linear
/// solves per step, and steps. Of a case that is refused, why, after motion and fabric. Computing
/// time decides nothing: where bench_trade_off leaves out points that were slow before, all are
/// followed, as one that blows up ends with the first step that is not accepted.
class TradeOffSweep final : public Study {
 public:
  /// @throws std::invalid_argument naming what is allowed, for none or more than all fabrics
  explicit TradeOffSweep(TradeOffSweepSettings settings);

  std::string name() const override { return "trade_off"; }
  std::size_t unitCount() const override { return cases_.size(); }
  /// With checksums of the fabrics' files and of the points' names.
  StudyInputs inputs() const override;
  /// @throws what material::loadFabric() throws
  std::string run(std::size_t unit) const override;
  /// The errors, solves per step and stabilities as bench_trade_off prints them.
  void summarise(const std::vector<std::string>& records, std::ostream& out) const override;

 private:
  TradeOffSweepSettings settings_;
  std::vector<TradeOffCaseName> cases_;
};

}  // namespace haptex::studies
