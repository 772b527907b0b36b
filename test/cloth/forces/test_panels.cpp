// Panels that are sewn together, against sheets in one piece.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "derivatives.h"
#include "fixtures.h"
#include "haptex/cloth/dynamics/integrator.h"
#include "haptex/mesh/seam.h"
#include "self_contact_fixtures.h"

namespace haptex::cloth::test_panels {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// The square cut along its middle line: the right half lies elsewhere on its fabric, turned, which
/// its grain takes back.
mesh::ClothMesh sewnSquare(int cells, int right_fabric = 0, double turn = 0.7, double size = 0.1) {
  mesh::ClothMesh mesh = square(cells, size);
  mesh.panels = {{0, 0.0}, {right_fabric, turn}};
  const double middle = 0.5 * mesh.rest_coordinates.back().x();
  const Eigen::Rotation2Dd turned(turn);
  for (const std::array<int, 3>& triangle : mesh.triangles) {
    std::array<Vector2d, 3> corners;
    double u = 0.0;
    for (int i = 0; i < 3; ++i) {
      corners[i] = mesh.rest_coordinates[triangle[i]];
      u += corners[i].x() / 3.0;
    }
    const bool right = u > middle;
    for (Vector2d& corner : corners) {
      if (right) corner = turned * (corner + Vector2d(0.3, -0.1));
    }
    mesh.triangle_panels.push_back(right ? 1 : 0);
    mesh.corner_coordinates.push_back(corners);
  }
  return mesh;
}

class SewnCloth : public testing::TestWithParam<Elasticity> {};
INSTANTIATE_TEST_SUITE_P(Elasticity, SewnCloth,
                         testing::Values(Elasticity::kGreenLagrange, Elasticity::kBilinear,
                                         Elasticity::kCorotational));

TEST_P(SewnCloth, OfOneFabricIsTheSheetInOnePiece) {
  ModelledEffects effects;
  effects.viscosity = true;
  effects.gravity = {0.0, 0.0, -9.8};
  effects.elasticity = GetParam();
  effects.air = Air{};
  const Cloth sheet(square(4), stiffeningFabric(), effects);
  const Cloth sewn(sewnSquare(4), stiffeningFabric(), effects);
  const ClothState state = randomState(sheet, 0.003, 1.0, 3);
  std::vector<Vector3d> whole, parts;
  sheet.computeForces(state, whole);
  sewn.computeForces(state, parts);
  double scale = 0.0;
  for (const Vector3d& force : whole) scale = std::max(scale, force.norm());
  for (std::size_t i = 0; i < whole.size(); ++i) {
    EXPECT_LT((whole[i] - parts[i]).norm(), 1e-12 * scale);
    // The coordinates on the right are 20 times a cell away from the origin.
    EXPECT_NEAR(sheet.masses()[i], sewn.masses()[i], 1e-13 * sheet.masses()[i]);
  }
  EXPECT_NEAR(sheet.potentialEnergy(state), sewn.potentialEnergy(state),
              1e-12 * std::abs(sheet.potentialEnergy(state)));
}

TEST_P(SewnCloth, StepsAsTheSheetInOnePiece) {
  ModelledEffects effects;
  effects.gravity = {0.0, 0.0, -9.8};
  effects.elasticity = GetParam();
  StepSettings settings;
  settings.newton_iterations = 3;
  settings.tolerance = 1e-12;
  std::vector<ClothState> ends;
  for (const mesh::ClothMesh& mesh : {square(4), sewnSquare(4)}) {
    Cloth cloth(mesh, stiffeningFabric(), effects);
    ClothState state = cloth.initialState();
    for (const int particle : mesh::sideParticles(mesh, mesh::Side::kTop)) {
      cloth.attach(particle, {state.positions[particle]});
    }
    Integrator integrator(cloth, settings);
    for (int i = 0; i < 20; ++i) ASSERT_TRUE(integrator.step(cloth, state, 0.01).accepted);
    ends.push_back(state);
  }
  for (std::size_t i = 0; i < ends[0].positions.size(); ++i) {
    EXPECT_LT((ends[0].positions[i] - ends[1].positions[i]).norm(), 1e-9);
  }
}

TEST(Panels, OfTwoFabricsInSeriesCarryTheSameForce) {
  // Linear in Green strain and stretched along weft: P(l) = k l (l^2 - 1) / 2.
  material::Fabric soft = linearFabric(), stiff = linearFabric();
  soft.weft.elastic = material::StrainStressCurve::linear(100.0);
  stiff.weft.elastic = material::StrainStressCurve::linear(400.0);
  const Cloth cloth(sewnSquare(4, 1), {soft, stiff}, {});
  const double stretch = 1.05;
  const double force = 100.0 * stretch * (stretch * stretch - 1.0) / 2.0;
  double other = 1.0;
  for (int i = 0; i < 20; ++i) {
    other -=
        (200.0 * other * (other * other - 1.0) - force) / (200.0 * (3.0 * other * other - 1.0));
  }
  ClothState state = cloth.initialState();
  const double side = cloth.mesh().rest_coordinates.back().x();
  double seam_length = 0.0;
  for (std::size_t i = 0; i < state.positions.size(); ++i) {
    const Vector2d& rest = cloth.mesh().rest_coordinates[i];
    const double left = std::min(rest.x(), 0.5 * side), right = rest.x() - left;
    state.positions[i] = {0.0, stretch * left + other * right, rest.y()};
    seam_length = std::max(seam_length, rest.y());
  }
  std::vector<Vector3d> forces;
  cloth.computeForces(state, forces);
  double pull = 0.0;
  for (std::size_t i = 0; i < forces.size(); ++i) {
    const double u = cloth.mesh().rest_coordinates[i].x();
    if (u == 0.0) pull += forces[i].y();
    if (u == 0.0 || u > 0.999 * side) continue;
    EXPECT_NEAR(forces[i].y(), 0.0, 1e-12);
  }
  EXPECT_NEAR(pull, force * seam_length, 1e-12);
}

TEST(Panels, WeighWhatTheirFabricsWeigh) {
  material::Fabric light = linearFabric(), heavy = linearFabric();
  heavy.areal_density = 3.0 * light.areal_density;
  const Cloth cloth(sewnSquare(4, 1), {light, heavy}, {});
  double mass = 0.0;
  for (const double particle : cloth.masses()) mass += particle;
  const double area = std::pow(cloth.mesh().rest_coordinates.back().x(), 2);
  EXPECT_NEAR(mass, 2.0 * light.areal_density * area, 1e-12);
}

TEST(Panels, BendEachByItself) {
  material::Fabric fabric = linearFabric();
  fabric.bending = {1e-5, 2e-5};
  fabric.bending_hysteresis = {1e-3, 1e-3};
  ModelledEffects effects;
  effects.bending = effects.bending_hysteresis = true;
  const Cloth cloth(sewnSquare(6), fabric, effects);
  ClothState state = cloth.initialState();
  const double flat = cloth.potentialEnergy(state);
  // Folded along the seam: nothing is bent inside of the panels.
  const double middle = state.positions[3].y();
  for (Vector3d& position : state.positions) {
    if (position.y() > middle) position = {position.y() - middle, middle, position.z()};
  }
  EXPECT_NEAR(cloth.potentialEnergy(state), flat, 1e-15);
  // Rolled, with friction on the way: forces are the gradient of the energy.
  state = randomState(cloth, 0.002, 0.0, 5);
  cloth.forget(state);
  for (std::size_t i = 0; i < state.positions.size(); ++i) {
    state.positions[i].x() += 1e-4 * std::sin(3.0 * static_cast<double>(i));
  }
  expectExactDerivatives(cloth, state, {0, 3, 24, 30});
}

TEST(Panels, ThatCannotBeModelledAreRefused) {
  ModelledEffects effects;
  EXPECT_THROW(Cloth(sewnSquare(2, 1), linearFabric(), effects), std::invalid_argument);
  effects.elasticity = Elasticity::kMassSpring;
  EXPECT_THROW(Cloth(sewnSquare(2), linearFabric(), effects), std::invalid_argument);
}

/// Rolled up about an axis along warp, layers half a thickness apart.
ClothState rolledUp(const Cloth& cloth) {
  ClothState state = cloth.initialState();
  const double pitch = 0.5 * cloth.selfContact()->layers().law(0).thickness() / (2.0 * M_PI);
  for (std::size_t i = 0; i < state.positions.size(); ++i) {
    const Vector2d& rest = cloth.mesh().rest_coordinates[i];
    const double radius = 0.002, angle = rest.x() / radius;
    const double at = radius + pitch * angle;
    state.positions[i] = {at * std::cos(angle), at * std::sin(angle), rest.y()};
    state.velocities[i] = {0.1 * rest.x(), -0.2 * rest.y(), 0.3 * rest.x()};
  }
  return state;
}

TEST(Panels, TouchEachOtherAsTheSheetInOnePieceTouchesItself) {
  const Cloth sheet(square(30), fabricNamed("wool"), selfCollision());
  const Cloth sewn(sewnSquare(30), fabricNamed("wool"), selfCollision());
  const ClothState state = rolledUp(sheet);
  const double energy = sheet.selfContact()->energy(state.ofForces());
  ASSERT_GT(energy, 0.0);
  EXPECT_NEAR(sewn.selfContact()->energy(state.ofForces()), energy, 1e-12 * energy);
  const std::vector<Vector3d> whole = contactForces(sheet, state);
  const std::vector<Vector3d> parts = contactForces(sewn, state);
  double scale = 0.0;
  for (const Vector3d& force : whole) scale = std::max(scale, force.norm());
  for (std::size_t i = 0; i < whole.size(); ++i) {
    EXPECT_LT((whole[i] - parts[i]).norm(), 1e-11 * scale);
  }
}

TEST(Panels, ThatCollideHaveTrianglesLargerThanTheirThickness) {
  EXPECT_NO_THROW(Cloth(square(4, 0.001), fabricNamed("wool"), selfCollision()));
  try {
    Cloth(sewnSquare(4, 0, 0.7, 0.001), fabricNamed("wool"), selfCollision());
    FAIL() << "not refused";
  } catch (const std::invalid_argument& refusal) {
    EXPECT_NE(std::string(refusal.what()).find("the shortest altitude of a triangle is"),
              std::string::npos)
        << refusal.what();
    EXPECT_NE(std::string(refusal.what()).find("allowed are longer edges"), std::string::npos);
  }
}

/// A square with a slit from the middle of its top to its middle, and the seam that closes it. The
/// right side of the slit lies a little to the right on the fabric.
mesh::ClothMesh slitSquare(mesh::Seam& seam) {
  constexpr int kCells = 6;
  mesh::ClothMesh mesh = square(kCells);
  const auto particle = [](int column, int row) { return row * (kCells + 1) + column; };
  seam.first = seam.second = {particle(kCells / 2, kCells / 2)};
  for (int row = kCells / 2 + 1; row <= kCells; ++row) {
    const int left = particle(kCells / 2, row);
    const int right = static_cast<int>(mesh.rest_coordinates.size());
    mesh.rest_coordinates.push_back(mesh.rest_coordinates[left] + Vector2d(0.001, 0.0));
    mesh.initial_positions.push_back(mesh.initial_positions[left]);
    seam.first.push_back(left);
    seam.second.push_back(right);
    for (std::array<int, 3>& triangle : mesh.triangles) {
      double column = 0.0;
      for (const int corner : triangle) {
        column += corner < (kCells + 1) * (kCells + 1) ? corner % (kCells + 1) : 0.5 * kCells;
      }
      if (column / 3.0 <= kCells / 2) continue;
      std::replace(triangle.begin(), triangle.end(), left, right);
    }
  }
  for (std::size_t i = 0; i < seam.first.size(); ++i) {
    seam.first_places.push_back(static_cast<double>(i) / (kCells / 2));
  }
  seam.second_places = seam.first_places;
  return mesh;
}

TEST(Panels, WithAMergedDartBendAsTheyDoUnsewn) {
  material::Fabric fabric = linearFabric();
  fabric.bending = {1e-5, 2e-5};
  ModelledEffects effects;
  effects.bending = true;
  mesh::Seam seam;
  const mesh::ClothMesh open = slitSquare(seam);
  const mesh::MergedMesh merged = mesh::merge(open, {seam});
  mesh::ClothMesh without_hinges = merged.mesh;
  without_hinges.seam_hinges.clear();
  const Cloth sewn(without_hinges, fabric, effects), unsewn(open, fabric, effects);
  const ClothState state = randomState(sewn, 0.003, 1.0, 3);
  ClothState apart = unsewn.initialState();
  for (std::size_t i = 0; i < apart.positions.size(); ++i) {
    apart.positions[i] = state.positions[merged.particles[i]];
    apart.velocities[i] = state.velocities[merged.particles[i]];
  }
  std::vector<Vector3d> forces, parts, sums(sewn.particleCount(), Vector3d::Zero());
  sewn.computeForces(state, forces);
  unsewn.computeForces(apart, parts);
  for (std::size_t i = 0; i < parts.size(); ++i) sums[merged.particles[i]] += parts[i];
  double scale = 0.0;
  for (const Vector3d& force : forces) scale = std::max(scale, force.norm());
  for (std::size_t i = 0; i < sums.size(); ++i) {
    EXPECT_LT((sums[i] - forces[i]).norm(), 1e-12 * scale);
  }
  EXPECT_NEAR(sewn.potentialEnergy(state), unsewn.potentialEnergy(apart),
              1e-12 * sewn.potentialEnergy(state));
  StepSettings settings;
  settings.tolerance = 1e-12;
  Cloth stepped(without_hinges, fabric, effects);
  ClothState end = state;
  Integrator integrator(stepped, settings);
  EXPECT_TRUE(integrator.step(stepped, end, 1e-3).accepted);
}

}  // namespace
}  // namespace haptex::cloth::test_panels
