#include "haptex/tactile/amplitude_map.h"

#include <cmath>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace haptex::tactile {
namespace {

/// A place in cells of a map that repeats after `count`: the cell before it and the share of the
/// next.
struct Cell {
  int first;
  int second;
  double share;
};

Cell cellOf(double place, int count) {
  double cells = std::fmod(place / AmplitudeMap::kSpacing, count);
  if (cells < 0.0) cells += count;
  const int first = static_cast<int>(cells) % count;  // rounding may have made it `count`
  return {first, (first + 1) % count, cells - std::floor(cells)};
}

}  // namespace

AmplitudeMap::AmplitudeMap(int columns, int rows, std::vector<PerChannel<double>> values)
    : columns_(columns), rows_(rows), values_(std::move(values)) {
  if (columns < 1 || rows < 1 || values_.size() != static_cast<std::size_t>(columns) * rows) {
    std::ostringstream message;
    message << "an amplitude map of " << columns << " columns and " << rows << " rows with "
            << values_.size() << " values: allowed is at least 1 of each, and one value per cell";
    throw std::invalid_argument(message.str());
  }
  for (std::size_t i = 0; i < values_.size(); ++i) {
    for (const double value : values_[i]) {
      if (std::isfinite(value) && value >= 0.0) continue;
      std::ostringstream message;
      message << "value " << i << " of an amplitude map is " << value
              << ": it must be finite and >= 0";
      throw std::invalid_argument(message.str());
    }
  }
}

PerChannel<double> AmplitudeMap::at(const Eigen::Vector2d& place) const {
  if (!place.allFinite()) return {1.0, 1.0};
  const Cell u = cellOf(place.x(), columns_);
  const Cell v = cellOf(place.y(), rows_);
  PerChannel<double> result{};
  for (int channel = 0; channel < kChannels; ++channel) {
    const auto value = [&](int column, int row) {
      return values_[static_cast<std::size_t>(columns_) * row + column][channel];
    };
    const double before =
        value(u.first, v.first) + u.share * (value(u.second, v.first) - value(u.first, v.first));
    const double after =
        value(u.first, v.second) + u.share * (value(u.second, v.second) - value(u.first, v.second));
    result[channel] = before + v.share * (after - before);
  }
  return result;
}

}  // namespace haptex::tactile
