#include <algorithm>
#include <cmath>

#include "haptex/oracles/checks/contact_oracles.h"
#include "haptex/oracles/exact/flat_contact.h"
#include "haptex/oracles/exact/pinched_sheet.h"
#include "haptex/oracles/experiments/contact_scenes.h"

namespace haptex::oracles {
namespace {

using base::Finger;
using contact::Fingertip;
using contact::SphereContact;
using Eigen::Vector3d;

constexpr double kFrictionTolerance = 0.02;
constexpr double kDriftTolerance = 1e-6;  // m

/// Both fingertips pinch a taut sample and are drawn over it to and fro: when all slips, the force
/// along the way is the coefficient of friction times the normal force.
void validateSlip(const material::Fabric& fabric, const Sink& sink) {
  constexpr double kSpeed = 0.01;  // m/s
  constexpr double kStart = 2e-3;  // m: then all slips
  // Two cells of the mesh, after which the pattern of particles under the fingertips repeats: what
  // the particles store in their dents and give back is zero on average.
  constexpr double kPeriod = 2.0 * kSampleSide / 32.0;  // m
  for (double closing : {0.4e-3, 0.8e-3, 1.2e-3}) {
    HapticLoop loop(tautSample(fabric, 0.005, 80.0));
    const double thickness = 2.0 * loop.layer().law().halfThickness();
    Hand hand;
    hand.middle.z() = -0.5 * kSampleSide;
    hand.gap = thickness;
    const auto step = [&](const Fingertips& fingertips) { loop.step(fingertips); };
    move(hand, kStill, -closing, 0.2, 1e-3, step);
    move(hand, kStill, 0.0, 0.2, 1e-3, step);
    for (double sense : {1.0, -1.0}) {
      double along = 0.0, normal = 0.0;
      int ticks = 0;
      const Vector3d way(0.0, 0.0, sense * (kStart + kPeriod));
      move(hand, way, 0.0, way.norm() / kSpeed, 1e-3, [&](const Fingertips& fingertips) {
        loop.step(fingertips);
        if (++ticks * 1e-3 * kSpeed <= kStart) return;
        along -= sense * forceOnFingertips(loop.layer()).z();
        for (const auto& contact : loop.layer().contacts().values)
          normal += std::abs(contact.force.x());
      });
      sink(base::relativeTo(*fabric.friction,
                            "contact/friction/slip/" + std::to_string(std::lround(closing * 1e5)) +
                                (sense > 0.0 ? "e-5m/up" : "e-5m/down"),
                            *fabric.friction, along / normal, kFrictionTolerance));
    }
  }
}

/// A fingertip on a sheet that does not yield, drawn sideways: sticks, slips from the rim inwards,
/// slips.
void validateStick(const material::Fabric& fabric, const Sink& sink) {
  constexpr double kDepth = 5e-5;  // m, so shallow that normals stay within 7 degrees
  const contact::ContactLaw law(fabric);
  const FlatSheet sheet(1.5e-3, 120);
  SphereContact contact(law, sheet.positions.size());
  Fingertip fingertip;
  fingertip.radius = kIndexRadius;
  fingertip.position.x() = kIndexRadius + law.halfThickness() - kDepth;
  contact.commit(sheet.particles(), fingertip);
  const double full = exactDrag(law, kIndexRadius, kDepth, 1.0);
  // The displacement at which even the middle slips.
  const double slip = law.friction() * law.pressure(kDepth).stress / law.tangentialStiffness();
  for (int i = 1; i <= 6; ++i) {
    const double displacement = 0.2 * i * slip;
    fingertip.position.y() = displacement;
    double force = 0.0;
    for (const auto& touched : contact.commit(sheet.particles(), fingertip)) {
      force += touched.friction.y();
    }
    sink(base::relativeTo(
        full, "contact/friction/stick/" + std::to_string(20 * i) + "percent_of_slip",
        exactDrag(law, kIndexRadius, kDepth, displacement), force, kFrictionTolerance));
  }
}

/// Below the limit nothing creeps: the cloth under the fingertips stays where it is for 2 s.
void validateDrift(const material::Fabric& fabric, const Sink& sink) {
  HapticLoop loop(tautSample(fabric, 0.005, 80.0));
  Hand hand;
  hand.middle.z() = -0.5 * kSampleSide;
  hand.gap = 2.0 * loop.layer().law().halfThickness();
  const auto step = [&](const Fingertips& fingertips) { loop.step(fingertips); };
  move(hand, kStill, -1.2e-3, 0.2, 1e-3, step);
  // Force grows with the displacement until it slips; this takes the fingertips half the way.
  move(hand, {0.0, 0.0, 5e-5}, 0.0, 0.1, 1e-3, step);
  move(hand, kStill, 0.0, 1.0, 1e-3, step);
  const double before = forceOnFingertips(loop.layer()).z();
  const Eigen::Vector2d place = loop.layer().contacts()[Finger::kIndex].fabric_position;
  move(hand, kStill, 0.0, 2.0, 1e-3, step);
  const double drift = (loop.layer().contacts()[Finger::kIndex].fabric_position - place).norm();
  sink({"contact/friction/drift_m", 0.0, drift, drift, kDriftTolerance});
  const double after = forceOnFingertips(loop.layer()).z();
  sink(base::relativeTo(before, "contact/friction/held_N", before, after, 0.01));
}

}  // namespace

void validateContactFriction(const material::Fabric& fabric, const Sink& sink) {
  validateStick(fabric, sink);
  validateSlip(fabric, sink);
  validateDrift(fabric, sink);
}

}  // namespace haptex::oracles
