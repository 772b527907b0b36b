// The program large_sheet: the sheet of a scene in as many cells as several machines can hold, by
// the reference method on PETSc over MPI (docs/large_sheets.md). Needs no ROS master.
#include "haptex/large/large_sheet.h"

#include <petscsys.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <sstream>
#include <string>
#include <thread>

#include "haptex/base/command_line.h"
#include "haptex/base/require.h"
#include "haptex/nodes/common/config_files.h"

namespace {

using namespace haptex;

constexpr const char* kUsage =
    "usage: mpirun -n PROCESSES large_sheet SCENE --edge M [--seconds S] [--step S] [--out OBJ]\n"
    "SCENE is the name of a scene of the package or the path of a scene file: a sheet that is "
    "held\n"
    "by its sides. No edge along weft or warp is longer than --edge (m). It moves for --seconds "
    "(1)\n"
    "in steps of --step (that of the scene) and is then written to OBJ. The environment variable\n"
    "PETSC_OPTIONS has options of PETSc.\n";

struct Request {
  large::Sheet sheet;
  double step = 0.0;  // s
  int steps = 0;
  std::string out;
};

constexpr double kMostSteps = 1e9;

double numberOf(const base::CommandLine& line, const std::string& option, double otherwise) {
  return line.number(
      option, otherwise, [](double number) { return std::isfinite(number) && number > 0.0; },
      "are numbers greater than 0");
}

Request readRequest(const std::vector<std::string>& arguments) {
  const base::CommandLine line =
      base::readCommandLine(arguments, {"--edge", "--seconds", "--step", "--out"});
  if (line.files.size() != 1) {
    base::refuse(line.files.size(), " scenes are named: allowed is one");
  }
  if (line.options.count("--edge") == 0) base::refuse("--edge is missing: it is needed");
  Request request;
  request.sheet = large::loadSheet(nodes::findConfigFile("scenes", line.files[0]),
                                   numberOf(line, "--edge", 0.0));
  request.step = numberOf(line, "--step", request.sheet.time_step);
  const double steps = std::ceil(numberOf(line, "--seconds", 1.0) / request.step - 1e-9);
  if (!(steps <= kMostSteps)) {
    base::refuse("--seconds are ", steps, " steps of --step: allowed are ", kMostSteps);
  }
  request.steps = static_cast<int>(steps);
  request.out = line.value("--out");
  return request;
}

/// A line per step: what is printed belongs to the first process.
void run(const Request& request, bool prints) {
  large::LargeSheet sheet(request.sheet);
  std::ofstream file;
  if (prints && !request.out.empty()) {
    file.open(request.out);
    if (!file) base::refuse("cannot write to ", request.out);
  }
  if (prints) {
    std::printf("# %lld particles, %lld triangles\n",
                static_cast<long long>(request.sheet.particleCount()),
                static_cast<long long>(request.sheet.triangleCount()));
    std::printf("time_s\tnewton\tlinear\tresidual\tkinetic_J\tpotential_J\tlowest_m\ttaken_s\n");
  }
  for (int i = 0; i < request.steps; ++i) {
    const auto start = std::chrono::steady_clock::now();
    const large::LargeStep step = sheet.step(request.step);
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
    const large::SheetEnergy energy = sheet.energy();
    const double lowest = sheet.lowest();
    if (prints) {
      std::printf("%.9g\t%d\t%d\t%.3g\t%.9g\t%.9g\t%.9g\t%.3g\n", sheet.time(),
                  step.newton_iterations, step.linear_iterations, step.residual, energy.kinetic,
                  energy.potential, lowest, taken.count());
      std::fflush(stdout);
    }
    if (step.converged) continue;
    std::ostringstream message;
    message << "the step to " << sheet.time() << " s has not converged: its residual is "
            << step.residual << " of the weight; try a shorter --step";
    throw std::runtime_error(message.str());
  }
  if (request.out.empty()) return;
  sheet.writeObj(file);
  if (prints && !file.flush()) base::refuse("cannot write to ", request.out);
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  int none = 1;
  if (PetscInitialize(&none, &argv, nullptr, nullptr) != 0) return 1;
  int rank = 0;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  // All processes refuse the same arguments; one says so.
  std::ostringstream unsaid;
  Request request;
  const int status = base::runProgram(
      kUsage, rank == 0 ? std::cerr : unsaid, [&] { request = readRequest(arguments); },
      [&] {
        run(request, rank == 0);
        return 0;
      });
  if (status == 1) {
    if (rank != 0) {
      // Mostly the first one has failed, too, and says why before it ends all.
      std::this_thread::sleep_for(std::chrono::seconds(1));
      std::cerr << "process " << rank << ": " << unsaid.str();
    }
    MPI_Abort(PETSC_COMM_WORLD, 1);  // the others may wait for this one
  }
  PetscFinalize();
  return status;
}
