#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "../refusal.h"
#include "haptex/appearance/directions.h"

namespace haptex::appearance::test_directions {
namespace {

using Eigen::Vector3d;

Vector3d at(double polar_degrees, double azimuth_degrees) {
  const double polar = polar_degrees * M_PI / 180.0, azimuth = azimuth_degrees * M_PI / 180.0;
  return {std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth),
          std::cos(polar)};
}

TEST(Directions, AreTheEightyOneOfSattler) {
  const auto& directions = sampledDirections();
  EXPECT_EQ(directions[0], Vector3d::UnitZ());
  EXPECT_LT((directions[1] - at(15.0, 0.0)).norm(), 1e-12);
  EXPECT_LT((directions[8] - at(30.0, 30.0)).norm(), 1e-12);
  EXPECT_LT((directions[80] - at(75.0, 345.0)).norm(), 1e-12);
}

TEST(Directions, AreTheirOwnMean) {
  for (int i = 0; i < kDirections; ++i) {
    const DirectionWeights weights = weightsOf(sampledDirections()[i]);
    double own = 0.0;
    for (int k = 0; k < 4; ++k) own += weights.index[k] == i ? weights.weight[k] : 0.0;
    EXPECT_NEAR(own, 1.0, 1e-9) << i;
  }
}

TEST(Directions, BetweenAreMeansOfWeightOneThatFollowWithoutAJump) {
  // What is interpolated: a smooth function. Between two neighbours it may change as much as it
  // does.
  const auto mean = [](const Vector3d& direction) {
    const DirectionWeights weights = weightsOf(direction);
    double sum = 0.0, value = 0.0;
    for (int k = 0; k < 4; ++k) {
      EXPECT_GE(weights.weight[k], 0.0);
      sum += weights.weight[k];
      value += weights.weight[k] * sampledDirections()[weights.index[k]].x();
    }
    EXPECT_NEAR(sum, 1.0, 1e-12);
    return value;
  };
  for (double polar = 0.5; polar < 90.0; polar += 3.7) {
    double before = mean(at(polar, -0.1));
    for (double azimuth = 0.0; azimuth < 361.0; azimuth += 0.1) {
      const double value = mean(at(polar, azimuth));
      ASSERT_NEAR(value, before, 0.003) << polar << ' ' << azimuth;
      before = value;
      // The chord between directions 60 degrees or less apart.
      if (polar <= 75.0) {
        ASSERT_NEAR(value, at(polar, azimuth).x(), 0.04) << polar << ' ' << azimuth;
      }
    }
  }
}

TEST(Directions, AreRefusedBelowTheFabricOrIfTheyAreNone) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (const Vector3d& direction : {Vector3d(1.0, 0.0, 0.0), Vector3d(0.0, 0.0, -1.0),
                                    Vector3d(kNan, 0.0, 1.0), Vector3d(0.0, 0.0, kNan)}) {
    const std::string refusal = test::refusalOf([&] { soundDirection("light", direction); });
    EXPECT_NE(refusal.find("direction of the light"), std::string::npos) << refusal;
    EXPECT_NE(refusal.find("z > 0"), std::string::npos) << refusal;
  }
}

TEST(Directions, AreOfLengthOneAndNotTooFlat) {
  EXPECT_LT((soundDirection("view", {0.0, 3.0, 4.0}) - Vector3d(0.0, 0.6, 0.8)).norm(), 1e-12);
  const Vector3d flat = soundDirection("view", {2.0, 0.0, 1e-300});
  EXPECT_NEAR(flat.norm(), 1.0, 1e-12);
  EXPECT_EQ(flat.z(), kFlattest);
  EXPECT_GT(flat.x(), 0.0);
}

}  // namespace
}  // namespace haptex::appearance::test_directions
