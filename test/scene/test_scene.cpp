#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "../refusal.h"
#include "haptex/material/fabric_file.h"
#include "haptex/scene/scene.h"
#include "scene_fixtures.h"

namespace haptex::scene::test_scene {
namespace {

namespace fs = std::filesystem;

TEST_F(SceneFile, ReadsASheet) {
  const Scene scene = load(kValid);
  const mesh::ClothMesh expected =
      mesh::makeRectangle(0.3, 0.2, 3, 2, mesh::Triangulation::kAlternating);
  EXPECT_EQ(scene.mesh.triangles, expected.triangles);
  EXPECT_EQ(scene.mesh.rest_coordinates, expected.rest_coordinates);
  EXPECT_EQ(scene.mesh.initial_positions, expected.initial_positions);
  EXPECT_EQ(scene.fabric_path, (root_ / "fabrics/silk.yaml").string());
  EXPECT_EQ(scene.attached_particles, (std::vector<int>{8, 9, 10, 11}));
  EXPECT_EQ(scene.time_step, 0.0125);
}

TEST_F(SceneFile, ReadsOneWayDiagonals) {
  EXPECT_EQ(load(replaced(kValid, "alternating", "one_way")).mesh.triangles,
            mesh::makeRectangle(0.3, 0.2, 3, 2, mesh::Triangulation::kOneWay).triangles);
}

TEST_F(SceneFile, LaysASheetWhereItsPoseSays) {
  const Scene scene =
      load(replaced(kValid, "alternating",
                    "alternating, position: [0.1, 0, 0.5], rpy: [0, -1.5707963267948966, 0]"));
  const mesh::ClothMesh upright =
      mesh::makeRectangle(0.3, 0.2, 3, 2, mesh::Triangulation::kAlternating);
  for (std::size_t i = 0; i < upright.initial_positions.size(); ++i) {
    const Eigen::Vector3d& place = upright.initial_positions[i];  // in the plane x = 0
    const Eigen::Vector3d lying(0.1 - place.z(), place.y(), 0.5 + place.x());
    EXPECT_LT((scene.mesh.initial_positions[i] - lying).norm(), 1e-12);
  }
  EXPECT_EQ(scene.mesh.rest_coordinates, upright.rest_coordinates);
  EXPECT_NE(refusalOf(replaced(kValid, "alternating", "alternating, position: [0, 0, 101]"))
                .find("must be from -100 to 100 m"),
            std::string::npos);
}

TEST_F(SceneFile, ModelsOnlyWhatIsListed) {
  const Scene both = load(kValid);
  EXPECT_TRUE(both.effects.viscosity);
  EXPECT_EQ(both.effects.gravity, Eigen::Vector3d(0, 0, -9.80665));
  const Scene none = load(replaced(kValid, "[gravity, viscosity]", "[]"));
  EXPECT_FALSE(none.effects.viscosity);
  EXPECT_EQ(none.effects.gravity, Eigen::Vector3d::Zero());
  EXPECT_FALSE(load(replaced(kValid, "[gravity, viscosity]", "[gravity]")).effects.viscosity);
  EXPECT_FALSE(both.effects.contraction);
  EXPECT_TRUE(load(replaced(kValid, "viscosity]", "contraction]")).effects.contraction);
}

TEST_F(SceneFile, MakesRoomForPointLoadsForFingersOnly) {
  const Scene without = load(kValid);
  EXPECT_FALSE(without.fingers || without.tactile || without.recording);
  EXPECT_FALSE(without.effects.point_loads);
  const Scene touched = load(replaced(kValid, "viscosity]", "fingers, tactile, recording]"));
  EXPECT_TRUE(touched.fingers && touched.tactile && touched.recording);
  EXPECT_TRUE(touched.effects.point_loads);
}

TEST_F(SceneFile, ReadsTheElasticity) {
  EXPECT_EQ(load(kValid).effects.elasticity, cloth::Elasticity::kGreenLagrange);
  const auto read = [&](const std::string& name) {
    return load(kValid + "elasticity: " + name + "\n").effects.elasticity;
  };
  EXPECT_EQ(read("green_lagrange"), cloth::Elasticity::kGreenLagrange);
  EXPECT_EQ(read("bilinear"), cloth::Elasticity::kBilinear);
  EXPECT_EQ(read("mass_spring"), cloth::Elasticity::kMassSpring);
  EXPECT_EQ(read("corotational"), cloth::Elasticity::kCorotational);
  EXPECT_EQ(refusalOf(meshScene("corner") + "elasticity: mass_spring\n"),
            path() +
                ": elasticity: a spring lattice needs a mesh of rectangles along weft and warp of "
                "two triangles each; triangle 0 is not half of one");
}

TEST_F(SceneFile, GivesSheetsThatBendCellsUnlessWhatIsModelledNeedsTriangles) {
  const auto with = [&](const std::string& effects) {
    return load(replaced(kValid, "[gravity, viscosity]", "[" + effects + "]")).effects.elasticity;
  };
  EXPECT_EQ(with("gravity, bending"), cloth::Elasticity::kBilinear);
  EXPECT_EQ(with("bending, bending_hysteresis"), cloth::Elasticity::kBilinear);
  EXPECT_EQ(with("gravity"), cloth::Elasticity::kGreenLagrange);
  for (const char* needs : {"contraction", "membrane_hysteresis"}) {
    EXPECT_EQ(with(std::string("bending, ") + needs), cloth::Elasticity::kGreenLagrange);
  }
  const std::string bends = replaced(kValid, "viscosity]", "bending]");
  EXPECT_EQ(load(bends + "elasticity: green_lagrange\n").effects.elasticity,
            cloth::Elasticity::kGreenLagrange);
  EXPECT_EQ(load(replaced(meshScene("corner"), "viscosity]", "bending]")).effects.elasticity,
            cloth::Elasticity::kGreenLagrange);
}

TEST_F(SceneFile, ReadsGravity) {
  EXPECT_EQ(load(kValid + "gravity: [1, 0, -1.62]\n").effects.gravity,
            Eigen::Vector3d(1, 0, -1.62));
}

TEST_F(SceneFile, ReadsAirAndWind) {
  EXPECT_FALSE(load(kValid).effects.air);
  const std::string with_air = replaced(kValid, "viscosity]", "air]");
  const std::string with_wind = replaced(kValid, "viscosity]", "air, wind]");
  const cloth::Air still = *load(with_air).effects.air;
  EXPECT_EQ(still.coefficients.normal, cloth::AirCoefficients().normal);
  EXPECT_EQ(still.wind.velocity(3.0), Eigen::Vector3d::Zero());
  const cloth::Air air = *load(with_wind + R"(
air: {normal: 1.5, tangential: 0.1, lift: 0}
wind:
  velocity: [2, 0, 0.5]
  gusts:
    - {velocity: [0.5, 0, 0], frequency: 0.5}
    - {velocity: [0, 1, 0], frequency: 0.25, phase: 1.5}
)")
                              .effects.air;
  EXPECT_EQ(air.coefficients.normal, 1.5);
  EXPECT_EQ(air.coefficients.tangential, 0.1);
  EXPECT_EQ(air.coefficients.lift, 0.0);
  // At 0.5 s the first gust blows fully, the second at sin(pi/4 + 1.5).
  const Eigen::Vector3d expected(2.0 + 0.5 * std::sin(0.5 * M_PI), std::sin(0.25 * M_PI + 1.5),
                                 0.5);
  EXPECT_LT((air.wind.velocity(0.5) - expected).norm(), 1e-15);
}

TEST_F(SceneFile, ReadsHowBendingIsModelled) {
  const std::string with_bending = replaced(kValid, "[gravity, viscosity]", "[bending]");
  const cloth::BendingSettings flat = load(with_bending).effects.bending_settings;
  EXPECT_EQ(flat.model, cloth::BendingModel::kLinear);
  EXPECT_EQ(flat.rest_curvature, Eigen::Vector2d::Zero());
  EXPECT_EQ(load(with_bending + "bending: {model: linear}\n").effects.bending_settings.model,
            cloth::BendingModel::kLinear);
  const cloth::BendingSettings curved =
      load(with_bending + "bending: {model: quadratic, rest_curvature: {weft: 20, warp: -1000}}\n")
          .effects.bending_settings;
  EXPECT_EQ(curved.model, cloth::BendingModel::kQuadratic);
  EXPECT_EQ(curved.rest_curvature, Eigen::Vector2d(20.0, -1000.0));
}

TEST_F(SceneFile, ModelsHysteresisOnlyIfAsked) {
  EXPECT_FALSE(
      load(replaced(kValid, "[gravity, viscosity]", "[bending]")).effects.bending_hysteresis);
  const cloth::ModelledEffects asked =
      load(replaced(kValid, "[gravity, viscosity]", "[bending_hysteresis, bending]")).effects;
  EXPECT_TRUE(asked.bending && asked.bending_hysteresis);
  EXPECT_FALSE(asked.membrane_hysteresis);
  EXPECT_TRUE(load(replaced(kValid, "[gravity, viscosity]", "[membrane_hysteresis]"))
                  .effects.membrane_hysteresis);
}

TEST_F(SceneFile, JoinsAttachedSidesAndParticles) {
  const auto attached = [&](const std::string& list) {
    return load(replaced(kValid, "[top]", list)).attached_particles;
  };
  using Particles = std::vector<int>;
  EXPECT_EQ(attached("[]"), Particles{});
  EXPECT_EQ(attached("[bottom]"), (Particles{0, 1, 2, 3}));
  EXPECT_EQ(attached("[left]"), (Particles{0, 4, 8}));
  EXPECT_EQ(attached("[right, top]"), (Particles{3, 7, 8, 9, 10, 11}));
  EXPECT_EQ(attached("[left, {particles: [5, 0, 5]}]"), (Particles{0, 4, 5, 8}));
}

TEST_F(SceneFile, HasTheDocumentedSolverDefaults) {
  const cloth::StepSettings step = load(kValid).step;
  EXPECT_EQ(step.solver, linear::LinearSolverMethod::kAutomatic);
  EXPECT_EQ(step.tolerance, 1e-6);
  EXPECT_EQ(step.newton_iterations, 1);
  EXPECT_EQ(step.newton_error, 0.0);
  EXPECT_EQ(step.threads, 1);
}

TEST_F(SceneFile, ReadsTheSolver) {
  const cloth::StepSettings step = load(kValid +
                                        "solver: {method: cholesky, tolerance: 1e-9, "
                                        "newton_iterations: 5, error: 1e-3, threads: 3}\n")
                                       .step;
  EXPECT_EQ(step.solver, linear::LinearSolverMethod::kCholesky);
  EXPECT_EQ(step.tolerance, 1e-9);
  EXPECT_EQ(step.newton_iterations, 5);
  EXPECT_EQ(step.newton_error, 1e-3);
  EXPECT_EQ(step.threads, 3);
  EXPECT_EQ(load(kValid + "solver: {method: conjugate_gradient}\n").step.solver,
            linear::LinearSolverMethod::kConjugateGradient);
  EXPECT_EQ(load(kValid + "solver: {method: automatic}\n").step.solver,
            linear::LinearSolverMethod::kAutomatic);
}

TEST_F(SceneFile, ReadsTheIntegrator) {
  EXPECT_EQ(load(kValid).step.method, cloth::IntegrationMethod::kBackwardEuler);
  for (const cloth::NamedIntegrationMethod& named : cloth::kIntegrationMethods) {
    EXPECT_EQ(load(kValid + "integrator: " + named.name + "\n").step.method, named.method);
  }
  const cloth::StepSettings step =
      load(kValid + "integrator: bdf2\nsolver: {newton_iterations: 2}\n").step;
  EXPECT_EQ(step.method, cloth::IntegrationMethod::kBdf2);
  EXPECT_EQ(step.newton_iterations, 2);
}

TEST_F(SceneFile, FindsMeshesByNameAndByPath) {
  for (const std::string name : {"corner", "corner.obj", "../meshes/corner.obj"}) {
    const Scene scene = load(meshScene(name));
    EXPECT_EQ(scene.mesh.triangles.size(), 1u) << name;
    EXPECT_EQ(scene.attached_particles, (std::vector<int>{0, 1})) << name;
  }
  EXPECT_EQ(load(meshScene((root_ / "meshes/corner.obj").string())).mesh.triangles.size(), 1u);
}

TEST_F(SceneFile, FindsFabricsByNameAndByPath) {
  const std::string expected = (root_ / "fabrics/silk.yaml").string();
  for (const std::string& name : {std::string("silk.yaml"), std::string("../fabrics/silk.yaml"),
                                  std::string("../fabrics/silk"), expected}) {
    EXPECT_EQ(load(replaced(kValid, "silk", name)).fabric_path, expected) << name;
  }
}

TEST_F(SceneFile, NamesTheFabricsThereAre) {
  const std::string fabrics = (root_ / "fabrics").string();
  EXPECT_EQ(refusalOf(replaced(kValid, "silk", "velvet")),
            path() + ": fabric: 'velvet' must be a name in " + fabrics +
                " (silk) or a path with a '/'; there is no file " + fabrics + "/velvet.yaml");
}

TEST_F(SceneFile, NamesTheMeshAndItsLine) {
  std::ofstream(root_ / "meshes/quad.obj") << "f 1/1 2/2 3/3 4/4\n";
  EXPECT_EQ(refusalOf(meshScene("quad")), (root_ / "meshes/quad.obj").string() +
                                              ": line 1: a face has 4 corners, must be a triangle");
}

TEST_F(SceneFile, LeavesTheKeyOfTheForceRendererToIt) {
  EXPECT_TRUE(load(replaced(kValid, "viscosity]", "fingers]") + "haptics: {depth: 3}\n").fingers);
}

TEST_F(SceneFile, AcceptsValuesAtTheirLimits) {
  EXPECT_EQ(load(replaced(kValid, "[3, 2]", "[1000, 1000]")).mesh.triangles.size(), 2000000u);
  EXPECT_NO_THROW(load(replaced(kValid, "[0.3, 0.2]", "[100, 100]")));
  EXPECT_NO_THROW(load(replaced(kValid, "0.0125", "1e-6")));
  EXPECT_NO_THROW(load(replaced(kValid, "0.0125", "10")));
}

TEST_F(SceneFile, NamesTheFileThatIsNotYaml) {
  try {
    load("fabric: [silk\nmodel: 3\n");
    ADD_FAILURE() << "not refused";
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(std::string(error.what()).rfind(path() + ": line ", 0), 0u) << error.what();
  }
  EXPECT_THROW(loadScene((root_ / "scenes/none.yaml").string()), std::runtime_error);
}

TEST_F(SceneFile, MeshesASheetWithAsFewCellsAsTheCellSizeAllows) {
  const std::string sheet =
      "fabric: silk\nsheet: {size: [0.2, 0.1], cells: [3, 2], diagonals: one_way}\n"
      "model: []\ntime_step: 0.01\n";
  load(sheet + "attach: [top]\n");
  EXPECT_TRUE(loadScene(path()).any_cells);
  EXPECT_EQ(loadScene(path()).mesh.triangles.size(), 2u * 3u * 2u);
  const Scene fine = loadScene(path(), 0.0125);
  EXPECT_EQ(fine.mesh.triangles.size(), 2u * 16u * 8u);
  EXPECT_EQ(fine.attached_particles.size(), 17u);
  EXPECT_EQ(loadScene(path(), 0.0124).mesh.triangles.size(), 2u * 17u * 9u);
  EXPECT_EQ(loadScene(path(), 10.0).mesh.triangles.size(), 2u);
  EXPECT_THROW(loadScene(path(), 1e-6), std::invalid_argument);
  EXPECT_THROW(loadScene(path(), 1e-300), std::invalid_argument);
  EXPECT_THROW(loadScene(path(), 0.0), std::invalid_argument);
  EXPECT_THROW(loadScene(path(), std::nan("")), std::invalid_argument);

  load(sheet + "attach: [top, {particles: [0]}]\n");  // whose places would be others
  EXPECT_FALSE(loadScene(path()).any_cells);
  EXPECT_EQ(loadScene(path(), 0.0125).mesh.triangles.size(), 2u * 3u * 2u);
  load("fabric: silk\nmesh: corner\nattach: []\nmodel: []\ntime_step: 0.01\n");
  EXPECT_FALSE(loadScene(path()).any_cells);
  EXPECT_EQ(loadScene(path(), 0.0125).mesh.triangles.size(), 1u);
}

TEST_F(SceneFile, StartsOutsideOfObstaclesWhereItCollidesWithItself) {
  const std::string obstacles = R"(obstacles:
  - {name: ball, sphere: 0.03, position: [0.01, 0, -0.1]}
)";
  const std::string among = replaced(kValid, "viscosity]", "viscosity, obstacles]") + obstacles;
  const Scene as_described = load(replaced(among, "[3, 2]", "[30, 20]"));
  EXPECT_EQ(as_described.start_move.triangle, -1);
  const Scene moved = load(
      replaced(replaced(among, "[3, 2]", "[30, 20]"), "obstacles]", "obstacles, self_collision]"));
  EXPECT_EQ(moved.start_move.obstacle, "ball");
  EXPECT_GT(moved.start_move.particles, 0);
  for (const int particle : moved.attached_particles) {
    EXPECT_EQ(moved.mesh.initial_positions[particle],
              as_described.mesh.initial_positions[particle]);
  }
}

TEST(ShippedScenes, LoadWithTheirFabrics) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(kConfig / "scenes")) {
    names.push_back(entry.path().stem().string());
    const Scene scene = loadScene(entry.path().string());
    EXPECT_NO_THROW(requireSound(scene.mesh)) << names.back();
    EXPECT_GT(material::loadFabric(scene.fabric_path).areal_density, 0.0) << names.back();
    if (names.back() == "net" || names.back() == "sphere_mass_spring") {
      EXPECT_EQ(scene.effects.elasticity, cloth::Elasticity::kMassSpring) << names.back();
      EXPECT_TRUE(scene.obstacles[0].body) << names.back();
      continue;
    }
    if (scene.mesh.panelCount() > 1) continue;  // ShippedGarments
    if (names.back() == "soft_top") {
      EXPECT_EQ(scene.frames.size(), 5u);
      EXPECT_EQ(scene.attached_particles.size(), 5u * 34u);
      continue;
    }
    const bool hangs = names.back() != "dropped_sheet";
    const bool lies = names.back() == "table";
    EXPECT_EQ(scene.mesh.triangles.size(), lies ? 800u : hangs ? 2048u : 512u) << names.back();
    EXPECT_EQ(scene.attached_particles.size(), lies ? 21u : hangs ? 33u : 0u) << names.back();
    EXPECT_EQ(scene.time_step, 0.0125) << names.back();
  }
  std::sort(names.begin(), names.end());
  std::string all;
  for (const std::string& name : names) all += name + " ";
  EXPECT_EQ(all,
            "acrylic_knit_sample cotton_knit_sample cushion dropped_sheet gathered_wool "
            "hemmed_wool jacket linear_sheet net orbiting_sphere shirt_in_trousers skirt "
            "soft_top sphere_mass_spring table trousers_and_shirt tshirt wool_among_obstacles "
            "wool_in_wind wool_sample ");
}

TEST_F(SceneFile, MayHaveAnotherSheet) {
  load(kValid);
  const Scene same = loadScene(path(), SheetChange{});
  EXPECT_EQ(same.mesh.initial_positions, loadScene(path()).mesh.initial_positions);
  SheetChange change;
  change.size = {0.4, 0.1};
  change.cells = {5, 1};
  change.diagonals = mesh::Triangulation::kOneWay;
  const Scene other = loadScene(path(), change);
  const mesh::ClothMesh expected =
      mesh::makeRectangle(0.4, 0.1, 5, 1, mesh::Triangulation::kOneWay);
  EXPECT_EQ(other.mesh.triangles, expected.triangles);
  EXPECT_EQ(other.mesh.initial_positions, expected.initial_positions);
  EXPECT_EQ(other.attached_particles, (std::vector<int>{6, 7, 8, 9, 10, 11}));
}

TEST_F(SceneFile, RefusesSheetsThatCannotBe) {
  load(kValid);
  const auto refusal = [&](const SheetChange& change) -> std::string {
    return test::refusalOf([&] { loadScene(path(), change); });
  };
  SheetChange long_sheet, no_cells, fine;
  long_sheet.size = {0.1, 101.0};
  no_cells.cells = {3, 0};
  fine.cells = {1001, 1000};
  EXPECT_NE(refusal(long_sheet).find("size[1] = 101 m"), std::string::npos);
  EXPECT_NE(refusal(no_cells).find("cells[1] = 0"), std::string::npos);
  EXPECT_NE(refusal(fine).find("at most 2000000"), std::string::npos) << refusal(fine);
}

TEST(ShippedScenes, WoolSampleIsTheTwoHundredMillimetreSquare) {
  const Scene scene = loadScene((kConfig / "scenes/wool_sample.yaml").string());
  EXPECT_EQ(fs::path(scene.fabric_path).filename(), "wool.yaml");
  EXPECT_EQ(scene.mesh.rest_coordinates.back(), Eigen::Vector2d(0.2, 0.2));
  EXPECT_EQ(scene.attached_particles.front(), 32 * 33);
  EXPECT_TRUE(scene.effects.viscosity);
  EXPECT_EQ(scene.effects.gravity.z(), -9.80665);
}

}  // namespace
}  // namespace haptex::scene::test_scene
