#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "haptex/tactile/amplitude_map.h"

namespace haptex::tactile::test_amplitude_map {
namespace {

using Eigen::Vector2d;

constexpr double kCell = AmplitudeMap::kSpacing;

/// 3 columns, 2 rows; the channels differ.
AmplitudeMap sample() {
  return AmplitudeMap(3, 2,
                      {{1.0, 10.0}, {2.0, 8.0}, {4.0, 6.0}, {0.0, 1.0}, {3.0, 0.5}, {5.0, 2.0}});
}

TEST(AmplitudeMap, HasItsValuesAtTheCellsCentres) {
  const double expected[2][3] = {{1.0, 2.0, 4.0}, {0.0, 3.0, 5.0}};
  for (int row = 0; row < 2; ++row) {
    for (int column = 0; column < 3; ++column) {
      // A place in metres is a whole number of cells up to rounding, and the map changes by up to
      // 5 per cell.
      EXPECT_NEAR(sample().at(kCell * Vector2d(column, row))[k40], expected[row][column], 1e-14);
    }
  }
  EXPECT_EQ(sample().at(Vector2d::Zero())[k320], 10.0);
}

TEST(AmplitudeMap, WeighsItsNeighboursBilinearly) {
  const double u = 0.25, v = 0.625;
  const PerChannel<double> found = sample().at(kCell * Vector2d(1.0 + u, v));
  const auto weighted = [&](double a, double b, double c, double d) {
    return (1.0 - v) * ((1.0 - u) * a + u * b) + v * ((1.0 - u) * c + u * d);
  };
  EXPECT_NEAR(found[k40], weighted(2.0, 4.0, 3.0, 5.0), 1e-13);
  EXPECT_NEAR(found[k320], weighted(8.0, 6.0, 0.5, 2.0), 1e-13);
}

TEST(AmplitudeMap, ContinuesAtItsOppositeEdge) {
  EXPECT_NEAR(sample().at(kCell * Vector2d(2.5, 0.0))[k40], 2.5, 1e-13);
  EXPECT_NEAR(sample().at(kCell * Vector2d(0.0, 1.5))[k40], 0.5, 1e-13);
  for (const Vector2d& place : {Vector2d(0.3, 0.8), Vector2d(2.9, 1.9), Vector2d(1.0, 0.0)}) {
    for (const int turns : {-7, -1, 1, 1000}) {
      const Vector2d elsewhere = place + turns * Vector2d(3.0, 2.0);
      // 1000 turns are some thousand cells, which leaves 13 digits of the place in a cell.
      EXPECT_NEAR(sample().at(kCell * elsewhere)[k40], sample().at(kCell * place)[k40], 1e-11)
          << elsewhere.transpose();
    }
  }
}

TEST(AmplitudeMap, StaysWithinItsValuesEverywhere) {
  const AmplitudeMap map = sample();
  for (int i = -5000; i < 5000; ++i) {
    const PerChannel<double> found = map.at({1.7e-5 * i, -2.9e-5 * i});
    ASSERT_GE(found[k40], 0.0);
    ASSERT_LE(found[k40], 5.0);
    ASSERT_GE(found[k320], 0.5);
    ASSERT_LE(found[k320], 10.0);
  }
  // Just below zero, where the remainder rounds to the whole map.
  EXPECT_NEAR(map.at({-1e-25, -1e-25})[k40], 1.0, 1e-14);
}

TEST(AmplitudeMap, IsOneWithoutValuesAndWithoutAPlace) {
  EXPECT_EQ(AmplitudeMap().at({0.0123, -4.5}), (PerChannel<double>{1.0, 1.0}));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(sample().at({nan, 0.0}), (PerChannel<double>{1.0, 1.0}));
  EXPECT_EQ(sample().at({0.0, -infinity}), (PerChannel<double>{1.0, 1.0}));
}

void expectRefusal(int columns, int rows, std::vector<PerChannel<double>> values,
                   const std::string& complaint) {
  try {
    const AmplitudeMap map(columns, rows, std::move(values));
    ADD_FAILURE() << "not refused: " << complaint;
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find(complaint), std::string::npos) << error.what();
  }
}

TEST(AmplitudeMap, RefusesBadSizesAndValues) {
  expectRefusal(0, 1, {}, "0 columns and 1 rows");
  expectRefusal(2, 2, {{1.0, 1.0}}, "2 columns and 2 rows with 1 values");
  expectRefusal(2, 1, {{1.0, 1.0}, {1.0, -0.5}}, "value 1 of an amplitude map is -0.5");
  expectRefusal(1, 1, {{std::nan(""), 1.0}}, "value 0 of an amplitude map is nan");
}

}  // namespace
}  // namespace haptex::tactile::test_amplitude_map
