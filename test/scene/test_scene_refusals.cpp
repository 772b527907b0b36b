// What scene files may not say.
#include <gtest/gtest.h>

#include <string>

#include "scene_fixtures.h"

namespace haptex::scene::test_scene_refusals {
namespace {

class SceneFileRefuses : public RefusedScene {};

TEST_P(SceneFileRefuses, NamingFileKeyValueAndWhatIsAllowed) { expectRefusal(kValid); }

const std::string kSheet = "sheet: {size: [0.3, 0.2], cells: [3, 2], diagonals: alternating}\n";

INSTANTIATE_TEST_SUITE_P(
    Keys, SceneFileRefuses,
    testing::Values(
        Refusal{"UnknownKey", "fabric: silk", "fabric: silk\nwaves: 3",
                "waves: unknown key, allowed here: fabric, attach, model, time_step, sheet, mesh, "
                "elasticity, gravity, bending, air, wind, integrator, solver, obstacles, "
                "penalty, haptics, state, regions, frames, fasteners, stuffing"},
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
        Refusal{
            "UnknownSheetKey", "size:", "thickness: 1, size:",
            "sheet.thickness: unknown key, allowed here: size, cells, diagonals, position, rpy"},
        Refusal{"MissingCells", "cells: [3, 2], ", "",
                "sheet: the key 'cells' is missing, required here: size, cells, diagonals"},
        Refusal{"UnknownSolverKey", "attach:", "solver: {iterations: 9}\nattach:",
                "solver.iterations: unknown key, allowed here: method, tolerance, "
                "newton_iterations, error, threads"},
        Refusal{"UnknownAttachKey", "[top]", "[{corner: 1}]",
                "attach[0].corner: unknown key, allowed here: particles, side, from, to, frame"},
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
        Refusal{"UnknownEffect", "viscosity]", "steam]",
                "model[1]: 'steam' must be one of gravity, viscosity, membrane_hysteresis, "
                "bending, bending_hysteresis, contraction, self_collision, stuffing, air, wind, "
                "obstacles, fingers, tactile, recording"},
        Refusal{"SelfCollisionOfOtherIntegrators", "[gravity, viscosity]",
                "[self_collision]\nintegrator: backward_midpoint",
                "integrator: 'backward_midpoint' is not allowed if model lists self_collision: "
                "backward_euler, bdf2 and tr_bdf2 are"},
        Refusal{"SelfCollisionAmongObstaclesOfOtherIntegrators", "[gravity, viscosity]",
                "[self_collision, obstacles]\nintegrator: bdf2",
                "integrator: 'bdf2' is not allowed if model lists self_collision and obstacles: "
                "backward_euler is"},
        Refusal{"UnknownElasticity", "attach:", "elasticity: rubber\nattach:",
                "elasticity: 'rubber' must be one of green_lagrange, bilinear, mass_spring, "
                "corotational"},
        Refusal{"ContractionOfSprings", "[gravity, viscosity]",
                "[contraction]\nelasticity: mass_spring",
                "elasticity: 'mass_spring' is not allowed if model lists contraction"},
        Refusal{"MembraneHysteresisOfLinearElements", "[gravity, viscosity]",
                "[membrane_hysteresis]\nelasticity: corotational",
                "elasticity: 'corotational' is not allowed if model lists membrane_hysteresis"},
        Refusal{"HysteresisOfSprings", "[gravity, viscosity]",
                "[bending, bending_hysteresis]\nelasticity: mass_spring",
                "elasticity: 'mass_spring' is not allowed if model lists bending_hysteresis"},
        Refusal{"HysteresisWithoutBending", "[gravity, viscosity]", "[bending_hysteresis]",
                "model: lists bending_hysteresis, which needs bending listed, too"},
        Refusal{"WindWithoutAir", "[gravity, viscosity]", "[wind]\nwind: {velocity: [1, 0, 0]}",
                "model: lists wind, which needs air listed, too"},
        Refusal{"TactileWithoutFingers", "[gravity, viscosity]", "[tactile]",
                "model: lists tactile, which needs fingers listed, too"},
        Refusal{"HapticsWithoutFingers", "attach:", "haptics: {refinement: 1}\nattach:",
                "haptics: is allowed only if model lists fingers, which it does not"},
        Refusal{"RecordingTwice", "[gravity, viscosity]", "[recording, recording]",
                "model[1]: 'recording' is listed twice"},
        Refusal{"BendingSettingsOfSprings", "[gravity, viscosity]",
                "[bending]\nelasticity: mass_spring\nbending: {model: quadratic}",
                "bending: is not allowed with mass_spring, which bends by springs"},
        Refusal{"EffectListedTwice", "viscosity]", "gravity]",
                "model[1]: 'gravity' is listed twice"},
        Refusal{"ModelNotAList", "[gravity, viscosity]", "gravity",
                "model: 'gravity' must be a list"},
        Refusal{"GravityNotModelled", "[gravity, viscosity]", "[viscosity]\ngravity: [0, 0, -1]",
                "gravity: is allowed only if model lists gravity, which it does not"},
        Refusal{"WindNotModelled", "attach:", "wind: {velocity: [1, 0, 0]}\nattach:",
                "wind: is allowed only if model lists wind, which it does not"},
        Refusal{"WindInStillAir", "viscosity]", "air]\nwind: {velocity: [1, 0, 0]}",
                "wind: is allowed only if model lists wind, which it does not"},
        Refusal{"WindUnknown", "viscosity]", "air, wind]",
                "model: lists wind, so the key wind is required"},
        Refusal{"AirNotModelled", "attach:", "air: {normal: 1}\nattach:",
                "air: is allowed only if model lists air, which it does not"},
        Refusal{"AirCoefficientNegative", "viscosity]", "air]\nair: {lift: -1}",
                "air.lift: '-1' must be a finite number >= 0"},
        Refusal{"WindWithoutVelocity", "viscosity]", "air, wind]\nwind: {}",
                "wind: the key 'velocity' is missing, required here: velocity"},
        Refusal{"GustFrequencyNegative", "viscosity]",
                "air, wind]\n"
                "wind: {velocity: [1, 0, 0], gusts: [{velocity: [0, 1, 0], frequency: -1}]}",
                "wind.gusts[0].frequency: '-1' must be a finite number >= 0"},
        Refusal{"BendingNotModelled", "attach:", "bending: {model: linear}\nattach:",
                "bending: is allowed only if model lists bending, which it does not"},
        Refusal{"UnknownBendingModel", "[gravity, viscosity]", "[bending]\nbending: {model: cubic}",
                "bending.model: 'cubic' must be one of linear, quadratic"},
        Refusal{"UnknownBendingKey", "[gravity, viscosity]", "[bending]\nbending: {hysteresis: 1}",
                "bending.hysteresis: unknown key, allowed here: model, rest_curvature"},
        Refusal{"RestCurvatureOfOneDirection", "[gravity, viscosity]",
                "[bending]\nbending: {rest_curvature: {weft: 1}}",
                "bending.rest_curvature: the key 'warp' is missing, required here: weft, warp"},
        Refusal{"RestCurvatureTooLarge", "[gravity, viscosity]",
                "[bending]\nbending: {rest_curvature: {weft: 1, warp: -1001}}",
                "bending.rest_curvature.warp: '-1001' must be from -1000 to 1000 1/m"},
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
        Refusal{"TooManyCells", "[3, 2]", "[1001, 1000]",
                "sheet.cells: 2002000 triangles, at most 2000000 are allowed"},
        Refusal{"AbsurdlyManyCells", "[3, 2]", "[2147483647, 2147483647]",
                "sheet.cells[0]: 4294967294 triangles, at most 2000000 are allowed"},
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
        Refusal{"AdaptiveWithoutError", "0.0125", "{from: 0.001, to: 0.01}",
                "time_step: the key 'error' is missing, required here: from, to, error"},
        Refusal{"AdaptiveFromTooShort", "0.0125", "{from: 1.0e-7, to: 0.01, error: 1.0e-4}",
                "time_step.from: '1.0e-7' must be from 1e-6 to 10 s"},
        Refusal{"AdaptiveBackwards", "0.0125", "{from: 0.01, to: 0.001, error: 1.0e-4}",
                "time_step.to: '0.001' must not be shorter than from"},
        Refusal{"AdaptiveWithoutAnyError", "0.0125", "{from: 0.001, to: 0.01, error: 0}",
                "time_step.error: '0' must be > 0 and at most 1 m"},
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
        Refusal{"ZeroError", "attach:", "solver: {newton_iterations: 9, error: 0}\nattach:",
                "solver.error: '0' must be > 0 and < 1"},
        Refusal{"ErrorOne", "attach:", "solver: {newton_iterations: 9, error: 1}\nattach:",
                "solver.error: '1' must be > 0 and < 1"},
        Refusal{"ErrorOfOneSolve", "attach:", "solver: {error: 1e-3}\nattach:",
                "solver.error: '1e-3' needs newton_iterations of at least 2 to reach it"},
        Refusal{"NoThreads", "attach:", "solver: {threads: 0}\nattach:",
                "solver.threads: '0' must be an integer from 1 to 64"},
        Refusal{"TooManyThreads", "attach:", "solver: {threads: 65}\nattach:",
                "solver.threads: '65' must be an integer from 1 to 64"},
        Refusal{"TooManyNewtonIterations", "attach:", "solver: {newton_iterations: 1001}\nattach:",
                "solver.newton_iterations: '1001' must be an integer from 1 to 1000"}),
    [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace haptex::scene::test_scene_refusals
