#include "haptex/large/petsc_system.h"

#include <petscksp.h>

#include <algorithm>
#include <stdexcept>
#include <string>

#include "haptex/linear/block_cholesky.h"

namespace haptex::large {
namespace {

constexpr double kTolerance = 1e-6;  // relative, of the residual
constexpr int kMostIterations = 10000;
// Of the unit diagonal: what single precision needs where it cannot factorise a matrix otherwise.
constexpr float kShift = 1e-4f;

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
  const auto is_own = [&](int i) { return i >= place.own_begin && i < place.own_end; };
  RowCounts counts;
  counts.here.assign(place.own_end - place.own_begin, 1);
  counts.elsewhere.assign(counts.here.size(), 0);
  const auto count = [&](int row, int column) {
    if (is_own(row)) ++(is_own(column) ? counts.here : counts.elsewhere)[row - place.own_begin];
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

Mat makeMatrix(const linear::SymmetricBlockMatrix& pattern, const PartPlace& place) {
  const PetscInt own = 3 * (place.own_end - place.own_begin);
  const auto all = static_cast<PetscInt>(3 * place.all);
  Mat matrix = nullptr;
  check(MatCreate(PETSC_COMM_WORLD, &matrix));
  check(MatSetSizes(matrix, own, own, all, all));
  check(MatSetBlockSize(matrix, 3));
  check(MatSetType(matrix, MATAIJ));
  check(MatSetFromOptions(matrix));
  const RowCounts counts = countBlocks(pattern, place);
  const std::vector<PetscInt> here = scalarRows(counts.here);
  const std::vector<PetscInt> elsewhere = scalarRows(counts.elsewhere);
  check(MatSeqAIJSetPreallocation(matrix, 0, here.data()));
  check(MatMPIAIJSetPreallocation(matrix, 0, here.data(), 0, elsewhere.data()));
  check(MatSetOption(matrix, MAT_SPD, PETSC_TRUE));
  return matrix;
}

}  // namespace

struct PetscSystem::Objects {
  explicit Objects(const linear::SymmetricBlockMatrix& pattern, const PartPlace& place);
  ~Objects() {
    KSPDestroy(&solver);
    VecScatterDestroy(&to_known);
    for (Vec* vector : {&rhs, &solution, &known}) VecDestroy(vector);
    MatDestroy(&matrix);
  }
  Objects(const Objects&) = delete;
  Objects& operator=(const Objects&) = delete;

  /// @param to of the strip
  PetscErrorCode bring(Vec from, double* to) {
    PetscCall(VecScatterBegin(to_known, from, known, INSERT_VALUES, SCATTER_FORWARD));
    PetscCall(VecScatterEnd(to_known, from, known, INSERT_VALUES, SCATTER_FORWARD));
    const PetscScalar* values = nullptr;
    PetscCall(VecGetArrayRead(known, &values));
    std::copy_n(values, part.size(), to);
    PetscCall(VecRestoreArrayRead(known, &values));
    return 0;
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

  /// to = the sum over all parts of what their factors make of theirs. PETSc calls it: an exception
  /// must not pass its frames.
  PetscErrorCode precondition(Vec from, Vec to) noexcept {
    PetscCall(bring(from, part.data()));
    clearCut();
    factor->solve(part);
    clearCut();
    PetscScalar* values = nullptr;
    PetscCall(VecGetArray(known, &values));
    std::copy_n(part.data(), part.size(), values);
    PetscCall(VecRestoreArray(known, &values));
    PetscCall(VecSet(to, 0.0));
    PetscCall(VecScatterBegin(to_known, known, to, ADD_VALUES, SCATTER_REVERSE));
    PetscCall(VecScatterEnd(to_known, known, to, ADD_VALUES, SCATTER_REVERSE));
    return 0;
  }

  /// Of what the strip does not know whole.
  void clearCut() {
    part.leftCols(place.whole_begin).setZero();
    part.rightCols(part.cols() - place.whole_end).setZero();
  }

  PartPlace place;
  Mat matrix = nullptr;
  Vec rhs = nullptr, solution = nullptr;
  Vec known = nullptr;  // of the strip, of this process
  VecScatter to_known = nullptr;
  KSP solver = nullptr;
  linear::BlockVector part;     // of the strip
  std::vector<char> is_cut;     // per particle of it: its rows are not whole
  linear::BlockVector nothing;  // of what is cut: zero
  std::unique_ptr<linear::BasicBlockCholesky<float>> factor;  // null: PETSC_OPTIONS chose otherwise
  bool is_definite = true;  // as far as the factors of all processes say
};

PetscSystem::Objects::Objects(const linear::SymmetricBlockMatrix& pattern, const PartPlace& at)
    : place(at),
      matrix(makeMatrix(pattern, at)),
      part(linear::BlockVector::Zero(3, pattern.size())),
      is_cut(pattern.size(), 1),
      nothing(linear::BlockVector::Zero(3, pattern.size())) {
  check(MatCreateVecs(matrix, &solution, &rhs));
  std::fill(is_cut.begin() + at.whole_begin, is_cut.begin() + at.whole_end, 0);

  const PetscInt size = 3 * pattern.size();
  check(VecCreateSeq(PETSC_COMM_SELF, size, &known));
  IS places = nullptr;
  check(ISCreateStride(PETSC_COMM_SELF, size, static_cast<PetscInt>(3 * at.offset), 1, &places));
  check(VecScatterCreate(solution, places, known, nullptr, &to_known));
  check(ISDestroy(&places));

  check(KSPCreate(PETSC_COMM_WORLD, &solver));
  check(KSPSetOperators(solver, matrix, matrix));
  check(KSPSetType(solver, KSPCG));
  check(KSPSetNormType(solver, KSP_NORM_UNPRECONDITIONED));
  check(KSPSetTolerances(solver, kTolerance, PETSC_DEFAULT, PETSC_DEFAULT, kMostIterations));
  PC preconditioner = nullptr;
  check(KSPGetPC(solver, &preconditioner));
  check(PCSetType(preconditioner, PCSHELL));
  check(PCShellSetContext(preconditioner, this));
  check(PCShellSetApply(preconditioner, [](PC shell, Vec from, Vec to) {
    void* objects = nullptr;
    const PetscErrorCode error = PCShellGetContext(shell, &objects);
    return error != 0 ? error : static_cast<Objects*>(objects)->precondition(from, to);
  }));
  check(PCShellSetName(preconditioner, "additive Schwarz with factors in single precision"));
  check(KSPSetFromOptions(solver));
  PetscBool is_ours = PETSC_FALSE;
  check(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(preconditioner), PCSHELL, &is_ours));
  if (is_ours) factor = std::make_unique<linear::BasicBlockCholesky<float>>(pattern);
}

PetscSystem::PetscSystem(const linear::SymmetricBlockMatrix& pattern, const PartPlace& place)
    : objects_(std::make_unique<Objects>(pattern, place)) {}

PetscSystem::~PetscSystem() = default;

void PetscSystem::take(linear::SymmetricBlockMatrix& matrix, const linear::BlockVector& rhs) {
  using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  Objects& o = *objects_;
  const auto set = [&](int row, int column, const RowMajor& block) {
    if (row < o.place.own_begin || row >= o.place.own_end) return;
    const auto global_row = static_cast<PetscInt>(o.place.offset + row);
    const auto global_column = static_cast<PetscInt>(o.place.offset + column);
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
  o.put(rhs.col(o.place.own_begin).data(), o.rhs);
  if (!o.factor) return;
  matrix.eliminate(o.is_cut, o.nothing, o.part);
  const bool is_definite = o.factor->factorise(matrix) || o.factor->factorise(matrix, kShift);
  o.is_definite = sum(is_definite ? 0.0 : 1.0) == 0.0;
}

double PetscSystem::rhsNorm() const {
  PetscReal norm = 0.0;
  check(VecNorm(objects_->rhs, NORM_2, &norm));
  return norm;
}

PetscSolve PetscSystem::solve(linear::BlockVector& solution) {
  Objects& o = *objects_;
  if (!o.is_definite) return {};
  check(KSPSolve(o.solver, o.rhs, o.solution));
  KSPConvergedReason reason = KSP_CONVERGED_ITERATING;
  check(KSPGetConvergedReason(o.solver, &reason));
  PetscInt iterations = 0;
  check(KSPGetIterationNumber(o.solver, &iterations));
  check(o.bring(o.solution, solution.data()));
  return {reason > 0, static_cast<int>(iterations)};
}

double PetscSystem::product() const {
  PetscScalar product = 0.0;
  check(VecDot(objects_->rhs, objects_->solution, &product));
  return product;
}

void PetscSystem::share(std::vector<Eigen::Vector3d>& vectors) {
  Objects& o = *objects_;
  o.put(vectors[o.place.own_begin].data(), o.solution);
  check(o.bring(o.solution, vectors.front().data()));
}

double PetscSystem::sum(double number) {
  double sum = 0.0;
  MPI_Allreduce(&number, &sum, 1, MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD);
  return sum;
}

}  // namespace haptex::large
