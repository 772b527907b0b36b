// The front of all motions together of every fabric, its presets, and the files that hold them.
#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "haptex/scene/quality.h"
#include "haptex/studies/pareto.h"
#include "haptex/studies/trade_off_study.h"

namespace haptex::studies {

/// All that was measured.
struct TradeOffTable {
  std::vector<TradeOffCase> cases;
  std::vector<Reference> references;  ///< by case
  std::vector<TradeOffPoint> points;
  std::vector<std::vector<TradeOffResult>> results;  ///< by point, then by case
};

/// The geometric means of a point's costs and of its relative errors: what halves one of them
/// counts alike whichever it is. Infinite if it was not stable or not followed in one.
CostAndError overall(const std::vector<TradeOffResult>& results);

/// For one fabric of the table after the other, the points of its front that a scene may ask for,
/// by rising cost and falling error (overall() of its motions): with Green-Lagrange elements and an
/// implicit method, cells of at most kMaxCell, stable in all of its motions, and each more accurate
/// than the one before by kMinGain at least. Three of them have the names of presets, by rule:
///   accurate: the least error of those whose cost is at most kMaxCost where nothing touches the
///             cloth
///   fast:     the least cost of those whose error in position is at most kMaxPositionError of the
///             sample's size in every motion
///   balanced: kneeOf() those from the one to the other, but neither of them; only if there is one
/// the others are called point_1, point_2, ... by their place. Measured are all fabrics in which
/// the point was followed.
std::vector<scene::Quality> chooseQualities(const TradeOffTable& table);

constexpr double kMaxCell = 0.017;  ///< m, the width of a fingertip
constexpr double kMinGain = 1.05;
constexpr double kMaxCost = 1.0;  ///< computing time of one core over simulated time
constexpr double kMaxPositionError = 0.05;

/// CSV, a line per point and case that was followed, and one per reference with its own errors. In
/// the columns position_limited, force_limited, energy_limited 1 stands for an error that is the
/// reference's own, because the distance from it is smaller. Of the column front, 1: on the front
/// of cost and relative error of its case; preset: the point's name among `qualities`, if it is
/// there.
void writeTable(std::ostream& out, const TradeOffTable& table,
                const std::vector<scene::Quality>& qualities);

/// YAML: docs/trade_off.md describes the format.
/// @param machine of the study, for people
void writeQualities(std::ostream& out, const std::vector<scene::Quality>& qualities,
                    const std::string& machine);

}  // namespace haptex::studies
