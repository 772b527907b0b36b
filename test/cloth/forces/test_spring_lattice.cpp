// What tells the spring lattice from the membrane; what both promise is in test_elasticity.cpp.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <stdexcept>

#include "elasticity_fixtures.h"
#include "force_fixtures.h"
#include "haptex/cloth/dynamics/cloth.h"

namespace haptex::cloth::test_spring_lattice {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

Cloth latticeCloth(const mesh::ClothMesh& mesh, const material::Fabric& fabric,
                   bool bending = false) {
  return Cloth(mesh, fabric, effectsOf(Elasticity::kMassSpring, false, bending));
}

/// Force (N) across a cut of a sheet in the deformation U, V, by which the halves of the sheet pull
/// on each other along `axis` (1 weft, 2 warp): half of all forces, as they balance.
Vector2d pullOf(const Cloth& cloth, const Eigen::Matrix2d& deformation, int side_axis) {
  ClothState state = cloth.initialState();
  for (std::size_t i = 0; i < cloth.particleCount(); ++i) {
    state.positions[i] << 0.0, deformation * cloth.mesh().rest_coordinates[i];
  }
  const std::vector<Vector3d> forces = forcesOf(cloth, state);
  const mesh::Side side = side_axis == 0 ? mesh::Side::kRight : mesh::Side::kTop;
  Vector2d pull = Vector2d::Zero();
  for (int particle : mesh::sideParticles(cloth.mesh(), side)) pull -= forces[particle].tail<2>();
  return pull;
}

TEST(SpringLattice, StretchedAndHeldAcrossItPullsAsTheFabricsCurvesSay) {
  const material::Fabric fabric = stiffeningFabric();
  const Cloth cloth =
      latticeCloth(mesh::makeRectangle(0.06, 0.12, 3, 4, mesh::Triangulation::kOneWay), fabric);
  for (double stretch : {0.9, 1.02, 1.1}) {
    const double strain = 0.5 * (stretch * stretch - 1.0);
    Eigen::Matrix2d weft = Eigen::Matrix2d::Identity(), warp = weft;
    weft(0, 0) = warp(1, 1) = stretch;
    const double exact_weft = 0.12 * stretch * fabric.weft.elastic.evaluate(strain).stress;
    const double exact_warp = 0.06 * stretch * fabric.warp.elastic.evaluate(strain).stress;
    EXPECT_NEAR(pullOf(cloth, weft, 0).x(), exact_weft, 1e-12 * std::abs(exact_weft));
    EXPECT_NEAR(pullOf(cloth, warp, 1).y(), exact_warp, 1e-12 * std::abs(exact_warp));
  }
}

TEST(SpringLattice, TheDiagonalsPullAcrossByTheShearCurve) {
  // Cells of 20 x 30 mm: stretching weft by e strains the shear curve by r e, r = 20 / 30, and the
  // warp direction is pulled by fs(r e) / r. The fabric itself has no such force: the defect.
  const material::Fabric fabric = stiffeningFabric();
  const Cloth cloth =
      latticeCloth(mesh::makeRectangle(0.06, 0.12, 3, 4, mesh::Triangulation::kOneWay), fabric);
  const double ratio = 0.02 / 0.03, strain = 0.5 * (1.1 * 1.1 - 1.0);
  Eigen::Matrix2d weft = Eigen::Matrix2d::Identity();
  weft(0, 0) = 1.1;
  const double exact = 0.06 * fabric.shear.elastic.evaluate(ratio * strain).stress / ratio;
  EXPECT_GT(exact, 0.0);
  EXPECT_NEAR(pullOf(cloth, weft, 1).y(), exact, 1e-12 * exact);
}

TEST(SpringLattice, ShearOfCellsWhoseSidesKeepTheirLengthFollowsTheShearCurve) {
  material::Fabric fabric = stiffeningFabric();
  // Not alike to both sides, as a twill's.
  fabric.shear.elastic = material::StrainStressCurve::fit(
      {{-0.5, -40.0}, {-0.2, -10.0}, {0.2, 5.0}, {0.5, 60.0}}, material::NegativeBranch::kLinear);
  const Cloth cloth =
      latticeCloth(mesh::makeRectangle(0.06, 0.12, 3, 4, mesh::Triangulation::kOneWay), fabric);
  for (double angle : {-0.4, -0.1, 0.1, 0.4}) {
    ClothState state = cloth.initialState();
    for (std::size_t i = 0; i < cloth.particleCount(); ++i) {
      const Vector2d& rest = cloth.mesh().rest_coordinates[i];
      state.positions[i] << 0.0, rest.x() + std::sin(angle) * rest.y(), std::cos(angle) * rest.y();
    }
    const double exact = 0.06 * 0.12 * fabric.shear.elastic.energy(std::sin(angle));
    EXPECT_NEAR(cloth.potentialEnergy(state), exact, 1e-12 * exact);
  }
}

TEST(SpringLattice, AFoldCostsWhatTheRigidityAsksAtARightAngleAndTooLittleBelow) {
  // One fold in the middle of a sheet of 4 x 3 cells: a hinge of the width of the sheet, whose
  // energy is 2 B width / cell sin^2(angle / 2) (Volino and Magnenat-Thalmann 2006).
  constexpr double kCell = 0.01, kWidth = 0.03;
  const material::Fabric fabric = fabricWithRigidity();
  const Cloth cloth = latticeCloth(
      mesh::makeRectangle(0.04, kWidth, 4, 3, mesh::Triangulation::kAlternating), fabric, true);
  for (double angle : {0.1, 0.5, 0.5 * M_PI, 2.0}) {
    ClothState state = cloth.initialState();
    for (std::size_t i = 0; i < cloth.particleCount(); ++i) {
      const Vector2d& rest = cloth.mesh().rest_coordinates[i];
      const double beyond = rest.x() - 0.02, turned = std::max(beyond, 0.0);
      state.positions[i] = {std::min(beyond, 0.0) + turned * std::cos(angle), rest.y(),
                            turned * std::sin(angle)};
    }
    const double half = std::pow(std::sin(0.5 * angle), 2);
    // The diagonals beside the fold keep their lengths: nothing but the bend springs is strained.
    const double asked = 2.0 * fabric.bending->weft * kWidth / kCell * half;
    EXPECT_NEAR(cloth.potentialEnergy(state), asked * 2.0 * half, 1e-12 * asked);
  }
}

TEST(SpringLattice, BendSpringsDoNotResistTension) {
  const Cloth with = latticeCloth(square(4), fabricWithRigidity(), true);
  const Cloth without = latticeCloth(square(4), fabricWithRigidity());
  ClothState state = with.initialState();
  for (Vector3d& position : state.positions) position *= 1.05;
  EXPECT_EQ(with.potentialEnergy(state), without.potentialEnergy(state));
  EXPECT_GT(with.forces().find<SpringLattice>()->springs().size(),
            without.forces().find<SpringLattice>()->springs().size());
}

TEST(SpringLattice, HasTheSpringsOfItsCellsWithTheirShares) {
  // Two cells side by side: their common side carries half of each, the others half of one.
  const auto springs =
      findLatticeSprings(mesh::makeRectangle(0.02, 0.03, 2, 1, mesh::Triangulation::kOneWay), true);
  std::map<LatticeSpring::Kind, int> count;
  std::map<LatticeSpring::Kind, double> area;
  for (const LatticeSpring& spring : springs) {
    EXPECT_LT(spring.first, spring.second);
    ++count[spring.kind];
    area[spring.kind] += spring.area;
  }
  using Kind = LatticeSpring::Kind;
  EXPECT_EQ(count[Kind::kWeft], 4);
  EXPECT_EQ(count[Kind::kWarp], 3);
  EXPECT_EQ(count[Kind::kShear], 4);
  EXPECT_EQ(count[Kind::kWeftBend], 2);
  EXPECT_EQ(count[Kind::kWarpBend], 0);
  for (Kind kind : {Kind::kWeft, Kind::kWarp, Kind::kShear, Kind::kWeftBend}) {
    EXPECT_NEAR(area[kind], 0.02 * 0.03, 1e-15);
  }
}

TEST(SpringLattice, TakesCellsOfDifferentShape) {
  // Linear springs on unequal cells pass the patch test all the same.
  mesh::ClothMesh mesh = square(3);
  for (std::size_t i = 0; i < mesh.rest_coordinates.size(); ++i) {
    Vector2d& rest = mesh.rest_coordinates[i];
    rest = {rest.x() * (1.0 + 5.0 * rest.x()), rest.y() * (1.0 + 3.0 * rest.y())};
  }
  const Cloth cloth = latticeCloth(mesh, linearFabric());
  ClothState state = cloth.initialState();
  Eigen::Matrix<double, 3, 2> gradient;
  gradient << 0.2, -0.3, 1.2, 0.3, 0.1, 0.8;
  for (std::size_t i = 0; i < cloth.particleCount(); ++i) {
    state.positions[i] = gradient * mesh.rest_coordinates[i];
  }
  const std::vector<Vector3d> forces = forcesOf(cloth, state);
  for (int particle : {5, 6, 9, 10}) {
    EXPECT_LT(forces[particle].norm(), 1e-13 * largest(forces));
  }
}

void expectRefused(const mesh::ClothMesh& mesh, const std::string& triangle) {
  try {
    latticeCloth(mesh, linearFabric());
    FAIL() << "not refused";
  } catch (const std::invalid_argument& error) {
    EXPECT_EQ(error.what(),
              "a spring lattice needs a mesh of rectangles along weft and warp of two triangles "
              "each; triangle " +
                  triangle + " is not half of one");
  }
}

TEST(SpringLattice, RefusesOtherMeshesNamingATriangle) {
  mesh::ClothMesh oblique = square(2);
  oblique.rest_coordinates[4].x() += 1e-6;
  expectRefused(oblique, "0");
  mesh::ClothMesh turned = square(2);
  for (Vector2d& rest : turned.rest_coordinates) rest = Eigen::Rotation2Dd(0.3) * rest;
  expectRefused(turned, "0");
  mesh::ClothMesh half_a_cell = square(2);
  half_a_cell.triangles.pop_back();
  expectRefused(half_a_cell, "6");
}

TEST(SpringLattice, NeedsARigidityForBendSprings) {
  EXPECT_THROW(latticeCloth(square(2), linearFabric(), true), std::invalid_argument);
  Cloth cloth = latticeCloth(square(2), fabricWithRigidity(), true);
  EXPECT_THROW(cloth.setFabric(linearFabric()), std::invalid_argument);
  EXPECT_EQ(cloth.forces().find<Bending>(), nullptr);
}

}  // namespace
}  // namespace haptex::cloth::test_spring_lattice
