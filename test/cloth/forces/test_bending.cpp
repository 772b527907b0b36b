#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <limits>
#include <random>

#include "fixtures.h"
#include "force_fixtures.h"
#include "haptex/cloth/forces/bending/bending.h"
#include "haptex/cloth/forces/bending/bending_stencils.h"
#include "haptex/linear/block_cholesky.h"

namespace haptex::cloth::test_bending {
namespace {

using Eigen::Vector3d;

constexpr material::BendingRigidity kWool{2e-6, 1e-6};

/// A rectangle of 12 x `cells_v` cells of 10 mm x 8 mm.
mesh::ClothMesh strip(int cells_v, mesh::Triangulation triangulation) {
  return mesh::makeRectangle(0.12, 0.008 * cells_v, 12, cells_v, triangulation);
}

/// Inner particles moved by up to a quarter of a cell.
mesh::ClothMesh irregular(int cells_v) {
  mesh::ClothMesh mesh = strip(cells_v, mesh::Triangulation::kAlternating);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> shift(-0.002, 0.002);
  for (Eigen::Vector2d& place : mesh.rest_coordinates) {
    const double u = shift(random), v = shift(random);
    if (place.x() > 1e-9 && place.x() < 0.12 - 1e-9) place.x() += u;
    if (place.y() > 1e-9 && place.y() < 0.008 * cells_v - 1e-9) place.y() += v;
  }
  return mesh;
}

/// Energy with the second derivatives wuu, wvv, wuv of the displacement out of the plane.
double energyOf(const mesh::ClothMesh& mesh, const Bending& bending, double wuu, double wvv,
                double wuv) {
  Positions positions;
  for (const Eigen::Vector2d& x : mesh.rest_coordinates) {
    positions.emplace_back(
        0.5 * wuu * x.x() * x.x() + 0.5 * wvv * x.y() * x.y() + wuv * x.x() * x.y(), x.x(), x.y());
  }
  return bending.energy(resting(positions));
}

TEST(Bending, CylindersHaveTheRigidityAskedForHoweverTheCellsAreCut) {
  const double twist = std::sqrt(kWool.weft * kWool.warp);
  for (mesh::Triangulation triangulation :
       {mesh::Triangulation::kOneWay, mesh::Triangulation::kAlternating}) {
    for (int cells : {1, 2, 3, 4, 15}) {  // narrow strips too
      const mesh::ClothMesh mesh = strip(cells, triangulation);
      const Bending bending(mesh, kWool);
      // Half a cell along both edges across the curvature has none.
      const double weft = 0.5 * kWool.weft * (0.12 - 0.01) * 0.008 * cells;
      const double warp = 0.5 * kWool.warp * 0.12 * 0.008 * (cells - 1);
      const double area = 0.12 * 0.008 * cells;
      EXPECT_NEAR(energyOf(mesh, bending, 1, 0, 0), weft, 1e-9 * weft) << cells;
      EXPECT_NEAR(energyOf(mesh, bending, 0, 1, 0), warp, 1e-9 * weft) << cells;
      EXPECT_NEAR(energyOf(mesh, bending, 0, 0, 1), twist * area, 1e-9 * weft) << cells;
      for (double sign : {1.0, -1.0}) {  // cylinders at 45 degrees: (u + sign v)^2 / 4
        const double diagonal = 0.25 * (weft + warp + twist * area);
        EXPECT_NEAR(energyOf(mesh, bending, 0.5, 0.5, 0.5 * sign), diagonal, 1e-9 * weft) << cells;
      }
    }
  }
}

TEST(Bending, CylindersOfAnIrregularMeshHaveTheRigidityAskedFor) {
  const int cells = 15;
  const mesh::ClothMesh mesh = irregular(cells);
  const Bending bending(mesh, kWool);
  const double weft = 0.5 * kWool.weft * (0.12 - 0.01) * 0.008 * cells;
  const double warp = 0.5 * kWool.warp * 0.12 * 0.008 * (cells - 1);
  const double twist = std::sqrt(kWool.weft * kWool.warp) * 0.12 * 0.008 * cells;
  // The triangles along an edge, which have no curvature across it, are not half a cell wide.
  EXPECT_NEAR(energyOf(mesh, bending, 1, 0, 0), weft, 0.01 * weft);
  EXPECT_NEAR(energyOf(mesh, bending, 0, 1, 0), warp, 0.01 * warp);
  EXPECT_NEAR(energyOf(mesh, bending, 0, 0, 1), twist, 1e-9 * twist);
  const double diagonal = 0.25 * (weft + warp + twist);
  EXPECT_NEAR(energyOf(mesh, bending, 0.5, 0.5, 0.5), diagonal, 0.01 * diagonal);
  EXPECT_NEAR(energyOf(mesh, bending, 0.5, 0.5, -0.5), diagonal, 0.01 * diagonal);
}

// The patch test: a curvature that is the same everywhere is in equilibrium, whatever the mesh.
TEST(Bending, AConstantMomentDoesNoWorkOnInnerParticles) {
  const int cells = 15;
  for (const mesh::ClothMesh& mesh :
       {strip(cells, mesh::Triangulation::kOneWay), irregular(cells)}) {
    for (BendingModel model : {BendingModel::kLinear, BendingModel::kQuadratic}) {
      const Bending bending(mesh, kWool, {model});
      for (const Vector3d& k : {Vector3d(1, 0, 0), Vector3d(0, 1, 0), Vector3d(0, 0, 1)}) {
        Positions positions;
        for (const Eigen::Vector2d& x : mesh.rest_coordinates) {
          positions.emplace_back(
              0.5 * k[0] * x.x() * x.x() + 0.5 * k[1] * x.y() * x.y() + k[2] * x.x() * x.y(), x.x(),
              x.y());
        }
        std::vector<Vector3d> forces(positions.size(), Vector3d::Zero());
        bending.addForces(resting(positions), forces);
        double inner = 0.0, outer = 0.0;
        for (std::size_t i = 0; i < forces.size(); ++i) {
          // Four cells from the edge no triangle along it has a part.
          const Eigen::Vector2d& x = mesh.rest_coordinates[i];
          const bool inside = x.x() > 0.04 && x.x() < 0.08 && x.y() > 0.032 && x.y() < 0.088;
          (inside ? inner : outer) = std::max(inside ? inner : outer, std::abs(forces[i].x()));
        }
        EXPECT_GT(outer, 1e-7);
        EXPECT_LT(inner, 1e-9 * outer) << k.transpose();
      }
    }
  }
}

TEST(Bending, GridsHaveHingesOfFourParticlesAndIrregularMeshesOfMore) {
  const auto most = [](const Bending& bending) {
    int corners = 0;
    for (const Hinge& hinge : bending.hinges())
      corners = std::max(corners, hinge.end - hinge.begin);
    return corners;
  };
  for (mesh::Triangulation triangulation :
       {mesh::Triangulation::kOneWay, mesh::Triangulation::kAlternating}) {
    EXPECT_EQ(most(Bending(strip(6, triangulation), kWool)), 4);
  }
  EXPECT_GT(most(Bending(irregular(6), kWool)), 4);
  EXPECT_LE(most(Bending(irregular(6), kWool)), 12);
}

// Too few particles to tell every curvature: what is flat is still flat.
TEST(Bending, SmallMeshesHaveNoEnergyWhenFlat) {
  for (int cells : {1, 2}) {
    mesh::ClothMesh mesh =
        mesh::makeRectangle(0.01 * cells, 0.01, cells, 1, mesh::Triangulation::kOneWay);
    mesh.rest_coordinates.front() += Eigen::Vector2d(-0.002, 0.001);
    const Bending bending(mesh, kWool, {BendingModel::kQuadratic});
    ASSERT_FALSE(bending.hinges().empty());
    Positions positions;
    for (const Eigen::Vector2d& x : mesh.rest_coordinates) {
      positions.emplace_back(3.0 * x.x() - x.y(), x.x() + 2.0, 0.5 * x.y());
    }
    EXPECT_LT(bending.energy(resting(positions)), 1e-28);
    positions.front().z() += 0.001;
    EXPECT_GT(bending.energy(resting(positions)), 1e-12);
  }
}

TEST(Bending, AnIsotropicFabricMayBeCutInAnyDirection) {
  // The same grid turned by 30 degrees against the threads, of a fabric without a direction.
  mesh::ClothMesh mesh = strip(15, mesh::Triangulation::kOneWay);
  const Eigen::Rotation2Dd turn(M_PI / 6.0);
  for (Eigen::Vector2d& place : mesh.rest_coordinates) place = turn * place;
  const Bending turned(mesh, {1e-6, 1e-6});
  const mesh::ClothMesh straight = strip(15, mesh::Triangulation::kOneWay);
  const Bending reference(straight, {1e-6, 1e-6});
  // Curvature along the grid's own first axis: H = a a^T.
  const Eigen::Vector2d a = turn * Eigen::Vector2d::UnitX();
  const double exact = energyOf(straight, reference, 1, 0, 0);
  EXPECT_NEAR(energyOf(mesh, turned, a.x() * a.x(), a.y() * a.y(), a.x() * a.y()), exact,
              1e-9 * exact);
}

TEST(Bending, FlatStatesHaveNoEnergyAndNoForces) {
  for (const mesh::ClothMesh& mesh : {strip(5, mesh::Triangulation::kOneWay), irregular(5)}) {
    const Bending bending(mesh, kWool);
    std::mt19937 random(3);
    std::normal_distribution<double> normal;
    for (int trial = 0; trial < 5; ++trial) {
      Eigen::Matrix<double, 3, 2> map;
      for (int i = 0; i < 6; ++i) map(i) = normal(random);
      Positions positions;
      for (const Eigen::Vector2d& place : mesh.rest_coordinates) {
        positions.emplace_back(map * place + Vector3d(1.0, -2.0, 0.5));
      }
      std::vector<Vector3d> forces(positions.size(), Vector3d::Zero());
      bending.addForces(resting(positions), forces);
      // Rounding of coordinates near 1 m times a stiffness near 1 N/m.
      for (const Vector3d& force : forces) EXPECT_LT(force.norm(), 1e-13);
      EXPECT_LT(bending.energy(resting(positions)), 1e-28);
    }
  }
}

TEST(Bending, ForcesAreTheGradientAndTheStepIsTheirLinearisation) {
  const mesh::ClothMesh mesh = irregular(3);
  Bending bending(mesh, kWool);
  const int size = static_cast<int>(mesh.rest_coordinates.size());
  linear::SymmetricBlockMatrix matrix(size, mesh.triangles, bending.pairs());
  bending.bind(matrix);
  Positions positions(size);
  Velocities velocities(size);
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  for (int i = 0; i < size; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      positions[i][axis] = normal(random);
      velocities[i][axis] = normal(random);
    }
  }
  std::vector<Vector3d> forces(size, Vector3d::Zero());
  bending.addForces(resting(positions), forces);
  Eigen::MatrixXd jacobian(3 * size, 3 * size);
  double scale = 0.0;
  for (const Vector3d& force : forces) scale = std::max(scale, force.norm());
  for (int i = 0; i < size; ++i) {
    for (int axis = 0; axis < 3; ++axis) {  // the energy is quadratic: differences are exact
      std::vector<Vector3d> beyond(size, Vector3d::Zero());
      Positions moved = positions;
      moved[i][axis] += 1.0;
      const double energy = bending.energy(resting(moved));
      bending.addForces(resting(moved), beyond);
      for (int j = 0; j < size; ++j) {
        jacobian.block<3, 1>(3 * j, 3 * i + axis) = beyond[j] - forces[j];
      }
      moved[i][axis] -= 2.0;
      EXPECT_NEAR(forces[i][axis], -0.5 * (energy - bending.energy(resting(moved))), 1e-12 * scale);
    }
  }
  const double h = 0.01;
  linear::BlockVector rhs = linear::BlockVector::Zero(3, size);
  bending.assembleLinearised({positions, velocities}, {h, h}, matrix, rhs);
  EXPECT_LT((dense(matrix) + h * h * jacobian).norm(), 1e-12 * h * h * jacobian.norm());
  Eigen::VectorXd exact(3 * size), velocity(3 * size);
  for (int i = 0; i < size; ++i) {
    exact.segment<3>(3 * i) = forces[i];
    velocity.segment<3>(3 * i) = velocities[i];
  }
  exact = h * (exact + h * jacobian * velocity);
  EXPECT_LT((stacked(rhs) - exact).norm(), 1e-12 * exact.norm());
  EXPECT_GT(dense(matrix).selfadjointView<Eigen::Lower>().eigenvalues().minCoeff(),
            -1e-12 * dense(matrix).norm());
}

TEST(Bending, AFabricWithoutRigidityCostsNothingAndBadOnesAreRefused) {
  const mesh::ClothMesh mesh = strip(2, mesh::Triangulation::kOneWay);
  EXPECT_TRUE(Bending(mesh, {0.0, 0.0}).hinges().empty());
  const Bending only_warp(mesh, {0.0, 1e-6});
  EXPECT_LT(energyOf(mesh, only_warp, 1, 0, 0), 1e-15 * energyOf(mesh, only_warp, 0, 1, 0));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (double bad : {-1e-9, nan, std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW(Bending(mesh, {bad, 1e-6}), std::invalid_argument);
    EXPECT_THROW(Bending(mesh, {1e-6, bad}), std::invalid_argument);
  }
  Bending bending(mesh, kWool);
  EXPECT_THROW(bending.bind({static_cast<int>(mesh.rest_coordinates.size()), mesh.triangles}),
               std::out_of_range);
}

/// Tip drop over horizontal reach of a strip clamped at one end, at rest under its own weight.
double dropOverReach(double gamma, mesh::Triangulation triangulation, bool along_warp) {
  const double length = 0.1, weight = 1.0;  // m, N/m2
  const int cells = 60;
  // Two rows are held: the clamp is half way between them.
  const double cell = length / (cells - 0.5);
  const double width = 3.0 * cell;
  const mesh::ClothMesh mesh =
      along_warp ? mesh::makeRectangle(width, cells * cell, 3, cells, triangulation)
                 : mesh::makeRectangle(cells * cell, width, cells, 3, triangulation);
  const double rigidity = weight * length * length * length / gamma;
  const material::BendingRigidity both{along_warp ? 7.0 * rigidity : rigidity,
                                       along_warp ? rigidity : 7.0 * rigidity};
  Bending bending(mesh, both);
  material::Fabric fabric = linearFabric();
  fabric.weft.elastic = fabric.warp.elastic = material::StrainStressCurve::linear(1e4);
  fabric.shear.elastic = material::StrainStressCurve::linear(5e3);
  Membrane membrane(restElements(mesh), fabric, false);
  const int size = static_cast<int>(mesh.rest_coordinates.size());
  linear::SymmetricBlockMatrix matrix(size, mesh.triangles, bending.pairs());
  bending.bind(matrix);
  membrane.bind(matrix);
  linear::BlockCholesky cholesky(matrix);
  Positions positions;
  std::vector<char> fixed;
  std::vector<double> areas(size, 0.0);
  for (const MembraneElement& element : membrane.elements()) {
    for (int particle : element.particles) areas[particle] += element.area / 3.0;
  }
  for (const Eigen::Vector2d& x : mesh.rest_coordinates) {
    const double along = along_warp ? x.y() : x.x();
    positions.emplace_back(along - 0.5 * cell, along_warp ? x.x() : x.y(), 0.0);
    fixed.push_back(along < 1.5 * cell);
  }
  // Steps from rest each time: Newton's method, damped by the mass.
  const Velocities still(size, Vector3d::Zero());
  const linear::BlockVector nothing = linear::BlockVector::Zero(3, size);
  double h = 0.003;
  for (int iteration = 0; iteration < 400; ++iteration) {
    matrix.setZero();
    linear::BlockVector rhs = linear::BlockVector::Zero(3, size);
    for (int i = 0; i < size; ++i) {
      matrix.diagonal(i).diagonal().setConstant(0.1 * areas[i]);
      rhs(2, i) = -h * weight * areas[i];
    }
    membrane.assembleLinearised({positions, still}, {h, h}, matrix, rhs);
    bending.assembleLinearised({positions, still}, {h, h}, matrix, rhs);
    matrix.eliminate(fixed, nothing, rhs);
    if (!cholesky.factorise(matrix)) return std::numeric_limits<double>::quiet_NaN();
    cholesky.solve(rhs);
    for (int i = 0; i < size; ++i) positions[i] += h * rhs.col(i);
    if (h * rhs.cwiseAbs().maxCoeff() < 1e-11) break;
    h = std::min(1.1 * h, 1.0);
  }
  Vector3d tip = Vector3d::Zero();
  for (int particle :
       mesh::sideParticles(mesh, along_warp ? mesh::Side::kTop : mesh::Side::kRight)) {
    tip += 0.25 * positions[particle];
  }
  return -tip.z() / tip.x();
}

TEST(Bending, TheHeavyCantileverHangsAsTheElastica) {
  // theta'' = -gamma (1 - s) cos(theta), theta(0) = theta'(1) = 0; tip drop over horizontal reach,
  // solved as a boundary value problem, within 0.15 % of the published master curve of Romero et
  // al. 2021 (doi 10.1145/3450626.3459939).
  const std::array<std::array<double, 2>, 4> elastica = {
      {{0.1, 0.012500}, {1.0, 0.124562}, {10.0, 1.066802}, {100.0, 5.888105}}};
  for (const auto& [gamma, exact] : elastica) {
    for (mesh::Triangulation triangulation :
         {mesh::Triangulation::kOneWay, mesh::Triangulation::kAlternating}) {
      for (bool along_warp : {false, true}) {
        const double found = dropOverReach(gamma, triangulation, along_warp);
        // 60 cells: 0.13 % at gamma 100, where the fabric turns down within four cells.
        EXPECT_NEAR(found, exact, 0.003 * exact) << "gamma " << gamma;
      }
    }
  }
}

TEST(NonNegativeLeastSquares, FindsTheNearestPointOfTheCone) {
  Eigen::MatrixXd columns(2, 3);
  columns << 1.0, 1.0, -1.0,  //
      0.0, 1.0, 1.0;
  // Inside: exactly. Beside (1, 0): its nearest point on that ray. Behind: zero.
  EXPECT_LT((columns * nonNegativeLeastSquares(columns, Eigen::Vector2d(3.0, 2.0)) -
             Eigen::Vector2d(3.0, 2.0))
                .norm(),
            1e-12);
  const Eigen::VectorXd beside = nonNegativeLeastSquares(columns, Eigen::Vector2d(2.0, -1.0));
  EXPECT_LT((beside - Eigen::Vector3d(2.0, 0.0, 0.0)).norm(), 1e-12);
  EXPECT_EQ(nonNegativeLeastSquares(columns, Eigen::Vector2d(-0.1, -2.0)).norm(), 0.0);
}

}  // namespace
}  // namespace haptex::cloth::test_bending
