// What the loop from fingertip to force takes and how it feels: the time of a millisecond with two
// patches, and a person who pinches and moves wool through the simulated exoskeleton, with and
// without prediction and linearised commands. scripts/bench loop measures the real nodes.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "haptex/base/constants.h"
#include "haptex/contact/haptic_layer.h"
#include "haptex/material/fabric_file.h"
#include "haptex/oracles/exact/finger_geometry.h"
#include "haptex/oracles/experiments/touch_loop.h"
#include "haptex/proximity/kdop_hierarchy.h"
#include "haptex/scene/usual_elasticity.h"
#include "tab_lines.h"

namespace {

using namespace haptex;
using base::Finger;
using base::kFingers;
using bench::printLine;
using Eigen::Vector3d;

const std::string kConfig = HAPTEX_CONFIG_DIRECTORY;

oracles::HapticLoopSettings woolSample(double large_scale_step) {
  oracles::HapticLoopSettings settings;
  settings.mesh = mesh::makeRectangle(0.2, 0.2, 32, 32, mesh::Triangulation::kAlternating);
  settings.fabric = material::loadFabric(kConfig + "/fabrics/wool.yaml");
  settings.effects.viscosity = true;
  settings.effects.bending = true;
  settings.effects.elasticity = scene::usualElasticity(settings.effects);
  settings.effects.gravity = Vector3d(0.0, 0.0, -base::kStandardGravity);
  settings.attached_particles = mesh::sideParticles(settings.mesh, mesh::Side::kTop);
  settings.large_scale_step = large_scale_step;
  settings.step.newton_iterations = 2;
  return settings;
}

// Two fingertips press into two places of the wool sample and stroke it; every millisecond is
// timed.
class Computation {
 public:
  explicit Computation(int particles_per_patch)
      : settings_(woolSample(0.0125)),
        layer_(settings_.mesh, settings_.fabric, settings_.effects, settings_.haptics) {
    const std::vector<Vector3d> still(settings_.mesh.initial_positions.size(), Vector3d::Zero());
    layer_.receive(settings_.mesh.initial_positions, still, settings_.large_scale_step);
    const proximity::KdopHierarchy hierarchy(settings_.mesh.triangles,
                                             settings_.mesh.initial_positions);
    const std::vector<char> attached(settings_.mesh.initial_positions.size(), 0);
    for (std::size_t elements = 1; layer_.particleCount() < 2u * particles_per_patch; ++elements) {
      std::vector<int> chosen;
      for (const Vector3d& place : places_.values) {
        hierarchy.query(proximity::Cursor::point(place), {1.0, elements}, near_);
        for (const proximity::NearElement& element : near_) chosen.push_back(element.triangle);
      }
      layer_.exchange(layer_.preparePatch(chosen, attached));
    }
  }

  /// Ascending, s.
  std::vector<double> times(int milliseconds) {
    std::vector<double> result;
    for (int i = 0; i < milliseconds; ++i) {
      contact::Fingertips fingertips;
      for (const Finger finger : kFingers) {
        contact::Fingertip& fingertip = fingertips[finger].emplace();
        fingertip.radius = 0.008;
        const double depth = 1e-3 + 1e-3 * std::sin(0.01 * i);
        fingertip.position =
            places_[finger] + Vector3d(fingertip.radius - depth, 0.0, 2e-3 * std::sin(0.02 * i));
      }
      const auto start = std::chrono::steady_clock::now();
      layer_.step(fingertips);
      result.push_back(
          std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
      if (!layer_.lastStepAccepted()) throw std::runtime_error("a step was rejected");
    }
    std::sort(result.begin(), result.end());
    return result;
  }

  std::size_t particles() const { return layer_.particleCount(); }

 private:
  const base::PerFinger<Vector3d> places_{
      {Vector3d(0.0, -0.045, -0.1), Vector3d(0.0, 0.045, -0.1)}};
  oracles::HapticLoopSettings settings_;
  contact::HapticLayer layer_;
  std::vector<proximity::NearElement> near_;
};

void printComputation() {
  constexpr int kMilliseconds = 20000;
  Computation computation(300);
  computation.times(500);
  const std::vector<double> times = computation.times(kMilliseconds);
  const std::string prefix = "haptic_loop/computation/" + std::to_string(computation.particles());
  const auto percentile = [&](double share) {
    return 1e3 * times[static_cast<std::size_t>(share * (times.size() - 1))];
  };
  printLine(prefix + "/p50", percentile(0.5), "ms");
  printLine(prefix + "/p99", percentile(0.99), "ms");
  printLine(prefix + "/p999", percentile(0.999), "ms");
  printLine(prefix + "/max", 1e3 * times.back(), "ms");
}

struct Variant {
  const char* name;
  double large_scale_step;  // s
  bool predict;
  bool linearised;
  int delay;  // ms
};

// What is told of a person who holds, lifts and lowers the sample.
class Feel {
 public:
  explicit Feel(const Variant& variant)
      : loop_(oracles::shippedUrdf(kConfig), {}, settings(variant)) {
    loop_.observe([this](const oracles::TouchLoop&) { watch(); });
  }

  void print(const std::string& prefix) {
    loop_.rest(0.3);
    loop_.close(-0.012, 0.5);
    loop_.rest(1.5);
    begin();
    loop_.rest(1.0);
    printLine(prefix + "/pinch_force", sums_[Finger::kIndex].norm() / count_, "N");
    printLine(prefix + "/hold_ripple", ripple(), "N");
    begin();
    loop_.shift(Vector3d(0.05, 0.0, 0.02), 0.5);
    printLine(prefix + "/move_force", most_carried_, "N");
    printLine(prefix + "/move_step", largest_step_, "N");
    loop_.rest(1.0);
    begin();
    loop_.rest(1.0);
    printLine(prefix + "/carry_force", most_carried_, "N");
    loop_.shift(Vector3d(-0.05, 0.0, -0.02), 0.5);
    loop_.rest(0.5);
    loop_.close(0.02, 0.3);
    printLine(prefix + "/least_work", least_work_, "J");
    printLine(prefix + "/rejected_steps", loop_.cloth().rejectedSteps(), "steps");
  }

 private:
  static oracles::TouchLoopSettings settings(const Variant& variant) {
    oracles::TouchLoopSettings settings;
    settings.cloth = woolSample(variant.large_scale_step);
    settings.cloth.haptics.predict = variant.predict;
    settings.linearised = variant.linearised;
    settings.delay = variant.delay;
    settings.pinched = Vector3d(0.0, 0.0, -0.19);
    return settings;
  }

  void begin() {
    count_ = 0;
    most_carried_ = largest_step_ = 0.0;
    for (const Finger finger : kFingers) {
      sums_[finger].setZero();
      squares_[finger] = 0.0;
    }
  }

  void watch() {
    ++count_;
    Vector3d carried = Vector3d::Zero();
    for (const Finger finger : kFingers) {
      const Vector3d felt = loop_.felt(finger);
      carried += felt;
      sums_[finger] += felt;
      squares_[finger] += felt.squaredNorm();
      largest_step_ = std::max(largest_step_, (felt - last_[finger]).norm());
      last_[finger] = felt;
      least_work_ = std::min(least_work_, loop_.work(finger));
    }
    most_carried_ = std::max(most_carried_, carried.norm());
  }

  double ripple() const {
    double most = 0.0;
    for (const Finger finger : kFingers) {
      most = std::max(most, squares_[finger] / count_ - (sums_[finger] / count_).squaredNorm());
    }
    return std::sqrt(most);
  }

  oracles::TouchLoop loop_;
  int count_ = 0;
  base::PerFinger<Vector3d> sums_, last_{{Vector3d::Zero(), Vector3d::Zero()}};
  base::PerFinger<double> squares_{};
  double most_carried_ = 0.0;  // N, sum of both fingers' forces: what the cloth weighs on the hand
  double largest_step_ = 0.0;  // N, of a finger from one millisecond to the next
  double least_work_ = 0.0;    // J, below 0: the device gave energy
};

}  // namespace

int main() {
  printComputation();
  const Variant variants[] = {
      {"as_shipped", 0.0125, true, true, 0},       {"no_prediction", 0.0125, false, true, 0},
      {"force_only", 0.0125, true, false, 0},      {"as_shipped_3ms", 0.0125, true, true, 3},
      {"force_only_3ms", 0.0125, true, false, 3},  {"as_shipped_25Hz", 0.04, true, true, 0},
      {"no_prediction_25Hz", 0.04, false, true, 0}};
  for (const Variant& variant : variants) {
    Feel(variant).print(std::string("haptic_loop/touch/") + variant.name);
  }
  return 0;
}
