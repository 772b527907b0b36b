#include "haptex/studies/pareto.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <tuple>

namespace haptex::studies {

std::vector<std::size_t> paretoFront(const std::vector<CostAndError>& points) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (std::isfinite(points[i].cost) && std::isfinite(points[i].error)) order.push_back(i);
  }
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::tie(points[a].cost, points[a].error, a) <
           std::tie(points[b].cost, points[b].error, b);
  });
  std::vector<std::size_t> front;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i : order) {
    if (!(points[i].error < least)) continue;
    least = points[i].error;
    front.push_back(i);
  }
  return front;
}

std::size_t kneeOf(const std::vector<CostAndError>& front) {
  if (front.empty()) throw std::invalid_argument("the front has no points; it needs one");
  for (const CostAndError& point : front) {
    for (double value : {point.cost, point.error}) {
      if (std::isfinite(value) && value > 0.0) continue;
      throw std::invalid_argument("the front has a cost or an error of " + std::to_string(value) +
                                  "; both must be finite and greater than 0");
    }
  }
  const double width = std::log(front.back().cost / front.front().cost);
  const double height = std::log(front.back().error / front.front().error);
  std::size_t knee = 0;
  double deepest = 0.0;
  for (std::size_t i = 0; i < front.size(); ++i) {
    const double depth = height * std::log(front[i].cost / front.front().cost) -
                         width * std::log(front[i].error / front.front().error);
    if (depth <= deepest) continue;
    deepest = depth;
    knee = i;
  }
  return knee;
}

}  // namespace haptex::studies
