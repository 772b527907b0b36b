#include "haptex/tactile/knit_relief.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "haptex/base/require.h"
#include "haptex/tactile/yarn_irregularity.h"

namespace haptex::tactile {
namespace {

using material::Knit;

constexpr int kMinSamples = 8;  // of a loop: its shape needs them
constexpr double kYarnPerWale = 3.8;

void require(bool holds, const char* name, double value, const char* allowed) {
  if (!holds) base::refuse("the ", name, " of the knit is ", value, ": allowed are ", allowed);
}

void requireSound(const Knit& knit) {
  const auto require_spacing = [](const char* name, double value) {
    require(value >= material::kMinLoopSpacing && value <= material::kMaxLoopSpacing, name, value,
            "0.0004 to 0.006 m");
  };
  require_spacing("wale", knit.wale);
  require_spacing("course", knit.course);
  require(knit.irregularity >= 0.0 && knit.irregularity <= material::kMaxIrregularity,
          "irregularity", knit.irregularity, "0 to 0.5");
}

/// A side of the piece, in loops.
struct Side {
  int loops;
  int per_loop;  // samples

  int samples() const { return loops * per_loop; }
  /// A sample's place from the middle of a loop to that of the next.
  struct Place {
    int before, after;  // loops
    double share;       // of the way, 0 to below 1
  };
  Place at(int sample) const {
    const int loop = sample / per_loop;
    return {loop, (loop + 1) % loops, static_cast<double>(sample % per_loop) / per_loop};
  }
};

Side sideOf(double spacing) {
  const int per_loop =
      std::max(kMinSamples, static_cast<int>(std::lround(spacing / kReliefSpacing)));
  return {kReliefSamples / per_loop, per_loop};
}

double squaredCosine(double angle) {
  if (std::abs(angle) >= 0.5 * M_PI) return 0.0;
  const double cosine = std::cos(angle);
  return cosine * cosine;
}

/// Height of a loop's two legs.
/// @param u from the middle of the wale, in wales, -1 to 1
/// @param v from the middle of the loop, in courses, -1 to 1
double legHeight(double u, double v) {
  const double middle = 0.25 * (1.0 + 0.5 * v);
  return squaredCosine(2.0 * M_PI * (std::abs(u) - middle)) * squaredCosine(0.5 * M_PI * v);
}

/// Loops by course and wale.
using Loops = std::vector<std::vector<double>>;

double highestLeg(const Loops& loops, const Side::Place& wale, const Side::Place& course) {
  double highest = 0.0;
  for (const bool above : {false, true}) {
    const std::vector<double>& row = loops[above ? course.after : course.before];
    const double v = course.share - above;
    highest = std::max({highest, row[wale.before] * legHeight(wale.share, v),
                        row[wale.after] * legHeight(wale.share - 1.0, v)});
  }
  return highest;
}

}  // namespace

HeightField knitRelief(const Knit& knit) {
  requireSound(knit);
  const Side wales = sideOf(knit.wale), courses = sideOf(knit.course);
  NormalNumbers numbers;
  Loops loops;
  for (int course = 0; course < courses.loops; ++course) {
    loops.push_back(yarnNoise(numbers, wales.loops, kYarnPerWale * wales.loops * knit.wale));
    for (double& loop : loops.back()) loop = variation(loop, knit.irregularity);
  }
  return makeField(wales.samples(), courses.samples(), knit.wale / wales.per_loop,
                   knit.course / courses.per_loop, [&](int column, int row) {
                     return highestLeg(loops, wales.at(column), courses.at(row));
                   });
}

AmplitudeMap knitUnevenness(const Knit& knit) {
  requireSound(knit);
  if (!(knit.irregularity > 0.0)) return {};
  NormalNumbers numbers;
  // Yarns lie one beside the other along warp: the map's index is kMapCells warp + weft, too.
  return mapOfPowers(cellPowers(numbers, {knit.course, kYarnPerWale}, knit.irregularity));
}

}  // namespace haptex::tactile
