#include "haptex/oracles/experiments/contact_scenes.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "haptex/base/constants.h"
#include "haptex/contact/obstacles/obstacle_collision.h"
#include "haptex/scene/usual_elasticity.h"

namespace haptex::oracles {
namespace {

using base::Finger;
using base::kFingers;
using contact::Fingertip;
using Eigen::Vector3d;

/// A square that nothing holds, without gravity.
HapticLoopSettings sheetOf(const material::Fabric& fabric, double side, int cells) {
  HapticLoopSettings settings;
  settings.mesh = mesh::makeRectangle(side, side, cells, cells, mesh::Triangulation::kAlternating);
  settings.fabric = fabric;
  settings.effects.viscosity = true;
  settings.effects.bending = true;
  settings.effects.elasticity = scene::usualElasticity(settings.effects);
  settings.step.newton_iterations = 4;
  // What the linear solves leave open is not what these scenes are about, and at 25 Hz 1e-6 can
  // keep the released sample in a small cycle.
  settings.step.tolerance = 1e-10;
  return settings;
}

HapticLoopSettings sampleAt(const material::Fabric& fabric, double large_scale_rate, int cells) {
  HapticLoopSettings settings = sheetOf(fabric, kSampleSide, cells);
  settings.large_scale_step =
      std::round(1.0 / large_scale_rate / settings.haptics.time_step) * settings.haptics.time_step;
  return settings;
}

/// The index finger above the origin.
/// @param height m, of its centre
Fingertip fingerAbove(double height) {
  Fingertip finger;
  finger.radius = kIndexRadius;
  finger.position = {0.0, 0.0, height};
  return finger;
}

}  // namespace

HapticLoopSettings hangingSample(const material::Fabric& fabric, kes::Direction up,
                                 double large_scale_rate, int cells) {
  HapticLoopSettings settings = sampleAt(fabric, large_scale_rate, cells);
  settings.effects.gravity = {0.0, 0.0, -base::kStandardGravity};
  settings.attached_particles = sideParticles(
      settings.mesh, up == kes::Direction::kWarp ? mesh::Side::kTop : mesh::Side::kLeft);
  if (up == kes::Direction::kWarp) return settings;
  for (std::size_t i = 0; i < settings.mesh.rest_coordinates.size(); ++i) {
    const Eigen::Vector2d& rest = settings.mesh.rest_coordinates[i];
    settings.mesh.initial_positions[i] = {0.0, rest.y() - 0.5 * kSampleSide, -rest.x()};
  }
  return settings;
}

HapticLoopSettings tautSample(const material::Fabric& fabric, double strain,
                              double large_scale_rate) {
  HapticLoopSettings settings = sampleAt(fabric, large_scale_rate, kSampleCells);
  std::vector<char> held(settings.mesh.rest_coordinates.size(), 0);
  for (mesh::Side side :
       {mesh::Side::kTop, mesh::Side::kBottom, mesh::Side::kLeft, mesh::Side::kRight}) {
    for (int particle : sideParticles(settings.mesh, side)) held[particle] = 1;
  }
  const Vector3d middle(0.0, 0.0, -0.5 * kSampleSide);
  for (std::size_t i = 0; i < held.size(); ++i) {
    if (held[i]) settings.attached_particles.push_back(static_cast<int>(i));
    Vector3d& position = settings.mesh.initial_positions[i];
    position = middle + (1.0 + strain) * (position - middle);
  }
  return settings;
}

HapticLoopSettings tautLayers(const material::Fabric& fabric, int layers, double large_scale_rate) {
  const HapticLoopSettings one = tautSample(fabric, 0.0, large_scale_rate);
  HapticLoopSettings all = one;
  all.effects.self_collision = true;
  all.mesh = {};
  all.attached_particles.clear();
  const Vector3d middle(0.0, 0.0, -0.5 * kSampleSide);
  const double thickness = fabric.compression->thickness;
  for (int layer = 0; layer < layers; ++layer) {
    const int first = static_cast<int>(all.mesh.rest_coordinates.size());
    const Eigen::AngleAxisd turn(0.3 * layer, Vector3d::UnitX());
    const Vector3d shift(thickness * (0.5 * (layers - 1) - layer), 0.0, 0.0);
    for (std::size_t i = 0; i < one.mesh.rest_coordinates.size(); ++i) {
      all.mesh.rest_coordinates.push_back(one.mesh.rest_coordinates[i] +
                                          Eigen::Vector2d(2.0 * kSampleSide * layer, 0.0));
      all.mesh.initial_positions.push_back(middle +
                                           turn * (one.mesh.initial_positions[i] - middle) + shift);
    }
    for (const auto& [a, b, c] : one.mesh.triangles) {
      all.mesh.triangles.push_back({a + first, b + first, c + first});
    }
    for (const int held : one.attached_particles) all.attached_particles.push_back(held + first);
  }
  all.haptics.most_elements *= layers;
  return all;
}

double weight(const HapticLoopSettings& sample) {
  const cloth::Cloth cloth(sample.mesh, sample.fabric, sample.effects);
  return base::kStandardGravity *
         std::accumulate(cloth.masses().begin(), cloth.masses().end(), 0.0);
}

Fingertips Hand::fingertips() const {
  Fingertip index, thumb;
  index.radius = index_radius;
  thumb.radius = thumb_radius;
  index.position = middle + Vector3d(0.5 * gap + index_radius, 0.0, 0.0);
  thumb.position = middle - Vector3d(0.5 * gap + thumb_radius, 0.0, 0.0);
  index.velocity = velocity + Vector3d(0.5 * opening, 0.0, 0.0);
  thumb.velocity = velocity - Vector3d(0.5 * opening, 0.0, 0.0);
  return {index, thumb};
}

void move(Hand& hand, const Vector3d& displacement, double opening, double seconds, double h,
          const std::function<void(const Fingertips&)>& step) {
  const Hand begin = hand;
  const int steps = static_cast<int>(std::lround(seconds / h));
  hand.velocity = displacement / (steps * h);
  hand.opening = opening / (steps * h);
  for (int i = 1; i <= steps; ++i) {
    const double part = static_cast<double>(i) / steps;
    hand.middle = begin.middle + part * displacement;
    hand.gap = begin.gap + part * opening;
    step(hand.fingertips());
  }
  hand.velocity.setZero();
  hand.opening = 0.0;
}

Vector3d forceOnFingertips(const contact::HapticLayer& layer) {
  return layer.contacts()[Finger::kIndex].force + layer.contacts()[Finger::kThumb].force;
}

RefinedCloth::RefinedCloth(const HapticLoopSettings& sample)
    : fabrics_{sample.fabric},
      laws_{contact::ContactLaw(sample.fabric, {},
                                sample.effects.self_collision ? contact::LayersBetween::kMost : 1)},
      motion_(sample.mesh.rest_coordinates.size()) {
  std::vector<int> all(sample.mesh.triangles.size());
  std::iota(all.begin(), all.end(), 0);
  std::vector<char> attached(sample.mesh.rest_coordinates.size(), 0);
  for (int particle : sample.attached_particles) attached[particle] = 1;
  const contact::MeshTopology topology(sample.mesh);
  patch_ = std::make_unique<contact::Patch>(
      sample.mesh,
      contact::cutAndRefine(sample.mesh, topology, all, attached, sample.haptics.refinement),
      fabrics_, sample.effects, laws_);
  motion_.receive(sample.mesh.initial_positions, 1.0);
  patch_->start(motion_);
}

void RefinedCloth::step(const Fingertips& fingertips, double h) {
  base::PerFinger<const Fingertip*> present{};
  for (const Finger finger : kFingers)
    present[finger] = fingertips[finger] ? &*fingertips[finger] : nullptr;
  if (!patch_->advance(motion_, present, h)) {
    throw std::runtime_error("the refined cloth's step could not be solved");
  }
}

Vector3d RefinedCloth::force(Finger finger) const {
  Vector3d sum = Vector3d::Zero();
  for (const contact::TouchedParticle& touched : patch_->contact(finger).touched()) {
    sum -= touched.force();
  }
  return sum;
}

Eigen::Vector2d RefinedCloth::fabricPosition(Finger finger) const {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double weights = 0.0;
  for (const contact::TouchedParticle& touched : patch_->contact(finger).touched()) {
    sum += touched.normal_force * patch_->restCoordinates(touched.particle);
    weights += touched.normal_force;
  }
  return weights > 0.0 ? Eigen::Vector2d(sum / weights) : sum;
}

HapticLoopSettings sheetOnPlate(const TableSettings& settings) {
  constexpr double kTouched = 0.02;    // m, the side of a square that a patch covers at least
  constexpr double kThickness = 0.02;  // m, of the plate
  const double cell = settings.side / settings.cells;
  HapticLoopSettings loop = sheetOf(settings.fabric, settings.side, settings.cells);
  for (Vector3d& place : loop.mesh.initial_positions) {
    place = {-place.z() - 0.5 * settings.side, place.y(), 0.0};
  }
  loop.effects.contacts = true;
  loop.effects.gravity = {0.0, 0.0, -base::kStandardGravity};
  loop.haptics.refinement = settings.refinement;
  loop.haptics.margin = 0.5 * kTouched;
  loop.haptics.most_elements = static_cast<int>(2.0 * std::pow(kTouched / cell + 1.0, 2));
  const double down = contact::ObstacleCollision::kOffset + 0.5 * kThickness;
  mesh::Obstacle plate{"plate", mesh::ObstacleBox{{0.4, 0.4, kThickness}},
                       Eigen::Isometry3d(Eigen::Translation3d(0.0, 0.0, -down))};
  plate.friction = settings.plate_friction;
  loop.obstacles = {plate};
  return loop;
}

Fingertip press(HapticLoop& loop, double height, double seconds) {
  const double touch = kIndexRadius + loop.layer().law().halfThickness();
  Fingertip finger = fingerAbove(touch + 1e-3);
  loop.rest({finger, std::nullopt}, 0.1);  // until there is a patch
  const int ticks = static_cast<int>(std::lround(seconds * 1e3));
  finger.velocity.z() = (height - touch) / (1e-3 * ticks);
  for (int i = 1; i <= ticks; ++i) {
    finger.position.z() = touch + (height - touch) * i / ticks;
    loop.step({finger, std::nullopt});
  }
  finger.velocity.setZero();
  loop.rest({finger, std::nullopt}, 0.3);
  return finger;
}

double frictionOfDrag(const TableSettings& settings, double depth, const Vector3d& velocity) {
  constexpr double kLength = 0.008;  // m
  HapticLoop loop(sheetOnPlate(settings));
  Fingertip finger = press(loop, kIndexRadius + loop.layer().law().halfThickness() - depth, 0.1);
  finger.velocity = velocity;
  const Vector3d way = velocity.normalized();
  const double weight =
      settings.fabric.areal_density * settings.side * settings.side * base::kStandardGravity;
  double drag = 0.0, pressed = 0.0;
  const int ticks = static_cast<int>(kLength / velocity.norm() * 1e3);
  for (int tick = 0; tick < ticks; ++tick) {
    finger.position += 1e-3 * velocity;
    loop.step({finger, std::nullopt});
    if (2 * tick < ticks) continue;
    drag -= feltByIndex(loop).dot(way);
    pressed += feltByIndex(loop).z() + weight;
  }
  return drag / pressed;
}

Vector3d feltByIndex(const HapticLoop& loop) {
  return loop.layer().contacts()[Finger::kIndex].force;
}

}  // namespace haptex::oracles
