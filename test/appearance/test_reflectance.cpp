#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "../refusal.h"
#include "fixtures.h"
#include "haptex/appearance/reflectance.h"
#include "haptex/base/repeatable_random.h"

namespace haptex::appearance::test_reflectance {
namespace {

using Eigen::Vector3d;

/// What comes back of light from a direction, by the midpoint rule over all views.
double sentBack(const Reflectance& reflectance, const Vector3d& light) {
  constexpr int kSteps = 500;
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    for (int j = 0; j < kSteps; ++j) {
      const double square = (i + 0.5) / kSteps, turn = 2.0 * M_PI * (j + 0.5) / kSteps;
      const double radius = std::sqrt(square);
      const Vector3d view(radius * std::cos(turn), radius * std::sin(turn),
                          std::sqrt(1.0 - square));
      sum += reflectance.of(true, Vector3d::UnitZ(), light, view).x();
    }
  }
  return M_PI * sum / (kSteps * kSteps);  // uniform in the square of the sine: by the cosine
}

TEST(Reflectance, OfWhiteSendsAllLightBackFromEveryDirection) {
  for (const double width : {0.15, 0.25, 0.4, 0.7, 1.0}) {
    const Reflectance white(lookOf(1.0, 1.0, 0.6, width));
    for (const double degrees : {0.0, 20.0, 45.0, 70.0, 80.0, 87.0}) {
      const double polar = degrees * M_PI / 180.0;
      // 0.5 %: the table of what facets lose has 65 cosines.
      EXPECT_NEAR(sentBack(white, {std::sin(polar), 0.0, std::cos(polar)}), 1.0, 0.005)
          << width << ' ' << degrees;
    }
  }
}

TEST(Reflectance, IsTheSameBothWays) {
  base::RepeatableRandom random(3);
  const Reflectance reflectance({{0.2, 0.4, 0.6}, {0.5, 0.3, 0.1}, 0.3, 0.35});
  for (int i = 0; i < 200; ++i) {
    const Vector3d normal = random.direction(), a = random.direction(), b = random.direction();
    const Vector3d there = reflectance.of(i % 2 == 0, normal, a, b);
    EXPECT_LT((there - reflectance.of(i % 2 == 0, normal, b, a)).norm(),
              1e-12 * (1 + there.norm()));
    if (normal.dot(a) <= 0.0 || normal.dot(b) <= 0.0) {
      EXPECT_EQ(there, Vector3d::Zero());
    }
  }
}

TEST(Reflectance, WithoutGlossIsLambertsOfTheYarn) {
  const Reflectance reflectance({{0.2, 0.4, 0.6}, {0.5, 0.3, 0.1}, 0.0, 0.5});
  const Vector3d up = Vector3d::UnitZ(), slanted = Vector3d(0.6, 0.0, 0.8);
  EXPECT_LT((reflectance.of(true, up, slanted, up) - Vector3d(0.2, 0.4, 0.6) / M_PI).norm(), 1e-15);
  EXPECT_LT((reflectance.of(false, up, slanted, up) - Vector3d(0.5, 0.3, 0.1) / M_PI).norm(),
            1e-15);
  EXPECT_LT((reflectance.albedo(false) - Vector3d(0.5, 0.3, 0.1)).norm(), 1e-15);
}

TEST(Reflectance, ShinesWhereAMirrorWouldTheMoreTheNarrower) {
  const Vector3d up = Vector3d::UnitZ(), light(-0.6, 0.0, 0.8), mirrored(0.6, 0.0, 0.8);
  const Reflectance narrow(lookOf(0.0, 0.0, 1.0, 0.1)), broad(lookOf(0.0, 0.0, 1.0, 0.5));
  EXPECT_GT(narrow.highlight(up, light, mirrored), 4.0 * broad.highlight(up, light, mirrored));
  EXPECT_LT(narrow.highlight(up, light, up), broad.highlight(up, light, up));
}

TEST(Reflectance, RefusesWhatIsNoLook) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const auto expect_refusal = [](const material::Look& look, const std::string& name) {
    const std::string refusal = test::refusalOf([&] { Reflectance reflectance(look); });
    EXPECT_NE(refusal.find("look: " + name + " is"), std::string::npos) << refusal;
  };
  expect_refusal(lookOf(0.5, 0.5, 1.1, 0.5), "gloss");
  expect_refusal(lookOf(0.5, 0.5, kNan, 0.5), "gloss");
  expect_refusal(lookOf(0.5, 0.5, 0.1, 0.0), "width");
  expect_refusal(lookOf(0.5, 0.5, 0.1, kNan), "width");
  expect_refusal(lookOf(1.5, 0.5, 0.1, 0.5), "warp");
  expect_refusal(lookOf(0.5, kNan, 0.1, 0.5), "weft");
}

}  // namespace
}  // namespace haptex::appearance::test_reflectance
