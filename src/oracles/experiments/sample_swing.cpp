#include "haptex/oracles/experiments/sample_swing.h"

#include <cmath>
#include <stdexcept>
#include <string>

#include "haptex/base/constants.h"
#include "haptex/cloth/dynamics/integrator.h"
#include "haptex/kes/equilibrium.h"
#include "haptex/oracles/experiments/hanging_strip.h"

namespace haptex::oracles {
namespace {

using cloth::Cloth;
using cloth::ClothState;
using Eigen::Vector3d;

constexpr double kSize = 0.2;  // m

Cloth sampleUnder(const material::Fabric& fabric, int cells, double gravity) {
  if (cells <= 0) {
    throw std::invalid_argument("cells is " + std::to_string(cells) + "; it must be positive");
  }
  cloth::ModelledEffects effects;
  effects.viscosity = true;
  effects.bending = fabric.bending.has_value();
  effects.gravity = {0.0, 0.0, -gravity};
  Cloth cloth(mesh::makeRectangle(kSize, kSize, cells, cells, mesh::Triangulation::kAlternating),
              fabric, effects);
  for (int particle : sideParticles(cloth.mesh(), mesh::Side::kTop)) {
    cloth::AttachmentPath place;
    place.start = cloth.mesh().initial_positions[particle];
    cloth.attach(particle, place);
  }
  return cloth;
}

ClothState restUnder(const material::Fabric& fabric, int cells, double gravity) {
  constexpr double kCycle = 0.1;  // s
  Cloth cloth = sampleUnder(fabric, cells, gravity);
  ClothState state = cloth.initialState();
  kes::Equilibrium(cloth).settle(cloth, state, kCycle);
  return state;
}

double requireAngle(double angle) {
  if (!(std::abs(angle) < M_PI / 2.0)) {
    throw std::invalid_argument("the angle is " + std::to_string(angle) +
                                " rad; it must lie between -pi/2 and pi/2");
  }
  return angle;
}

}  // namespace

SampleSwing::SampleSwing(const material::Fabric& fabric, int cells, double angle)
    : cloth_(sampleUnder(fabric, cells, base::kStandardGravity)), start_(cloth_.initialState()) {
  const double cosine = std::cos(requireAngle(angle)), sine = std::sin(angle);
  start_.positions = restUnder(fabric, cells, base::kStandardGravity * cosine).positions;
  for (Vector3d& place : start_.positions) {
    place = Vector3d(-sine * place.z(), place.y(), cosine * place.z());
  }
  cloth_.forget(start_);
  energy_at_rest_ = cloth_.potentialEnergy(restUnder(fabric, cells, base::kStandardGravity));
}

double SampleSwing::energy(const ClothState& state) const {
  return cloth_.potentialEnergy(state) + cloth_.kineticEnergy(state) - energy_at_rest_;
}

SampleSwing::Motion SampleSwing::swing(const cloth::StepSettings& settings, double duration,
                                       int steps) const {
  cloth::Integrator integrator(cloth_, settings);
  Motion motion{start_};
  for (int i = 0; i < steps; ++i) {
    const cloth::StepReport report = integrator.step(cloth_, motion.end, duration / steps);
    motion.accepted = report.accepted && motion.accepted;
    motion.solves += static_cast<double>(report.newton_iterations) / steps;
    motion.seconds += report.total_seconds / steps;
    motion.taken_anew += report.taken_anew ? 1 : 0;
  }
  motion.kept = energy(motion.end) / energy(start_);
  return motion;
}

double orderOfSwing(const SampleSwing& swing, const cloth::StepSettings& settings,
                    double duration) {
  constexpr double kLongest = 0.0125;  // s
  const int cycles = static_cast<int>(std::lround(duration / kLongest));
  const auto end = [&](int steps_per_cycle) {
    return swing.swing(settings, duration, cycles * steps_per_cycle).end.positions;
  };
  const cloth::Positions exact = end(50);
  const auto error = [&](int steps_per_cycle) {
    const cloth::Positions positions = end(steps_per_cycle);
    double sum = 0.0;
    for (std::size_t i = 0; i < exact.size(); ++i) sum += (positions[i] - exact[i]).squaredNorm();
    return std::sqrt(sum / static_cast<double>(exact.size()));
  };
  return std::log10(error(1) / error(10));
}

}  // namespace haptex::oracles
