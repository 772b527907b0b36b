#include <gtest/gtest.h>

#include <cmath>

#include "fixtures.h"
#include "haptex/appearance/brdf.h"

namespace haptex::appearance::test_brdf {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

TEST(Brdf, OfAMattFabricWithoutReliefIsLamberts) {
  const material::Look look{{0.2, 0.4, 0.6}, {0.5, 0.3, 0.1}, 0.0, 1.0};
  const Brdf brdf = meanOverRepeat(smallBtf(flatRelief(), look));
  const Vector3f warp(0.2F, 0.4F, 0.6F);
  const Vector3d views[] = {{0.0, 0.0, 1.0}, {0.9, -0.2, 0.1}, {-3.0, 4.0, 6.0}};
  const Vector3d lights[] = {{0.3, 0.1, 0.7}, {-0.9, 0.3, 0.05}, {0.0, -2.0, 1.0}};
  for (const Vector3d& view : views) {
    for (const Vector3d& light : lights) {
      const auto irradiance = static_cast<float>(light.normalized().z());
      EXPECT_LT((brdf.radiance(view, light) - irradiance / float(M_PI) * warp).norm(), 1e-5F);
    }
    EXPECT_LT((brdf.underSky(view) - warp).norm(), 1e-5F);
  }
}

TEST(Brdf, ShowsNothingByLightFromBelow) {
  const Brdf brdf = meanOverRepeat(smallBtf(flatRelief(), lookOf(0.5, 0.5, 0.0, 1.0)));
  EXPECT_EQ(brdf.radiance({0.0, 0.0, 1.0}, {0.6, 0.0, -0.8}), Vector3f::Zero());
  EXPECT_EQ(brdf.radiance({0.0, 0.0, 1.0}, {1.0, 0.0, 0.0}), Vector3f::Zero());
}

TEST(Brdf, OfWhiteYarnsShowsAllOfAnEvenSky) {
  const Brdf brdf =
      meanOverRepeat(makeBtf(furrows(4e-4), lookOf(1.0, 1.0, 0.0, 1.0), {64, 64, kSmall}));
  for (const Vector3d& view : sampledDirections()) {
    EXPECT_NEAR(brdf.underSky(view).y(), 1.0, 0.03) << view.transpose();
  }
}

TEST(Brdf, IsTheMeanOverTheRepeat) {
  const Btf btf = smallBtf(twill(), lookOf(0.6, 0.2, 0.1, 0.5));
  EXPECT_LT(meanError(btf, meanOverRepeat(btf), {48, 32, 1, 1, 7}), 0.1);
}

}  // namespace
}  // namespace haptex::appearance::test_brdf
