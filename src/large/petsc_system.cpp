#include "haptex/large/petsc_system.h"

#include <petscksp.h>

#include <algorithm>
#include <stdexcept>
#include <string>

namespace haptex::large {
namespace {

constexpr double kTolerance = 1e-6;  // relative, of the residual
constexpr int kMostIterations = 10000;

void check(PetscErrorCode error) {
  if (error == 0) return;
  const char* text = nullptr;
  PetscErrorMessage(error, &text, nullptr);
  throw std::runtime_error("PETSc: error " + std::to_string(error) + ", " +
                           (text != nullptr ? text : "unknown"));
}

/// Blocks per row of those that a strip owns, in the columns that this process has and in others.
struct RowCounts {
  std::vector<PetscInt> here, elsewhere;
};

RowCounts countBlocks(const linear::SymmetricBlockMatrix& pattern, const PartPlace& place) {
  const auto isOwn = [&](int i) { return i >= place.own_begin && i < place.own_end; };
  RowCounts counts;
  counts.here.assign(place.own_end - place.own_begin, 1);
  counts.elsewhere.assign(counts.here.size(), 0);
  const auto count = [&](int row, int column) {
    if (isOwn(row)) ++(isOwn(column) ? counts.here : counts.elsewhere)[row - place.own_begin];
  };
  for (int i = 0; i < pattern.size(); ++i) {
    for (int s = pattern.rowBegin(i); s < pattern.rowBegin(i + 1); ++s) {
      count(i, pattern.column(s));
      count(pattern.column(s), i);
    }
  }
  return counts;
}

/// Each three times, for the rows of a block.
std::vector<PetscInt> scalarRows(const std::vector<PetscInt>& blocks) {
  std::vector<PetscInt> rows;
  for (const PetscInt count : blocks) rows.insert(rows.end(), 3, 3 * count);
  return rows;
}

}  // namespace

struct PetscSystem::Objects {
  Mat matrix = nullptr;
  Vec rhs = nullptr, solution = nullptr, positions = nullptr;
  Vec known = nullptr;  // of the strip, of this process
  VecScatter to_known = nullptr;
  KSP solver = nullptr;

  ~Objects() {
    KSPDestroy(&solver);
    VecScatterDestroy(&to_known);
    for (Vec* vector : {&rhs, &solution, &positions, &known}) VecDestroy(vector);
    MatDestroy(&matrix);
  }

  void bring(Vec from, double* to, std::size_t size) {
    check(VecScatterBegin(to_known, from, known, INSERT_VALUES, SCATTER_FORWARD));
    check(VecScatterEnd(to_known, from, known, INSERT_VALUES, SCATTER_FORWARD));
    const PetscScalar* values = nullptr;
    check(VecGetArrayRead(known, &values));
    std::copy_n(values, size, to);
    check(VecRestoreArrayRead(known, &values));
  }

  /// @param from of the strip's own particles
  static void put(const double* from, Vec to) {
    PetscInt size = 0;
    check(VecGetLocalSize(to, &size));
    PetscScalar* values = nullptr;
    check(VecGetArray(to, &values));
    std::copy_n(from, size, values);
    check(VecRestoreArray(to, &values));
  }
};

PetscSystem::PetscSystem(const linear::SymmetricBlockMatrix& pattern, const PartPlace& place)
    : objects_(std::make_unique<Objects>()), place_(place) {
  Objects& o = *objects_;
  const PetscInt own = 3 * (place.own_end - place.own_begin);
  const auto all = static_cast<PetscInt>(3 * place.all);
  check(MatCreate(PETSC_COMM_WORLD, &o.matrix));
  check(MatSetSizes(o.matrix, own, own, all, all));
  check(MatSetBlockSize(o.matrix, 3));
  check(MatSetType(o.matrix, MATAIJ));
  check(MatSetFromOptions(o.matrix));
  const RowCounts counts = countBlocks(pattern, place);
  const std::vector<PetscInt> here = scalarRows(counts.here);
  const std::vector<PetscInt> elsewhere = scalarRows(counts.elsewhere);
  check(MatSeqAIJSetPreallocation(o.matrix, 0, here.data()));
  check(MatMPIAIJSetPreallocation(o.matrix, 0, here.data(), 0, elsewhere.data()));
  check(MatSetOption(o.matrix, MAT_SPD, PETSC_TRUE));
  check(MatCreateVecs(o.matrix, &o.solution, &o.rhs));
  check(VecSetBlockSize(o.solution, 3));
  check(VecDuplicate(o.rhs, &o.positions));
  check(VecSetBlockSize(o.positions, 3));

  const PetscInt known = 3 * pattern.size();
  check(VecCreateSeq(PETSC_COMM_SELF, known, &o.known));
  IS places = nullptr;
  check(
      ISCreateStride(PETSC_COMM_SELF, known, static_cast<PetscInt>(3 * place.offset), 1, &places));
  check(VecScatterCreate(o.solution, places, o.known, nullptr, &o.to_known));
  check(ISDestroy(&places));

  check(KSPCreate(PETSC_COMM_WORLD, &o.solver));
  check(KSPSetOperators(o.solver, o.matrix, o.matrix));
  check(KSPSetType(o.solver, KSPCG));
  check(KSPSetNormType(o.solver, KSP_NORM_UNPRECONDITIONED));
  check(KSPSetTolerances(o.solver, kTolerance, PETSC_DEFAULT, PETSC_DEFAULT, kMostIterations));
  PC preconditioner = nullptr;
  check(KSPGetPC(o.solver, &preconditioner));
  check(PCSetType(preconditioner, PCCHOLESKY));
  check(PCFactorSetMatSolverType(preconditioner, MATSOLVERMUMPS));
  check(KSPSetFromOptions(o.solver));
}

PetscSystem::~PetscSystem() = default;

void PetscSystem::take(const linear::SymmetricBlockMatrix& matrix, const linear::BlockVector& rhs,
                       const std::vector<Eigen::Vector3d>& positions) {
  using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  Objects& o = *objects_;
  const auto set = [&](int row, int column, const RowMajor& block) {
    if (row < place_.own_begin || row >= place_.own_end) return;
    const auto global_row = static_cast<PetscInt>(place_.offset + row);
    const auto global_column = static_cast<PetscInt>(place_.offset + column);
    check(MatSetValuesBlocked(o.matrix, 1, &global_row, 1, &global_column, block.data(),
                              INSERT_VALUES));
  };
  for (int i = 0; i < matrix.size(); ++i) {
    set(i, i, matrix.diagonal(i));
    for (int s = matrix.rowBegin(i); s < matrix.rowBegin(i + 1); ++s) {
      set(i, matrix.column(s), matrix.lower(s));
      set(matrix.column(s), i, matrix.lower(s).transpose());
    }
  }
  check(MatAssemblyBegin(o.matrix, MAT_FINAL_ASSEMBLY));
  check(MatAssemblyEnd(o.matrix, MAT_FINAL_ASSEMBLY));
  o.put(rhs.col(place_.own_begin).data(), o.rhs);
  o.put(positions[place_.own_begin].data(), o.positions);
  MatNullSpace rigid = nullptr;
  check(MatNullSpaceCreateRigidBody(o.positions, &rigid));
  check(MatSetNearNullSpace(o.matrix, rigid));
  check(MatNullSpaceDestroy(&rigid));
}

double PetscSystem::rhsNorm() const {
  PetscReal norm = 0.0;
  check(VecNorm(objects_->rhs, NORM_2, &norm));
  return norm;
}

PetscSolve PetscSystem::solve(linear::BlockVector& solution) {
  Objects& o = *objects_;
  check(KSPSolve(o.solver, o.rhs, o.solution));
  KSPConvergedReason reason = KSP_CONVERGED_ITERATING;
  check(KSPGetConvergedReason(o.solver, &reason));
  PetscInt iterations = 0;
  check(KSPGetIterationNumber(o.solver, &iterations));
  o.bring(o.solution, solution.data(), static_cast<std::size_t>(solution.size()));
  return {reason > 0, static_cast<int>(iterations)};
}

double PetscSystem::product() const {
  PetscScalar product = 0.0;
  check(VecDot(objects_->rhs, objects_->solution, &product));
  return product;
}

void PetscSystem::share(std::vector<Eigen::Vector3d>& vectors) {
  Objects& o = *objects_;
  o.put(vectors[place_.own_begin].data(), o.positions);
  o.bring(o.positions, vectors.front().data(), 3 * vectors.size());
}

double PetscSystem::sum(double number) {
  double sum = 0.0;
  MPI_Allreduce(&number, &sum, 1, MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD);
  return sum;
}

}  // namespace haptex::large
