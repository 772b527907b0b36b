#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "fixtures.h"
#include "haptex/tactile/height_file.h"
#include "haptex/tactile/kes_surface.h"
#include "haptex/tactile/surface.h"
#include "haptex/tactile/weave_relief.h"
#include "temporary_file.h"

namespace haptex::tactile::test_surface {
namespace {

using Eigen::Vector2d;
using material::Fabric;
using material::HeightFile;
using material::Weave;
using material::WeaveKind;

constexpr double kRoughness = 5e-6, kFrictionDeviation = 0.02;
const std::vector<WeaveKind> kWeaves = {WeaveKind::kPlain, WeaveKind::kTwill22, WeaveKind::kTwill31,
                                        WeaveKind::kSatin5, WeaveKind::kRib2};

template <typename Relief>
Fabric fabricWith(const Relief& relief) {
  Fabric fabric;
  fabric.name = "sample";
  fabric.surface = material::Surface{kRoughness, kFrictionDeviation, relief};
  return fabric;
}

Weave weaveOf(WeaveKind kind, double irregularity = 0.0) {
  return {kind, {4e-4, 5e-5}, {4e-4, 5e-5}, irregularity};
}

/// The standard stroke in a direction, degrees from weft.
PerChannel<double> stroked(const Surface& surface, double degrees, double speed = 0.02) {
  const double angle = degrees * M_PI / 180.0;
  return strokeAmplitudes(surface.small_scale,
                          {speed * Vector2d(std::cos(angle), std::sin(angle)), 0.5});
}

void expectEqual(const PerChannel<double>& a, const PerChannel<double>& b, double tolerance) {
  for (const Channel channel : {k40, k320}) {
    EXPECT_GT(a[channel], 0.0);
    EXPECT_NEAR(a[channel], b[channel], tolerance * a[channel]);
  }
}

TEST(Surface, GivesBackTheRoughnessAndTheFrictionOfTheTester) {
  for (const WeaveKind kind : kWeaves) {
    for (const double irregularity : {0.0, 0.3}) {
      const Weave weave = weaveOf(kind, irregularity);
      const Surface surface = buildSurface(fabricWith(weave));
      EXPECT_EQ(surface.fabric, "sample");
      // The relief as large as the waves are.
      HeightField field = weaveRelief(weave);
      const double scale = std::sqrt(surface.small_scale.waves.totalPower() / variance(field));
      for (double& height : field.heights) height *= scale;
      const KesSurface tested = testSurface(field);
      EXPECT_NEAR(tested.roughness, kRoughness, 1e-10 * kRoughness);
      EXPECT_NEAR(surface.small_scale.friction_per_slope * tested.slope_deviation,
                  kFrictionDeviation, 1e-10 * kFrictionDeviation);
    }
  }
}

TEST(Surface, OfAKnitGivesBackTheRoughnessOfTheTesterAndFeelsItsWales) {
  const material::Knit knit = {1.8e-3, 1.4e-3, 0.2};
  const Fabric fabric = fabricWith(knit);
  const Surface surface = buildSurface(fabric);
  HeightField field = sampledRelief(*fabric.surface);
  const double scale = std::sqrt(surface.small_scale.waves.totalPower() / variance(field));
  for (double& height : field.heights) height *= scale;
  EXPECT_NEAR(testSurface(field).roughness, kRoughness, 1e-10 * kRoughness);
  // Its face is its own mirror across the wales.
  const Surface regular = buildSurface(fabricWith(material::Knit{1.8e-3, 1.4e-3, 0.0}));
  for (const double degrees : {13.0, 45.0, 71.0}) {
    expectEqual(stroked(regular, degrees), stroked(regular, 180.0 - degrees), 1e-9);
  }
}

TEST(Surface, HasThePowerOfItsScaledRelief) {
  for (const WeaveKind kind : kWeaves) {
    const Weave weave = weaveOf(kind, 0.2);
    const HeightField field = weaveRelief(weave);
    const double scale = kRoughness / testSurface(field).roughness;
    const double expected = scale * scale * variance(field);
    EXPECT_NEAR(buildSurface(fabricWith(weave)).small_scale.waves.totalPower(), expected,
                1e-10 * expected);
  }
}

TEST(Surface, FeelsTheSameAfterTheTurnsOfItsWeave) {
  const Surface plain = buildSurface(fabricWith(weaveOf(WeaveKind::kPlain)));
  const Surface twill = buildSurface(fabricWith(weaveOf(WeaveKind::kTwill22)));
  for (const double degrees : {0.0, 13.0, 45.0, 71.0}) {
    expectEqual(stroked(plain, degrees), stroked(plain, degrees + 90.0), 1e-9);
    expectEqual(stroked(plain, degrees), stroked(plain, -degrees), 1e-9);
    // Swapping weft and warp leaves a twill 2/2 as it is.
    expectEqual(stroked(twill, degrees), stroked(twill, 90.0 - degrees), 1e-9);
  }
  // Its lines are felt across them only.
  EXPECT_GT(std::abs(stroked(twill, 45.0)[k40] / stroked(twill, 135.0)[k40] - 1.0), 0.05);
}

TEST(Surface, ShowsItsWeaveInTheChannelsOfTwoStrokes) {
  // Of equal roughness and yarns: what a person can tell, along weft and along warp.
  std::vector<std::vector<double>> felt;
  for (const WeaveKind kind : kWeaves) {
    const Surface surface = buildSurface(fabricWith(weaveOf(kind)));
    felt.emplace_back();
    for (const double degrees : {0.0, 90.0}) {
      for (const double speed : {0.02, 0.1}) {
        const PerChannel<double> amplitudes = stroked(surface, degrees, speed);
        felt.back().push_back(amplitudes[k320] / amplitudes[k40]);
      }
    }
  }
  for (std::size_t a = 0; a < felt.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      double largest = 0.0;
      for (std::size_t i = 0; i < felt[a].size(); ++i) {
        largest = std::max(largest, std::abs(std::log(felt[a][i] / felt[b][i])));
      }
      EXPECT_GT(largest, 0.1) << a << ", " << b;
    }
  }
}

TEST(Surface, IsTheSameAtEveryBuild) {
  const Fabric fabric = fabricWith(weaveOf(WeaveKind::kRib2, 0.3));
  EXPECT_EQ(buildSurface(fabric).small_scale.waves.power,
            buildSurface(fabric).small_scale.waves.power);
}

/// A field in a raw file of 16 bits.
template <typename F>
void writeField(const TemporaryFile& file, int columns, int rows, F value) {
  std::vector<int> values;
  for (int row = rows - 1; row >= 0; --row) {
    for (int column = 0; column < columns; ++column) {
      values.push_back(static_cast<int>(std::lround(value(column, row))));
    }
  }
  file.write(rawBytes(columns, rows, values));
}

double grating(int column, double samples_per_wave) {
  return 30000.0 + 20000.0 * std::sin(2.0 * M_PI * column / samples_per_wave);
}

TEST(Surface, OfAPeriodicFileEqualsThatOfTheWeaveInIt) {
  const Weave weave = weaveOf(WeaveKind::kTwill31, 0.2);
  const HeightField field = weaveRelief(weave);
  const double largest = *std::max_element(field.heights.begin(), field.heights.end());
  const TemporaryFile file(".raw");
  writeField(file, field.columns, field.rows,
             [&](int column, int row) { return 65535.0 * field.at(column, row) / largest; });
  const Surface from_file =
      buildSurface(fabricWith(HeightFile{file.path(), field.weft_spacing, largest, true}));
  const Surface from_weave = buildSurface(fabricWith(weave));
  // 16 bits round heights to 1e-5 of the largest.
  for (const double degrees : {0.0, 30.0, 90.0}) {
    expectEqual(stroked(from_file, degrees), stroked(from_weave, degrees), 1e-4);
  }
}

TEST(Surface, OfAFileDoesNotDependOnItsTilt) {
  const auto build = [](double tilt) {
    const TemporaryFile file(".raw");
    writeField(file, 100, 90, [&](int column, int row) {
      return grating(column, 7.3) - tilt * (column + 2.0 * row);
    });
    return buildSurface(fabricWith(HeightFile{file.path(), 1e-4, 2e-4, false}));
  };
  // Rounded to whole samples of a grating of 20000, and whole tilts round alike.
  expectEqual(stroked(build(0.0), 10.0), stroked(build(30.0), 10.0), 1e-9);
}

TEST(Surface, OfALargeFileCostsNoMoreThanAWeave) {
  const TemporaryFile file(".raw");
  const double wave = 5.3;
  writeField(file, 300, 200, [&](int column, int) { return grating(column, wave); });
  for (const bool periodic : {false, true}) {
    const Surface surface = buildSurface(fabricWith(HeightFile{file.path(), 1e-4, 2e-4, periodic}));
    const KSpace& waves = surface.small_scale.waves;
    EXPECT_LE(waves.size(), 129u * 129u / 2u);  // -64 to 64 each way, opposites together
    // A Hann window spreads a wave over two bins to each side: the rest is 1e-4 at most.
    const double k = 2.0 * M_PI / (wave * 1e-4), bin = 2.0 * M_PI / 12.8e-3;
    double near = 0.0;
    for (std::size_t i = 0; i < waves.size(); ++i) {
      if (std::abs(std::abs(waves.weft[i]) - k) < 2.5 * bin &&
          std::abs(waves.warp[i]) < 2.5 * bin) {
        near += waves.power[i];
      }
    }
    EXPECT_GT(near, (1.0 - 1e-3) * waves.totalPower());
    // The tester's mean of a grating along weft is half of |Hp| 2a/pi, and the power a^2/2; 300
    // samples are no whole number of waves, which both feel by a few per cent.
    const double x = 1e-3 / (wave * 1e-4);
    const double high_pass = x * x / std::hypot(1.0 - x * x, 1.2 * x);
    const double amplitude = kRoughness * M_PI / high_pass;
    EXPECT_NEAR(std::sqrt(2.0 * waves.totalPower()), amplitude, 0.03 * amplitude);
  }
}

TEST(Surface, OfALargeFileCountsAllOfItsParts) {
  const auto power = [](bool right, bool upper) {
    const TemporaryFile file(".raw");
    writeField(file, 300, 200, [&](int column, int row) {
      const bool grooved =
          (column >= 200) == right && (right || column < 100) && (row >= 100) == upper;
      return grooved ? grating(column, 5.0) : 30000.0;
    });
    const Surface surface = buildSurface(fabricWith(HeightFile{file.path(), 1e-4, 2e-4, true}));
    return surface.small_scale.waves.totalPower();
  };
  // Grooves in one corner or another are as rough for the tester. The begins of pieces are whole
  // samples, which moves the corners' shares by a hundredth or so.
  const double first = power(false, false);
  EXPECT_NEAR(power(true, false), first, 0.05 * first);
  EXPECT_NEAR(power(false, true), first, 0.05 * first);
  EXPECT_NEAR(power(true, true), first, 0.05 * first);
}

TEST(Surface, OfAFileShowsWhereItIsRough) {
  // 20 x 12 mm, grooved on the left: in every cell two waves or none.
  const TemporaryFile file(".raw");
  writeField(file, 200, 120,
             [](int column, int) { return column < 100 ? grating(column, 5.0) : 30000.0; });
  const Surface surface = buildSurface(fabricWith(HeightFile{file.path(), 1e-4, 2e-4, true}));
  ASSERT_EQ(surface.large_scale.columns(), 20);
  ASSERT_EQ(surface.large_scale.rows(), 12);
  for (int row = 0; row < 12; ++row) {
    for (int column = 0; column < 20; ++column) {
      const auto found = surface.large_scale.at(1e-3 * Vector2d(column, row));
      const double expected = column < 10 ? std::sqrt(2.0) : 0.0;
      EXPECT_NEAR(found[k40], expected, 1e-12) << column;
      EXPECT_NEAR(found[k320], expected, 1e-12) << column;
    }
  }
}

TEST(Surface, OfASmallOrCoarseFileIsUniform) {
  const TemporaryFile file(".raw");
  writeField(file, 90, 120, [](int column, int) { return grating(std::min(column, 50), 5.0); });
  for (const double spacing : {1e-4, 3e-4}) {
    const Surface surface = buildSurface(fabricWith(HeightFile{file.path(), spacing, 2e-4, true}));
    EXPECT_EQ(surface.large_scale.columns(), 1);
    EXPECT_EQ(surface.large_scale.at({0.003, 0.004}), (PerChannel<double>{1.0, 1.0}));
  }
}

void expectRefusal(const Fabric& fabric, const std::string& complaint) {
  try {
    buildSurface(fabric);
    ADD_FAILURE() << "not refused: " << complaint;
  } catch (const std::invalid_argument& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find(complaint), std::string::npos) << message;
  }
}

TEST(Surface, RefusesFabricsWithoutOne) {
  Fabric fabric;
  fabric.name = "bare";
  expectRefusal(fabric, "fabric 'bare' has no surface");
  expectRefusal(fabric, "add the key surface");
}

TEST(Surface, RefusesFlatReliefs) {
  const TemporaryFile file(".raw");
  for (const bool periodic : {false, true}) {
    writeField(file, 64, 64, [](int, int) { return 1234.0; });
    expectRefusal(fabricWith(HeightFile{file.path(), 1e-4, 1e-3, periodic}),
                  "fabric 'sample': the relief of its surface is flat");
  }
  writeField(file, 64, 64, [](int column, int row) { return 100.0 * column + 30.0 * row; });
  expectRefusal(fabricWith(HeightFile{file.path(), 1e-4, 1e-3, false}), "is flat");
  // Up and down with every sample, whose slope nobody can tell.
  writeField(file, 64, 64, [](int column, int) { return 100.0 * (column % 2); });
  expectRefusal(fabricWith(HeightFile{file.path(), 1e-4, 1e-3, true}), "is flat");
}

TEST(Surface, RefusesWeavesOutOfRange) {
  Weave weave = weaveOf(WeaveKind::kPlain);
  weave.warp.spacing = 0.01;
  expectRefusal(fabricWith(weave), "warp.spacing");
}

}  // namespace
}  // namespace haptex::tactile::test_surface
