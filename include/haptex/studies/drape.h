// Virtual drape test: a disc of fabric clamped over a smaller one, brought down to hang by itself.
#pragma once

#include "haptex/material/fabric.h"
#include "haptex/mesh/mesh.h"

namespace haptex::studies {

/// How the fabric comes down from flat.
enum class Descent {
  kByWeight,  ///< it is carried everywhere, by less and less of its weight, as by hands or by air
  kOnPlane,   ///< it lies on a plane around the support that goes down, without friction
};

/// Drapemeter after Cusick: the fabric is clamped between two horizontal discs, and what is beyond
/// them comes down slowly.
///
/// The motion is overdamped, so that the fabric goes from equilibrium to equilibrium and falls only
/// where there is none near: every particle moves at F / (m damping), F the sum of gravity,
/// elasticity, the friction inside of the fabric (2HB) and contact. Where it ends does not depend
/// on inertia or air. It does depend on the way, because there are many equilibria and because
/// friction remembers: hence Descent.
struct DrapeTest {
  double fabric_radius = 0.127;    ///< m
  double support_radius = 0.0635;  ///< m
  /// m, between the circles of particles (mesh::meshOfCircles()) on either side of the support's
  /// edge. The fabric bends there with a radius of a few millimetres, so cells are finest there and
  /// grow by a tenth of their distance from it.
  double cell = 2.2e-3;
  Descent descent = Descent::kByWeight;
  double lowering_time = 2.0;  ///< s, until nothing carries the fabric but the clamp
  double time_step = 0.01;     ///< s
  double damping = 10.0;       ///< 1/s: free fall is at 9.81 / damping m/s
  double rest_speed = 5e-4;    ///< m/s: done when the fastest particle is slower than that
  double most_time = 15.0;     ///< s, of lowering and settling
};

struct DrapeOutcome {
  double coefficient;  ///< drapeCoefficient()
  int nodes;           ///< folds: maxima of the shadow's edge
  double energy;       ///< J, gravity's from the height of the support, and what the fabric holds
  double time;         ///< s, until the fabric was at rest
  double fastest;      ///< m/s, at the end
  int inside_support;  ///< particles below the top of the support and nearer than its edge
  mesh::ClothMesh shape;  ///< as draped
};

/// Drapes a disc of fabric. Starts differ as those of a careful person do: how the mesh lies in the
/// fabric, the disc off centre by up to 1 mm along x and along y, and not flat by waves of orders 1
/// to 12 around the rim of up to 0.2 mm each. The same seed is the same start on every mesh.
///
/// Folds do not touch each other. The support is a solid cylinder that goes all the way down. Plane
/// and cylinder are without friction.
///
/// Only what is beyond the support is simulated, as cells of two triangles (Elasticity::kBilinear).
/// Threads are as stiff as the fabric's, but only so stiff that its own weight stretches them by
/// 0.01 % (docs/mechanics.md, Drape, what stiffer ones change).
/// @throws std::invalid_argument if the fabric has no bending rigidity, a number of the test is not
///   finite and > 0, the support is not smaller than the fabric, or the cell not smaller than the
///   ring between them or not smaller than twice the support
/// @throws std::runtime_error if a step is not finite
DrapeOutcome drape(const material::Fabric& fabric, const DrapeTest& test, unsigned seed);

}  // namespace haptex::studies
