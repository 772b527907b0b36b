#include "haptex/tactile/surface.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "haptex/base/quoted.h"
#include "haptex/tactile/height_file.h"
#include "haptex/tactile/kes_surface.h"
#include "haptex/tactile/knit_relief.h"
#include "haptex/tactile/weave_relief.h"

namespace haptex::tactile {
namespace {

constexpr double kShortestMap = 1e-2;        // m, side of a field that shows a large scale
constexpr double kCoarsestSpacing = 2.5e-4;  // m, for 4 x 4 samples in a cell of the map
constexpr double kFlat = 1e-12;  // of the farthest height: what rounding leaves of it is less

/// Begins of pieces that cover `samples` and overlap by half, so that the fading at their edges
/// leaves nothing out (Welch 1967, IEEE Trans. Audio Electroacoust. 15:70).
std::vector<int> beginsOfPieces(int samples, int piece) {
  const int last = samples - piece;
  const int steps = (2 * last + piece - 1) / piece;
  std::vector<int> begins{0};
  for (int i = 1; i <= steps; ++i) {
    begins.push_back(static_cast<int>(static_cast<long>(last) * i / steps));
  }
  return begins;
}

HeightField cut(const HeightField& field, int column, int row, int columns, int rows) {
  HeightField piece{columns, rows, field.weft_spacing, field.warp_spacing, {}};
  piece.heights.reserve(static_cast<std::size_t>(columns) * rows);
  for (int r = row; r < row + rows; ++r) {
    const auto begin =
        field.heights.begin() + static_cast<std::ptrdiff_t>(field.columns) * r + column;
    piece.heights.insert(piece.heights.end(), begin, begin + columns);
  }
  return piece;
}

/// The sum of k-spaces of pieces of one size, by wave.
class PowerSum {
 public:
  PowerSum(int columns, int rows, double weft_spacing, double warp_spacing)
      : columns_(columns),
        rows_(rows),
        weft_step_(2.0 * M_PI / (columns * weft_spacing)),
        warp_step_(2.0 * M_PI / (rows * warp_spacing)),
        powers_(static_cast<std::size_t>(columns + 1) * (rows + 1)) {}

  void add(const KSpace& waves) {
    for (std::size_t i = 0; i < waves.size(); ++i) {
      const int column = static_cast<int>(std::lround(waves.weft[i] / weft_step_));
      const int row = static_cast<int>(std::lround(waves.warp[i] / warp_step_));
      powers_[indexOf(column, row)] += waves.power[i];
    }
    ++count_;
  }
  KSpace mean() const {
    KSpace result;
    for (int row = -rows_ / 2; row <= rows_ / 2; ++row) {
      for (int column = -columns_ / 2; column <= columns_ / 2; ++column) {
        const double power = powers_[indexOf(column, row)] / count_;
        if (!(power > 0.0)) continue;
        result.weft.push_back(weft_step_ * column);
        result.warp.push_back(warp_step_ * row);
        result.power.push_back(power);
      }
    }
    return result;
  }

 private:
  /// Of signed wave numbers: both of half an even size have their own place, see k_space.h.
  std::size_t indexOf(int column, int row) const {
    return static_cast<std::size_t>(columns_ + 1) * (row + rows_ / 2) + column + columns_ / 2;
  }

  int columns_, rows_;
  double weft_step_, warp_step_;
  std::vector<double> powers_;
  int count_ = 0;
};

/// The k-space of a field from a file, no larger than that of a weave.
KSpace kSpaceOf(const HeightField& field, bool periodic) {
  const int columns = std::min(field.columns, kReliefSamples);
  const int rows = std::min(field.rows, kReliefSamples);
  if (periodic && columns == field.columns && rows == field.rows) return kSpaceOfPeriodic(field);
  PowerSum sum(columns, rows, field.weft_spacing, field.warp_spacing);
  for (const int row : beginsOfPieces(field.rows, rows)) {
    for (const int column : beginsOfPieces(field.columns, columns)) {
      sum.add(kSpaceOfPiece(cut(field, column, row, columns, rows)));
    }
  }
  return sum.mean();
}

/// Of the heights in every cell about their mean, so that, as in the KES tester, nothing much
/// longer than 1 mm counts. The cells begin at the field's corner: where on the fabric that lies is
/// nobody's choice.
AmplitudeMap unevenness(const HeightField& field) {
  const double weft = field.columns * field.weft_spacing, warp = field.rows * field.warp_spacing;
  const double coarsest = std::max(field.weft_spacing, field.warp_spacing);
  if (std::min(weft, warp) < kShortestMap || coarsest > kCoarsestSpacing) return {};
  const int columns = static_cast<int>(std::lround(weft / AmplitudeMap::kSpacing));
  const int rows = static_cast<int>(std::lround(warp / AmplitudeMap::kSpacing));
  struct Cell {
    double count = 0.0, mean = 0.0, squares = 0.0;
  };
  std::vector<Cell> cells(static_cast<std::size_t>(columns) * rows);
  for (int row = 0; row < field.rows; ++row) {
    const int r = static_cast<int>(static_cast<long>(row) * rows / field.rows);
    for (int column = 0; column < field.columns; ++column) {
      const int c = static_cast<int>(static_cast<long>(column) * columns / field.columns);
      Cell& cell = cells[static_cast<std::size_t>(columns) * r + c];
      // Welford's update: no difference of large sums.
      const double height = field.at(column, row), before = height - cell.mean;
      cell.mean += before / ++cell.count;
      cell.squares += before * (height - cell.mean);
    }
  }
  double mean = 0.0;
  for (const Cell& cell : cells) mean += cell.squares / cell.count / cells.size();
  if (!(mean > 0.0)) return {};
  std::vector<PerChannel<double>> values;
  values.reserve(cells.size());
  for (const Cell& cell : cells) {
    const double amplitude = std::sqrt(cell.squares / cell.count / mean);
    values.push_back({amplitude, amplitude});
  }
  return AmplitudeMap(columns, rows, std::move(values));
}

/// A relief before it is scaled.
struct Relief {
  HeightField field;
  double farthest;  ///< m, of all heights from zero, any tilt included
  KSpace waves;
  AmplitudeMap large_scale;
};

double farthestOf(const HeightField& field) {
  double farthest = 0.0;
  for (const double height : field.heights) farthest = std::max(farthest, std::abs(height));
  return farthest;
}

Relief periodicRelief(HeightField field, AmplitudeMap large_scale) {
  KSpace waves = kSpaceOfPeriodic(field);
  const double farthest = farthestOf(field);
  return {std::move(field), farthest, std::move(waves), std::move(large_scale)};
}

Relief reliefOf(const material::Weave& weave) {
  return periodicRelief(weaveRelief(weave), weaveUnevenness(weave));
}

Relief reliefOf(const material::Knit& knit) {
  return periodicRelief(knitRelief(knit), knitUnevenness(knit));
}

Relief reliefOf(const material::HeightFile& file) {
  HeightField field = loadHeights(file);
  const double farthest = farthestOf(field);
  if (!file.periodic) removePlane(field);
  KSpace waves = kSpaceOf(field, file.periodic);
  AmplitudeMap large_scale = unevenness(field);
  return {std::move(field), farthest, std::move(waves), std::move(large_scale)};
}

bool isFlat(const Relief& relief, const KesSurface& tested) {
  const double little = kFlat * relief.farthest;
  const double spacing = std::max(relief.field.weft_spacing, relief.field.warp_spacing);
  return !(tested.roughness > little && tested.slope_deviation * spacing > little);
}

Relief reliefOf(const material::Surface& surface) {
  return std::visit([](const auto& kind) { return reliefOf(kind); }, surface.relief);
}

}  // namespace

HeightField sampledRelief(const material::Surface& surface) { return reliefOf(surface).field; }

Surface buildSurface(const material::Fabric& fabric) {
  if (!fabric.surface) {
    throw std::invalid_argument("fabric " + base::quoted(fabric.name) +
                                " has no surface; the tactile renderer needs it: add the key "
                                "surface");
  }
  const material::Surface& measured = *fabric.surface;
  Relief relief = reliefOf(measured);
  const KesSurface tested = testSurface(relief.field);
  if (isFlat(relief, tested)) {
    throw std::invalid_argument("fabric " + base::quoted(fabric.name) +
                                ": the relief of its surface is flat; it must rise and fall from "
                                "sample to sample");
  }
  const double scale = measured.roughness / tested.roughness;
  for (double& power : relief.waves.power) power *= scale * scale;
  const double friction_per_slope = measured.friction_deviation / (scale * tested.slope_deviation);
  return {
      fabric.name, {std::move(relief.waves), friction_per_slope}, std::move(relief.large_scale)};
}

}  // namespace haptex::tactile
