#include <gtest/gtest.h>

#include <map>
#include <utility>

#include "fixtures.h"
#include "haptex/tactile/k_space.h"

namespace haptex::tactile::test_k_space {
namespace {

/// Power by wave numbers over the field, of a wave and its opposite together: the warp's are >= 0.
using Table = std::map<std::pair<long, long>, double>;

Table tableOf(const HeightField& field, const KSpace& waves) {
  Table table;
  for (std::size_t i = 0; i < waves.size(); ++i) {
    const auto number = [](double k, double length) {
      return std::lround(k * length / (2.0 * M_PI));
    };
    const long m = number(waves.weft[i], field.columns * field.weft_spacing);
    const long n = number(waves.warp[i], field.rows * field.warp_spacing);
    table[n < 0 || (n == 0 && m < 0) ? std::pair(-m, -n) : std::pair(m, n)] += waves.power[i];
  }
  return table;
}

void expectEqual(const Table& a, const Table& b, double tolerance) {
  ASSERT_EQ(a.size(), b.size());
  for (const auto& [numbers, power] : a) {
    ASSERT_EQ(b.count(numbers), 1u) << numbers.first << ' ' << numbers.second;
    EXPECT_NEAR(b.at(numbers), power, tolerance) << numbers.first << ' ' << numbers.second;
  }
}

TEST(KSpace, ParsevalHoldsForEvenOddAndPrimeSizes) {
  for (const auto& [columns, rows] : {std::pair(64, 48), {63, 45}, {61, 127}, {60, 31}, {2, 509}}) {
    const HeightField field = whiteNoise(columns, rows);
    const double exact = variance(field);
    EXPECT_NEAR(kSpaceOfPeriodic(field).totalPower(), exact, 1e-10 * exact)
        << columns << " x " << rows;
  }
}

TEST(KSpace, ASingleWaveLandsOnItsWaveVector) {
  constexpr double kAmplitude = 3e-6;
  for (int m = -5; m <= 5; ++m) {
    for (int n = 0; n <= 4; ++n) {
      if (n == 0 && m <= 0) continue;
      HeightField field = flatField(12, 9, 1e-4, 1.5e-4);
      addGrating(field, m, n, kAmplitude);
      const KSpace waves = kSpaceOfPeriodic(field);
      const double power = 0.5 * kAmplitude * kAmplitude;
      double elsewhere = 0.0, here = 0.0;
      for (std::size_t i = 0; i < waves.size(); ++i) {
        const double sign = waves.weft[i] * m * 9 * 1.5 + waves.warp[i] * n * 12 < 0.0 ? -1.0 : 1.0;
        const double off_weft = sign * waves.weft[i] - 2.0 * M_PI * m / 12e-4;
        const double off_warp = sign * waves.warp[i] - 2.0 * M_PI * n / 13.5e-4;
        const bool is_here = std::hypot(off_weft, off_warp) < 1e-6;  // rad/m, steps are 4000
        (is_here ? here : elsewhere) += waves.power[i];
      }
      EXPECT_NEAR(here, power, 1e-13 * power) << m << ' ' << n;
      EXPECT_LT(elsewhere, 1e-26 * power) << m << ' ' << n;  // squares of rounding
    }
  }
}

TEST(KSpace, TheMeanIsNotFelt) {
  const HeightField field = whiteNoise(16, 15);
  HeightField lifted = field;
  for (double& height : lifted.heights) height += 1e-5;
  const double power = kSpaceOfPeriodic(field).totalPower();
  EXPECT_NEAR(kSpaceOfPeriodic(lifted).totalPower(), power, 1e-12 * power);
}

TEST(KSpace, OfAMirroredSurfaceIsMirrored) {
  const HeightField field = whiteNoise(16, 12);  // even: waves at half of the samples' rate, too
  HeightField mirrored = field;
  for (int row = 0; row < 12; ++row) {
    for (int column = 0; column < 16; ++column) {
      mirrored.heights[16 * row + column] = field.at(15 - column, row);
    }
  }
  const KSpace waves = kSpaceOfPeriodic(field);
  KSpace expected = waves;
  for (double& k : expected.weft) k = -k;
  expectEqual(tableOf(field, expected), tableOf(field, kSpaceOfPeriodic(mirrored)),
              1e-12 * waves.totalPower());
}

TEST(KSpace, OfATurnedSurfaceIsTurned) {
  HeightField field = whiteNoise(16, 16);
  field.warp_spacing = field.weft_spacing;
  HeightField turned = field;
  for (int row = 0; row < 16; ++row) {
    for (int column = 0; column < 16; ++column) {
      turned.heights[16 * row + column] = field.at(row, 15 - column);
    }
  }
  const KSpace waves = kSpaceOfPeriodic(field);
  KSpace expected = waves;
  for (std::size_t i = 0; i < waves.size(); ++i) {
    expected.weft[i] = -waves.warp[i];
    expected.warp[i] = waves.weft[i];
  }
  expectEqual(tableOf(field, expected), tableOf(field, kSpaceOfPeriodic(turned)),
              1e-12 * waves.totalPower());
}

TEST(KSpaceOfPiece, KeepsTheVarianceAboutThePlane) {
  HeightField field = flatField(40, 31, 1e-4, 1.3e-4);
  addGrating(field, 5, 0, 2e-6);
  addGrating(field, -3, 7, 1e-6);
  // Whole periods are nearly orthogonal to a plane: what the plane takes of them is below 1 %.
  const double exact = variance(field);
  const double power = kSpaceOfPiece(field).totalPower();
  EXPECT_NEAR(power, exact, 0.01 * exact);
  for (int row = 0; row < field.rows; ++row) {
    for (int column = 0; column < field.columns; ++column) {
      field.heights[40 * row + column] += 1e-4 + 3e-6 * column - 2e-6 * row;
    }
  }
  EXPECT_NEAR(kSpaceOfPiece(field).totalPower(), power, 1e-10 * power);  // the tilt is 20 times h
}

TEST(KSpaceOfPiece, FindsAWaveThatDoesNotFitThePiece) {
  HeightField field = flatField(50, 50);
  const Eigen::Vector2d k = 2.0 * M_PI / 0.43e-3 * direction(25.0);
  for (int row = 0; row < 50; ++row) {
    for (int column = 0; column < 50; ++column) {
      field.heights[50 * row + column] = 1e-6 * std::cos(1e-4 * (k.x() * column + k.y() * row));
    }
  }
  const KSpace waves = kSpaceOfPiece(field);
  const double step = 2.0 * M_PI / 5e-3;
  double near = 0.0;
  for (std::size_t i = 0; i < waves.size(); ++i) {
    const Eigen::Vector2d wave(waves.weft[i], waves.warp[i]);
    if (std::min((wave - k).norm(), (wave + k).norm()) < 2.5 * step) near += waves.power[i];
  }
  // The main lobe of the Hann window reaches two steps to all sides; outside lies 1 part in 1000.
  EXPECT_GT(near, 0.995 * waves.totalPower());
}

TEST(KSpaceOfPiece, OfAPlaneIsEmptyButForRounding) {
  EXPECT_EQ(kSpaceOfPiece(flatField(8, 9)).size(), 0u);
  HeightField field = flatField(8, 9);
  for (int i = 0; i < 72; ++i) {
    const int row = i / 8;
    field.heights[i] = 1e-5 * (i % 8) + 2e-5 * row;
  }
  EXPECT_LT(kSpaceOfPiece(field).totalPower(), 1e-30 * variance(field) * 1e4);
}

TEST(KSpace, RefusesFieldsThatAreNotSound) {
  EXPECT_THROW(kSpaceOfPeriodic(flatField(1, 8)), std::invalid_argument);
  EXPECT_THROW(kSpaceOfPiece(flatField(8, 8, -1e-4)), std::invalid_argument);
}

}  // namespace
}  // namespace haptex::tactile::test_k_space
