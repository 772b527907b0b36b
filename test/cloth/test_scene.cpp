#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <ostream>
#include <stdexcept>
#include <string>
#include <vector>

#include "haptex/cloth/scene.h"
#include "haptex/material/fabric_file.h"

namespace haptex::cloth {
namespace {

namespace fs = std::filesystem;

const fs::path kConfig = fs::path(__FILE__).parent_path() / "../../config";

const std::string kObj = R"(v 0 0 0
v 0 0.1 0
v 0 0 -0.1
vt 0 0.1
vt 0.1 0.1
vt 0 0
f 1/1 2/2 3/3
)";

// scenes/, fabrics/ and meshes/ as under config/, with one file each.
class SceneFile : public testing::Test {
 protected:
  SceneFile() : root_(fs::path(testing::TempDir()) / ("haptex_scene_" + std::to_string(getpid()))) {
    for (const char* kind : {"scenes", "fabrics", "meshes"}) fs::create_directories(root_ / kind);
    fs::copy_file(kConfig / "fabrics/linear.yaml", root_ / "fabrics/silk.yaml");
    std::ofstream(root_ / "meshes/corner.obj") << kObj;
  }
  ~SceneFile() override { fs::remove_all(root_); }

  std::string path() const { return (root_ / "scenes/scene.yaml").string(); }

  Scene load(const std::string& text) const {
    std::ofstream(path()) << text;
    return loadScene(path());
  }

  std::string refusalOf(const std::string& text) const {
    try {
      load(text);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "(not refused)";
  }

  fs::path root_;
};

const std::string kValid = R"(fabric: silk
sheet: {size: [0.3, 0.2], cells: [3, 2], diagonals: alternating}
attach: [top]
model: [gravity, viscosity]
time_step: 0.0125
)";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << "the test replaces what is not there: " << from;
  return text.replace(at, from.size(), to);
}

std::string meshScene(const std::string& mesh) {
  return replaced(kValid, "sheet: {size: [0.3, 0.2], cells: [3, 2], diagonals: alternating}",
                  "mesh: " + mesh);
}

TEST_F(SceneFile, ReadsASheet) {
  const Scene scene = load(kValid);
  const ClothMesh expected = makeRectangle(0.3, 0.2, 3, 2, Triangulation::kAlternating);
  EXPECT_EQ(scene.mesh.triangles, expected.triangles);
  EXPECT_EQ(scene.mesh.rest_coordinates, expected.rest_coordinates);
  EXPECT_EQ(scene.mesh.initial_positions, expected.initial_positions);
  EXPECT_EQ(scene.fabric_path, (root_ / "fabrics/silk.yaml").string());
  EXPECT_EQ(scene.attached_particles, (std::vector<int>{8, 9, 10, 11}));
  EXPECT_EQ(scene.time_step, 0.0125);
}

TEST_F(SceneFile, ReadsOneWayDiagonals) {
  EXPECT_EQ(load(replaced(kValid, "alternating", "one_way")).mesh.triangles,
            makeRectangle(0.3, 0.2, 3, 2, Triangulation::kOneWay).triangles);
}

TEST_F(SceneFile, ModelsOnlyWhatIsListed) {
  const Scene both = load(kValid);
  EXPECT_TRUE(both.effects.viscosity);
  EXPECT_EQ(both.effects.gravity, Eigen::Vector3d(0, 0, -9.80665));
  const Scene none = load(replaced(kValid, "[gravity, viscosity]", "[]"));
  EXPECT_FALSE(none.effects.viscosity);
  EXPECT_EQ(none.effects.gravity, Eigen::Vector3d::Zero());
  EXPECT_FALSE(load(replaced(kValid, "[gravity, viscosity]", "[gravity]")).effects.viscosity);
}

TEST_F(SceneFile, ReadsGravity) {
  EXPECT_EQ(load(kValid + "gravity: [1, 0, -1.62]\n").effects.gravity,
            Eigen::Vector3d(1, 0, -1.62));
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
  const StepSettings step = load(kValid).step;
  EXPECT_EQ(step.solver, LinearSolverMethod::kAutomatic);
  EXPECT_EQ(step.tolerance, 1e-6);
  EXPECT_EQ(step.newton_iterations, 1);
}

TEST_F(SceneFile, ReadsTheSolver) {
  const StepSettings step =
      load(kValid + "solver: {method: cholesky, tolerance: 1e-9, newton_iterations: 5}\n").step;
  EXPECT_EQ(step.solver, LinearSolverMethod::kCholesky);
  EXPECT_EQ(step.tolerance, 1e-9);
  EXPECT_EQ(step.newton_iterations, 5);
  EXPECT_EQ(load(kValid + "solver: {method: conjugate_gradient}\n").step.solver,
            LinearSolverMethod::kConjugateGradient);
  EXPECT_EQ(load(kValid + "solver: {method: automatic}\n").step.solver,
            LinearSolverMethod::kAutomatic);
}

TEST_F(SceneFile, ReadsTheIntegrator) {
  EXPECT_EQ(load(kValid).step.method, IntegrationMethod::kBackwardEuler);
  for (const NamedIntegrationMethod& named : kIntegrationMethods) {
    EXPECT_EQ(load(kValid + "integrator: " + named.name + "\n").step.method, named.method);
  }
  const StepSettings step =
      load(kValid + "integrator: bdf2\nsolver: {newton_iterations: 2}\n").step;
  EXPECT_EQ(step.method, IntegrationMethod::kBdf2);
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

TEST_F(SceneFile, RefusesAMeshOfTooManyTriangles) {
  // A strip of 200001 triangles between two rows of points.
  std::ofstream obj(root_ / "meshes/strip.obj");
  const int triangles = 200001;
  for (int i = 0; i < triangles + 2; ++i) {
    obj << "v 0 " << i << ' ' << i % 2 << "\nvt " << i << ' ' << i % 2 << '\n';
  }
  for (int i = 1; i <= triangles; ++i) {
    obj << "f " << i << '/' << i << ' ' << i + 1 << '/' << i + 1 << ' ' << i + 2 << '/' << i + 2
        << '\n';
  }
  obj.close();
  EXPECT_EQ(refusalOf(meshScene("strip")),
            path() + ": mesh: 200001 triangles, at most 200000 are allowed");
}

TEST_F(SceneFile, LeavesTheKeyOfTheForceRendererToIt) {
  EXPECT_EQ(load(kValid + "haptics: {layer: patch}\n").time_step, 0.0125);
}

TEST_F(SceneFile, AcceptsValuesAtTheirLimits) {
  EXPECT_EQ(load(replaced(kValid, "[3, 2]", "[1000, 100]")).mesh.triangles.size(), 200000u);
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

struct Refusal {
  std::string name;
  std::string from, to;   // the change that makes the valid scene invalid
  std::string complaint;  // after the path
};

void PrintTo(const Refusal& refusal, std::ostream* stream) { *stream << refusal.name; }

class SceneFileRefuses : public SceneFile, public testing::WithParamInterface<Refusal> {};

TEST_P(SceneFileRefuses, NamingFileKeyValueAndWhatIsAllowed) {
  EXPECT_EQ(refusalOf(replaced(kValid, GetParam().from, GetParam().to)),
            path() + ": " + GetParam().complaint);
}

const std::string kSheet = "sheet: {size: [0.3, 0.2], cells: [3, 2], diagonals: alternating}\n";

INSTANTIATE_TEST_SUITE_P(
    Keys, SceneFileRefuses,
    testing::Values(
        Refusal{"UnknownKey", "fabric: silk", "fabric: silk\nwind: 3",
                "wind: unknown key, allowed here: fabric, attach, model, time_step, sheet, mesh, "
                "gravity, integrator, solver, obstacles, haptics"},
        Refusal{"MissingModel", "model: [gravity, viscosity]\n", "",
                "the key 'model' is missing, required here: fabric, attach, model, time_step"},
        Refusal{"MissingAttach", "attach: [top]\n", "",
                "the key 'attach' is missing, required here: fabric, attach, model, time_step"},
        Refusal{"MissingFabric", "fabric: silk\n", "",
                "the key 'fabric' is missing, required here: fabric, attach, model, time_step"},
        Refusal{"MissingTimeStep", "time_step: 0.0125\n", "",
                "the key 'time_step' is missing, required here: fabric, attach, model, time_step"},
        Refusal{"SheetAndMesh",
                "attach:", "mesh: corner\nattach:", "must have exactly one of sheet, mesh"},
        Refusal{"NeitherSheetNorMesh", kSheet, "", "must have exactly one of sheet, mesh"},
        Refusal{"UnknownSheetKey", "size:", "thickness: 1, size:",
                "sheet.thickness: unknown key, allowed here: size, cells, diagonals"},
        Refusal{"MissingCells", "cells: [3, 2], ", "",
                "sheet: the key 'cells' is missing, required here: size, cells, diagonals"},
        Refusal{"UnknownSolverKey", "attach:", "solver: {iterations: 9}\nattach:",
                "solver.iterations: unknown key, allowed here: method, tolerance, "
                "newton_iterations"},
        Refusal{"UnknownAttachKey", "[top]", "[{corner: 1}]",
                "attach[0].corner: unknown key, allowed here: particles"},
        Refusal{"MissingMesh", kSheet, "mesh: ./none.obj\n",
                "mesh: './none.obj' must be a name in " + testing::TempDir() + "haptex_scene_" +
                    std::to_string(getpid()) +
                    "/meshes (corner) or a path with a '/'; there is no file " +
                    testing::TempDir() + "haptex_scene_" + std::to_string(getpid()) +
                    "/scenes/none.obj"}),
    [](const auto& info) { return info.param.name; });

INSTANTIATE_TEST_SUITE_P(
    Values, SceneFileRefuses,
    testing::Values(
        Refusal{"UnknownEffect", "viscosity]", "wind]",
                "model[1]: 'wind' must be one of gravity, viscosity, bending"},
        Refusal{"EffectListedTwice", "viscosity]", "gravity]",
                "model[1]: 'gravity' is listed twice"},
        Refusal{"ModelNotAList", "[gravity, viscosity]", "gravity",
                "model: 'gravity' must be a list"},
        Refusal{"GravityNotModelled", "[gravity, viscosity]", "[viscosity]\ngravity: [0, 0, -1]",
                "gravity: is allowed only if model lists gravity, which it does not"},
        Refusal{"GravityNotAVector",
                "attach:", "gravity: -9.8\nattach:", "gravity: '-9.8' must be a list of 3"},
        Refusal{"GravityNan", "attach:", "gravity: [0, .nan, 0]\nattach:",
                "gravity[1]: '.nan' must be a finite number"},
        Refusal{"ZeroSize", "[0.3, 0.2]", "[0.3, 0]",
                "sheet.size[1]: '0' must be > 0 and <= 100 m"},
        Refusal{"NegativeSize", "[0.3, 0.2]", "[-1, 1]",
                "sheet.size[0]: '-1' must be > 0 and <= 100 m"},
        Refusal{"SizeTooLarge", "[0.3, 0.2]", "[0.3, 100.1]",
                "sheet.size[1]: '100.1' must be > 0 and <= 100 m"},
        Refusal{"SizeNan", "[0.3, 0.2]", "[.nan, 1]",
                "sheet.size[0]: '.nan' must be a finite number"},
        Refusal{"SizeNotAPair", "[0.3, 0.2]", "0.3", "sheet.size: '0.3' must be a list of 2"},
        Refusal{"CellsNotWhole", "[3, 2]", "[3, 2.5]", "sheet.cells[1]: '2.5' must be an integer"},
        Refusal{"NoCells", "[3, 2]", "[0, 2]", "sheet.cells[0]: '0' must be an integer >= 1"},
        Refusal{"TooManyCells", "[3, 2]", "[317, 316]",
                "sheet.cells: 200344 triangles, at most 200000 are allowed"},
        Refusal{"AbsurdlyManyCells", "[3, 2]", "[2147483647, 2147483647]",
                "sheet.cells[0]: 4294967294 triangles, at most 200000 are allowed"},
        Refusal{"CellsTooSlender", "[0.3, 0.2]", "[100, 1e-10]",
                "sheet: degenerate triangles: 0 1 2 3 4 5 6 7 8 9 and 2 more"},
        Refusal{"UnknownDiagonals", "alternating", "random",
                "sheet.diagonals: 'random' must be one of one_way, alternating"},
        Refusal{"UnknownSide", "[top]", "[top, front]",
                "attach[1]: 'front' must be one of top, bottom, left, right"},
        Refusal{"AttachNotAList", "[top]", "top", "attach: 'top' must be a list"},
        Refusal{"ParticleTooLarge", "[top]", "[{particles: [3, 12]}]",
                "attach[0].particles[1]: '12' must be a particle from 0 to 11"},
        Refusal{"ParticleNegative", "[top]", "[{particles: [-1]}]",
                "attach[0].particles[0]: '-1' must be a particle from 0 to 11"},
        Refusal{"ParticleNotAnInteger", "[top]", "[{particles: [one]}]",
                "attach[0].particles[0]: 'one' must be an integer"},
        Refusal{"ZeroTimeStep", "0.0125", "0", "time_step: '0' must be from 1e-6 to 10 s"},
        Refusal{"TimeStepTooLong", "0.0125", "10.5", "time_step: '10.5' must be from 1e-6 to 10 s"},
        Refusal{"TimeStepNan", "0.0125", ".nan", "time_step: '.nan' must be a finite number"},
        Refusal{"UnknownIntegrator", "attach:", "integrator: leapfrog\nattach:",
                "integrator: 'leapfrog' must be one of backward_euler, backward_midpoint, bdf2, "
                "tr_bdf2, explicit_euler, midpoint, runge_kutta_4, two_step_euler"},
        Refusal{"SolverOfAnExplicitIntegrator",
                "attach:", "integrator: runge_kutta_4\nsolver: {tolerance: 1e-9}\nattach:",
                "solver: is allowed only with an implicit integrator, which runge_kutta_4 is not"},
        Refusal{"UnknownMethod", "attach:", "solver: {method: lu}\nattach:",
                "solver.method: 'lu' must be one of automatic, conjugate_gradient, cholesky"},
        Refusal{"ZeroTolerance", "attach:", "solver: {tolerance: 0}\nattach:",
                "solver.tolerance: '0' must be > 0 and < 1"},
        Refusal{"ToleranceOne", "attach:", "solver: {tolerance: 1}\nattach:",
                "solver.tolerance: '1' must be > 0 and < 1"},
        Refusal{"NoNewtonIterations", "attach:", "solver: {newton_iterations: 0}\nattach:",
                "solver.newton_iterations: '0' must be an integer from 1 to 1000"},
        Refusal{"TooManyNewtonIterations", "attach:", "solver: {newton_iterations: 1001}\nattach:",
                "solver.newton_iterations: '1001' must be an integer from 1 to 1000"}),
    [](const auto& info) { return info.param.name; });

TEST(ShippedScenes, LoadWithTheirFabrics) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(kConfig / "scenes")) {
    names.push_back(entry.path().stem().string());
    const Scene scene = loadScene(entry.path().string());
    EXPECT_NO_THROW(requireSound(scene.mesh)) << names.back();
    EXPECT_EQ(scene.mesh.triangles.size(), 2048u) << names.back();
    EXPECT_EQ(scene.attached_particles.size(), 33u) << names.back();
    EXPECT_EQ(scene.time_step, 0.0125) << names.back();
    EXPECT_GT(material::loadFabric(scene.fabric_path).areal_density, 0.0) << names.back();
  }
  std::sort(names.begin(), names.end());
  EXPECT_EQ(names,
            (std::vector<std::string>{"acrylic_knit_sample", "cotton_knit_sample", "linear_sheet",
                                      "wool_among_obstacles", "wool_sample"}));
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
}  // namespace haptex::cloth
