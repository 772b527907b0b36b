// How does the time of a step grow with the size of the cloth? The sheet that is held along an edge
// (held_sheet.h) swings for a quarter of a second, of fabric of 1000 N/m ("linear") and of wool, at
// 12.5 ms, solved once to a relative residual of 1e-4 by whichever solver the automatic choice
// takes, on two threads. Printed are the mean times of a step, what the linear solver takes of it
// ("_solve") and its iterations.
//
// "exponent" is that with which the time of linear grows from the smallest sheet to the largest,
// "memory" what the largest holds.
//
// The system of the last state is solved from zero to 1e-4 by multigrid and by a new factor, their
// patterns set up already ("multigrid", "factor"; of wool "wool_multigrid", "wool_factor"), and by
// CHOLMOD's supernodal factorisation, its pattern analysed already, with OpenBLAS on two threads,
// up to 100352 triangles ("cholmod"); "difference" is that of the two solutions where multigrid
// goes to a residual of 1e-9.
//
// Wool that is folded in half and sags, its layers on one another (folded_sheet.h), makes the same
// steps ("folded_wool", "folded_wool_solve"), up to 31752 triangles; "folded_wool_solves" are its
// linear solves per step.
//
// Where PETSc was found when this was built, it solves the same systems of up to 316808 triangles
// by one process and by two ("gamg", "hypre", "mumps", "gamg_2" ...; petsc_solve.cpp).
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>

#include "cholmod.h"
#include "dumped_system.h"
#include "folded_sheet.h"
#include "haptex/base/constants.h"
#include "haptex/linear/kept_factor.h"
#include "haptex/linear/multigrid.h"
#include "haptex/material/fabric_file.h"
#include "haptex/simulation/step_cost.h"
#include "held_sheet.h"
#include "tab_lines.h"

namespace {

using namespace haptex;
using Clock = std::chrono::steady_clock;

constexpr double kTimeStep = 0.0125;  // s
constexpr double kTolerance = 1e-4;
constexpr double kTight = 1e-9;
constexpr int kThreads = 2;
constexpr int kFirstSteps = 4;  // memory is allocated, hierarchies are made
constexpr int kSteps = 16;
constexpr int kMostIterations = 2000;
constexpr double kStiffness = 1000.0;                   // N/m
constexpr int kCells[] = {32, 71, 126, 224, 398, 707};  // 2048 to 999698 triangles
constexpr int kFoldedCells[] = {32, 71, 126};
constexpr int kMostCellsOfCholmod = 224;
constexpr int kMostCellsOfPetsc = 398;

double milliseconds(Clock::time_point since) {
  return std::chrono::duration<double, std::milli>(Clock::now() - since).count();
}

struct System {
  linear::SymmetricBlockMatrix matrix;
  linear::BlockVector rhs;
};

/// The first one of the step that follows, without what a solve before it changed.
System systemOf(const bench::HeldSheet& sheet) {
  const cloth::Cloth& cloth = sheet.cloth();
  const auto size = static_cast<int>(cloth.particleCount());
  System system{cloth.pattern(), linear::BlockVector::Zero(3, size)};
  for (int i = 0; i < size; ++i) {
    const double mass = cloth.masses()[i];
    system.matrix.diagonal(i).diagonal().setConstant(mass);
    system.rhs.col(i) = kTimeStep * mass * Eigen::Vector3d(0.0, 0.0, -base::kStandardGravity);
  }
  cloth.forces().assembleLinearised(sheet.state().ofForces(), {kTimeStep, kTimeStep}, system.matrix,
                                    system.rhs);
  std::vector<char> held(size, 0);
  for (const int particle : mesh::sideParticles(cloth.mesh(), mesh::Side::kTop)) held[particle] = 1;
  system.matrix.eliminate(held, linear::BlockVector::Zero(3, size), system.rhs);
  return system;
}

bench::DumpedSystem rowsOf(const System& system, const cloth::Positions& positions) {
  const linear::SymmetricBlockMatrix& matrix = system.matrix;
  const int size = matrix.size();
  std::vector<std::vector<std::pair<int, Eigen::Matrix3d>>> rows(size);
  for (int i = 0; i < size; ++i) {
    rows[i].emplace_back(i, matrix.diagonal(i));
    for (int s = matrix.rowBegin(i); s < matrix.rowBegin(i + 1); ++s) {
      rows[i].emplace_back(matrix.column(s), matrix.lower(s));
      rows[matrix.column(s)].emplace_back(i, matrix.lower(s).transpose());
    }
  }
  bench::DumpedSystem dumped;
  dumped.begin.push_back(0);
  for (int i = 0; i < size; ++i) {
    for (const auto& [column, block] : rows[i]) {
      dumped.columns.push_back(column);
      for (int k = 0; k < 9; ++k) dumped.blocks.push_back(block(k / 3, k % 3));
    }
    dumped.begin.push_back(static_cast<int>(dumped.columns.size()));
    for (int c = 0; c < 3; ++c) {
      dumped.rhs.push_back(system.rhs(c, i));
      dumped.positions.push_back(positions[i][c]);
    }
  }
  return dumped;
}

/// By a program beside this one, which is there if PETSc is. Its lines are printed.
void solveByPetsc(const std::filesystem::path& directory, const std::string& triangles,
                  const bench::DumpedSystem& system) {
  const std::filesystem::path program = directory / "petsc_solve";
  if (!std::filesystem::exists(program)) return;
  std::string file = (std::filesystem::temp_directory_path() / "haptexXXXXXX").string();
  const int descriptor = mkstemp(file.data());
  if (descriptor < 0) throw std::runtime_error("no file " + file);
  close(descriptor);
  try {
    bench::writeSystem(system, file);
  } catch (const std::exception&) {
    std::filesystem::remove(file);
    throw;
  }
  const std::string alone = program.string() + " " + file + " " + triangles;
  for (const std::string& command : {alone, "mpirun --oversubscribe -n 2 " + alone}) {
    // Open MPI wants to be told that root may.
    const std::string whole =
        "OPENBLAS_NUM_THREADS=1 OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 " +
        command;
    if (std::system(whole.c_str()) != 0) std::fprintf(stderr, "failed: %s\n", command.c_str());
  }
  std::filesystem::remove(file);
}

void compareSolvers(const std::string& fabric, const std::string& triangles, const System& system,
                    bool with_cholmod) {
  linear::ThreadPool pool(kThreads);
  linear::Multigrid multigrid(system.matrix, &pool);
  linear::ConjugateGradient conjugate_gradient(system.matrix.size(), &pool);
  linear::BlockVector x(3, system.matrix.size());
  const auto solve = [&](double tolerance) {
    x.setZero();
    multigrid.takeValues(system.matrix);
    const linear::SolveResult result = conjugate_gradient.solve(
        system.matrix, multigrid, system.rhs, tolerance, kMostIterations, x);
    if (!result.converged) throw std::runtime_error("multigrid did not reach its tolerance");
  };
  const Clock::time_point start = Clock::now();
  solve(kTolerance);
  const std::string prefix = fabric == "linear" ? "scale/" : "scale/" + fabric + "_";
  bench::printLine(prefix + "multigrid/" + triangles, milliseconds(start), "ms");
  linear::KeptFactor factor(system.matrix, &pool);
  x.setZero();
  const Clock::time_point start_of_factor = Clock::now();
  if (!factor.solve(conjugate_gradient, system.matrix, system.rhs, kTolerance, kMostIterations, x)
           .converged) {
    throw std::runtime_error("the factor did not lead to the tolerance");
  }
  bench::printLine(prefix + "factor/" + triangles, milliseconds(start_of_factor), "ms");
  if (!with_cholmod) return;
  bench::Cholmod cholmod(system.matrix);
  const Eigen::SparseMatrix<double> scalars = bench::Cholmod::scalars(system.matrix);
  const Clock::time_point start_of_cholmod = Clock::now();
  if (!cholmod.factorise(scalars)) throw std::runtime_error("not positive definite");
  const Eigen::VectorXd exact = cholmod.solve(system.rhs);
  bench::printLine("scale/cholmod/" + triangles, milliseconds(start_of_cholmod), "ms");
  solve(kTight);
  const Eigen::Map<const Eigen::VectorXd> ours(x.data(), x.size());
  bench::printLine("scale/difference/" + triangles, (ours - exact).norm() / exact.norm(), "ratio");
}

cloth::StepSettings settings() {
  cloth::StepSettings settings;
  settings.tolerance = kTolerance;
  settings.newton_iterations = 1;
  settings.threads = kThreads;
  return settings;
}

/// Means over steps.
struct StepTimes {
  double total = 0.0, solve = 0.0;  // ms
  double iterations = 0.0, solves = 0.0;
};

StepTimes timesOf(bench::HeldSheet& sheet) {
  StepTimes times;
  for (int step = 0; step < kFirstSteps; ++step) sheet.step(kTimeStep);
  for (int step = 0; step < kSteps; ++step) {
    const cloth::StepReport report = sheet.step(kTimeStep);
    times.total += 1e3 * report.total_seconds / kSteps;
    times.solve += 1e3 * report.solve_seconds / kSteps;
    times.iterations += static_cast<double>(report.linear_iterations) / kSteps;
    times.solves += static_cast<double>(report.newton_iterations) / kSteps;
  }
  return times;
}

void measureFolded(const material::Fabric& wool, int cells) {
  bench::HeldSheet sheet = bench::foldedSheet(wool, cells, settings());
  const StepTimes times = timesOf(sheet);
  const std::string triangles = std::to_string(sheet.triangleCount());
  bench::printLine("scale/folded_wool/" + triangles, times.total, "ms");
  bench::printLine("scale/folded_wool_solve/" + triangles, times.solve, "ms");
  bench::printLine("scale/folded_wool_solves/" + triangles, times.solves, "per_step");
}

/// @returns ms, of a step
double measure(const std::string& name, const material::Fabric& fabric, int cells,
               const std::filesystem::path& programs) {
  const bool compared = name == "linear";
  const std::size_t before = simulation::allocatedBytes();
  bench::HeldSheet sheet(fabric, cells, settings());
  const std::string triangles = std::to_string(sheet.triangleCount());
  const StepTimes times = timesOf(sheet);
  bench::printLine("scale/" + name + "/" + triangles, times.total, "ms");
  bench::printLine("scale/" + name + "_solve/" + triangles, times.solve, "ms");
  bench::printLine("scale/" + name + "_iterations/" + triangles, times.iterations, "per_step");
  if (compared && cells == kCells[std::size(kCells) - 1]) {
    const auto bytes = static_cast<double>(simulation::allocatedBytes() - before);
    bench::printLine("scale/memory", bytes / sheet.triangleCount() / 1e3, "kB_per_triangle");
  }
  const System system = systemOf(sheet);
  compareSolvers(name, triangles, system, compared && cells <= kMostCellsOfCholmod);
  if (compared && cells <= kMostCellsOfPetsc) {
    solveByPetsc(programs, triangles, rowsOf(system, sheet.state().positions));
  }
  return times.total;
}

}  // namespace

int main(int, char** argv) {
  try {
    const std::filesystem::path programs = std::filesystem::path(argv[0]).parent_path();
    const std::string fabrics = HAPTEX_CONFIG_DIRECTORY "/fabrics/";
    const material::Fabric linear =
        bench::withStiffness(material::loadFabric(fabrics + "linear.yaml"), kStiffness);
    const material::Fabric wool = material::loadFabric(fabrics + "wool.yaml");
    double first = 0.0, last = 0.0;
    for (const int cells : kCells) {
      last = measure("linear", linear, cells, programs);
      if (first == 0.0) first = last;
    }
    const double growth = static_cast<double>(kCells[std::size(kCells) - 1]) / kCells[0];
    bench::printLine("scale/exponent", std::log(last / first) / (2.0 * std::log(growth)),
                     "exponent");
    for (const int cells : kFoldedCells) measureFolded(wool, cells);
    for (const int cells : kCells) measure("wool", wool, cells, programs);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_scale: %s\n", error.what());
    return 1;
  }
  return 0;
}
