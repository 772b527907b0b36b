// By one process; test/nodes/large_sheet_test.py starts several.
#include <gtest/gtest.h>
#include <petscsys.h>

#include <algorithm>
#include <sstream>

#include "haptex/cloth/dynamics/integrator.h"
#include "haptex/large/large_sheet.h"
#include "haptex/material/fabric_file.h"

namespace haptex::large {
namespace {

class Petsc : public testing::Environment {
 public:
  void SetUp() override { ASSERT_EQ(PetscInitializeNoArguments(), 0); }
  void TearDown() override { PetscFinalize(); }
};
const testing::Environment* const kPetsc = testing::AddGlobalTestEnvironment(new Petsc);

/// Held along an edge, lying flat, and let go.
Sheet lyingWool(int cells) {
  Sheet sheet;
  sheet.width = sheet.height = 0.2;
  sheet.cells_u = sheet.cells_v = cells;
  sheet.axes.col(0) = Eigen::Vector3d::UnitY();
  sheet.axes.col(1) = Eigen::Vector3d::UnitX();
  sheet.held = {mesh::Side::kTop};
  sheet.fabric = material::loadFabric(HAPTEX_CONFIG_DIRECTORY "/fabrics/wool.yaml");
  sheet.effects.gravity = {0.0, 0.0, -9.80665};
  sheet.effects.viscosity = sheet.effects.bending = true;
  sheet.effects.elasticity = cloth::Elasticity::kBilinear;
  return sheet;
}

cloth::StepSettings toTheEnd() {
  cloth::StepSettings settings;
  settings.method = cloth::IntegrationMethod::kTrBdf2;
  settings.newton_iterations = 40;
  settings.newton_tolerance = 1e-11;
  settings.tolerance = 1e-10;
  return settings;
}

TEST(LargeSheetOfOneProcess, GoesWhereTheIntegratorTakesTheSameCloth) {
  constexpr double kStep = 5e-3;  // s
  constexpr int kSteps = 40;
  const Sheet sheet = lyingWool(12);
  const cloth::Cloth cloth = clothOf(sheet, {0, sheet.rowCount()});
  cloth::Integrator integrator(cloth, toTheEnd());
  cloth::ClothState state = cloth.initialState();
  LargeSheet large(sheet);
  double taken = 0.0;  // J
  for (int i = 0; i < kSteps; ++i) {
    const cloth::StepReport report = integrator.step(cloth, state, kStep);
    ASSERT_TRUE(report.accepted && report.newton_converged);
    ASSERT_TRUE(large.step(kStep).converged) << i;
    taken += report.energy_taken;
    double farthest = 0.0;  // m
    for (std::size_t k = 0; k < cloth.particleCount(); ++k) {
      farthest = std::max(farthest, (large.state().positions[k] - state.positions[k]).norm());
    }
    // It fell by 95 mm. The integrator's energy balance takes what the large sheet keeps.
    EXPECT_LT(farthest, i == 0 ? 1e-12 : 2e-7) << i;
  }
  EXPECT_LT(taken, 1e-10);
  EXPECT_LT(large.lowest(), -0.05);
  const SheetEnergy energy = large.energy();
  EXPECT_NEAR(energy.kinetic + energy.potential,
              cloth.kineticEnergy(state) + cloth.potentialEnergy(state), 2.0 * taken);
  EXPECT_NEAR(large.time(), kSteps * kStep, 1e-12);
}

TEST(LargeSheetOfOneProcess, WritesItsTrianglesWithRestCoordinates) {
  Sheet sheet = lyingWool(3);
  sheet.cells_u = 2;
  const LargeSheet large(sheet);
  std::ostringstream written, expected;
  large.writeObj(written);
  const mesh::ClothMesh mesh = clothOf(sheet, {0, sheet.rowCount()}).mesh();
  expected.precision(17);
  for (const auto& p : mesh.initial_positions) {
    expected << "v " << p.x() << ' ' << p.y() << ' ' << p.z() << '\n';
  }
  for (const auto& rest : mesh.rest_coordinates) {
    expected << "vt " << rest.x() << ' ' << rest.y() << '\n';
  }
  for (const auto& triangle : mesh.triangles) {
    expected << 'f';
    for (const int corner : triangle) expected << ' ' << corner + 1 << '/' << corner + 1;
    expected << '\n';
  }
  EXPECT_EQ(written.str(), expected.str());
}

}  // namespace
}  // namespace haptex::large
