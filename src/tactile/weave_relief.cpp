#include "haptex/tactile/weave_relief.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "haptex/base/require.h"
#include "haptex/tactile/yarn_irregularity.h"

namespace haptex::tactile {
namespace {

using material::Weave;
using material::WeaveKind;

constexpr int kMinSamples = 4;  // across a yarn: its shape needs them

[[noreturn]] void refuse(const char* name, double value, const char* allowed) {
  base::refuse("the ", name, " of the weave is ", value, ": allowed are ", allowed);
}

void requireSound(const Weave& weave) {
  const auto require_spacing = [](const char* name, double value) {
    // Written so that it refuses NaN.
    if (value >= material::kMinYarnSpacing && value <= material::kMaxYarnSpacing) return;
    refuse(name, value, "0.0002 to 0.003 m");
  };
  const auto require_height = [](const char* name, double value) {
    if (!std::isfinite(value) || value < 0.0) refuse(name, value, "finite numbers >= 0 m");
  };
  require_spacing("weft.spacing", weave.weft.spacing);
  require_spacing("warp.spacing", weave.warp.spacing);
  require_height("weft.height", weave.weft.height);
  require_height("warp.height", weave.warp.height);
  if (!(weave.weft.height > 0.0 || weave.warp.height > 0.0)) {
    refuse("weft.height and warp.height", 0.0, "numbers of which one is > 0 m");
  }
  if (!(weave.irregularity >= 0.0 && weave.irregularity <= material::kMaxIrregularity)) {
    refuse("irregularity", weave.irregularity, "0 to 0.5");
  }
}

int modulo(int value, int count) { return (value % count + count) % count; }

/// Yarns along each side of a repeat; yarns that lie together count as one.
int repeatOf(WeaveKind kind) {
  switch (kind) {
    case WeaveKind::kTwill22:
    case WeaveKind::kTwill31:
      return 4;
    case WeaveKind::kSatin5:
      return 5;
    default:
      return 2;
  }
}

bool warpIsOnTop(WeaveKind kind, int warp, int weft) {
  switch (kind) {
    case WeaveKind::kTwill22:
      return modulo(warp - weft, 4) < 2;
    case WeaveKind::kTwill31:
      return modulo(warp - weft, 4) < 3;
    case WeaveKind::kSatin5:
      return modulo(weft - 2 * warp, 5) != 0;
    default:
      return modulo(warp + weft, 2) == 0;
  }
}

/// The weave with the weft yarns that lie together in one as wide as they are.
Weave withJoinedYarns(Weave weave) {
  if (weave.kind == WeaveKind::kRib2) weave.weft.spacing *= 2.0;
  return weave;
}

/// The samples along a side of the tile, across the yarns that it is measured in.
struct Side {
  int yarns;
  int per_yarn;
  double yarn_spacing;  // m
  // Of a yarn, by the sample's number after the yarn's middle.
  std::vector<double> across;  // height towards the next yarn
  std::vector<double> rise;    // share of the height at the next yarn

  int samples() const { return yarns * per_yarn; }
  double length() const { return yarns * yarn_spacing; }
  int before(int sample) const { return sample / per_yarn; }
  int after(int sample) const { return (before(sample) + 1) % yarns; }
  int nearest(int sample) const {
    return 2 * (sample % per_yarn) < per_yarn ? before(sample) : after(sample);
  }
};

Side sideAcross(const material::Yarns& yarns, int repeat) {
  Side side;
  side.per_yarn = std::clamp(static_cast<int>(std::lround(yarns.spacing / kReliefSpacing)),
                             kMinSamples, kReliefSamples / repeat);
  side.yarns = repeat * (kReliefSamples / (repeat * side.per_yarn));
  side.yarn_spacing = yarns.spacing;
  for (int i = 0; i < side.per_yarn; ++i) {
    const double cosine = std::cos(M_PI * i / side.per_yarn);
    side.across.push_back(cosine * cosine);
    side.rise.push_back(0.5 * (1.0 - cosine));
  }
  return side;
}

/// Heights of one system's yarns at the crossings: index crossings yarn + crossing, zero where a
/// yarn goes under.
template <typename F>
std::vector<double> crowns(NormalNumbers& numbers, const Side& across, const Side& along,
                           double height, double irregularity, F is_on_top) {
  std::vector<double> heights;
  heights.reserve(static_cast<std::size_t>(across.yarns) * along.yarns);
  for (int yarn = 0; yarn < across.yarns; ++yarn) {
    const std::vector<double> noise = yarnNoise(numbers, along.yarns, along.length());
    for (int crossing = 0; crossing < along.yarns; ++crossing) {
      heights.push_back(
          is_on_top(yarn, crossing) ? height * variation(noise[crossing], irregularity) : 0.0);
    }
  }
  return heights;
}

/// Height of one system of yarns at a place, given by the samples across and along them.
double yarnHeight(const std::vector<double>& crowns, const Side& across, int sample_across,
                  const Side& along, int sample_along) {
  const double* const yarn = crowns.data() + along.yarns * across.nearest(sample_across);
  const double before = yarn[along.before(sample_along)];
  const double after = yarn[along.after(sample_along)];
  const double middle = before + along.rise[sample_along % along.per_yarn] * (after - before);
  return across.across[sample_across % across.per_yarn] * middle;
}

/// The piece of weaveRelief(), by the heights of its two systems.
class WovenPiece {
 public:
  explicit WovenPiece(const Weave& weave)
      // Warp yarns lie side by side along weft, and the other way round.
      : kind_(weave.kind),
        along_weft_(sideAcross(weave.warp, repeatOf(weave.kind))),
        along_warp_(sideAcross(weave.weft, repeatOf(weave.kind))) {
    NormalNumbers numbers;
    warp_ = crowns(numbers, along_weft_, along_warp_, weave.warp.height, weave.irregularity,
                   [&](int yarn, int crossing) { return warpIsOnTop(kind_, yarn, crossing); });
    weft_ = crowns(numbers, along_warp_, along_weft_, weave.weft.height, weave.irregularity,
                   [&](int yarn, int crossing) { return !warpIsOnTop(kind_, crossing, yarn); });
  }

  int columns() const { return along_weft_.samples(); }
  int rows() const { return along_warp_.samples(); }
  double weftSpacing() const { return along_weft_.yarn_spacing / along_weft_.per_yarn; }
  double warpSpacing() const { return along_warp_.yarn_spacing / along_warp_.per_yarn; }
  double warpHeight(int column, int row) const {
    return yarnHeight(warp_, along_weft_, column, along_warp_, row);
  }
  double weftHeight(int column, int row) const {
    return yarnHeight(weft_, along_warp_, row, along_weft_, column);
  }
  bool warpIsOnTopAtCrossing(int column, int row) const {
    return warpIsOnTop(kind_, along_weft_.nearest(column), along_warp_.nearest(row));
  }

 private:
  WeaveKind kind_;
  Side along_weft_, along_warp_;
  std::vector<double> warp_, weft_;
};

}  // namespace

HeightField weaveRelief(const material::Weave& asked) {
  requireSound(asked);
  const WovenPiece piece(withJoinedYarns(asked));
  return makeField(piece.columns(), piece.rows(), piece.weftSpacing(), piece.warpSpacing(),
                   [&](int column, int row) {
                     return piece.warpHeight(column, row) + piece.weftHeight(column, row);
                   });
}

std::vector<bool> warpsOnTop(const material::Weave& asked) {
  requireSound(asked);
  const WovenPiece piece(withJoinedYarns(asked));
  std::vector<bool> on_top;
  on_top.reserve(static_cast<std::size_t>(piece.columns()) * piece.rows());
  for (int row = 0; row < piece.rows(); ++row) {
    for (int column = 0; column < piece.columns(); ++column) {
      const double warp = piece.warpHeight(column, row), weft = piece.weftHeight(column, row);
      // Between yarns both may be zero.
      on_top.push_back(warp == weft ? piece.warpIsOnTopAtCrossing(column, row) : warp > weft);
    }
  }
  return on_top;
}

AmplitudeMap weaveUnevenness(const material::Weave& asked) {
  requireSound(asked);
  if (!(asked.irregularity > 0.0)) return {};
  const Weave weave = withJoinedYarns(asked);
  NormalNumbers numbers;
  const std::vector<double> warp =
      cellPowers(numbers, {weave.warp.spacing, 1.0}, weave.irregularity);
  const std::vector<double> weft =
      cellPowers(numbers, {weave.weft.spacing, 1.0}, weave.irregularity);
  const double weft_share = 1.0 / (1.0 + std::pow(weave.warp.height / weave.weft.height, 2));
  std::vector<double> powers;
  for (int row = 0; row < kMapCells; ++row) {
    for (int column = 0; column < kMapCells; ++column) {
      const double of_warp = warp[static_cast<std::size_t>(kMapCells) * column + row];
      const double of_weft = weft[static_cast<std::size_t>(kMapCells) * row + column];
      powers.push_back(of_warp + weft_share * (of_weft - of_warp));
    }
  }
  return mapOfPowers(powers);
}

}  // namespace haptex::tactile
