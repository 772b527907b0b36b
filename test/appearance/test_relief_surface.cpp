#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "../refusal.h"
#include "fixtures.h"
#include "haptex/appearance/relief_surface.h"
#include "haptex/base/repeatable_random.h"

namespace haptex::appearance::test_relief_surface {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// Height of the bilinear surface, another way: from the four corners.
double heightAt(const ReliefSurface& surface, const Vector3d& place) {
  const double x = place.x() / surface.size().x() * surface.columns();
  const double y = place.y() / surface.size().y() * surface.rows();
  const int i = static_cast<int>(std::floor(x)), j = static_cast<int>(std::floor(y));
  const auto corner = [&](int column, int row) {
    const int n = surface.columns(), m = surface.rows();
    return surface.heights()[n * ((row % m + m) % m) + (column % n + n) % n];
  };
  const double u = x - i, v = y - j;
  return (1 - u) * (1 - v) * corner(i, j) + u * (1 - v) * corner(i + 1, j) +
         (1 - u) * v * corner(i, j + 1) + u * v * corner(i + 1, j + 1);
}

TEST(ReliefSurface, HasTheHeightsOfTheReliefAtItsSamples) {
  const tactile::FaceRelief relief = twill();
  const int columns = relief.heights.columns, rows = relief.heights.rows;
  const ReliefSurface surface(relief, 2 * columns, 2 * rows);
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      ASSERT_NEAR(surface.heights()[4 * columns * row + 2 * column], relief.heights.at(column, row),
                  1e-10);
    }
  }
}

TEST(ReliefSurface, BetweenSamplesIsSmooth) {
  // A sine of 16 samples: the cubic is true to 0.2 %.
  const ReliefSurface surface(furrows(2e-4), 64, 64);
  for (int column = 0; column < 64; ++column) {
    EXPECT_NEAR(surface.heights()[column], 1e-4 * std::cos(2.0 * M_PI * column / 64), 3e-7);
  }
}

TEST(ReliefSurface, IsSeenWhereARayFirstMeetsIt) {
  // Against small steps along the ray.
  const ReliefSurface surface(twill(), 60, 75);
  base::RepeatableRandom random(5);
  for (int i = 0; i < 300; ++i) {
    Vector3d view = random.direction();
    view.z() = std::abs(view.z()) + 0.05;
    view.normalize();
    const Vector2d seen = surface.size().cwiseProduct(random.inSquare(0.0, 1.0));
    Vector3d place(seen.x(), seen.y(), surface.highest() + 1e-9);
    constexpr double kStep = 1e-6;
    while (place.z() > heightAt(surface, place)) place -= kStep / view.z() * view;
    const ReliefSurface::Point point = surface.seenAt(seen, view);
    // A crest that the steps go through would be met before.
    ASSERT_NEAR(point.place.z(), place.z(), 3e-6) << i;
    ASSERT_NEAR(point.place.z(), heightAt(surface, point.place), 1e-9) << i;
    ASSERT_GT(point.normal.dot(view), -0.05) << i;
  }
}

TEST(ReliefSurface, HidesTheSunAsItsCrestsDo) {
  // Furrows: from the bottom of one, the sky begins where the tangent over the crest ends. That of
  // z = a cos(k x) through x0 = pi/k: the steepest line to any x.
  const ReliefSurface surface(furrows(), 256, 16);
  double steepest = 0.0;
  for (int i = 1; i < 4000; ++i) {
    const double x = 1.6e-3 * i / 4000.0;
    steepest = std::max(steepest, (heightAt(surface, {8e-4 + x, 0.0, 0.0}) + 4e-4) / x);
  }
  const double horizon = std::atan(steepest) * 180.0 / M_PI;
  const ReliefSurface::Point bottom = surface.centreOf(128);
  for (double degrees = 1.0; degrees < 179.0; degrees += 0.5) {
    const double elevation = std::min(degrees, 180.0 - degrees);
    if (std::abs(elevation - horizon) < 1.0) continue;
    const double angle = degrees * M_PI / 180.0;
    EXPECT_EQ(surface.met(bottom, {std::cos(angle), 0.0, std::sin(angle)}).has_value(),
              elevation < horizon)
        << degrees;
  }
  // Along the furrow nothing is in the way.
  EXPECT_FALSE(surface.met(bottom, Vector3d(0.0, 0.999, 0.05).normalized()));
}

TEST(ReliefSurface, RepeatsWithoutEnd) {
  const ReliefSurface surface(twill(), 60, 75);
  const Vector3d view = Vector3d(0.9, -0.3, 0.2).normalized();
  const Vector2d seen(1.234e-3, 5.678e-3);
  const ReliefSurface::Point here = surface.seenAt(seen, view);
  const ReliefSurface::Point there =
      surface.seenAt(seen + surface.size().cwiseProduct(Vector2d(3.0, -2.0)), view);
  EXPECT_EQ(here.texel, there.texel);
  EXPECT_LT((here.normal - there.normal).norm(), 1e-6);
}

TEST(ReliefSurface, RefusesWhatItCannotBeMadeOf) {
  const auto expect_refusal = [](const auto& make, const std::string& name) {
    const std::string refusal = test::refusalOf(make);
    EXPECT_NE(refusal.find(name), std::string::npos) << refusal;
  };
  expect_refusal([] { ReliefSurface(flatRelief(), 3, 16); }, "3 columns of texels");
  expect_refusal([] { ReliefSurface(flatRelief(), 16, 1025); }, "1025 rows of texels");
  tactile::FaceRelief relief = flatRelief();
  relief.warp_on_top.pop_back();
  expect_refusal([&] { ReliefSurface(relief, 16, 16); }, "255 values of warp_on_top");
  const std::vector<bool> warp(16, true);
  const Vector2d size(1e-3, 1e-3);
  expect_refusal([&] { ReliefSurface(4, 4, size, std::vector<float>(15), warp); }, "15 heights");
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  expect_refusal([&] { ReliefSurface(4, 4, size, std::vector<float>(16, kNan), warp); }, "height");
  expect_refusal([&] { ReliefSurface(4, 4, {1e-3, kNan}, std::vector<float>(16), warp); }, "size");
}

}  // namespace
}  // namespace haptex::appearance::test_relief_surface
