// The oracles of the models of stretch and shear that the membrane is compared with.
#include <algorithm>
#include <cmath>

#include "haptex/base/workload.h"
#include "haptex/cloth/dynamics/cloth.h"
#include "haptex/kes/virtual_test.h"
#include "haptex/material/strain_measures.h"
#include "haptex/oracles/checks/cloth_oracles.h"
#include "haptex/oracles/exact/elastica.h"
#include "haptex/oracles/experiments/hung_square.h"
#include "haptex/oracles/experiments/strip_statics.h"

namespace haptex::oracles {
namespace {

using cloth::Cloth;
using cloth::ClothState;
using cloth::Elasticity;
using Eigen::Vector2d;
using Eigen::Vector3d;
using material::Fabric;

constexpr double kModelTolerance = 1e-6;  // of the largest force of a test

Cloth clothOf(const mesh::ClothMesh& mesh, const Fabric& fabric, Elasticity elasticity,
              bool bending) {
  cloth::ModelledEffects effects;
  effects.elasticity = elasticity;
  effects.bending = bending;
  return {mesh, fabric, effects};
}

/// What the right and the upper side of a sheet in the plane pull at the rest by (N, along and
/// across themselves), in the stretches along weft and warp.
struct Pull {
  Vector2d right, top;
};
Pull pullOf(const Cloth& cloth, double weft_stretch, double warp_stretch) {
  ClothState state = cloth.initialState();
  for (std::size_t i = 0; i < cloth.particleCount(); ++i) {
    const Vector2d& rest = cloth.mesh().rest_coordinates[i];
    state.positions[i] = {0.0, weft_stretch * rest.x(), warp_stretch * rest.y()};
  }
  std::vector<Vector3d> forces;
  cloth.computeForces(state, forces);
  const auto sum = [&](mesh::Side side) {
    Vector2d pull = Vector2d::Zero();
    for (int particle : sideParticles(cloth.mesh(), side)) pull -= forces[particle].tail<2>();
    return pull;
  };
  return {sum(mesh::Side::kRight), sum(mesh::Side::kTop)};
}

/// A sheet of springs that is stretched along weft or warp and held across: along the stretch the
/// fabric's force; across it one that the fabric does not have, from the diagonals, which feel r e,
/// with r the ratio of a cell's sides.
void validateLatticeTension(const Fabric& fabric, double weft_strain, double warp_strain,
                            const Sink& sink) {
  constexpr double kWidth = 0.12, kHeight = 0.09, kRatio = 2.0 / 3.0;  // cells of 20 x 30 mm
  const Cloth cloth =
      clothOf(mesh::makeRectangle(kWidth, kHeight, 6, 3, mesh::Triangulation::kAlternating), fabric,
              Elasticity::kMassSpring, false);
  const std::string name = "cloth/mass_spring/";
  for (double part : {0.1, 0.5, 1.0}) {
    for (bool weft : {true, false}) {
      const double strain = part * (weft ? weft_strain : warp_strain);
      const double green = material::greenStrain(strain);
      const auto& curve = weft ? fabric.weft.elastic : fabric.warp.elastic;
      const Pull pull = weft ? pullOf(cloth, 1.0 + strain, 1.0) : pullOf(cloth, 1.0, 1.0 + strain);
      const std::string of = fabric.name + (weft ? "/weft/" : "/warp/") + numbered(strain);
      const double along =
          (weft ? kHeight : kWidth) * material::forcePerWidth(curve.evaluate(green).stress, green);
      sink(base::relativeTo(along, name + "tension_along/" + of, along,
                            weft ? pull.right.x() : pull.top.y(), kRounding));
      const double ratio = weft ? kRatio : 1.0 / kRatio;
      const double across =
          (weft ? kWidth : kHeight) * fabric.shear.elastic.evaluate(ratio * green).stress / ratio;
      sink(base::relativeTo(along, name + "tension_across/" + of, across,
                            weft ? pull.top.y() : pull.right.x(), kRounding));
    }
  }
}

/// Energy of one fold along warp over that of a hinge of linear bending: 2 sin^2(angle / 2).
void validateLatticeFold(const Fabric& fabric, const Sink& sink) {
  constexpr double kCell = 0.01;
  const Cloth cloth =
      clothOf(mesh::makeRectangle(4 * kCell, 3 * kCell, 4, 3, mesh::Triangulation::kAlternating),
              fabric, Elasticity::kMassSpring, true);
  for (int degrees : {10, 30, 90, 150}) {
    const double angle = M_PI / 180.0 * degrees;
    ClothState state = cloth.initialState();
    for (std::size_t i = 0; i < cloth.particleCount(); ++i) {
      const Vector2d& rest = cloth.mesh().rest_coordinates[i];
      const double before = std::min(rest.x() - 2 * kCell, 0.0);
      const double beyond = std::max(rest.x() - 2 * kCell, 0.0);
      state.positions[i] = {before + beyond * std::cos(angle), rest.y(), beyond * std::sin(angle)};
    }
    const double half = std::pow(std::sin(0.5 * angle), 2);
    const double hinge = 2.0 * fabric.bending->weft * 3.0 * half;
    sink(base::relativeTo(1.0,
                          "cloth/mass_spring/fold_energy/" + std::to_string(degrees) + "_degrees",
                          2.0 * half, cloth.potentialEnergy(state) / hinge, 1e-9));
  }
}

/// Cells of an irregular mesh pull as the fabric's curves say, with free sides.
void validateCellTension(const Fabric& fabric, double weft_strain, double warp_strain,
                         const Sink& sink) {
  for (kes::Direction direction : {kes::Direction::kWeft, kes::Direction::kWarp}) {
    const bool weft = direction == kes::Direction::kWeft;
    const double most = weft ? weft_strain : warp_strain;
    for (const kes::Reading& reading : kes::tensileTest(
             fabric, direction, {0.1 * most, 0.5 * most, most}, Elasticity::kBilinear)) {
      sink(base::relativeTo(kes::exactTensileForce(fabric, direction, most),
                            "cloth/bilinear/tensile/" + fabric.name + (weft ? "/weft/" : "/warp/") +
                                numbered(reading.strain),
                            kes::exactTensileForce(fabric, direction, reading.strain),
                            reading.force, kModelTolerance));
    }
  }
}

/// Cantilevers of threads that hardly stretch, at 30 degrees to them: how much less they drop than
/// the elastica does. One has the moduli of wool, the other that of its warp in all directions.
void validateObliqueCells(const Sink& sink) {
  struct Threads {
    const char* name;
    double modulus, warp_over_weft, tolerance;
  };
  constexpr double kGamma = 10.0;
  const double exact = exactDropOverReach(kGamma);
  // N/m: 366 (weft) and 16 kN/m where B = 6.6e-6 N.m and L = 0.2 m
  for (const Threads& threads :
       {Threads{"wool/", 2.2e3, 45.0, 0.01}, Threads{"", 9.7e4, 1.0, 0.0125}}) {
    for (const unsigned seed : {1U, 2U}) {
      Cantilever cantilever{kGamma, StripMesh::kIrregular};
      cantilever.cells = 32;
      cantilever.across = 1.0;
      cantilever.grain = M_PI / 6.0;
      cantilever.seed = seed;
      cantilever.elasticity = Elasticity::kBilinear;
      cantilever.modulus = threads.modulus;
      cantilever.warp_over_weft = threads.warp_over_weft;
      sink(base::relativeTo(
          exact,
          std::string("cloth/bilinear/oblique_cantilever/") + threads.name + std::to_string(seed),
          exact, simulatedDropOverReach(cantilever), threads.tolerance));
    }
  }
}

/// Threads along a twisted strip are stretched by a parabola across it, which coarse cells have to
/// carry. The exact torque is what triangles and cells come to as they are refined: 85.8 and
/// 84.9 mN.m (docs/mechanics.md, Locking).
void validateTwistOfCells(const Fabric& wool, const Sink& sink) {
  constexpr double kTorque = 0.0854;  // N.m
  for (const auto& [cells, tolerance] : {std::pair(16, 0.1), std::pair(32, 0.05)}) {
    for (const auto& [triangulation, cut] :
         {std::pair(mesh::Triangulation::kOneWay, "one_way/"),
          std::pair(mesh::Triangulation::kAlternating, "alternating/")}) {
      sink(base::relativeTo(
          kTorque, std::string("cloth/bilinear/twist/") + cut + std::to_string(cells), kTorque,
          simulatedTwistTorque(wool, Elasticity::kBilinear, triangulation, cells, 0.5 * M_PI),
          tolerance));
    }
  }
}

/// However cells are cut, what hangs obliquely to its threads rests in the same places.
void validateCutsOfCells(const Fabric& wool, const Sink& sink) {
  constexpr double kApart = 1e-3;  // m
  const CutDifference difference = differenceOfCuts(wool, Elasticity::kBilinear, 32);
  sink(base::relativeTo(1.0, "cloth/bilinear/hung/cuts_apart", 0.0, difference.apart, kApart));
}

/// Width times modulus times engineering strain, on an irregular mesh.
void validateCorotationalTension(const Fabric& fabric, double weft_strain, double warp_strain,
                                 const Sink& sink) {
  for (kes::Direction direction : {kes::Direction::kWeft, kes::Direction::kWarp}) {
    const bool weft = direction == kes::Direction::kWeft;
    const double most = weft ? weft_strain : warp_strain;
    const double modulus = (weft ? fabric.weft.elastic : fabric.warp.elastic).evaluate(0.0).slope;
    const std::vector<kes::Reading> readings = kes::tensileTest(
        fabric, direction, {0.1 * most, 0.5 * most, most}, Elasticity::kCorotational);
    for (const kes::Reading& reading : readings) {
      sink(base::relativeTo(kes::kSampleWidth * modulus * most,
                            "cloth/corotational/tensile/" + fabric.name +
                                (weft ? "/weft/" : "/warp/") + numbered(reading.strain),
                            kes::kSampleWidth * modulus * reading.strain, reading.force,
                            kModelTolerance));
    }
  }
}

}  // namespace

void validateModels(const Fabric& linear, const Fabric& wool, const Sink& sink) {
  validateLatticeTension(linear, 0.5, 0.5, sink);
  validateLatticeTension(wool, 0.1, 0.01, sink);
  validateLatticeFold(wool, sink);
  validateCellTension(linear, 0.5, 0.5, sink);
  validateCellTension(wool, 0.1, 0.01, sink);
  if (!base::kSanitized) {
    validateObliqueCells(sink);
    validateTwistOfCells(wool, sink);
    validateCutsOfCells(wool, sink);
  }
  validateCorotationalTension(linear, 0.5, 0.5, sink);
  validateCorotationalTension(wool, 0.1, 0.01, sink);
  Eigen::Matrix2d tension, compression, shear;
  tension << 1.05, 0.0, 0.0, 1.008;
  compression << 0.7, 0.0, 0.0, 0.8;
  shear << 1.0, 0.1, 0.0, 1.0;
  for (const auto& [elasticity, name] :
       {std::pair<Elasticity, std::string>(Elasticity::kBilinear, "bilinear/"),
        {Elasticity::kMassSpring, "mass_spring/"},
        {Elasticity::kCorotational, "corotational/"}}) {
    validateJacobian(wool, elasticity, name + "tension", tension, sink);
    validateJacobian(wool, elasticity, name + "compression", compression, sink);
    validateJacobian(wool, elasticity, name + "shear", shear, sink);
  }
}

}  // namespace haptex::oracles
