#include "haptex/studies/evaluation/trial.h"

#include <cmath>
#include <random>
#include <utility>

namespace haptex::studies {

using base::Finger;
using base::kFingers;
using contact::Fingertips;
using Eigen::Vector3d;

namespace {
constexpr double kStep = 1e-3;                    // s
constexpr double kAmplitude = 20e-6 / 1.7320508;  // m, of each of three waves
}  // namespace

Tremor::Tremor(std::uint64_t seed) {
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

void Tremor::move(double time, Fingertips& fingertips) const {
  for (const Finger finger : kFingers) {
    if (!fingertips[finger]) continue;
    for (int axis = 0; axis < 3; ++axis) {
      for (const Wave& wave : waves_[static_cast<std::size_t>(finger)][axis]) {
        const double angle = wave.pulsation * time + wave.phase;
        fingertips[finger]->position[axis] += kAmplitude * std::sin(angle);
        fingertips[finger]->velocity[axis] += kAmplitude * wave.pulsation * std::cos(angle);
      }
    }
  }
}

Trial::Trial(oracles::HapticLoopSettings sample, std::uint64_t tremor, const Fingertips& fingertips)
    : loop_(std::move(sample)), tremor_(tremor), fingertips_(fingertips) {}

void Trial::moveTo(const Fingertips& fingertips, double seconds) {
  const Fingertips begin = fingertips_;
  const int steps = static_cast<int>(std::lround(seconds / kStep));
  for (int i = 1; i <= steps; ++i) {
    for (const Finger finger : kFingers) {
      const Vector3d way = fingertips[finger]->position - begin[finger]->position;
      fingertips_[finger]->position = begin[finger]->position + way * (double(i) / steps);
      fingertips_[finger]->velocity = way / (steps * kStep);
    }
    step(fingertips_);
  }
  for (const Finger finger : kFingers) fingertips_[finger]->velocity.setZero();
}

void Trial::step(Fingertips fingertips) {
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

}  // namespace haptex::studies
