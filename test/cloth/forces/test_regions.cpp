// Regions of other fabrics in a sheet, which are one piece with it.
#include <gtest/gtest.h>

#include <cmath>

#include "../../refusal.h"
#include "derivatives.h"
#include "fixtures.h"
#include "force_fixtures.h"
#include "haptex/cloth/forces/bending/bending.h"

namespace haptex::cloth::test_regions {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// Beyond a line across the weft all is of fabric 1.
mesh::ClothMesh divided(mesh::ClothMesh mesh, double border) {
  for (const auto& [a, b, c] : mesh.triangles) {
    const double u = (mesh.rest_coordinates[a].x() + mesh.rest_coordinates[b].x() +
                      mesh.rest_coordinates[c].x()) /
                     3.0;
    mesh.triangle_fabrics.push_back(u > border ? 1 : 0);
  }
  return mesh;
}

mesh::ClothMesh strip(int cells, mesh::Triangulation cut = mesh::Triangulation::kAlternating) {
  return mesh::makeRectangle(0.2, 0.04, cells, cells / 5, cut);
}

/// Rolled up along the weft: rest coordinates on circles, the second after the first.
Positions rolled(const mesh::ClothMesh& mesh, double border, double first, double second) {
  Positions positions;
  const auto place = [](double s, double curvature) {
    return Vector2d(std::sin(curvature * s) / curvature,
                    (1.0 - std::cos(curvature * s)) / curvature);
  };
  for (const Vector2d& rest : mesh.rest_coordinates) {
    const double s = std::min(rest.x(), border);
    Vector2d at = place(s, first);
    if (rest.x() > border) {
      at += Eigen::Rotation2Dd(first * border) * place(rest.x() - border, second);
    }
    positions.emplace_back(at.y(), at.x(), rest.y());
  }
  return positions;
}

TEST(Regions, OfTheSameFabricAreTheSheet) {
  material::Fabric fabric = stiffeningFabric();
  fabric.bending = {1e-5, 2e-5};
  ModelledEffects effects;
  effects.viscosity = effects.bending = true;
  effects.gravity = {0.0, 0.0, -9.8};
  for (const BendingModel model : {BendingModel::kLinear, BendingModel::kQuadratic}) {
    effects.bending_settings.model = model;
    const Cloth sheet(square(6), fabric, effects);
    const Cloth of_two(divided(square(6), 0.05), {fabric, fabric}, effects);
    const ClothState state = randomState(sheet, 0.003, 1.0, 3);
    std::vector<Vector3d> whole, parts;
    sheet.computeForces(state, whole);
    of_two.computeForces(state, parts);
    for (std::size_t i = 0; i < whole.size(); ++i) {
      EXPECT_LT((whole[i] - parts[i]).norm(), 1e-12 * (1.0 + whole[i].norm())) << i;
      EXPECT_NEAR(sheet.masses()[i], of_two.masses()[i], 1e-15);
    }
  }
}

TEST(Regions, ResistBendingEachWithItsRigidity) {
  const double border = 0.1;
  const std::vector<material::BendingRigidity> rigidities = {{1e-6, 1e-6}, {1e-5, 1e-5}};
  for (const BendingModel model : {BendingModel::kLinear, BendingModel::kQuadratic}) {
    double last = 0.0;
    for (const int cells : {20, 40, 80}) {
      const mesh::ClothMesh mesh = divided(strip(cells), border);
      BendingSettings settings;
      settings.model = model;
      const Bending bending(mesh, rigidities, settings);
      const double first = 2.0, second = 3.0;  // 1/m
      const double exact = 0.5 * 0.04 * border * (1e-6 * first * first + 1e-5 * second * second);
      const double energy = bending.energy(resting(rolled(mesh, border, first, second)));
      // Half a cell has no curvature along either end, and as much at the border another: first
      // order in the cell.
      const double error = std::abs(energy - exact) / exact;
      EXPECT_LT(error, 2.5 / cells) << cells;
      if (last > 0.0) {
        EXPECT_LT(error, 0.6 * last) << cells;
      }
      last = error;
    }
  }
}

/// What would fold at a seam is held at the border of regions.
TEST(Regions, CarryAMomentOverTheirBorder) {
  material::Fabric soft = linearFabric(), stiff = linearFabric();
  soft.bending = {1e-6, 1e-6};
  stiff.bending = {1e-5, 1e-5};
  const double border = 0.1;
  for (const mesh::Triangulation cut :
       {mesh::Triangulation::kAlternating, mesh::Triangulation::kOneWay}) {
    const mesh::ClothMesh mesh = divided(strip(20, cut), border);
    const Bending bending(mesh, {*soft.bending, *stiff.bending});
    Positions folded;
    const double angle = 0.1;
    for (const Vector2d& rest : mesh.rest_coordinates) {
      const double beyond = std::max(0.0, rest.x() - border);
      folded.emplace_back(std::sin(angle) * beyond, rest.x() - beyond + std::cos(angle) * beyond,
                          rest.y());
    }
    // One row of particles bends by the angle: within a cell the mean of both rigidities.
    const double cell = 0.01, mean = 0.5 * (1e-6 + 1e-5);
    const double energy = 0.5 * mean * 0.04 * angle * angle / cell;
    EXPECT_NEAR(bending.energy(resting(folded)), energy, 0.01 * energy);
  }
}

TEST(Regions, ForcesAreTheGradientOfTheEnergy) {
  material::Fabric other = stiffeningFabric();
  other.bending = {3e-5, 1e-5};
  other.areal_density = 0.4;
  material::Fabric fabric = linearFabric(0.5);
  fabric.bending = {1e-6, 2e-6};
  ModelledEffects effects;
  effects.viscosity = effects.bending = true;
  effects.gravity = {0.0, 0.0, -9.8};
  effects.air = Air{};
  const Cloth cloth(divided(square(4), 0.05), {fabric, other}, effects);
  expectExactDerivatives(cloth, randomState(cloth, 0.002, 0.0, 5), {0, 2, 12, 20});
}

TEST(Regions, ThatDoNotResistBendingAreNotBentByTheOthers) {
  const mesh::ClothMesh mesh = divided(strip(20), 0.1);
  const Bending bending(mesh, std::vector<material::BendingRigidity>{{0.0, 0.0}, {1e-5, 1e-5}});
  // Curved in the first fabric up to one cell before the border.
  EXPECT_NEAR(bending.energy(resting(rolled(mesh, 0.1, 2.0, 1e-9))), 0.0,
              0.5 * 1e-5 * 4.0 * 0.04 * 0.01);
  EXPECT_GT(bending.energy(resting(rolled(mesh, 0.1, 1e-9, 2.0))), 0.0);
}

TEST(Regions, ThatWhatIsModelledDoesNotKnowAreRefused) {
  material::Fabric fabric = linearFabric();
  fabric.bending = {1e-6, 1e-6};
  fabric.bending_hysteresis = {1e-4, 1e-4};
  fabric.friction = 0.3;
  fabric.compression = {1e-3, material::StrainStressCurve::linear(1e4)};
  const auto refusal = [&](const ModelledEffects& effects, std::size_t fabrics) {
    return test::refusalOf([&] {
      Cloth(divided(square(4), 0.05), std::vector<material::Fabric>(fabrics, fabric), effects);
    });
  };
  EXPECT_EQ(refusal({}, 2), test::kNotRefused);
  EXPECT_NE(refusal({}, 1).find("is of fabric 1; there are 1"), std::string::npos);
  ModelledEffects springs, hysteresis;
  springs.elasticity = Elasticity::kMassSpring;
  EXPECT_EQ(refusal(springs, 2), "springs know one fabric, and the cloth has 2");
  hysteresis.bending = hysteresis.bending_hysteresis = true;
  EXPECT_NE(refusal(hysteresis, 2).find("hysteresis of bending knows one fabric"),
            std::string::npos);
}

}  // namespace
}  // namespace haptex::cloth::test_regions
