#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "haptex/tactile/weave_relief.h"

namespace haptex::tactile::test_weave_relief {
namespace {

using material::Weave;
using material::WeaveKind;

/// One repeat as drafts are drawn: a column for every warp yarn, the upper row at the larger warp
/// coordinate, X where the warp lies on top.
struct Draft {
  WeaveKind kind;
  std::vector<std::string> rows;
  int wefts_together;
};

const std::vector<Draft> kDrafts = {
    {WeaveKind::kPlain, {".X", "X."}, 1},
    {WeaveKind::kTwill22, {"X..X", "..XX", ".XX.", "XX.."}, 1},
    {WeaveKind::kTwill31, {"XX.X", "X.XX", ".XXX", "XXX."}, 1},
    {WeaveKind::kSatin5, {"XX.XX", "XXXX.", "X.XXX", "XXX.X", ".XXXX"}, 1},
    {WeaveKind::kRib2, {".X", "X."}, 2},
};

bool warpIsOnTop(const Draft& draft, int warp, int weft) {
  const int repeat = static_cast<int>(draft.rows.size());
  return draft.rows[repeat - 1 - weft % repeat][warp % repeat] == 'X';
}

Weave weaveOf(WeaveKind kind, double irregularity = 0.0) {
  return {kind, {4e-4, 5e-5}, {4e-4, 5e-5}, irregularity};
}

double wrapped(const HeightField& field, int column, int row) {
  return field.at((column % field.columns + field.columns) % field.columns,
                  (row % field.rows + field.rows) % field.rows);
}

TEST(WeaveRelief, HasTheHeightOfTheYarnOnTopAtEveryCrossing) {
  for (const Draft& draft : kDrafts) {
    Weave weave = weaveOf(draft.kind);
    weave.weft = {3e-4, 2e-5};
    weave.warp = {5e-4, 7e-5};
    const HeightField field = weaveRelief(weave);
    const int across_warp = 5;                                  // 0.5 mm at 0.1 mm
    const int across_weft = draft.wefts_together == 1 ? 4 : 6;  // 0.3 mm at 0.075, 0.6 at 0.1
    ASSERT_EQ(field.columns % (across_warp * draft.rows.size()), 0u);
    ASSERT_EQ(field.rows % (across_weft * draft.rows.size()), 0u);
    for (int weft = 0; weft < field.rows / across_weft; ++weft) {
      for (int warp = 0; warp < field.columns / across_warp; ++warp) {
        const double expected = warpIsOnTop(draft, warp, weft) ? 7e-5 : 2e-5;
        EXPECT_NEAR(field.at(across_warp * warp, across_weft * weft), expected, 1e-19)
            << static_cast<int>(draft.kind) << ": " << warp << ", " << weft;
      }
    }
  }
}

TEST(WeaveRelief, FallsOffAcrossAYarnAndGoesUnderAlongIt) {
  // A plain weave of which only the warp has a height, 16 samples from yarn to yarn.
  const double h = 5e-5;
  const HeightField field = weaveRelief({WeaveKind::kPlain, {1.6e-3, 0.0}, {1.6e-3, h}, 0.0});
  for (int i = 0; i <= 8; ++i) {
    const double share = i / 16.0;
    EXPECT_NEAR(field.at(i, 0), h * std::pow(std::cos(M_PI * share), 2), 1e-18) << i;
    EXPECT_NEAR(field.at(0, i), h * 0.5 * (1.0 + std::cos(M_PI * share)), 1e-18) << i;
  }
  EXPECT_NEAR(field.at(0, 16), 0.0, 1e-18);
}

TEST(WeaveRelief, DoesNotDipAlongFloats) {
  const HeightField field = weaveRelief(weaveOf(WeaveKind::kSatin5));
  // Warp yarn 0 goes under weft yarn 0 and over the weft yarns 1 to 4.
  for (int row = 4; row <= 16; ++row) EXPECT_NEAR(field.at(0, row), 5e-5, 1e-18) << row;
}

TEST(WeaveRelief, RepeatsExactlyWhenRegular) {
  for (const Draft& draft : kDrafts) {
    const HeightField field = weaveRelief(weaveOf(draft.kind));
    const int repeat = static_cast<int>(draft.rows.size());
    for (int row = 0; row < field.rows; ++row) {
      for (int column = 0; column < field.columns; ++column) {
        const double height = field.at(column, row);
        ASSERT_EQ(wrapped(field, column + 4 * repeat, row), height);
        ASSERT_EQ(wrapped(field, column, row + 4 * draft.wefts_together * repeat), height);
      }
    }
  }
}

TEST(WeaveRelief, IsUnchangedByTheTurnsOfItsWeave) {
  const HeightField plain = weaveRelief(weaveOf(WeaveKind::kPlain));
  const HeightField twill = weaveRelief(weaveOf(WeaveKind::kTwill22));
  const int yarn = 4;
  double down_to_the_right = 0.0;
  for (int row = 0; row < plain.rows; ++row) {
    for (int column = 0; column < plain.columns; ++column) {
      // Sums of the two systems in the other order round alike, and interpolation within 1e-20 m.
      // A quarter turn about a crossing swaps the systems, so it takes a step of one yarn.
      ASSERT_NEAR(wrapped(plain, -row + yarn, column), plain.at(column, row), 1e-19);
      ASSERT_NEAR(wrapped(plain, -column, row), plain.at(column, row), 1e-19);
      // The lines of the twill go up to the right.
      ASSERT_NEAR(wrapped(twill, column + yarn, row + yarn), twill.at(column, row), 1e-19);
      down_to_the_right =
          std::max(down_to_the_right,
                   std::abs(wrapped(twill, column + yarn, row - yarn) - twill.at(column, row)));
    }
  }
  EXPECT_GT(down_to_the_right, 1e-5);
}

TEST(WeaveRelief, IsAFewMillimetresAtAboutATenthWithWholeRepeats) {
  for (const Draft& draft : kDrafts) {
    const int repeat = static_cast<int>(draft.rows.size());
    for (double spacing = 2e-4; spacing < 3e-3; spacing += 0.7e-4) {
      Weave weave = weaveOf(draft.kind);
      weave.weft.spacing = weave.warp.spacing = spacing;
      const HeightField field = weaveRelief(weave);
      ASSERT_NO_THROW(requireSound(field));
      EXPECT_LE(std::max(field.columns, field.rows), 128) << spacing;
      for (const double step : {field.weft_spacing, field.warp_spacing}) {
        EXPECT_GE(step, 0.5e-4 * (1.0 - 1e-12)) << spacing;
        EXPECT_LE(step, 1.25e-4) << spacing;
      }
      const double weft_repeats = field.columns * field.weft_spacing / (repeat * spacing);
      const double warp_repeats =
          field.rows * field.warp_spacing / (repeat * draft.wefts_together * spacing);
      for (const double repeats : {weft_repeats, warp_repeats}) {
        EXPECT_GE(repeats, 1.0 - 1e-12);
        EXPECT_NEAR(repeats, std::round(repeats), 1e-12);
      }
    }
  }
}

/// Heights of the crowns of the warp of a plain weave, every yarn's in a row.
std::vector<std::vector<double>> warpCrowns(const HeightField& field) {
  std::vector<std::vector<double>> crowns;
  for (int column = 0; column < field.columns; column += 4) {
    crowns.emplace_back();
    for (int row = 4 * ((column / 4) % 2); row < field.rows; row += 8) {
      crowns.back().push_back(field.at(column, row));
    }
  }
  return crowns;
}

TEST(WeaveRelief, VariesItsCrownsAsAsked) {
  // 32 yarns of 6.4 mm, sampled 4 times each. What one yarn does along so little is worth hardly
  // more than one independent value, so 32 of them: their deviation has an error of 1/8.
  const double irregularity = 0.2, height = 5e-5;
  const HeightField field =
      weaveRelief({WeaveKind::kPlain, {2e-4, height}, {2e-4, height}, irregularity});
  const auto crowns = warpCrowns(field);
  ASSERT_EQ(crowns.size(), 32u);
  double mean = 0.0, squares = 0.0, along = 0.0;
  for (const auto& yarn : crowns) {
    ASSERT_EQ(yarn.size(), 16u);
    for (std::size_t i = 0; i < yarn.size(); ++i) {
      ASSERT_GT(yarn[i], 0.0);
      const double factor = yarn[i] / height;
      const double opposite = yarn[(i + 8) % 16] / height;
      mean += factor / 512.0;
      squares += factor * factor / 512.0;
      along += (factor - opposite) * (factor - opposite) / 512.0;
    }
  }
  const double deviation = std::sqrt(squares - mean * mean);
  EXPECT_NEAR(mean, 1.0, 3.0 * irregularity / std::sqrt(32.0));
  EXPECT_NEAR(deviation / mean, irregularity, 3.0 * irregularity / 8.0);
  // Places 3.2 mm apart differ by 2 (3.2 mm/40 mm) of the variance, with some scatter.
  const double expected = 2.0 * 3.2 / 40.0 * irregularity * irregularity;
  EXPECT_GT(along, expected / 2.0);
  EXPECT_LT(along, expected * 2.0);
}

TEST(WeaveRelief, IsTheSameAtEveryCall) {
  const Weave weave = weaveOf(WeaveKind::kTwill31, 0.3);
  EXPECT_EQ(weaveRelief(weave).heights, weaveRelief(weave).heights);
  EXPECT_NE(weaveRelief(weave).heights, weaveRelief(weaveOf(WeaveKind::kTwill31)).heights);
}

TEST(WeaveRelief, RefusesParametersOutOfRange) {
  struct Refusal {
    double Weave::*irregularity = nullptr;
    material::Yarns Weave::*yarns = nullptr;
    double material::Yarns::*of_yarns = nullptr;
    double value;
    const char* complaint;
  };
  using material::Yarns;
  const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
  for (const Refusal& refusal : {
           Refusal{nullptr, &Weave::weft, &Yarns::spacing, 1.9e-4, "weft.spacing of the weave is"},
           Refusal{nullptr, &Weave::warp, &Yarns::spacing, 3.1e-3, "warp.spacing of the weave is"},
           Refusal{nullptr, &Weave::warp, &Yarns::spacing, nan, "allowed are 0.0002 to 0.003 m"},
           Refusal{nullptr, &Weave::weft, &Yarns::height, -1e-6,
                   "weft.height of the weave is -1e-06"},
           Refusal{nullptr, &Weave::warp, &Yarns::height, infinity,
                   "warp.height of the weave is inf"},
           Refusal{&Weave::irregularity, nullptr, nullptr, 0.51,
                   "irregularity of the weave is 0.51"},
           Refusal{&Weave::irregularity, nullptr, nullptr, -0.1, "allowed are 0 to 0.5"},
           Refusal{&Weave::irregularity, nullptr, nullptr, nan, "irregularity of the weave is nan"},
       }) {
    Weave weave = weaveOf(WeaveKind::kPlain);
    if (refusal.irregularity) weave.*refusal.irregularity = refusal.value;
    if (refusal.yarns) weave.*refusal.yarns.*refusal.of_yarns = refusal.value;
    for (const bool map : {false, true}) {
      try {
        if (map) {
          weaveUnevenness(weave);
        } else {
          weaveRelief(weave);
        }
        ADD_FAILURE() << "not refused: " << refusal.complaint;
      } catch (const std::invalid_argument& error) {
        EXPECT_NE(std::string(error.what()).find(refusal.complaint), std::string::npos)
            << error.what();
      }
    }
  }
  Weave flat = weaveOf(WeaveKind::kPlain);
  flat.weft.height = flat.warp.height = 0.0;
  EXPECT_THROW(weaveRelief(flat), std::invalid_argument);
}

/// Value of a cell; both channels are alike.
double cell(const AmplitudeMap& map, int column, int row) {
  return map.at(AmplitudeMap::kSpacing * Eigen::Vector2d(column, row))[k40];
}

double varianceOf(const AmplitudeMap& map) {
  double mean = 0.0, squares = 0.0;
  const double cells = static_cast<double>(map.columns()) * map.rows();
  for (int row = 0; row < map.rows(); ++row) {
    for (int column = 0; column < map.columns(); ++column) {
      const double value = cell(map, column, row);
      mean += value / cells;
      squares += value * value / cells;
    }
  }
  return squares - mean * mean;
}

TEST(WeaveUnevenness, HasMeanSquareOneOverTensOfSquareCentimetres) {
  for (const Draft& draft : kDrafts) {
    const AmplitudeMap map = weaveUnevenness(weaveOf(draft.kind, 0.5));
    ASSERT_GE(map.columns(), 60);
    ASSERT_GE(map.rows(), 60);
    PerChannel<double> squares{};
    for (int row = 0; row < map.rows(); ++row) {
      for (int column = 0; column < map.columns(); ++column) {
        const auto found = map.at(AmplitudeMap::kSpacing * Eigen::Vector2d(column, row));
        for (const Channel channel : {k40, k320}) {
          ASSERT_GT(found[channel], 0.0);
          ASSERT_LT(found[channel], 5.0);
          squares[channel] += found[channel] * found[channel];
        }
      }
    }
    const double cells = static_cast<double>(map.columns()) * map.rows();
    // Places are whole cells up to rounding, which bilinear weights pass on.
    EXPECT_NEAR(squares[k40] / cells, 1.0, 1e-12);
    EXPECT_NEAR(squares[k320] / cells, 1.0, 1e-12);
  }
}

TEST(WeaveUnevenness, IsUniformForRegularYarns) {
  const AmplitudeMap map = weaveUnevenness(weaveOf(WeaveKind::kPlain));
  EXPECT_EQ(map.at({0.0123, 0.0456}), (PerChannel<double>{1.0, 1.0}));
}

TEST(WeaveUnevenness, AveragesFinerYarnsOut) {
  // 5 yarns in a cell instead of 1.25; a cell that yarns share takes from both, which lowers the
  // coarse one's variance a little. The patterns of hundreds of yarns scatter by a tenth or so.
  const AmplitudeMap fine = weaveUnevenness({WeaveKind::kPlain, {2e-4, 5e-5}, {2e-4, 5e-5}, 0.1});
  const AmplitudeMap coarse = weaveUnevenness({WeaveKind::kPlain, {8e-4, 5e-5}, {8e-4, 5e-5}, 0.1});
  const double ratio = varianceOf(coarse) / varianceOf(fine);
  EXPECT_GT(ratio, 2.0);
  EXPECT_LT(ratio, 5.0);
}

TEST(WeaveUnevenness, FollowsTheYarnsThatAreHighAndCloses) {
  // Only the warp is high: along warp the same yarns go on, along weft the next ones come.
  const AmplitudeMap map = weaveUnevenness({WeaveKind::kPlain, {1e-3, 0.0}, {1e-3, 5e-5}, 0.2});
  const int last = map.rows() - 1;
  double along = 0.0, across = 0.0, over_edge = 0.0;
  for (int i = 0; i < map.columns(); ++i) {
    along += std::pow(cell(map, i, 40) - cell(map, i, 41), 2);
    across += std::pow(cell(map, i, 40) - cell(map, i + 1, 40), 2);
    over_edge += std::pow(cell(map, i, last) - cell(map, i, 0), 2);
  }
  // 1 mm of 40 mm along a yarn, against strangers: 1/40 with the scatter of 80 pairs.
  EXPECT_LT(along, across / 20.0);
  EXPECT_LT(over_edge, across / 20.0);
  EXPECT_GT(along, across / 80.0);
}

TEST(WeaveUnevenness, VariesAsItsYarnsDoAndForgetsThemHalfWayRound) {
  // Only the warp counts, one yarn in every cell: 80 yarns, each worth about three independent
  // values. Amplitudes are their heights over the root mean square.
  const double irregularity = 0.2;
  const AmplitudeMap map =
      weaveUnevenness({WeaveKind::kPlain, {1e-3, 0.0}, {1e-3, 5e-5}, irregularity});
  double mean = 0.0, product = 0.0;
  for (int row = 0; row < 80; ++row) {
    for (int column = 0; column < 80; ++column) {
      mean += cell(map, column, row) / 6400.0;
      product += cell(map, column, row) * cell(map, column, (row + 40) % 80) / 6400.0;
    }
  }
  const double variance = varianceOf(map);
  EXPECT_NEAR(std::sqrt(variance) / mean, irregularity, 0.15 * irregularity);
  EXPECT_NEAR((product - mean * mean) / variance, 0.0, 0.3);
}

TEST(WeaveUnevenness, IsTheSameAtEveryCall) {
  const AmplitudeMap one = weaveUnevenness(weaveOf(WeaveKind::kSatin5, 0.2));
  const AmplitudeMap other = weaveUnevenness(weaveOf(WeaveKind::kSatin5, 0.2));
  for (int i = 0; i < 80; ++i) EXPECT_EQ(cell(one, i, 3 * i), cell(other, i, 3 * i));
}

}  // namespace
}  // namespace haptex::tactile::test_weave_relief
