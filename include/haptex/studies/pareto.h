// Which of many ways to do something are worth their cost.
#pragma once

#include <cstddef>
#include <vector>

namespace haptex::studies {

/// What a way costs and misses; any units, >= 0. Not a number or infinite: never on a front.
struct CostAndError {
  double cost;
  double error;
};

/// Indices of the points that no other one beats: none costs at most as much with a smaller error,
/// or less with the same. Sorted by cost; errors fall strictly from each to the next.
std::vector<std::size_t> paretoFront(const std::vector<CostAndError>& points);

/// Where more cost begins to buy less: of a front's points the one farthest below the straight line
/// between its first and last in logarithms of cost and error. The first one if none is below.
/// @param front by rising cost and falling error, all > 0
/// @return its index
/// @throws std::invalid_argument if the front is empty or a number is not finite and > 0
std::size_t kneeOf(const std::vector<CostAndError>& front);

}  // namespace haptex::studies
