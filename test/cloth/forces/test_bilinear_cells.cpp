// What tells cells of two triangles from the membrane; what both promise is in test_elasticity.cpp.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <functional>
#include <set>

#include "elasticity_fixtures.h"
#include "haptex/cloth/dynamics/cloth.h"
#include "haptex/cloth/forces/cells/bilinear_cells.h"

namespace haptex::cloth::test_bilinear_cells {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using mesh::Triangulation;

constexpr double kSide = 0.08;
constexpr int kCells = 8;

mesh::ClothMesh grid(Triangulation triangulation) {
  return mesh::makeRectangle(kSide, kSide, kCells, kCells, triangulation);
}

/// The grid's particles shifted, but for those on its border; and its threads turned against it.
mesh::ClothMesh irregular() {
  mesh::ClothMesh mesh = grid(Triangulation::kAlternating);
  for (std::size_t i = 0; i < mesh.rest_coordinates.size(); ++i) {
    Vector2d& rest = mesh.rest_coordinates[i];
    if (std::min(rest.minCoeff(), kSide - rest.maxCoeff()) < 1e-9) continue;
    const double angle = static_cast<double>(i);
    rest += 0.0025 * Vector2d(std::sin(1.7 * angle), std::cos(2.9 * angle));
  }
  mesh.panels = {{0, 0.4}};
  return mesh;
}

Cloth clothOf(const mesh::ClothMesh& mesh, Elasticity elasticity) {
  return Cloth(mesh, stiffeningFabric(), effectsOf(elasticity));
}

ClothState placed(const Cloth& cloth, const std::function<Vector3d(const Vector2d&)>& place) {
  ClothState state = cloth.initialState();
  for (std::size_t i = 0; i < cloth.particleCount(); ++i) {
    state.positions[i] = place(cloth.mesh().rest_coordinates[i]);
  }
  return state;
}

TEST(TrianglePairs, OfAGridAreItsCellsHoweverTheyAreCut) {
  for (const Triangulation triangulation : {Triangulation::kOneWay, Triangulation::kAlternating}) {
    const PairedTriangles found = pairTriangles(grid(triangulation), 0);
    EXPECT_TRUE(found.single.empty());
    ASSERT_EQ(found.pairs.size(), std::size_t{kCells * kCells});
    for (const TrianglePair& pair : found.pairs) {
      Vector2d low = pair.rest[0], high = pair.rest[0];
      for (const Vector2d& corner : pair.rest) {
        low = low.cwiseMin(corner);
        high = high.cwiseMax(corner);
      }
      EXPECT_NEAR((high - low).x(), kSide / kCells, 1e-15);
      EXPECT_NEAR((high - low).y(), kSide / kCells, 1e-15);
    }
  }
}

TEST(TrianglePairs, TakeEveryTriangleOnceAndMakeConvexCells) {
  const mesh::ClothMesh mesh = irregular();
  const PairedTriangles found = pairTriangles(mesh, 0);
  std::multiset<int> taken(found.single.begin(), found.single.end());
  for (const TrianglePair& pair : found.pairs) {
    taken.insert(pair.triangles.begin(), pair.triangles.end());
    const auto turn = [&](int a, int b, int c) {
      const Vector2d in = pair.rest[b] - pair.rest[a], out = pair.rest[c] - pair.rest[b];
      return in.x() * out.y() - in.y() * out.x();
    };
    const double sense = turn(2, 0, 3);
    for (const double other : {turn(0, 3, 1), turn(3, 1, 2), turn(1, 2, 0)}) {
      EXPECT_GT(sense * other, 0.0);
    }
  }
  ASSERT_EQ(taken.size(), mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    EXPECT_EQ(taken.count(static_cast<int>(t)), 1U);
  }
  EXPECT_GT(2 * found.pairs.size(), mesh.triangles.size() / 2);
}

TEST(TrianglePairs, DoNotReachOverBordersOfFabricsOrPanels) {
  mesh::ClothMesh mesh = mesh::makeRectangle(0.02, 0.01, 2, 1, Triangulation::kOneWay);
  mesh.triangle_fabrics = {0, 1, 0, 0};
  EXPECT_EQ(pairTriangles(mesh, 0).pairs.size(), 1U);
  EXPECT_EQ(pairTriangles(mesh, 0).single, std::vector<int>({0}));
  EXPECT_EQ(pairTriangles(mesh, 1).single, std::vector<int>({1}));
  mesh.triangle_fabrics.clear();
  mesh.panels = {{}, {}};
  mesh.triangle_panels = {0, 1, 0, 0};
  const PairedTriangles found = pairTriangles(mesh, 0);
  EXPECT_EQ(found.pairs.size(), 1U);
  EXPECT_EQ(found.single, std::vector<int>({0, 1}));
}

// So virtual tensile and shear tests are exact, and the patch test passes, as with triangles.
TEST(BilinearCells, UnderAffineDeformationForcesAreThoseOfTriangles) {
  Eigen::Matrix<double, 3, 2> gradient;
  gradient << 0.2, -0.3, 1.1, 0.3, 0.1, 0.9;
  for (const mesh::ClothMesh& mesh : {grid(Triangulation::kOneWay), irregular()}) {
    const Cloth cells = clothOf(mesh, Elasticity::kBilinear);
    const Cloth triangles = clothOf(mesh, Elasticity::kGreenLagrange);
    const ClothState state =
        placed(cells, [&](const Vector2d& rest) -> Vector3d { return gradient * rest; });
    const std::vector<Vector3d> forces = forcesOf(cells, state);
    const std::vector<Vector3d> exact = forcesOf(triangles, state);
    for (std::size_t i = 0; i < forces.size(); ++i) {
      EXPECT_LT((forces[i] - exact[i]).norm(), 1e-12 * largest(exact));
    }
    EXPECT_NEAR(cells.potentialEnergy(state), triangles.potentialEnergy(state),
                1e-12 * triangles.potentialEnergy(state));
  }
}

const Eigen::Vector3d kModuli(400.0, 16000.0, 100.0);  // N/m

CellStrain strainOf(const BilinearCell& cell, const std::function<Vector3d(const Vector2d&)>& place,
                    const mesh::ClothMesh& mesh) {
  CellStrain squares;
  for (int e = 0; e < 6; ++e) {
    const auto [i, j] = kCellDistances[e];
    squares[e] = (place(mesh.rest_coordinates[cell.particles[i]]) -
                  place(mesh.rest_coordinates[cell.particles[j]]))
                     .squaredNorm();
  }
  return cell.by_squares * (squares - cell.rest_squares);
}

BilinearCell onlyCell(const mesh::ClothMesh& mesh) {
  return restCell(pairTriangles(mesh, 0).pairs.front(), kModuli);
}

// The bilinear map's strains of weft and warp at Gauss' points, and the mean of its shear.
TEST(BilinearCells, StrainsAlongThreadsAreThoseOfTheBilinearMapAtTwoPoints) {
  const mesh::ClothMesh mesh = mesh::makeRectangle(0.02, 0.03, 1, 1, Triangulation::kOneWay);
  constexpr double kIn = 4.0, kOut = 9.0;  // 1/m
  const CellStrain strain = strainOf(
      onlyCell(mesh),
      [&](const Vector2d& x) {
        return Vector3d(x.x() + kIn * x.x() * x.y(), x.y(), kOut * x.x() * x.y());
      },
      mesh);
  const auto weft = [&](double y) { return Vector3d(1.0 + kIn * y, 0.0, kOut * y); };
  const auto warp = [&](double x) { return Vector3d(kIn * x, 1.0, kOut * x); };
  const double low = 0.5 - std::sqrt(1.0 / 12.0), high = 0.5 + std::sqrt(1.0 / 12.0);
  const auto green = [](const Vector3d& of) { return 0.5 * (of.squaredNorm() - 1.0); };
  EXPECT_NEAR(std::min(strain[0], strain[3]), green(weft(0.03 * low)), 1e-14);
  EXPECT_NEAR(std::max(strain[0], strain[3]), green(weft(0.03 * high)), 1e-14);
  EXPECT_NEAR(std::min(strain[1], strain[4]), green(warp(0.02 * low)), 1e-14);
  EXPECT_NEAR(std::max(strain[1], strain[4]), green(warp(0.02 * high)), 1e-14);
  // The shear is bilinear in x and y: its mean is that of Gauss' four points.
  double shear = 0.0;
  for (const double s : {low, high}) {
    for (const double t : {low, high}) shear += 0.25 * weft(0.03 * t).dot(warp(0.02 * s));
  }
  EXPECT_NEAR(strain[2], shear, 1e-14);
  EXPECT_NEAR(strain[5], shear, 1e-14);
}

// In its plane a strip of one cell of linear threads at any angle, bent about its middle, stores
// what Young's modulus along its sides does under a strain that varies from -e to e.
TEST(BilinearCells, BentInTheirPlaneTheyResistByTheModulusAlongTheirSides) {
  constexpr double kSide = 0.02, kBend = 1e-7;
  for (const double grain : {0.0, 0.3, 0.7, 1.2}) {
    mesh::ClothMesh mesh = mesh::makeRectangle(kSide, kSide, 1, 1, Triangulation::kOneWay);
    mesh.panels = {{0, grain}};
    const TrianglePair pair = pairTriangles(mesh, 0).pairs.front();
    const CellStrain strain = strainOf(
        restCell(pair, kModuli),
        [&](const Vector2d& x) {
          const double sign = (x.x() > 0.5 * kSide) == (x.y() > 0.5 * kSide) ? 1.0 : -1.0;
          return Vector3d(x.x() + 0.5 * kBend * kSide * sign, x.y(), 0.0);
        },
        mesh);
    // The top is pulled by the strain kBend, and the bottom pressed.
    const double along = std::cos(grain), across = std::sin(grain);
    const double modulus =
        1.0 / (std::pow(along, 4) / kModuli[0] + std::pow(across, 4) / kModuli[1] +
               std::pow(along * across, 2) / kModuli[2]);
    double density = 0.0;
    for (int m = 0; m < 6; ++m) density += 0.25 * kModuli[m % 3] * strain[m] * strain[m];
    EXPECT_NEAR(density, 0.5 * modulus * kBend * kBend / 3.0, 1e-5 * density) << grain;
  }
}

TEST(BilinearCells, PullsAreProjectedToTheNearestSemidefiniteMatrix) {
  const auto matrixOf = [](const CellStrain& pulls) {
    Eigen::Matrix4d matrix = Eigen::Matrix4d::Zero();
    for (int e = 0; e < 6; ++e) {
      const auto [i, j] = kCellDistances[e];
      matrix(i, j) = matrix(j, i) = -pulls[e];
      matrix(i, i) += pulls[e];
      matrix(j, j) += pulls[e];
    }
    return matrix;
  };
  int changed = 0;
  for (int trial = 0; trial < 100; ++trial) {
    CellStrain pulls;
    for (int e = 0; e < 6; ++e) pulls[e] = 0.4 + std::sin(1.0 + 7.3 * trial + 2.1 * e * e);
    const Eigen::Matrix4d before = matrixOf(pulls), after = matrixOf(projectPulls(pulls));
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> solver(before);
    const Eigen::Matrix4d nearest = solver.eigenvectors() *
                                    solver.eigenvalues().cwiseMax(0.0).asDiagonal() *
                                    solver.eigenvectors().transpose();
    EXPECT_LT((after - nearest).norm(), 1e-13);
    if ((after - before).norm() > 1e-6) ++changed;
  }
  EXPECT_GT(changed, 10);
  EXPECT_LT(changed, 90);
}

TEST(BilinearCells, RefuseContractionAndHysteresisByName) {
  material::Fabric fabric = stiffeningFabric();
  fabric.contraction = 0.1;
  fabric.resilience = {0.5, 0.5};
  fabric.shear_hysteresis = {0.01, 0.01};
  for (const bool contraction : {true, false}) {
    ModelledEffects effects = effectsOf(Elasticity::kBilinear);
    (contraction ? effects.contraction : effects.membrane_hysteresis) = true;
    try {
      const Cloth cloth(grid(Triangulation::kOneWay), fabric, effects);
      ADD_FAILURE();
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find("which only Green-Lagrange"), std::string::npos);
    }
  }
}

}  // namespace
}  // namespace haptex::cloth::test_bilinear_cells
