#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "haptex/oracles/exact/light_paths.h"
#include "haptex/oracles/experiments/known_surfaces.h"
#include "haptex/tactile/relief_picture.h"

namespace haptex::oracles::test_light_paths {
namespace {

using appearance::Reflectance;
using appearance::ReliefSurface;
using Eigen::Vector3d;

const material::Look kLook{{0.6, 0.4, 0.2}, {0.6, 0.4, 0.2}, 0.2, 0.4};

ReliefSurface waves(double amplitude) {
  tactile::HeightField field = flatField(32, 32);
  addGrating(field, 2, 1, amplitude);
  const std::vector<bool> warp(field.heights.size(), true);
  return ReliefSurface({field, warp}, 64, 64);
}

TEST(LightPaths, OnAFlatFabricReflectOnce) {
  base::RepeatableRandom random(1);
  const Reflectance reflectance(kLook);
  const Vector3d view(0.6, 0.0, 0.8), light(0.0, -0.8, 0.6);
  EXPECT_LT((radianceByPaths(waves(0.0), reflectance, view, light, 10, random) -
             0.6 * reflectance.of(true, Vector3d::UnitZ(), light, view))
                .norm(),
            1e-12);
}

TEST(LightPaths, AreTheSameBothWays) {
  base::RepeatableRandom random(1);
  const Reflectance reflectance(kLook);
  const ReliefSurface surface = waves(3e-4);
  const Vector3d a = Vector3d(0.7, 0.1, 0.4).normalized(),
                 b = Vector3d(-0.3, 0.5, 0.7).normalized();
  const Vector3d there = radianceByPaths(surface, reflectance, a, b, 250, random) / b.z();
  const Vector3d back = radianceByPaths(surface, reflectance, b, a, 250, random) / a.z();
  // 62 500 paths of radiances that spread as much as their mean: 0.4 % each.
  EXPECT_LT((there - back).norm(), 0.015 * there.norm());
}

TEST(LightPaths, OfWhiteUnderAnEvenSkyAreAsBrightAsIt) {
  base::RepeatableRandom random(1);
  const Reflectance white({{1.0, 1.0, 1.0}, {1.0, 1.0, 1.0}, 0.2, 0.4});
  const ReliefSurface surface = waves(3e-4);
  const Vector3d view = Vector3d(0.7, 0.1, 0.4).normalized();
  constexpr int kLights = 64;
  double sum = 0.0;
  for (int i = 0; i < kLights; ++i) {
    for (int j = 0; j < kLights; ++j) {
      const double z = (i + random.uniform(0.0, 1.0)) / kLights, radius = std::sqrt(1.0 - z * z);
      const double turn = 2.0 * M_PI * (j + random.uniform(0.0, 1.0)) / kLights;
      const Vector3d light(radius * std::cos(turn), radius * std::sin(turn), z);
      sum += radianceByPaths(surface, white, view, light, 5, random).x();
    }
  }
  EXPECT_NEAR(2.0 * M_PI * sum / (kLights * kLights), 1.0, 0.015);
}

}  // namespace
}  // namespace haptex::oracles::test_light_paths
