// Shares of the sky against exact ones and against rays cast at every triangle.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "../refusal.h"
#include "fixtures.h"
#include "haptex/proximity/sky_occlusion.h"
#include "ray_caster.h"

namespace haptex::proximity::test_sky_occlusion {
namespace {

using test::refusalOf;

using Eigen::Vector3d;

TEST(SkyOcclusion, FlatClothSeesTheWholeSky) {
  const mesh::ClothMesh mesh = sheet(8);
  SkyOcclusion sky(mesh.triangles, restPositions(mesh).size());
  for (const char* state : {"flat", "hanging", "stretched", "sheared", "mirrored", "far_away"}) {
    for (const SkyShare& share : sky.compute(oracles::deformedSheet(mesh, state))) {
      EXPECT_FLOAT_EQ(share.front, 1.0f) << state;
      EXPECT_FLOAT_EQ(share.back, 1.0f) << state;
    }
  }
}

/// A triangle below the middle of a square roof, from which it sees nothing but its share.
TEST(SkyOcclusion, UnderASquareIsOneMinusItsFormFactor) {
  for (const double half : {0.3, 1.0, 3.0}) {
    const std::vector<Vector3d> positions = {
        {0.0, 0.0, 0.0},    {1e-3, 0.0, 0.0},  {0.0, 1e-3, 0.0},  {-half, -half, 1.0},
        {half, -half, 1.0}, {half, half, 1.0}, {-half, half, 1.0}};
    SkyOcclusion sky({{0, 1, 2}, {3, 4, 5}, {3, 5, 6}}, positions.size());
    // Four times that of a rectangle over its corner (Siegel and Howell 1992, configuration 4).
    const double side = half / std::sqrt(1.0 + half * half);
    const double factor = 4.0 / M_PI * side * std::atan(side);
    const SkyShare share = sky.compute(positions)[0];
    EXPECT_NEAR(share.front, 1.0 - factor, 0.03) << half;
    EXPECT_EQ(share.back, 1.0f) << half;
  }
}

TEST(SkyOcclusion, IsWithinThreePercentOfTheSkyOfFourThousandRays) {
  const mesh::ClothMesh mesh = sheet(16);
  SkyOcclusion sky(mesh.triangles, restPositions(mesh).size());
  double squares = 0.0;
  int count = 0;
  for (const char* state : {"folded", "folded_twice", "draped", "waved", "rolled", "crumpled_1",
                            "crumpled_2", "twisted", "crumpled_to_a_ball"}) {
    const auto positions = oracles::deformedSheet(mesh, state);
    const std::vector<SkyShare> shares = sky.compute(positions);
    for (std::size_t i = 5; i < shares.size(); i += 23) {
      const SkyShare cast = castSky(mesh.triangles, positions, static_cast<int>(i), 4096);
      for (const float error : {shares[i].front - cast.front, shares[i].back - cast.back}) {
        EXPECT_NEAR(error, 0.0f, 0.03f) << state << " particle " << i;
        squares += error * error;
        ++count;
      }
    }
  }
  EXPECT_LT(std::sqrt(squares / count), 0.015);
}

TEST(SkyOcclusion, ChangesSidesWithTheTriangles) {
  mesh::ClothMesh mesh = sheet(8);
  const auto positions = oracles::deformedSheet(mesh, "waved");
  SkyOcclusion sky(mesh.triangles, positions.size());
  for (auto& triangle : mesh.triangles) std::swap(triangle[0], triangle[1]);
  SkyOcclusion turned(mesh.triangles, positions.size());
  const auto& shares = sky.compute(positions);
  const auto& others = turned.compute(positions);
  for (std::size_t i = 0; i < shares.size(); ++i) {
    EXPECT_FLOAT_EQ(shares[i].front, others[i].back);
    EXPECT_FLOAT_EQ(shares[i].back, others[i].front);
  }
}

TEST(SkyOcclusion, IsTheSameWithEveryInstructionSet) {
  if (bestInstructionSet() == InstructionSet::kBaseline) GTEST_SKIP() << "there is one";
  const mesh::ClothMesh mesh = sheet(9);
  SkyOcclusion best(mesh.triangles, restPositions(mesh).size());
  SkyOcclusion baseline(mesh.triangles, restPositions(mesh).size(), nullptr,
                        InstructionSet::kBaseline);
  for (const auto& state : oracles::deformedSheets(mesh)) {
    const auto& shares = best.compute(state.positions);
    const auto& others = baseline.compute(state.positions);
    for (std::size_t i = 0; i < shares.size(); ++i) {
      ASSERT_EQ(shares[i].front, others[i].front) << state.name << i;
      ASSERT_EQ(shares[i].back, others[i].back) << state.name << i;
    }
  }
}

TEST(SkyOcclusion, IsTheSameWithAnyNumberOfThreads) {
  const mesh::ClothMesh mesh = sheet(9);
  const std::size_t particles = restPositions(mesh).size();
  linear::ThreadPool two(2), three(3);
  SkyOcclusion alone(mesh.triangles, particles);
  for (linear::ThreadPool* pool : {&two, &three}) {
    SkyOcclusion shared(mesh.triangles, particles, pool);
    for (const auto& state : oracles::deformedSheets(mesh)) {
      const auto& shares = shared.compute(state.positions);
      const auto& others = alone.compute(state.positions);
      for (std::size_t i = 0; i < shares.size(); ++i) {
        ASSERT_EQ(shares[i].front, others[i].front) << state.name << i;
        ASSERT_EQ(shares[i].back, others[i].back) << state.name << i;
      }
    }
  }
}

TEST(SkyOcclusion, SeesAllWhereThereIsNoNormal) {
  const mesh::ClothMesh mesh = sheet(4);
  SkyOcclusion sky(mesh.triangles, restPositions(mesh).size());
  for (const char* state : {"on_a_line", "on_a_point"}) {
    for (const SkyShare& share : sky.compute(oracles::deformedSheet(mesh, state))) {
      EXPECT_TRUE(share.front == 1.0f && share.back == 1.0f) << state;
    }
  }
}

TEST(SkyOcclusion, RefusesWhatIsNotOfTheMeshAndKeepsTheLastShares) {
  EXPECT_EQ(refusalOf([] {
              SkyOcclusion({{0, 1, 3}}, 3);
            }),
            "triangle 0 has vertex 3: there are 3 particles");
  const mesh::ClothMesh mesh = sheet(4);
  auto positions = oracles::deformedSheet(mesh, "waved");
  SkyOcclusion sky(mesh.triangles, positions.size());
  const auto before = sky.compute(positions);
  EXPECT_EQ(refusalOf([&] { sky.compute({Vector3d::Zero()}); }),
            "1 positions for a sky over 25 particles");
  positions[7].y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(refusalOf([&] { sky.compute(positions); }).find("position 7 "), std::string::npos);
  positions[7].y() = 0.0;
  const auto& after = sky.compute(oracles::deformedSheet(mesh, "waved"));
  for (std::size_t i = 0; i < after.size(); ++i) EXPECT_EQ(after[i].front, before[i].front);
}

}  // namespace
}  // namespace haptex::proximity::test_sky_occlusion
