// petsc_solve FILE TRIANGLES: what a system of scripts/bench scale takes PETSc, on each MPI process
// that runs this: GAMG and hypre's BoomerAMG as preconditioners of conjugate gradients to a
// relative residual of 1e-4, told the rigid motions, and MUMPS. Patterns are set up already, values
// are new.
#include <petscksp.h>

#include <cstdio>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "dumped_system.h"

namespace {

using haptex::bench::DumpedSystem;

constexpr double kTolerance = 1e-4;
constexpr int kMostIterations = 2000;

struct Problem {
  Mat matrix = nullptr;
  Vec rhs = nullptr, x = nullptr;
};

/// Of the rows of this process.
void setValues(const DumpedSystem& system, Problem& problem) {
  PetscInt begin = 0, end = 0;
  MatGetOwnershipRange(problem.matrix, &begin, &end);
  for (PetscInt row = begin / 3; row < end / 3; ++row) {
    for (int s = system.begin[row]; s < system.begin[row + 1]; ++s) {
      const PetscInt block_row = row, column = system.columns[s];
      MatSetValuesBlocked(problem.matrix, 1, &block_row, 1, &column, &system.blocks[9 * s],
                          INSERT_VALUES);
    }
    for (PetscInt c = 3 * row; c < 3 * row + 3; ++c) {
      VecSetValue(problem.rhs, c, system.rhs[c], INSERT_VALUES);
    }
  }
  MatAssemblyBegin(problem.matrix, MAT_FINAL_ASSEMBLY);
  MatAssemblyEnd(problem.matrix, MAT_FINAL_ASSEMBLY);
  VecAssemblyBegin(problem.rhs);
  VecAssemblyEnd(problem.rhs);
}

Problem makeProblem(const DumpedSystem& system) {
  Problem problem;
  const auto size = static_cast<PetscInt>(system.rhs.size());
  MatCreate(PETSC_COMM_WORLD, &problem.matrix);
  MatSetSizes(problem.matrix, PETSC_DECIDE, PETSC_DECIDE, size, size);
  MatSetBlockSize(problem.matrix, 3);
  MatSetType(problem.matrix, MATAIJ);
  MatSetFromOptions(problem.matrix);
  constexpr PetscInt kMostInRow = 3 * 16;
  MatSeqAIJSetPreallocation(problem.matrix, kMostInRow, nullptr);
  MatMPIAIJSetPreallocation(problem.matrix, kMostInRow, nullptr, kMostInRow, nullptr);
  MatSetOption(problem.matrix, MAT_SPD, PETSC_TRUE);
  MatCreateVecs(problem.matrix, &problem.x, &problem.rhs);
  setValues(system, problem);

  Vec positions = nullptr;
  VecDuplicate(problem.rhs, &positions);
  VecSetBlockSize(positions, 3);
  PetscInt begin = 0, end = 0;
  VecGetOwnershipRange(positions, &begin, &end);
  for (PetscInt c = begin; c < end; ++c) {
    VecSetValue(positions, c, system.positions[c], INSERT_VALUES);
  }
  VecAssemblyBegin(positions);
  VecAssemblyEnd(positions);
  MatNullSpace rigid = nullptr;
  MatNullSpaceCreateRigidBody(positions, &rigid);
  MatSetNearNullSpace(problem.matrix, rigid);
  MatNullSpaceDestroy(&rigid);
  VecDestroy(&positions);
  return problem;
}

void measure(const char* name, const std::string& triangles, const DumpedSystem& system,
             Problem& problem) {
  const std::string kind = name;
  const bool is_direct = kind == "mumps";
  KSP ksp = nullptr;
  PC preconditioner = nullptr;
  KSPCreate(PETSC_COMM_WORLD, &ksp);
  KSPSetOperators(ksp, problem.matrix, problem.matrix);
  KSPGetPC(ksp, &preconditioner);
  if (is_direct) {
    KSPSetType(ksp, KSPPREONLY);
    PCSetType(preconditioner, PCCHOLESKY);
    PCFactorSetMatSolverType(preconditioner, MATSOLVERMUMPS);
  } else {
    KSPSetType(ksp, KSPCG);
    KSPSetNormType(ksp, KSP_NORM_UNPRECONDITIONED);
    KSPSetTolerances(ksp, kTolerance, PETSC_DEFAULT, PETSC_DEFAULT, kMostIterations);
    PCSetType(preconditioner, kind == "gamg" ? PCGAMG : PCHYPRE);
    if (kind == "gamg") PCGAMGSetReuseInterpolation(preconditioner, PETSC_TRUE);
    if (kind == "hypre") PCHYPRESetType(preconditioner, "boomeramg");
  }
  KSPSetFromOptions(ksp);
  KSPSetUp(ksp);
  KSPSolve(ksp, problem.rhs, problem.x);
  setValues(system, problem);
  VecSet(problem.x, 0.0);
  const double start = MPI_Wtime();
  KSPSetUp(ksp);
  KSPSolve(ksp, problem.rhs, problem.x);
  const double seconds = MPI_Wtime() - start;

  KSPConvergedReason reason = KSP_CONVERGED_ITERATING;
  KSPGetConvergedReason(ksp, &reason);
  PetscInt iterations = 0;
  KSPGetIterationNumber(ksp, &iterations);
  int processes = 1, rank = 0;
  MPI_Comm_size(PETSC_COMM_WORLD, &processes);
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  const std::string line =
      "scale/" + kind + (processes > 1 ? "_" + std::to_string(processes) : std::string());
  if (rank == 0 && reason > 0) {
    std::printf("%s/%s\t%.6g\tms\n", line.c_str(), triangles.c_str(), 1e3 * seconds);
    if (!is_direct) {
      std::printf("%s_iterations/%s\t%d\tper_solve\n", line.c_str(), triangles.c_str(),
                  static_cast<int>(iterations));
    }
    std::fflush(stdout);
  } else if (rank == 0) {
    std::fprintf(stderr, "%s/%s: no solution within %d iterations\n", line.c_str(),
                 triangles.c_str(), kMostIterations);
  }
  KSPDestroy(&ksp);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: petsc_solve FILE TRIANGLES\n");
    return 2;
  }
  int ours = 1;
  if (PetscInitialize(&ours, &argv, nullptr, nullptr) != 0) return 1;
  try {
    const DumpedSystem system = haptex::bench::readSystem(argv[1]);
    Problem problem = makeProblem(system);
    for (const char* kind : {"gamg", "hypre", "mumps"}) measure(kind, argv[2], system, problem);
    MatDestroy(&problem.matrix);
    VecDestroy(&problem.rhs);
    VecDestroy(&problem.x);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "petsc_solve: %s\n", error.what());
    PetscFinalize();
    return 1;
  }
  return PetscFinalize() == 0 ? 0 : 1;
}
