#include "haptex/oracles/experiments/prescribed_touch.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "haptex/exoskeleton/control/minimum_jerk.h"
#include "haptex/kes/equilibrium.h"

namespace haptex::oracles {
namespace {

using base::Finger;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kTouchedBy = 5.5e-3;  // m, around the middle of a fingertip
// The same sample hangs a little otherwise on other cells. In steps this long nothing swings.
constexpr int kSettlingSteps = 10;
constexpr double kSettlingStep = 0.05;          // s
constexpr double kLargeScaleRate = 80.0;        // Hz
const Vector3d kOffGrid(0.0, 1.8e-3, -2.6e-3);  // m: 0.29 and 0.42 of a cell of the sample

/// How far the fingertips of a touch go. One fabric's warp is 160 times as stiff as the other's:
/// the same ways would not give forces to feel in both.
struct Ways {
  double strain;  // of the taut sample
  double press;   // m, into the taut sample
  double pull;    // m
  double graze;   // m, into the taut sample before the slide
};

Ways waysOf(const material::Fabric& fabric) {
  const bool stiff = fabric.warp.elastic.evaluate(0.0).slope > 1e3;
  return stiff ? Ways{0.005, 5e-3, 1e-3, 3e-3} : Ways{0.05, 1e-2, 4e-3, 6e-3};
}

/// A part of the hand's way.
struct Stroke {
  double begin;     // s
  double duration;  // s
  Vector3d by;      // m
  double opening;   // m, of the gap
};

Hand handAt(const Hand& start, const std::vector<Stroke>& strokes, double time) {
  Hand hand = start;
  for (const Stroke& stroke : strokes) {
    const double part = std::clamp((time - stroke.begin) / stroke.duration, 0.0, 1.0);
    const double share = exoskeleton::minimumJerk(part);
    const double rate = 30.0 * part * part * (1.0 - part) * (1.0 - part) / stroke.duration;
    hand.middle += share * stroke.by;
    hand.gap += share * stroke.opening;
    hand.velocity += rate * stroke.by;
    hand.opening += rate * stroke.opening;
  }
  return hand;
}

/// The sample in static equilibrium.
HapticLoopSettings settled(HapticLoopSettings sample) {
  cloth::Cloth cloth(sample.mesh, sample.fabric, sample.effects);
  cloth::ClothState state = cloth.initialState();
  for (int particle : sample.attached_particles) {
    cloth::AttachmentPath path;
    path.start = state.positions[particle];
    cloth.attach(particle, path);
  }
  kes::Equilibrium(cloth).settle(cloth, state, 0.05);
  sample.mesh.initial_positions = state.positions;
  return sample;
}

PrescribedTouch makeTouch(const char* name, const HapticLoopSettings& sample, bool both,
                          const Hand& start, const std::vector<Stroke>& strokes, double duration) {
  PrescribedTouch touch;
  touch.name = name;
  touch.sample = sample;
  touch.duration = duration;
  touch.rest_from = strokes.back().begin + strokes.back().duration;
  touch.fingertips = [=](double time) {
    Fingertips fingertips = handAt(start, strokes, time).fingertips();
    if (!both) fingertips[Finger::kThumb].reset();
    return fingertips;
  };
  // The taut sample is a little wider than at rest, which is nothing beside kTouchedBy.
  Vector3d middle = start.middle;
  for (std::size_t i = 0; i <= strokes.size(); ++i) {
    const Vector2d rest(middle.y() + 0.5 * kSampleSide, middle.z() + kSampleSide);
    touch.touched.extend(rest - Vector2d::Constant(kTouchedBy));
    touch.touched.extend(rest + Vector2d::Constant(kTouchedBy));
    if (i < strokes.size()) middle += strokes[i].by;
  }
  return touch;
}

void require(bool holds, const char* name, double value, const char* allowed) {
  if (holds) return;
  std::ostringstream message;
  message << "prescribed touch: " << name << ' ' << value << " must be " << allowed;
  throw std::invalid_argument(message.str());
}

/// The line below a coordinate and the share of the way to the next one.
std::pair<int, double> onGrid(double coordinate, int cells) {
  const double place = coordinate / kSampleSide * cells;
  const double nearest = std::round(place);
  const double exact = std::abs(place - nearest) < 1e-9 ? nearest : place;
  const int line = std::min(static_cast<int>(exact), cells - 1);
  return {line, exact - line};
}

}  // namespace

std::vector<PrescribedTouch> prescribedTouches(const material::Fabric& fabric) {
  const Ways ways = waysOf(fabric);
  const Vector3d still = Vector3d::Zero();
  const HapticLoopSettings taut = tautSample(fabric, ways.strain, kLargeScaleRate);
  const HapticLoopSettings hanging =
      settled(hangingSample(fabric, kes::Direction::kWarp, kLargeScaleRate));
  Hand hand;
  hand.gap = 2.0 * contact::ContactLaw(fabric).halfThickness();
  hand.middle = Vector3d(0.0, 0.0, -0.5 * kSampleSide) + kOffGrid;
  std::vector<PrescribedTouch> touches;
  touches.push_back(
      makeTouch("press", taut, false, hand, {{0.0, 0.15, still, -2.0 * ways.press}}, 0.36));
  touches.push_back(makeTouch(
      "slide", taut, false, hand,
      {{0.0, 0.1, still, -2.0 * ways.graze}, {0.1, 0.15, Vector3d(0.0, 0.0036, -0.0048), 0.0}},
      0.4));
  hand.middle.z() = -0.75 * kSampleSide + kOffGrid.z();
  touches.push_back(
      makeTouch("pull", hanging, true, hand,
                {{0.0, 0.1, still, -3e-3}, {0.1, 0.1, Vector3d(0.0, 0.0, -ways.pull), 0.0}}, 0.4));
  return touches;
}

std::vector<double> gradedLines(double length, double low, double high, double cell,
                                double growth) {
  require(std::isfinite(length) && length > 0.0, "length", length, "finite and > 0");
  require(high < length, "high", high, "less than the length");
  require(low > 0.0 && low < high, "low", low, "> 0 and less than high");
  require(std::isfinite(cell) && cell > 0.0, "cell", cell, "finite and > 0");
  require(std::isfinite(growth) && growth > 1.0, "growth", growth, "finite and > 1");
  const auto outside = [&](double width) {  // lines from the fine part to the border
    std::vector<double> ways;
    double size = cell;
    for (double way = 0.0; way < width - 1e-12;) {
      size *= growth;
      way += size;
      ways.push_back(way);
    }
    const double scale = ways.empty() ? 1.0 : width / ways.back();
    for (double& way : ways) way *= scale;
    return ways;
  };
  std::vector<double> lines;
  const std::vector<double> before = outside(low);
  for (auto way = before.rbegin(); way != before.rend(); ++way) lines.push_back(low - *way);
  const int cells = static_cast<int>(std::ceil((high - low) / cell - 1e-9));
  for (int i = 0; i <= cells; ++i) lines.push_back(low + (high - low) * i / cells);
  for (double way : outside(length - high)) lines.push_back(high + way);
  lines.front() = 0.0;
  lines.back() = length;
  return lines;
}

HapticLoopSettings onLines(const HapticLoopSettings& sample, const std::vector<double>& weft,
                           const std::vector<double>& warp) {
  const int cells = static_cast<int>(std::lround(
                        std::sqrt(static_cast<double>(sample.mesh.rest_coordinates.size())))) -
                    1;
  std::vector<char> held(sample.mesh.rest_coordinates.size(), 0);
  for (int particle : sample.attached_particles) held[particle] = 1;
  HapticLoopSettings result = sample;
  const int columns = static_cast<int>(weft.size());
  const int rows = static_cast<int>(warp.size());
  result.mesh = mesh::makeRectangle(kSampleSide, kSampleSide, columns - 1, rows - 1,
                                    mesh::Triangulation::kAlternating);
  result.attached_particles.clear();
  for (int particle = 0; particle < columns * rows; ++particle) {
    const Vector2d rest(weft[particle % columns], warp[particle / columns]);
    const auto [u, u_share] = onGrid(rest.x(), cells);
    const auto [v, v_share] = onGrid(rest.y(), cells);
    Vector3d place = Vector3d::Zero();
    bool all_held = true;
    for (int corner = 0; corner < 4; ++corner) {
      const double weight =
          (corner % 2 ? u_share : 1.0 - u_share) * (corner / 2 ? v_share : 1.0 - v_share);
      if (weight == 0.0) continue;
      const int neighbour = (v + corner / 2) * (cells + 1) + u + corner % 2;
      place += weight * sample.mesh.initial_positions[neighbour];
      all_held = all_held && held[neighbour];
    }
    result.mesh.rest_coordinates[particle] = rest;
    result.mesh.initial_positions[particle] = place;
    if (all_held) result.attached_particles.push_back(particle);
  }
  return result;
}

ForceRecord computeInOneLayer(const PrescribedTouch& touch, double cell, double growth,
                              int steps_per_record) {
  require(steps_per_record >= 1, "steps_per_record", steps_per_record, ">= 1");
  const auto lines = [&](int axis) {
    return gradedLines(kSampleSide, touch.touched.min()[axis], touch.touched.max()[axis], cell,
                       growth);
  };
  HapticLoopSettings sample = onLines(touch.sample, lines(0), lines(1));
  sample.haptics.refinement = 0;
  RefinedCloth cloth(sample);
  for (int i = 0; i < kSettlingSteps; ++i) cloth.step({}, kSettlingStep);
  ForceRecord record;
  record.interval = kRecordInterval;
  const double h = kRecordInterval / steps_per_record;
  const long steps = std::lround(touch.duration / h);
  for (long i = 1; i <= steps; ++i) {
    cloth.step(touch.fingertips(i * h), h);
    if (i % steps_per_record == 0)
      record.forces.push_back({{cloth.force(Finger::kIndex), cloth.force(Finger::kThumb)}});
  }
  return record;
}

}  // namespace haptex::oracles
