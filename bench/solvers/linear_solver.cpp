// What does a factorisation cost in iterations of conjugate gradients? The constants behind
// KeptFactor's costs are the ratios kept_number_over_block, of the triangular solves,
// fitted_operation_over_block and fitted_factor_number_over_block, which together give the time
// of the factorisation in single precision at the smallest and the largest size, and
// analysed_number_over_block, of what is made anew for a matrix with new couplings; how supernodes
// are merged (elimination.cpp) was chosen by the factorisation times printed here. The systems are
// those of a swinging sheet of the linear reference at 12.5 ms. The patch cases are the parts of a
// 1 ms step of a sheet as small as the one that follows a fingertip, of wool with viscosity, with
// and without the matrix blocks that bending needs. cholmod is CHOLMOD's supernodal factorisation
// of the same systems, by scalars and with OpenBLAS on one thread.
#include "haptex/linear/linear_solver.h"

#include <Eigen/LU>

#include "cholmod.h"
#include "haptex/base/constants.h"
#include "haptex/cloth/dynamics/cloth.h"
#include "haptex/linear/ordering.h"
#include "haptex/material/fabric_file.h"
#include "tab_lines.h"

namespace {

using namespace haptex;

constexpr int kRuns = 20;
constexpr int kIterations = 50;
constexpr int kPatchRuns = 10;
constexpr int kPatchRepetitions = 200;
constexpr int kPatchCells = 16;
constexpr double kPatchStep = 0.001;  // s

struct System {
  linear::SymmetricBlockMatrix matrix;
  linear::BlockVector rhs;
};

/// The step of a sheet that is stretched by 2 % and pulled sideways by gravity.
System makeSystem(int cells) {
  const mesh::ClothMesh mesh =
      mesh::makeRectangle(0.5, 0.5, cells, cells, mesh::Triangulation::kAlternating);
  const material::Fabric fabric =
      material::loadFabric(HAPTEX_CONFIG_DIRECTORY "/fabrics/linear.yaml");
  cloth::ModelledEffects effects;
  effects.gravity = {-base::kStandardGravity, 0.0, 0.0};
  const cloth::Cloth cloth(mesh, fabric, effects);
  const int size = static_cast<int>(cloth.particleCount());
  System system{linear::SymmetricBlockMatrix(size, mesh.triangles),
                linear::BlockVector::Zero(3, size)};
  cloth::ClothState state = cloth.initialState();
  for (Eigen::Vector3d& position : state.positions) position *= 1.02;
  for (int i = 0; i < size; ++i) {
    system.matrix.diagonal(i).diagonal().setConstant(cloth.masses()[i]);
  }
  cloth.forces().assembleLinearised(state.ofForces(), {0.0125, 0.0125}, system.matrix, system.rhs);
  return system;
}

void factorisation(benchmark::State& run, int cells) {
  const System system = makeSystem(cells);
  linear::BlockCholesky cholesky(system.matrix);
  linear::BlockVector x(3, system.matrix.size());
  for (auto _ : run) {
    if (!cholesky.factorise(system.matrix)) run.SkipWithError("not positive definite");
    x = system.rhs;
    cholesky.solve(x);
  }
}

/// With the system as scalars already: what a program that assembles that way pays.
void cholmod(benchmark::State& run, int cells) {
  const System system = makeSystem(cells);
  bench::Cholmod solver(system.matrix);
  const Eigen::SparseMatrix<double> scalars = bench::Cholmod::scalars(system.matrix);
  Eigen::VectorXd x;
  for (auto _ : run) {
    if (!solver.factorise(scalars)) run.SkipWithError("not positive definite");
    x = solver.solve(system.rhs);
  }
}

/// |x - y| / |y| of the block factorisation's x and CHOLMOD's y.
double differenceToCholmod(const System& system) {
  linear::BlockCholesky cholesky(system.matrix);
  bench::Cholmod solver(system.matrix);
  cholesky.factorise(system.matrix);
  solver.factorise(bench::Cholmod::scalars(system.matrix));
  linear::BlockVector x = system.rhs;
  cholesky.solve(x);
  const Eigen::VectorXd y = solver.solve(system.rhs);
  return (Eigen::Map<const Eigen::VectorXd>(x.data(), x.size()) - y).norm() / y.norm();
}

void keptFactorisation(benchmark::State& run, int cells) {
  const System system = makeSystem(cells);
  linear::BasicBlockCholesky<float> factor(system.matrix);
  for (auto _ : run) {
    if (!factor.factorise(system.matrix)) run.SkipWithError("not positive definite");
  }
}

void keptSolve(benchmark::State& run, int cells) {
  const System system = makeSystem(cells);
  linear::BasicBlockCholesky<float> factor(system.matrix);
  if (!factor.factorise(system.matrix)) run.SkipWithError("not positive definite");
  linear::BlockVector x(3, system.matrix.size());
  for (auto _ : run) {
    x = system.rhs;
    factor.solve(x);
  }
}

/// A pattern, its order and the factor's structure and memory, without numbers.
void analysis(benchmark::State& run, int cells) {
  const System system = makeSystem(cells);
  for (auto _ : run) {
    const linear::SymmetricBlockMatrix pattern = system.matrix.wholePattern();
    const linear::BasicBlockCholesky<float> factor(
        pattern, linear::analyse(pattern, linear::minimumDegreeOrder(pattern)), nullptr);
    benchmark::DoNotOptimize(factor.numbers());
  }
}

void iterations(benchmark::State& run, int cells) {
  const System system = makeSystem(cells);
  linear::ConjugateGradient solver(system.matrix.size());
  linear::BlockVector x(3, system.matrix.size());
  for (auto _ : run) {
    x.setZero();
    solver.solve(system.matrix, system.rhs, 1e-15, kIterations, x);
  }
}

struct Patch {
  cloth::Cloth cloth;
  cloth::ClothState state;
  System system;

  explicit Patch(bool bending) : Patch(makeCloth(bending)) {}

  void assemble() {
    system.matrix.setZero();
    for (int i = 0; i < system.matrix.size(); ++i) {
      system.matrix.diagonal(i).diagonal().setConstant(cloth.masses()[i]);
    }
    system.rhs.setZero();
    cloth.forces().assembleLinearised(state.ofForces(), {kPatchStep, kPatchStep}, system.matrix,
                                      system.rhs);
  }

 private:
  static cloth::Cloth makeCloth(bool bending) {
    cloth::ModelledEffects effects;
    effects.viscosity = true;
    effects.bending = bending;
    return {mesh::makeRectangle(0.025, 0.025, kPatchCells, kPatchCells,
                                mesh::Triangulation::kAlternating),
            material::loadFabric(HAPTEX_CONFIG_DIRECTORY "/fabrics/wool.yaml"), effects};
  }
  explicit Patch(cloth::Cloth made)
      : cloth(std::move(made)),
        state(cloth.initialState()),
        system{cloth.pattern(), linear::BlockVector::Zero(3, cloth.particleCount())} {
    for (Eigen::Vector3d& position : state.positions) position *= 1.02;
    assemble();
  }
};

void patchAssembly(benchmark::State& run, bool bending) {
  Patch patch(bending);
  for (auto _ : run) patch.assemble();
}

void patchFactorisation(benchmark::State& run, bool bending) {
  const Patch patch(bending);
  linear::BlockCholesky cholesky(patch.system.matrix);
  for (auto _ : run) {
    if (!cholesky.factorise(patch.system.matrix)) run.SkipWithError("not positive definite");
  }
}

void patchSolve(benchmark::State& run, bool bending) {
  const Patch patch(bending);
  linear::BlockCholesky cholesky(patch.system.matrix);
  if (!cholesky.factorise(patch.system.matrix)) run.SkipWithError("not positive definite");
  linear::BlockVector x = patch.system.rhs;
  for (auto _ : run) {
    x = patch.system.rhs;
    cholesky.solve(x);
  }
}

void registerPatch() {
  const std::string triangles = "/" + std::to_string(2 * kPatchCells * kPatchCells);
  for (bool bending : {false, true}) {
    const std::string end = (bending ? "_bending" : "") + triangles;
    const auto add = [&](const std::string& name, void (*function)(benchmark::State&, bool)) {
      benchmark::RegisterBenchmark(("linear_solver/patch_" + name + end).c_str(), function, bending)
          ->Iterations(kPatchRuns)
          ->Repetitions(kPatchRepetitions);
    };
    add("assembly", patchAssembly);
    add("factorise", patchFactorisation);
    add("solve", patchSolve);
  }
}

}  // namespace

int main(int argc, char** argv) {
  const int cells[] = {22, 32, 50, 71, 224};
  for (int count : cells) {
    const std::string triangles = std::to_string(2 * count * count);
    benchmark::RegisterBenchmark(("linear_solver/factorise_and_solve/" + triangles).c_str(),
                                 factorisation, count)
        ->Iterations(kRuns);
    benchmark::RegisterBenchmark(("linear_solver/cholmod/" + triangles).c_str(), cholmod, count)
        ->Iterations(kRuns);
    benchmark::RegisterBenchmark(("linear_solver/kept_factorise/" + triangles).c_str(),
                                 keptFactorisation, count)
        ->Iterations(kRuns);
    benchmark::RegisterBenchmark(("linear_solver/kept_solve/" + triangles).c_str(), keptSolve,
                                 count)
        ->Iterations(kRuns);
    benchmark::RegisterBenchmark(("linear_solver/analyse/" + triangles).c_str(), analysis, count)
        ->Iterations(kRuns);
    benchmark::RegisterBenchmark(("linear_solver/50_iterations/" + triangles).c_str(), iterations,
                                 count)
        ->Iterations(kRuns);
  }
  registerPatch();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  bench::TabReporter reporter;
  benchmark::RunSpecifiedBenchmarks(&reporter);
  if (reporter.failed()) return 1;
  // Rows (operations, numbers) and right-hand side of the fit.
  Eigen::Matrix2d work;
  Eigen::Vector2d spent;
  for (const int count : cells) {
    const System system = makeSystem(count);
    const linear::BlockCholesky cholesky(system.matrix);
    const std::string triangles = std::to_string(2 * count * count);
    const double factorisation_time =
        reporter.time("linear_solver/factorise_and_solve/" + triangles);
    const double iteration_time =
        reporter.time("linear_solver/50_iterations/" + triangles) / kIterations;
    const double per_operation = factorisation_time / cholesky.cost();
    const double blocks = system.matrix.size() + 2.0 * system.matrix.lowerCount();
    const double per_block = iteration_time / blocks;
    bench::printLine("linear_solver/iterations_per_factorisation/" + triangles,
                     factorisation_time / iteration_time, "iterations");
    bench::printLine("linear_solver/factorise_and_solve_over_cholmod/" + triangles,
                     factorisation_time / reporter.time("linear_solver/cholmod/" + triangles),
                     "ratio");
    bench::printLine("linear_solver/difference_to_cholmod/" + triangles,
                     differenceToCholmod(system), "ratio");
    bench::printLine("linear_solver/operation_over_block/" + triangles, per_operation / per_block,
                     "ratio");
    bench::printLine(
        "linear_solver/kept_operation_over_block/" + triangles,
        reporter.time("linear_solver/kept_factorise/" + triangles) / cholesky.cost() / per_block,
        "ratio");
    bench::printLine(
        "linear_solver/kept_number_over_block/" + triangles,
        reporter.time("linear_solver/kept_solve/" + triangles) / cholesky.numbers() / per_block,
        "ratio");
    bench::printLine(
        "linear_solver/analysed_number_over_block/" + triangles,
        reporter.time("linear_solver/analyse/" + triangles) / cholesky.numbers() / per_block,
        "ratio");
    const int row = count == cells[0] ? 0 : 1;  // the last stays
    work.row(row) << cholesky.cost(), cholesky.numbers();
    spent[row] = reporter.time("linear_solver/kept_factorise/" + triangles) / per_block;
  }
  const Eigen::Vector2d fit = work.inverse() * spent;
  bench::printLine("linear_solver/fitted_operation_over_block/100352", fit[0], "ratio");
  bench::printLine("linear_solver/fitted_factor_number_over_block/100352", fit[1], "ratio");
  return 0;
}
