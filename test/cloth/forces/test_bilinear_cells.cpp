// What tells cells of two triangles from the membrane; what both promise is in test_elasticity.cpp.
#include <gtest/gtest.h>

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

// Gauss' two points along each side are exact for the squares of derivatives that are linear.
TEST(BilinearCells, MeanStrainIsThatOfTheBilinearMap) {
  const mesh::ClothMesh mesh = mesh::makeRectangle(0.02, 0.03, 1, 1, Triangulation::kOneWay);
  const BilinearCell cell = restCell(pairTriangles(mesh, 0).pairs.front());
  constexpr double kIn = 4.0, kOut = 9.0;  // 1/m
  const auto place = [&](const Vector2d& x) {
    return Vector3d(x.x() + kIn * x.x() * x.y(), x.y(), kOut * x.x() * x.y());
  };
  CellStrain squares;
  int e = 0;
  for (const auto& [i, j] : {std::pair(1, 0), {2, 0}, {2, 1}, {3, 0}, {3, 1}, {3, 2}}) {
    squares[e++] = (place(mesh.rest_coordinates[cell.particles[i]]) -
                    place(mesh.rest_coordinates[cell.particles[j]]))
                       .squaredNorm();
  }
  const CellStrain strain = cell.by_squares * (squares - cell.rest_squares);
  Vector3d exact = Vector3d::Zero();
  for (const double s : {0.5 - std::sqrt(1.0 / 12.0), 0.5 + std::sqrt(1.0 / 12.0)}) {
    for (const double t : {0.5 - std::sqrt(1.0 / 12.0), 0.5 + std::sqrt(1.0 / 12.0)}) {
      const double x = 0.02 * s, y = 0.03 * t;
      const Vector3d weft(1.0 + kIn * y, 0.0, kOut * y), warp(kIn * x, 1.0, kOut * x);
      exact += 0.25 * Vector3d(0.5 * (weft.squaredNorm() - 1.0), 0.5 * (warp.squaredNorm() - 1.0),
                               weft.dot(warp));
    }
  }
  for (int m = 0; m < 3; ++m) EXPECT_NEAR(strain[m], exact[m], 1e-14);
}

TEST(BilinearCells, ResistWhatTheirMeanStrainDoesNotSee) {
  // The hourglass of a cell in its plane: in it the derivatives' mean is that of rest.
  const Cloth cloth =
      clothOf(mesh::makeRectangle(0.02, 0.02, 1, 1, Triangulation::kOneWay), Elasticity::kBilinear);
  for (const Vector3d& direction : {Vector3d(1, 0, 0), Vector3d(0, 1, 0)}) {
    const ClothState state = placed(cloth, [&](const Vector2d& rest) -> Vector3d {
      const double sign = (rest.x() > 0.01) == (rest.y() > 0.01) ? 1.0 : -1.0;
      return Vector3d(rest.x(), rest.y(), 0.0) + 1e-4 * sign * direction;
    });
    EXPECT_GT(cloth.potentialEnergy(state), 0.0);
    const ClothState reverse = placed(cloth, [&](const Vector2d& rest) -> Vector3d {
      const double sign = (rest.x() > 0.01) == (rest.y() > 0.01) ? 1.0 : -1.0;
      return Vector3d(rest.x(), rest.y(), 0.0) - 1e-4 * sign * direction;
    });
    EXPECT_GT(cloth.potentialEnergy(reverse), 0.0);
  }
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
