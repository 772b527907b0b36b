#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "haptex/tactile/knit_relief.h"

namespace haptex::tactile::test_knit_relief {
namespace {

using material::Knit;

double wrapped(const HeightField& field, int column, int row) {
  return field.at((column % field.columns + field.columns) % field.columns,
                  (row % field.rows + field.rows) % field.rows);
}

// 16 samples from wale to wale, 12 from course to course.
const Knit kRegular = {1.6e-3, 1.2e-3, 0.0};

TEST(KnitRelief, HasTheCrownsOfBothLegsAQuarterOfAWaleBesideItsMiddle) {
  const HeightField field = knitRelief(kRegular);
  for (int row = 0; row < field.rows; row += 12) {
    for (int column = 0; column < field.columns; column += 16) {
      EXPECT_NEAR(wrapped(field, column + 4, row), 1.0, 1e-12);
      EXPECT_NEAR(wrapped(field, column - 4, row), 1.0, 1e-12);
      // Between the legs of a loop and between two wales lie the edges of legs.
      EXPECT_NEAR(wrapped(field, column, row), 0.0, 1e-12);
      EXPECT_NEAR(wrapped(field, column + 8, row), 0.0, 1e-12);
    }
  }
  EXPECT_NEAR(*std::max_element(field.heights.begin(), field.heights.end()), 1.0, 1e-12);
}

TEST(KnitRelief, LeansItsLegsOutwardsInAV) {
  const HeightField field = knitRelief(kRegular);
  // A third of a course above the crown: the middle has gone outwards by wale/4 (1/6).
  for (const int sign : {-1, 1}) {
    const int row = 4 * sign;
    const double middle = 4.0 * (1.0 + sign / 6.0);
    for (const int column : {3, 4, 5}) {
      const double expected =
          std::pow(std::cos(M_PI * (column - middle) / 8.0), 2) * std::pow(std::cos(M_PI / 6.0), 2);
      EXPECT_NEAR(wrapped(field, column, row), expected, 1e-12) << column << ", " << row;
    }
  }
}

TEST(KnitRelief, IsItsOwnMirrorAcrossButNotAlongItsWales) {
  const HeightField field = knitRelief(kRegular);
  double upside_down = 0.0;
  for (int row = 0; row < field.rows; ++row) {
    for (int column = 0; column < field.columns; ++column) {
      ASSERT_NEAR(wrapped(field, -column, row), field.at(column, row), 1e-12);
      ASSERT_NEAR(wrapped(field, column + 16, row), field.at(column, row), 1e-12);
      ASSERT_NEAR(wrapped(field, column, row + 12), field.at(column, row), 1e-12);
      upside_down =
          std::max(upside_down, std::abs(wrapped(field, column, -row) - field.at(column, row)));
    }
  }
  EXPECT_GT(upside_down, 0.1);
}

TEST(KnitRelief, IsAFewMillimetresAtAboutATenthWithWholeLoops) {
  for (double spacing = 4e-4; spacing < 6e-3; spacing += 0.7e-4) {
    const HeightField field = knitRelief({spacing, 6.4e-3 - spacing, 0.1});
    ASSERT_NO_THROW(requireSound(field));
    EXPECT_LE(std::max(field.columns, field.rows), 128) << spacing;
    for (const double step : {field.weft_spacing, field.warp_spacing}) {
      EXPECT_GE(step, 0.5e-4 * (1.0 - 1e-12)) << spacing;
      EXPECT_LE(step, 1.25e-4) << spacing;
    }
    const double wales = field.columns * field.weft_spacing / spacing;
    const double courses = field.rows * field.warp_spacing / (6.4e-3 - spacing);
    for (const double loops : {wales, courses}) {
      EXPECT_GE(loops, 1.0 - 1e-12);
      EXPECT_NEAR(loops, std::round(loops), 1e-12);
    }
  }
}

TEST(KnitRelief, HasNoStepsWhereLoopsOfDifferentHeightMeet) {
  // Of a regular knit the largest slope is that across a leg, 2 pi/wale; twice that with loops
  // that are twice as high.
  const Knit knit = {1.6e-3, 1.2e-3, 0.5};
  const HeightField field = knitRelief(knit);
  const double highest = *std::max_element(field.heights.begin(), field.heights.end());
  EXPECT_GT(highest, 1.2);
  const double steepest = 1.1 * highest * 2.0 * M_PI / knit.wale;
  for (int row = 0; row < field.rows; ++row) {
    for (int column = 0; column < field.columns; ++column) {
      const double rise = std::abs(wrapped(field, column + 1, row) - field.at(column, row));
      ASSERT_LT(rise, steepest * field.weft_spacing) << column << ", " << row;
    }
  }
}

TEST(KnitRelief, VariesItsLoopsAsAskedAndIsTheSameAtEveryCall) {
  const Knit knit = {8e-4, 8e-4, 0.2};
  const HeightField field = knitRelief(knit);
  EXPECT_EQ(field.heights, knitRelief(knit).heights);
  double mean = 0.0, squares = 0.0;
  int loops = 0;
  for (int row = 0; row < field.rows; row += 8) {
    for (int column = 0; column < field.columns; column += 8) {
      const double crown = wrapped(field, column + 2, row);
      mean += crown;
      squares += crown * crown;
      ++loops;
    }
  }
  ASSERT_EQ(loops, 256);
  mean /= loops;
  // 16 courses of 49 mm of yarn each, worth little more than one value: an error of 1/4.
  EXPECT_NEAR(mean, 1.0, 0.2);
  EXPECT_NEAR(std::sqrt(squares / loops - mean * mean), 0.2, 0.1);
}

TEST(KnitRelief, RefusesParametersOutOfRange) {
  struct Refusal {
    Knit knit;
    const char* complaint;
  };
  const double nan = std::nan("");
  for (const Refusal& refusal : {Refusal{{3.9e-4, 1e-3, 0.1}, "wale of the knit is 0.00039"},
                                 Refusal{{1e-3, 6.1e-3, 0.1}, "course of the knit is 0.0061"},
                                 Refusal{{nan, 1e-3, 0.1}, "allowed are 0.0004 to 0.006 m"},
                                 Refusal{{1e-3, 1e-3, 0.51}, "irregularity of the knit is 0.51"},
                                 Refusal{{1e-3, 1e-3, nan}, "allowed are 0 to 0.5"}}) {
    for (const bool map : {false, true}) {
      try {
        if (map) {
          knitUnevenness(refusal.knit);
        } else {
          knitRelief(refusal.knit);
        }
        ADD_FAILURE() << "not refused: " << refusal.complaint;
      } catch (const std::invalid_argument& error) {
        EXPECT_NE(std::string(error.what()).find(refusal.complaint), std::string::npos)
            << error.what();
      }
    }
  }
}

TEST(KnitUnevenness, FollowsItsCourses) {
  // Courses of 2 mm: along weft the same yarn goes on, along warp every second cell brings the
  // next.
  const AmplitudeMap map = knitUnevenness({2.6e-3, 2e-3, 0.2});
  const auto cell = [&](int column, int row) {
    return map.at(AmplitudeMap::kSpacing * Eigen::Vector2d(column % 80, row % 80))[k40];
  };
  double along = 0.0, within = 0.0, across = 0.0, mean_square = 0.0;
  for (int column = 0; column < 80; ++column) {
    for (int row = 0; row < 80; row += 2) {
      along += std::pow(cell(column, row) - cell(column + 1, row), 2);
      within += std::pow(cell(column, row) - cell(column, row + 1), 2);
      across += std::pow(cell(column, row) - cell(column, row + 2), 2);
      mean_square += (std::pow(cell(column, row), 2) + std::pow(cell(column, row + 1), 2)) / 6400.0;
    }
  }
  EXPECT_NEAR(mean_square, 1.0, 1e-12);
  EXPECT_NEAR(within, 0.0, 1e-20);
  // 1 mm of fabric is 3.8 of 40 mm of yarn: a tenth of what strangers differ by.
  EXPECT_GT(along, across / 20.0);
  EXPECT_LT(along, across / 6.0);
}

}  // namespace
}  // namespace haptex::tactile::test_knit_relief
