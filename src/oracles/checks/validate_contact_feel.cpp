#include <algorithm>
#include <array>
#include <cmath>

#include "haptex/oracles/checks/contact_oracles.h"
#include "haptex/oracles/experiments/contact_scenes.h"

namespace haptex::oracles {
namespace {

using base::Finger;
using base::kFingers;
using contact::Fingertip;
using Eigen::Vector3d;

constexpr double kRippleTolerance = 0.01;  // N, RMS
constexpr double kStepTolerance = 0.02;    // N
constexpr double kWholeClothTolerance = 0.02;

std::string hertz(double rate) { return std::to_string(std::lround(rate)) + "Hz"; }

/// Pinch between bar and fingertips, held: RMS of each fingertip's force about its mean.
void validateRipple(const material::Fabric& fabric, double rate, const Sink& sink) {
  HapticLoop loop(hangingSample(fabric, kes::Direction::kWarp, rate));
  Hand hand;
  hand.middle.z() = -0.19;
  hand.gap = 4e-3;
  const auto step = [&](const Fingertips& fingertips) { loop.step(fingertips); };
  move(hand, kStill, -8e-3, 0.2, 1e-3, step);
  for (double extension : {0.0, 2e-3, -4e-3}) {
    move(hand, {0.0, 0.0, -extension}, 0.0, 0.2, 1e-3, step);
    move(hand, kStill, 0.0, 0.8, 1e-3, step);
    base::PerFinger<Vector3d> sum{{kStill, kStill}};
    base::PerFinger<double> squares{};
    int count = 0;
    move(hand, kStill, 0.0, 1.0, 1e-3, [&](const Fingertips& fingertips) {
      loop.step(fingertips);
      for (const Finger finger : kFingers) {
        const Vector3d& force = loop.layer().contacts()[finger].force;
        sum[finger] += force;
        squares[finger] += force.squaredNorm();
      }
      ++count;
    });
    double ripple = 0.0;
    for (const Finger finger : kFingers) {
      const double variance = squares[finger] / count - (sum[finger] / count).squaredNorm();
      ripple = base::largerOrNaN(ripple, std::sqrt(std::max(0.0, variance)));
    }
    const std::string pose = extension == 0.0 ? "straight" : extension > 0.0 ? "taut" : "slack";
    sink({"contact/ripple_N/" + pose + "/" + hertz(rate), 0.0, ripple, ripple, kRippleTolerance});
  }
}

/// The largest force steps of a fingertip from one millisecond to the next.
struct ForceSteps {
  double at_exchange = 0.0;  // N, in the milliseconds of an exchange
  double elsewhere = 0.0;
  int exchanges = 0;
};

/// Watches the forces of a loop.
class StepWatch {
 public:
  explicit StepWatch(HapticLoop& loop) : loop_(loop), changes_(loop.patchChanges()) { remember(); }

  void step(const Fingertips& fingertips) {
    loop_.step(fingertips);
    const bool exchanged = loop_.patchChanges() != changes_;
    changes_ = loop_.patchChanges();
    if (exchanged) ++steps_.exchanges;
    for (const Finger finger : kFingers) {
      const double size = (loop_.layer().contacts()[finger].force - last_[finger]).norm();
      double& largest = exchanged ? steps_.at_exchange : steps_.elsewhere;
      largest = base::largerOrNaN(largest, size);
    }
    remember();
  }
  const ForceSteps& steps() const { return steps_; }

 private:
  void remember() {
    for (const Finger finger : kFingers) last_[finger] = loop_.layer().contacts()[finger].force;
  }
  HapticLoop& loop_;
  int changes_;
  base::PerFinger<Vector3d> last_;
  ForceSteps steps_;
};

/// Slides over a taut and over the hanging sample; the patch moves along.
void validateSteps(const material::Fabric& fabric, bool taut, double speed, const Sink& sink) {
  HapticLoop loop(taut ? tautSample(fabric, 0.005, 80.0)
                       : hangingSample(fabric, kes::Direction::kWarp, 80.0));
  Hand hand;
  hand.middle.z() = taut ? -0.08 : -0.15;
  hand.gap = 2.0 * loop.layer().law().halfThickness();
  const auto step = [&](const Fingertips& fingertips) { loop.step(fingertips); };
  move(hand, kStill, -1.2e-3, 0.2, 1e-3, step);
  move(hand, kStill, 0.0, 0.2, 1e-3, step);
  StepWatch watch(loop);
  move(hand, {0.0, 0.0, -0.03}, 0.0, 0.03 / speed, 1e-3,
       [&](const Fingertips& fingertips) { watch.step(fingertips); });
  const std::string name = std::string(taut ? "taut" : "hanging") + "/" +
                           std::to_string(std::lround(speed * 1e3)) + "mm_per_s";
  const ForceSteps& steps = watch.steps();
  sink({"contact/step_N/" + name + "/" + std::to_string(steps.exchanges) + "_exchanges", 0.0,
        steps.at_exchange, steps.at_exchange, kStepTolerance});
  sink({"contact/step_N/" + name + "/elsewhere", 0.0, steps.elsewhere, steps.elsewhere,
        kStepTolerance});
}

/// What a person has put into the cloth (J) over cycles of approach and retreat: never below zero,
/// as Hannaford and Ryu 2002 observe it. Between two samples the device follows the linearised
/// force, so the mean of both acts.
void validatePassivity(const material::Fabric& fabric, const Sink& sink) {
  constexpr int kCycles = 1000;
  constexpr int kTicks = 25;      // of approach, and of retreat
  constexpr double kSpeed = 0.1;  // m/s
  HapticLoop loop(tautSample(fabric, 0.005, 80.0));
  Fingertip fingertip;
  fingertip.radius = kIndexRadius;
  const double outside = kIndexRadius + loop.layer().law().halfThickness() + 0.5e-3;
  fingertip.position = {outside, 0.0, -0.5 * kSampleSide};
  double energy = 0.0, least = 0.0, least_of_cycle = 0.0;
  for (int cycle = 0; cycle < kCycles; ++cycle) {
    const double before = energy;
    for (int tick = 0; tick < 2 * kTicks; ++tick) {
      const double velocity = tick < kTicks ? -kSpeed : kSpeed;
      const Vector3d force = loop.layer().contacts()[Finger::kIndex].force;
      fingertip.velocity.x() = velocity;
      fingertip.position.x() += 1e-3 * velocity;
      loop.step({fingertip, std::nullopt});
      energy -= 0.5e-3 * velocity * (force + loop.layer().contacts()[Finger::kIndex].force).x();
      least = std::min(least, energy);
    }
    least_of_cycle = std::min(least_of_cycle, energy - before);
  }
  sink({"contact/passivity_J/least", 0.0, least, -least, 0.0});
  sink({"contact/passivity_J/least_of_a_cycle", 0.0, least_of_cycle, -least_of_cycle, 1e-6});
}

/// Pressed with the contact on the patch, and on the particles of the whole cloth at 1 kHz. Both
/// meshes are the same where the fingertip is: refinement 0. Without bending, which
/// patches always have and this cloth does not model.
void validateWholeCloth(const material::Fabric& fabric, const Sink& sink) {
  constexpr double kSide = 0.06;
  HapticLoopSettings sample;
  sample.mesh = mesh::makeRectangle(kSide, kSide, 16, 16, mesh::Triangulation::kAlternating);
  sample.fabric = fabric;
  sample.fabric.bending = material::BendingRigidity{0.0, 0.0};
  sample.effects.viscosity = true;
  for (mesh::Side side : {mesh::Side::kTop, mesh::Side::kBottom}) {
    for (int particle : sideParticles(sample.mesh, side)) {
      sample.attached_particles.push_back(particle);
    }
  }
  for (Vector3d& position : sample.mesh.initial_positions) position.z() *= 1.005;
  std::array<std::vector<double>, 2> forces;
  for (bool whole : {false, true}) {
    HapticLoopSettings settings = sample;
    settings.haptics.layer = whole ? contact::HapticSettings::Layer::kWholeCloth
                                   : contact::HapticSettings::Layer::kPatch;
    settings.haptics.refinement = 0;
    settings.haptics.most_elements = 100;  // the cells are a third of the usual ones
    settings.large_scale_step = whole ? 1e-3 : 12e-3;
    HapticLoop loop(settings);
    Fingertip fingertip;
    fingertip.radius = kIndexRadius;
    fingertip.position = {kIndexRadius + loop.layer().law().halfThickness(), 0.0, -0.5 * kSide};
    for (int i = 1; i <= 4; ++i) {
      fingertip.velocity.x() = -0.01;
      for (int tick = 0; tick < 100; ++tick) {
        fingertip.position.x() -= 1e-5;
        loop.step({fingertip, std::nullopt});
      }
      fingertip.velocity.setZero();
      loop.rest({fingertip, std::nullopt}, 0.6);
      forces[whole].push_back(loop.layer().contacts()[Finger::kIndex].force.x());
    }
  }
  for (int i = 0; i < 4; ++i) {
    sink(base::relativeTo(forces[1][i], "contact/whole_cloth/" + std::to_string(i + 1) + "mm",
                          forces[1][i], forces[0][i], kWholeClothTolerance));
  }
}

}  // namespace

void validateContactFeel(const material::Fabric& fabric, const Sink& sink) {
  validateWholeCloth(fabric, sink);
  for (bool taut : {true, false}) {
    for (double speed : {0.02, 0.05}) validateSteps(fabric, taut, speed, sink);
  }
  for (double rate : {25.0, 50.0, 80.0}) validateRipple(fabric, rate, sink);
  validatePassivity(fabric, sink);
}

}  // namespace haptex::oracles
