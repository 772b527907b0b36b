#include "haptex/tactile/k_space.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <kissfft/kissfft.hh>
#include <numeric>

namespace haptex::tactile {
namespace {

using Complex = std::complex<double>;

/// Transforms all rows, then all columns, in place; row by row as in HeightField.
std::vector<Complex> transform(const HeightField& field) {
  std::vector<Complex> values(field.heights.begin(), field.heights.end());
  const kissfft<double> along_weft(field.columns, false), along_warp(field.rows, false);
  std::vector<Complex> result(std::max(field.columns, field.rows));
  for (int row = 0; row < field.rows; ++row) {
    Complex* const begin = values.data() + static_cast<std::size_t>(field.columns) * row;
    along_weft.transform(begin, result.data());
    std::copy_n(result.begin(), field.columns, begin);
  }
  std::vector<Complex> column(field.rows);
  for (int c = 0; c < field.columns; ++c) {
    for (int row = 0; row < field.rows; ++row) {
      column[row] = values[static_cast<std::size_t>(field.columns) * row + c];
    }
    along_warp.transform(column.data(), result.data());
    for (int row = 0; row < field.rows; ++row) {
      values[static_cast<std::size_t>(field.columns) * row + c] = result[row];
    }
  }
  return values;
}

/// The signed wave number of a discrete frequency.
int waveNumber(int index, int count) { return index <= count / 2 ? index : index - count; }

/// Whether a discrete frequency is as well its own negative: half of an even count.
bool isFolded(int index, int count) { return 2 * index == count; }

void add(KSpace& waves, double weft, double warp, double power) {
  waves.weft.push_back(weft);
  waves.warp.push_back(warp);
  waves.power.push_back(power);
}

double variance(const std::vector<double>& heights) {
  const double mean = std::accumulate(heights.begin(), heights.end(), 0.0) / heights.size();
  double sum = 0.0;
  for (const double height : heights) sum += (height - mean) * (height - mean);
  return sum / heights.size();
}

/// Hann window of a sample among `count`, without zeros at the ends.
double window(int index, int count) {
  const double sine = std::sin(M_PI * (index + 0.5) / count);
  return sine * sine;
}

}  // namespace

double KSpace::totalPower() const { return std::accumulate(power.begin(), power.end(), 0.0); }

KSpace kSpaceOfPeriodic(const HeightField& field) {
  requireSound(field);
  const std::vector<Complex> values = transform(field);
  const double samples = static_cast<double>(values.size());
  const double step_weft = 2.0 * M_PI / (field.columns * field.weft_spacing);
  const double step_warp = 2.0 * M_PI / (field.rows * field.warp_spacing);
  KSpace result;
  for (int row = 0; row < field.rows; ++row) {
    for (int column = 0; column < field.columns; ++column) {
      const int opposite_column = (field.columns - column) % field.columns;
      const int opposite_row = (field.rows - row) % field.rows;
      const std::size_t index = static_cast<std::size_t>(field.columns) * row + column;
      const std::size_t opposite =
          static_cast<std::size_t>(field.columns) * opposite_row + opposite_column;
      // Each pair once; at the edges of the k-space a wave can be its own opposite.
      if (index == 0 || opposite < index) continue;
      const double once = std::norm(values[index] / samples);
      const double power = opposite == index ? once : 2.0 * once;
      if (!(power > 0.0)) continue;
      const double weft = step_weft * waveNumber(column, field.columns);
      const double warp = step_warp * waveNumber(row, field.rows);
      if ((isFolded(column, field.columns) && row != 0) ||
          (isFolded(row, field.rows) && column != 0)) {
        // The samples do not tell the wave from its mirror image. Either alone would give
        // symmetric surfaces a slant.
        add(result, weft, warp, 0.5 * power);
        add(result, -weft, warp, 0.5 * power);
      } else {
        add(result, weft, warp, power);
      }
    }
  }
  return result;
}

KSpace kSpaceOfPiece(const HeightField& field) {
  requireSound(field);
  HeightField faded = field;
  removePlane(faded);
  const double total = variance(faded.heights);
  for (int row = 0; row < field.rows; ++row) {
    for (int column = 0; column < field.columns; ++column) {
      faded.heights[static_cast<std::size_t>(field.columns) * row + column] *=
          window(column, field.columns) * window(row, field.rows);
    }
  }
  KSpace result = kSpaceOfPeriodic(faded);
  const double kept = result.totalPower();
  if (!(kept > 0.0)) return {};
  for (double& power : result.power) power *= total / kept;
  return result;
}

}  // namespace haptex::tactile
