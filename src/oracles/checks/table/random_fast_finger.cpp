// Fingers that are moved through the place of the fabric at up to 2 m/s, 2 mm a millisecond: it
// holds them on the side that they came from.
#include <algorithm>
#include <cmath>

#include "haptex/base/workload.h"
#include "haptex/material/fabric_file.h"
#include "haptex/oracles/checks/random_checks.h"
#include "haptex/oracles/experiments/contact_scenes.h"

namespace haptex::oracles {
namespace {

using base::Finger;
using contact::Fingertip;
using Eigen::Vector3d;

constexpr double kFrom = 0.05;     // m, before the fabric
constexpr double kNothing = 0.05;  // N, what has no direction
constexpr double kFastest = 2.0;   // m/s
// Cloth that goes on when the finger stops, or leaps after it, drags it along by friction. Slower
// fingers, and those on a plate, feel no such thing.
constexpr double kDragged = 0.1;    // N
constexpr double kUndragged = 0.7;  // m/s

/// A sample, a place of it, and the direction out of it from where a finger comes.
struct Target {
  std::string name;
  HapticLoopSettings sample;
  Vector3d place, normal;
};

Target drawTarget(const material::Fabric& fabric, Random& random) {
  const int kind = random.below(3);
  const double across = random.uniform(-0.05, 0.05), along = random.uniform(-0.05, 0.05);
  if (kind == 2) {
    TableSettings table;
    table.fabric = fabric;
    table.side = kSampleSide;
    Target target{"plate", sheetOnPlate(table), {along, across, 0.0}, Vector3d::UnitZ()};
    target.sample.haptics = contact::HapticSettings();
    return target;
  }
  const Vector3d place(0.0, across, along - 0.5 * kSampleSide);
  if (kind == 1) return {"taut", tautSample(fabric, 0.005, 80.0), place, Vector3d::UnitX()};
  return {"hanging", hangingSample(fabric, kes::Direction::kWarp, 80.0), place, Vector3d::UnitX()};
}

/// Gets fast within 20 ms, goes on to `beyond` (m) behind the fabric, and rests there.
class FastFinger {
 public:
  FastFinger(const Vector3d& place, const Vector3d& direction, double radius, double speed,
             double beyond)
      : start_(place - kFrom * direction),
        direction_(direction),
        length_(kFrom + beyond),
        speed_(speed) {
    finger_.radius = radius;
    finger_.position = start_;
  }

  const Fingertip& finger() const { return finger_; }
  void step() {
    constexpr double kTicks = 20.0;
    velocity_ = way_ < length_ ? std::min(speed_, velocity_ + speed_ / kTicks) : 0.0;
    way_ += 1e-3 * velocity_;
    finger_.position = start_ + way_ * direction_;
    finger_.velocity = velocity_ * direction_;
  }
  /// N, of the force that it feels, in the direction in which it moves.
  double along(const HapticLoop& loop, Finger finger) const {
    return loop.layer().contacts()[finger].force.dot(direction_);
  }
  /// Cosine between the force that it feels and the way back; 1 of next to no force.
  double opposition(const HapticLoop& loop, Finger finger) const {
    const Vector3d& force = loop.layer().contacts()[finger].force;
    return force.norm() < kNothing ? 1.0 : -force.normalized().dot(direction_);
  }

 private:
  Vector3d start_, direction_;
  double length_, speed_;
  double velocity_ = 0.0, way_ = 0.0;
  Fingertip finger_;
};

}  // namespace

/// One finger, or two that meet from both sides of cloth that nothing lies behind.
void randomFastFinger(const std::string& config_directory, Random& random, const Sink& sink) {
  static const char* const kNames[] = {"wool", "denim", "cotton_knit", "silk_habutae"};
  for (int i = 0; i < base::unlessSanitized(2, 1); ++i) {
    const material::Fabric fabric =
        material::loadFabric(config_directory + "/fabrics/" + kNames[random.below(4)] + ".yaml");
    const Target target = drawTarget(fabric, random);
    const bool both = target.name != "plate" && random.chance(0.4);
    const Vector3d aside = both ? Vector3d(Vector3d::Zero()) : random.direction();
    const Vector3d direction = (0.4 * aside - target.normal).normalized();
    const double speed = random.logarithmic(0.1, kFastest);
    const double beyond = random.uniform(0.002, 0.05);
    FastFinger index(target.place, direction, kIndexRadius, speed, beyond);
    FastFinger thumb(target.place, -direction, kThumbRadius, speed, beyond);
    HapticLoop loop(target.sample);
    double least = 1.0, along = 0.0;
    bool touched = false;
    const int ticks = static_cast<int>((kFrom + beyond) / speed * 1e3) + 120;
    for (int tick = -200; tick < ticks; ++tick) {
      if (tick >= 0) index.step();
      if (tick >= 0) thumb.step();
      contact::Fingertips fingertips{{{index.finger(), std::nullopt}}};
      if (both) fingertips[Finger::kThumb] = thumb.finger();
      loop.step(fingertips);
      least = std::min(least, index.opposition(loop, Finger::kIndex));
      along = base::largerOrNaN(along, index.along(loop, Finger::kIndex));
      if (both) {
        least = std::min(least, thumb.opposition(loop, Finger::kThumb));
        along = base::largerOrNaN(along, thumb.along(loop, Finger::kThumb));
      }
      touched = touched || loop.layer().contacts()[Finger::kIndex].touching;
    }
    CaseName name("table", "fast");
    name.with(target.name).with(fabric.name).with(both ? "both" : "index").with("speed", speed);
    name.with("beyond", beyond);
    // Touched at all, and never pushed away from where it came from, but by friction.
    const double error = touched ? along : NAN;
    sink({name.text() + "/along", 0.0, along, error, kDragged});
    if (target.name != "plate" && speed > kUndragged) continue;
    sink({name.text() + "/cosine", 1.0, least, touched ? 1.0 - least : NAN, 1.0});
  }
}

}  // namespace haptex::oracles
