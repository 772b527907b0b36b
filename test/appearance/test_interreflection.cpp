#include <gtest/gtest.h>

#include <cmath>

#include "fixtures.h"
#include "haptex/appearance/interreflection.h"

namespace haptex::appearance::test_interreflection {
namespace {

using Eigen::Vector3d;

double meanOpen(const Interreflection& light) {
  double sum = 0.0;
  for (int texel = 0; texel < light.surface().texels(); ++texel) sum += light.openShare(texel);
  return sum / light.surface().texels();
}

TEST(Interreflection, OfAFlatFabricIsNone) {
  const Interreflection light(ReliefSurface(flatRelief(), 8, 8), lookOf(0.5, 0.5, 0.2, 0.4));
  EXPECT_EQ(meanOpen(light), 1.0);
  const Interreflection::Light solved = light.solve({Vector3d(0.0, 0.6, 0.8)});
  EXPECT_NEAR(solved.radiosity.maxCoeff(), 0.8 * (0.8 * 0.5 + 0.2), 1e-6);
  EXPECT_EQ(light.send(5, solved, {Vector3d::UnitZ()}).cwiseAbs().maxCoeff(), 0.0f);
}

TEST(Interreflection, SeesTheShareOfTheSkyThatFurrowsLeave) {
  // A wall that sees a wall: by the rule of crossed strings the mean over the surface of the share
  // of the sky, weighted by area, is the opening by the length of the section.
  const ReliefSurface surface(furrows(), 256, 4);
  const Interreflection light(surface, lookOf(0.5, 0.5, 0.0, 1.0));
  double open = 0.0, length = 0.0;
  for (int texel = 0; texel < surface.texels(); ++texel) {
    const double weight = 1.0 / surface.centreOf(texel).normal.z();
    open += weight * light.openShare(texel);
    length += weight;
  }
  // 1024 texels of 100 rays: standard error 0.2 %.
  EXPECT_NEAR(open / length, surface.texels() / length, 0.005);
}

TEST(Interreflection, OfWhiteLosesNoLight) {
  // All that arrives leaves again: radiosity times open share, over the surface, is the light's
  // irradiance on the plane.
  const ReliefSurface surface(furrows(), 128, 8);
  const Interreflection white(surface, lookOf(1.0, 1.0, 0.0, 1.0));
  for (const Vector3d& towards : {Vector3d(0.0, 0.0, 1.0), Vector3d(0.6, 0.0, 0.8),
                                  Vector3d(0.5, 0.7, 0.5).normalized().eval()}) {
    const Interreflection::Light solved = white.solve({towards});
    double sent = 0.0;
    for (int texel = 0; texel < surface.texels(); ++texel) {
      sent +=
          white.openShare(texel) * solved.radiosity(texel, 0) / surface.centreOf(texel).normal.z();
    }
    EXPECT_NEAR(sent / surface.texels(), towards.z(), 0.01 * towards.z()) << towards.transpose();
  }
}

TEST(Interreflection, TakesTheColourOfTheYarnsOnTheWay) {
  const Interreflection red(ReliefSurface(furrows(), 64, 4),
                            {{0.8, 0.2, 0.0}, {0.8, 0.2, 0.0}, 0.0, 1.0});
  const Interreflection::Light solved = red.solve({Vector3d::UnitZ()});
  const auto sent = red.send(32, solved, {Vector3d::UnitZ()});
  // Two reflections or more.
  EXPECT_GT(sent(0, 0), 15.0f * sent(0, 1));
  EXPECT_GT(sent(0, 1), 0.0f);
  EXPECT_EQ(sent(0, 2), 0.0f);
}

/// Furrows are the same all along warp, so what differs there is error of the few rays: root mean
/// square, in parts of what is sent.
double noiseOf(const Interreflection& light) {
  const ReliefSurface& surface = light.surface();
  const Interreflection::Light solved = light.solve({Vector3d(0.6, 0.0, 0.8)});
  double variance = 0.0, squares = 0.0;
  for (int column = 0; column < surface.columns(); ++column) {
    Eigen::ArrayXd sent(surface.rows());
    for (int row = 0; row < surface.rows(); ++row) {
      sent[row] =
          light.send(surface.columns() * row + column, solved, {Vector3d(-0.6, 0.0, 0.8)})(0, 0);
    }
    variance += (sent - sent.mean()).square().sum();
    squares += sent.square().sum();
  }
  return std::sqrt(variance / squares);
}

TEST(Interreflection, CastsMoreRaysWhereHighlightsAreStrongAndNarrow) {
  const ReliefSurface surface(furrows(), 32, 32);
  const Interreflection knit(surface, lookOf(0.3, 0.3, 0.08, 0.4));
  const Interreflection satin(surface, lookOf(0.3, 0.3, 0.25, 0.25));
  EXPECT_EQ(knit.rays(), 100);
  EXPECT_EQ(Interreflection(surface, lookOf(0.3, 0.3, 0.0, 1.0)).rays(), 100);
  EXPECT_EQ(Interreflection(surface, lookOf(0.3, 0.3, 0.18, 0.3)).rays(), 144);
  EXPECT_EQ(satin.rays(), 400);
  EXPECT_EQ(Interreflection(surface, lookOf(0.3, 0.3, 1.0, 0.01)).rays(), 400);
  // 0.066 and 0.037; with 100 rays for each satin is at 0.167.
  EXPECT_LT(noiseOf(satin), 2.2 * noiseOf(knit));
}

TEST(Interreflection, SendsHighlightsTowardsTheEyeOnly) {
  const Interreflection shiny(ReliefSurface(furrows(), 64, 4), lookOf(0.1, 0.1, 0.5, 0.2));
  const Interreflection dull(ReliefSurface(furrows(), 64, 4), lookOf(0.1, 0.1, 0.0, 0.2));
  const std::vector<Vector3d> views{Vector3d::UnitZ(), Vector3d(0.5, 0.0, 0.866).normalized()};
  for (const int texel : {20, 32, 40}) {
    const auto of_shiny = shiny.send(texel, shiny.solve({Vector3d::UnitZ()}), views);
    const auto of_dull = dull.send(texel, dull.solve({Vector3d::UnitZ()}), views);
    EXPECT_FLOAT_EQ(of_dull(0, 0), of_dull(1, 0));
    EXPECT_GT(std::abs(of_shiny(0, 0) - of_shiny(1, 0)), 0.02f * of_shiny(0, 0)) << texel;
  }
}

}  // namespace
}  // namespace haptex::appearance::test_interreflection
