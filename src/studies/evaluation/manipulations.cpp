#include "haptex/studies/evaluation/manipulations.h"

#include <array>
#include <cmath>
#include <random>

#include "haptex/contact/contact_law.h"
#include "haptex/oracles/experiments/contact_scenes.h"

namespace haptex::studies {
namespace {

using base::Finger;
using base::kFingers;
using contact::Fingertips;
using Eigen::Vector3d;

constexpr double kStep = 1e-3;        // s
constexpr double kOpen = 4e-3;        // m, gap in which nothing touches
constexpr double kLowerEdge = -0.19;  // m, where a hand pinches there
constexpr double kMiddle = -0.1;      // m
const Vector3d kStill = Vector3d::Zero();

/// Sums of sines, alike for the same seed on every platform.
class Tremor {
 public:
  explicit Tremor(std::uint64_t seed) {
    std::mt19937_64 generator(seed);
    const auto uniform = [&] { return static_cast<double>(generator() >> 11) * 0x1.0p-53; };
    for (auto& axes : waves_) {
      for (auto& waves : axes) {
        for (Wave& wave : waves) {
          wave.pulsation = 2.0 * M_PI * (8.0 + 4.0 * uniform());
          wave.phase = 2.0 * M_PI * uniform();
        }
      }
    }
  }

  void move(double time, Fingertips& fingertips) const {
    for (const Finger finger : kFingers) {
      for (int axis = 0; axis < 3; ++axis) {
        for (const Wave& wave : waves_[static_cast<std::size_t>(finger)][axis]) {
          const double angle = wave.pulsation * time + wave.phase;
          fingertips[finger]->position[axis] += kAmplitude * std::sin(angle);
          fingertips[finger]->velocity[axis] += kAmplitude * wave.pulsation * std::cos(angle);
        }
      }
    }
  }

 private:
  static constexpr double kAmplitude = 20e-6 / 1.7320508;  // m, of each of three waves
  struct Wave {
    double pulsation = 0.0, phase = 0.0;  // rad/s, rad
  };
  std::array<std::array<std::array<Wave, 3>, 3>, 2> waves_{};  // by finger, axis
};

/// A hand with a sample, and what its device measures from record() on.
class Trial {
 public:
  Trial(oracles::HapticLoopSettings sample, double height, const ManipulationSettings& settings)
      : loop_(std::move(sample)), tremor_(settings.seed) {
    hand_.middle.z() = height;
    hand_.gap = kOpen;
  }

  void move(const Vector3d& displacement, double opening, double seconds) {
    oracles::move(hand_, displacement, opening, seconds, kStep,
                  [&](const Fingertips& fingertips) { step(fingertips); });
  }
  void rest(double seconds) { move(kStill, 0.0, seconds); }
  void record() { records_ = true; }
  void releaseAll() { loop_.releaseAll(); }
  const DeviceRecord& result() const { return record_; }

 private:
  void step(Fingertips fingertips) {
    tremor_.move(loop_.time(), fingertips);
    loop_.step(fingertips);
    if (!records_) return;
    DeviceSample sample;
    sample.time = loop_.time();
    for (const Finger finger : kFingers) {
      sample.positions[finger] = fingertips[finger]->position;
      sample.forces[finger] = loop_.layer().contacts()[finger].force;
    }
    record_.push_back(sample);
  }

  oracles::HapticLoop loop_;
  oracles::Hand hand_;
  Tremor tremor_;
  DeviceRecord record_;
  bool records_ = false;
};

oracles::HapticLoopSettings hanging(const material::Fabric& fabric, bool by_warp,
                                    const ManipulationSettings& settings) {
  return oracles::hangingSample(fabric, by_warp ? kes::Direction::kWarp : kes::Direction::kWeft,
                                settings.rate, settings.cells);
}

DeviceRecord weigh(const material::Fabric& fabric, const ManipulationSettings& settings) {
  Trial trial(hanging(fabric, true, settings), kLowerEdge, settings);
  trial.move(kStill, -1.75 * kOpen, 0.3);
  trial.rest(0.3);
  trial.releaseAll();
  trial.rest(4.0);
  trial.record();
  trial.rest(4.0);
  return trial.result();
}

DeviceRecord drag(const material::Fabric& fabric, const ManipulationSettings& settings) {
  Trial trial(hanging(fabric, true, settings), kMiddle, settings);
  trial.move(kStill, -1.4 * kOpen, 0.3);
  trial.rest(0.2);
  trial.record();
  trial.move({0.0, 0.0, -0.03}, 0.0, 1.5);
  return trial.result();
}

DeviceRecord pinch(const material::Fabric& fabric, const ManipulationSettings& settings) {
  Trial trial(hanging(fabric, true, settings), kMiddle, settings);
  trial.move(kStill, -0.5 * kOpen, 0.2);
  trial.record();
  trial.move(kStill, -0.9 * kOpen, 4.0);
  return trial.result();
}

/// Pinched firmly above its lower edge.
DeviceRecord drawBy(const Vector3d& way, const oracles::HapticLoopSettings& sample,
                    const ManipulationSettings& settings) {
  Trial trial(sample, kLowerEdge, settings);
  trial.move(kStill, -3.25 * kOpen, 0.6);
  trial.rest(0.3);
  trial.record();
  trial.move(way, 0.0, 2.0);
  return trial.result();
}

template <bool kAlongWarp>
DeviceRecord draw(const material::Fabric& fabric, const ManipulationSettings& settings) {
  return drawBy({0.0, 0.0, -8e-3}, hanging(fabric, kAlongWarp, settings), settings);
}

DeviceRecord shear(const material::Fabric& fabric, const ManipulationSettings& settings) {
  return drawBy({0.0, 12e-3, 0.0}, hanging(fabric, true, settings), settings);
}

}  // namespace

const std::vector<Manipulation>& manipulations() {
  static const std::vector<Manipulation> all = {
      {"weigh", weigh},           {"drag", drag},  {"pinch", pinch}, {"draw_warp", draw<true>},
      {"draw_weft", draw<false>}, {"shear", shear}};
  return all;
}

FingertipPair fingertipPair() {
  return {{{oracles::kIndexRadius, oracles::kThumbRadius}}, contact::PulpSettings().stiffness};
}

}  // namespace haptex::studies
