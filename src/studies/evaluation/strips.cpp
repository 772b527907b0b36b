#include "haptex/studies/evaluation/strips.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "haptex/studies/evaluation/trial.h"

namespace haptex::studies {
namespace {

using base::Finger;
using contact::Fingertips;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kClearance = 1e-3;  // m, before the finger touches
constexpr double kThumbAway = 0.12;  // m, behind the index finger
constexpr double kMostForce = 3.0;   // N, at which a hand ceases to press
constexpr int kParts = 50;           // of the way of a finger that becomes faster
constexpr double kPressCell = 4e-3;  // m, at most, along the sides of the cells
constexpr double kBiasCell = 5e-3;   // m, likewise
constexpr int kOverhangCells = 12;   // along the overhang, half of one in the clamp

/// Fingertips of which only the index finger touches: the thumb stays behind it.
Fingertips indexAlone(const Vector3d& position, const Vector3d& ahead) {
  contact::Fingertip index, thumb;
  index.radius = oracles::kIndexRadius;
  index.position = position;
  thumb.radius = oracles::kThumbRadius;
  thumb.position = position - kThumbAway * ahead;
  return {index, thumb};
}

/// A strip in the plane x = 0, its length from the origin downwards.
oracles::HapticLoopSettings stripOf(const material::Fabric& fabric, Cut cut, const Strip& strip,
                                    double cell, const ManipulationSettings& settings) {
  oracles::HapticLoopSettings sample =
      oracles::hangingSample(fabric, kes::Direction::kWarp, 1.0 / settings.large_scale_step);
  if (settings.step) sample.step = *settings.step;
  const auto cells = [&](double side) { return static_cast<int>(std::ceil(side / cell - 1e-9)); };
  sample.mesh = mesh::makeRectangle(strip.width, strip.length, cells(strip.width),
                                    cells(strip.length), mesh::Triangulation::kAlternating);
  sample.attached_particles = mesh::sideParticles(sample.mesh, mesh::Side::kTop);
  if (cut == Cut::kWarp) return sample;
  const Eigen::Rotation2Dd turn(cut == Cut::kWeft ? M_PI_2 : M_PI_4);
  for (Vector2d& rest : sample.mesh.rest_coordinates) rest = turn * rest;
  return sample;
}

}  // namespace

DeviceRecord pressStrip(const material::Fabric& fabric, Cut cut,
                        const ManipulationSettings& settings) {
  const bool biased = cut == Cut::kBias;
  const Strip strip = biased ? kBiased : kPressed;
  oracles::HapticLoopSettings sample =
      stripOf(fabric, cut, strip, biased ? kBiasCell : kPressCell, settings);
  for (std::size_t i = 0; i < sample.mesh.initial_positions.size(); ++i) {
    if (sample.mesh.initial_positions[i].z() < -strip.length + 1e-9) {
      sample.attached_particles.push_back(static_cast<int>(i));
    }
  }
  const Vector3d ahead(-1.0, 0.0, 0.0);
  const double surface = 0.5 * fabric.compression->thickness;
  const Vector3d begin(oracles::kIndexRadius + surface + kClearance, 0.0, -0.5 * strip.length);
  Trial trial(std::move(sample), settings.tremor, indexAlone(begin, ahead));
  trial.rest(0.3);
  trial.record();
  // Slow at first: stiff fabric resists soon. Knits need the long way.
  const double way = biased ? 42e-3 : 100e-3, seconds = biased ? 14.0 : 8.0;
  for (int i = 1; i <= kParts; ++i) {
    const double part = static_cast<double>(i) / kParts;
    trial.moveTo(indexAlone(begin + way * part * part * ahead, ahead), seconds / kParts);
    if (trial.result().back().forces[Finger::kIndex].norm() > kMostForce) break;
  }
  return trial.result();
}

DeviceRecord lowerStrip(const material::Fabric& fabric, Cut cut,
                        const ManipulationSettings& settings) {
  // The clamp holds two rows; the cell between them bends at both, so that its middle is where the
  // strip leaves the clamp.
  const double cell = kOverhang.length / (kOverhangCells - 0.5);
  oracles::HapticLoopSettings sample =
      stripOf(fabric, cut, {kOverhang.length + 0.5 * cell, kOverhang.width}, cell, settings);
  sample.attached_particles.clear();
  for (std::size_t i = 0; i < sample.mesh.initial_positions.size(); ++i) {
    Vector3d& position = sample.mesh.initial_positions[i];
    position = {-position.z() - 0.5 * cell, position.y(), 0.0};
    if (position.x() < 0.6 * cell) sample.attached_particles.push_back(static_cast<int>(i));
  }
  // So light that a step of the large-scale cloth is long: a single layer, at 1 kHz, in still air.
  sample.haptics.layer = contact::HapticSettings::Layer::kWholeCloth;
  sample.large_scale_step = sample.haptics.time_step;
  if (!settings.step) sample.step.newton_iterations = 2;
  sample.effects.air = cloth::Air();
  const Vector3d ahead(0.0, 0.0, 1.0);
  const double surface = 0.5 * fabric.compression->thickness;
  const Vector3d begin(2.0 / 3.0 * kOverhang.length, 0.0,
                       kClearance - surface - oracles::kIndexRadius);
  Trial trial(std::move(sample), settings.tremor, indexAlone(begin, ahead));
  trial.rest(0.3);
  trial.record();
  trial.moveTo(indexAlone(begin - 24e-3 * ahead, ahead), 8.0);
  return trial.result();
}

}  // namespace haptex::studies
