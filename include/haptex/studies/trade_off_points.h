// Which motions, fabrics and points the study of speed against accuracy has.
#pragma once

#include <string>
#include <vector>

#include "haptex/studies/trade_off_study.h"

namespace haptex::studies {

/// One of every class: linear, wool and acrylic_knit.
const std::vector<std::string>& tradeOffFabrics();

/// A case whose fabric has not been read yet.
struct TradeOffCaseName {
  Motion motion;
  std::string fabric;  ///< config/fabrics/FABRIC.yaml
};
/// One motion after the other, each with all fabrics in turn.
std::vector<TradeOffCaseName> tradeOffCases(const std::vector<std::string>& fabrics);

/// @param config the directory of the package's files
/// @throws what material::loadFabric() throws
TradeOffCase loadCase(const TradeOffCaseName& name, const std::string& config);

/// Elasticities, integrators, time steps, resolutions, solvers, tolerances and thicknesses; those
/// that take long first.
std::vector<TradeOffPoint> tradeOffPoints();

}  // namespace haptex::studies
