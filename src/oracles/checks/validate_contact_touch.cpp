#include <algorithm>
#include <cmath>

#include "haptex/oracles/checks/contact_oracles.h"
#include "haptex/oracles/exact/pinched_sheet.h"
#include "haptex/oracles/experiments/contact_scenes.h"

namespace haptex::oracles {
namespace {

using base::Finger;
using base::kFingers;
using contact::Fingertip;
using Eigen::Vector3d;

constexpr double kRimTolerance = 0.005;
constexpr double kLevelTolerance = 0.02;
constexpr double kPinchTolerance = 0.02;
constexpr double kLayersTolerance = 0.01;
constexpr double kThicknessTolerance = 1e-3;
constexpr double kAloneTolerance = 0.02;

constexpr double kStrain = 0.005;  // of the taut sample
constexpr double kRate = 80.0;     // Hz, large-scale
const Vector3d kMiddle(0.0, 0.0, -0.5 * kSampleSide);

/// A fingertip at `place` of the plane of the sample, pressed into it to the depth from one side
/// (+1 or -1 along x).
Fingertip pressed(const contact::ContactLaw& law, const Vector3d& place, double depth, double side,
                  double velocity) {
  Fingertip fingertip;
  fingertip.radius = kIndexRadius;
  const double height = kIndexRadius + law.halfThickness() - depth;
  fingertip.position = place + Vector3d(side * height, 0.0, 0.0);
  fingertip.velocity = {-side * velocity, 0.0, 0.0};
  return fingertip;
}

/// Where two fingertips press a taut sample, and from which sides.
struct Press {
  Vector3d place;
  double side;
};

/// Presses at an even pace and waits until nothing moves.
void pressAll(HapticLoop& loop, const base::PerFinger<std::optional<Press>>& presses, double from,
              double to) {
  constexpr double kSpeed = 0.02;  // m/s
  constexpr double kWait = 0.4;    // s
  const contact::ContactLaw& law = loop.layer().law();
  const auto fingertips = [&](double depth, double velocity) {
    Fingertips result;
    for (const Finger finger : kFingers) {
      if (presses[finger])
        result[finger] =
            pressed(law, presses[finger]->place, depth, presses[finger]->side, velocity);
    }
    return result;
  };
  const int steps = static_cast<int>(std::lround((to - from) / kSpeed / 1e-3));
  for (int i = 1; i <= steps; ++i) {
    loop.step(fingertips(from + (to - from) * i / steps, kSpeed));
  }
  loop.rest(fingertips(to, 0.0), kWait);
}

/// Without gravity the cloth only passes on what the rim holds.
void sinkRim(const HapticLoop& loop, const std::string& name, const Sink& sink) {
  const auto& contacts = loop.layer().contacts();
  const Vector3d force = forceOnFingertips(loop.layer());
  const Vector3d rim = loop.attachmentForce();
  const double error = (force - rim).norm() / (contacts[Finger::kIndex].force.norm() +
                                               contacts[Finger::kThumb].force.norm());
  sink({"contact/" + name + "/rim", rim.norm(), force.norm(), error, kRimTolerance});
}

void validateFree(const material::Fabric& fabric, const Sink& sink) {
  HapticLoop loop(tautSample(fabric, kStrain, kRate));
  const Fingertip near = pressed(loop.layer().law(), kMiddle, -1e-4, 1.0, 0.0);
  loop.rest({near, std::nullopt}, 0.1);
  const contact::FingertipContact& felt = loop.layer().contacts()[Finger::kIndex];
  const double all = felt.force.norm() + felt.normal_force + felt.stiffness.norm();
  sink({"contact/free", 0.0, all, all, 0.0});
  const double loads = static_cast<double>(loop.layer().loads().size());
  sink({"contact/free_loads", 0.0, loads, loads, 0.0});
}

/// Fingertips at different places feel what each alone feels; those on the same side too.
void validateTwoPlaces(const material::Fabric& fabric, const Sink& sink) {
  constexpr double kDepth = 2e-3;
  const Vector3d apart(0.0, 0.06, 0.06);
  HapticLoopSettings sample = tautSample(fabric, kStrain, kRate);
  sample.radii = {{kIndexRadius, kIndexRadius}};
  const Press index{kMiddle + apart, 1.0}, thumb{kMiddle - apart, -1.0};
  base::PerFinger<double> alone{};
  for (const Finger finger : kFingers) {
    HapticLoop loop(sample);
    base::PerFinger<std::optional<Press>> presses;
    presses[finger] = finger == Finger::kIndex ? index : thumb;
    pressAll(loop, presses, 0.0, kDepth);
    alone[finger] = loop.layer().contacts()[finger].force.norm();
    sinkRim(loop, base::name(finger) + std::string("_alone"), sink);
  }
  HapticLoop both(sample);
  pressAll(both, {index, thumb}, 0.0, kDepth);
  for (const Finger finger : kFingers) {
    sink(base::relativeTo(alone[finger], std::string("contact/two_places/") + base::name(finger),
                          alone[finger], both.layer().contacts()[finger].force.norm(),
                          kAloneTolerance));
  }
  sinkRim(both, "two_places", sink);
  HapticLoop same_side(sample);
  const Vector3d beside(0.0, 0.01, 0.0);
  pressAll(same_side, {Press{kMiddle + beside, 1.0}, Press{kMiddle - beside, 1.0}}, 0.0, kDepth);
  sinkRim(same_side, "same_side", sink);
}

/// Force of a pinch against the integral of the contact law, and the fabric's thickness in the
/// middle against its compression curve. In the middle of a cell of the large-scale mesh: all
/// particles there stand for equal areas. Nearly without friction, which resists the approach too
/// where the spheres are steep.
void validatePinch(const material::Fabric& fabric, const Sink& sink) {
  HapticLoopSettings sample = tautSample(fabric, 0.0, kRate);
  sample.fabric.friction = 1e-6;
  sample.haptics.refinement = 3;
  sample.radii = {{kIndexRadius, kIndexRadius}};
  HapticLoop loop(sample);
  const contact::ContactLaw& law = loop.layer().law();
  Hand hand;
  const double half_cell = 0.5 * kSampleSide / 32.0;
  hand.middle = kMiddle + Vector3d(0.0, half_cell, half_cell);
  hand.thumb_radius = kIndexRadius;
  // From 0.8 mm on: before, the area under pressure is hardly four particles wide.
  hand.gap = 2.0 * law.halfThickness() - 4e-4;
  const auto step = [&](const Fingertips& fingertips) { loop.step(fingertips); };
  base::Quantity thickness{"", 0.0, 0.0, -1.0, 0.0};
  for (int i = 1; i <= 5; ++i) {
    move(hand, Vector3d::Zero(), -4e-4, 0.02, 1e-3, step);
    move(hand, Vector3d::Zero(), 0.0, 0.3, 1e-3, step);
    const double distance = hand.gap + 2.0 * kIndexRadius;
    const double exact = pinchForce(law, kIndexRadius, distance).force;
    sink(base::relativeTo(exact, "contact/pinch/" + std::to_string(4 * i + 4) + "e-4m", exact,
                          loop.layer().contacts()[Finger::kIndex].force.x(), kPinchTolerance));
    // The particle that is pressed deepest: how thick is the fabric there?
    const auto& touched = loop.layer().patch()->contact(Finger::kIndex).touched();
    const auto deepest =
        std::max_element(touched.begin(), touched.end(),
                         [](const auto& a, const auto& b) { return a.depth < b.depth; });
    if (deepest == touched.end()) continue;
    const double pressure =
        deepest->normal_force / loop.layer().patch()->areas()[deepest->particle];
    const double pulps = 2.0 * pressure / contact::PulpSettings().stiffness;
    const double measured = 2.0 * law.halfThickness() - (2.0 * deepest->depth - pulps);
    double low = 0.0, high = 1.0;  // strain at which the fabric's curve has the pressure
    for (int k = 0; k < 60; ++k) {
      const double strain = 0.5 * (low + high);
      (fabric.compression->pressure.evaluate(strain).stress < pressure ? low : high) = strain;
    }
    const double exact_thickness = fabric.compression->thickness * (1.0 - low);
    base::keepWorse(thickness, base::relativeTo(exact_thickness, "contact/pinch/thickness_m",
                                                exact_thickness, measured, kThicknessTolerance));
  }
  sink(thickness);
}

/// Force of a pinch on layers that lie on each other against the integral of the law of one fabric
/// as thick as all of them: the compression curves in series. Nothing else than for one layer.
void validateLayers(const material::Fabric& fabric, int layers, const Sink& sink) {
  HapticLoopSettings sample = tautLayers(fabric, layers, kRate);
  sample.fabric.friction = 1e-6;
  sample.haptics.refinement = 3;
  sample.radii = {{kIndexRadius, kIndexRadius}};
  HapticLoop loop(sample);
  material::Fabric thick = fabric;
  thick.compression->thickness *= layers;
  const contact::ContactLaw law(thick);
  Hand hand;
  const double half_cell = 0.5 * kSampleSide / 32.0;
  hand.middle = kMiddle + Vector3d(0.0, half_cell, half_cell);
  hand.thumb_radius = kIndexRadius;
  hand.gap = 2.0 * law.halfThickness() - 4e-4;
  const auto step = [&](const Fingertips& fingertips) { loop.step(fingertips); };
  for (int i = 1; i <= 5; ++i) {
    move(hand, Vector3d::Zero(), -4e-4, 0.02, 1e-3, step);
    move(hand, Vector3d::Zero(), 0.0, 0.3, 1e-3, step);
    const double exact = pinchForce(law, kIndexRadius, hand.gap + 2.0 * kIndexRadius).force;
    sink(base::relativeTo(exact,
                          "contact/pinched_layers/" + std::to_string(layers) + "/" +
                              std::to_string(4 * i + 4) + "e-4m",
                          exact, loop.layer().contacts()[Finger::kIndex].force.x(),
                          kLayersTolerance));
  }
}

/// Forces (N) at five depths, 1 to 5 mm.
std::vector<double> pressForces(const material::Fabric& fabric, int refinement) {
  HapticLoopSettings sample = tautSample(fabric, kStrain, kRate);
  sample.haptics.refinement = refinement;
  HapticLoop loop(sample);
  std::vector<double> forces;
  for (int i = 1; i <= 5; ++i) {
    pressAll(loop, {Press{kMiddle, 1.0}, std::nullopt}, (i - 1) * 1e-3, i * 1e-3);
    forces.push_back(loop.layer().contacts()[Finger::kIndex].force.x());
  }
  return forces;
}

void validateRefinement(const material::Fabric& fabric, const Sink& sink) {
  std::vector<std::vector<double>> forces;
  for (int refinement = 0; refinement <= 3; ++refinement) {
    forces.push_back(pressForces(fabric, refinement));
  }
  for (int i = 0; i < 5; ++i) {
    const std::string depth = std::to_string(i + 1) + "mm";
    for (int level = 0; level < 3; ++level) {
      sink(base::relativeTo(forces[3][i],
                            "contact/press/" + depth + "/level_" + std::to_string(level) + "_to_3",
                            forces[3][i], forces[level][i], level == 2 ? kLevelTolerance : 1.0));
    }
  }
}

}  // namespace

void validateContactTouch(const material::Fabric& fabric, const Sink& sink) {
  validateFree(fabric, sink);
  validateTwoPlaces(fabric, sink);
  validatePinch(fabric, sink);
  validateLayers(fabric, 2, sink);
  validateLayers(fabric, 3, sink);
  validateRefinement(fabric, sink);
}

}  // namespace haptex::oracles
