#include "haptex/oracles/experiments/cloth_swing.h"

#include <cmath>
#include <stdexcept>
#include <string>

#include "haptex/base/constants.h"
#include "haptex/cloth/dynamics/integrator.h"
#include "haptex/oracles/experiments/hanging_strip.h"

namespace haptex::oracles {
namespace {

using cloth::Cloth;
using cloth::ClothState;

constexpr double kFrequency = 2.0 * M_PI;  // rad/s
constexpr double kMaxAmplitude = 0.1;      // m
constexpr int kCellsInWidth = 2;

double length() {
  constexpr double kSlowest = 2.404825557695773 / 2.0;  // half of the first zero of J0
  return base::kStandardGravity * std::pow(kSlowest / kFrequency, 2);
}

Cloth hangingSheet(const material::Fabric& fabric, int cells, double amplitude) {
  if (cells <= 0) {
    throw std::invalid_argument("cells is " + std::to_string(cells) + "; it must be positive");
  }
  if (!(std::abs(amplitude) <= kMaxAmplitude)) {
    throw std::invalid_argument("the amplitude is " + std::to_string(amplitude) +
                                " m; it must be at most 0.1 m to either side");
  }
  cloth::ModelledEffects effects;
  effects.gravity = {0.0, 0.0, -base::kStandardGravity};
  Cloth cloth(mesh::makeRectangle(kCellsInWidth * length() / cells, length(), kCellsInWidth, cells,
                                  mesh::Triangulation::kAlternating),
              fabric, effects);
  for (int particle : sideParticles(cloth.mesh(), mesh::Side::kTop)) {
    cloth::AttachmentPath place;
    place.start = cloth.mesh().initial_positions[particle];
    cloth.attach(particle, place);
  }
  return cloth;
}

}  // namespace

ClothSwing::ClothSwing(const material::Fabric& fabric, int cells, double amplitude)
    : cloth_(hangingSheet(fabric, cells, amplitude)), start_(cloth_.initialState()) {
  const double cell = length() / cells;
  const auto shape = [&](double height) {
    return amplitude *
           std::cyl_bessel_j(0.0, 2.0 * kFrequency * std::sqrt(height / base::kStandardGravity));
  };
  // Each row of elements carries the particles below it, half a row of them at the lower edge.
  ClothState rest = start_;
  double hanging = 0.0, swinging = 0.0;
  for (int row = cells - 1; row >= 0; --row) {
    const double load = fabric.areal_density * base::kStandardGravity * cell * (row + 0.5);
    const double rise = cell * stretchUnder(load, fabric.warp.elastic);
    const double aside = shape(row * cell) - shape((row + 1) * cell);
    hanging -= rise;
    swinging -= std::sqrt(rise * rise - aside * aside);
    for (int i = 0; i <= kCellsInWidth; ++i) {
      const std::size_t particle = row * (kCellsInWidth + 1) + i;
      rest.positions[particle].z() = hanging;
      start_.positions[particle].z() = swinging;
      start_.positions[particle].x() = shape(row * cell);
    }
  }
  energy_at_rest_ = cloth_.potentialEnergy(rest);
}

double ClothSwing::energy(const ClothState& state) const {
  return cloth_.potentialEnergy(state) + cloth_.kineticEnergy(state) - energy_at_rest_;
}

ClothSwing::Motion ClothSwing::swing(const cloth::StepSettings& settings, double duration,
                                     int steps) const {
  cloth::Integrator integrator(cloth_, settings);
  Motion motion{start_, {energy(start_)}};
  for (int i = 0; i < steps; ++i) {
    motion.accepted =
        integrator.step(cloth_, motion.end, duration / steps).accepted && motion.accepted;
    motion.energies.push_back(energy(motion.end));
  }
  return motion;
}

}  // namespace haptex::oracles
