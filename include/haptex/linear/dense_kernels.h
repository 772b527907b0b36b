// Dense kernels of the supernodal factorisation, compiled for several instruction sets.
#pragma once

#include "haptex/linear/row_run.h"

namespace haptex::linear {

// Matrices are column-major; `ld` is the distance between columns. T is double or float.
// The instruction set (baseline, AVX2 with FMA, or AVX-512) is chosen once by what the processor
// has; the build itself keeps the baseline, because wider alignment would break the ABI with
// Debian's libraries.

/// C -= A B^T without aliasing. A is rows x depth, B is columns x depth, C is rows x columns.
template <typename T>
void subtractProduct(int rows, int columns, int depth, const T* a, int lda, const T* b, int ldb,
                     T* c, int ldc);

/// C = A B^T without aliasing. A is rows x depth, B is columns x depth, C is rows x columns.
/// @param columns a multiple of 3
template <typename T>
void multiply(int rows, int columns, int depth, const T* a, int lda, const T* b, int ldb, T* c,
              int ldc);

/// C -= A in the rows of the runs, without aliasing, of three columns.
template <typename T>
void subtractRuns(const RowRun* runs, int run_count, const T* a, int lda, T* c, int ldc);

/// A := A L_top^-T, where A is rows x 3 and the 3 x 3 top is as factoriseThreeColumns() leaves it.
template <typename T>
void divideThreeColumns(int rows, const T* top, int ldtop, T* a, int lda);

/// Cholesky factorisation A = L L_top^T in place, where A is rows x 3 and its symmetric top 3 x 3
/// is read only on and below the diagonal. The diagonal of L is stored inverted.
/// @returns false if the top is not positive definite to rounding, or not finite
template <typename T>
bool factoriseThreeColumns(int rows, T* a, int lda);

/// x := [L_top^-1 x_top; x_below - L_below L_top^-1 x_top] with columns of L as
/// factoriseThreeColumns() leaves them. @param columns a multiple of 3
template <typename T>
void substituteForward(int rows, int columns, const T* l, int ldl, T* x);

/// x_top := L_top^-T (x_top - L_below^T x_below). @param columns a multiple of 3
template <typename T>
void substituteBackward(int rows, int columns, const T* l, int ldl, T* x);

enum class InstructionSet { kBaseline, kAvx2, kAvx512 };

/// The functions above by one instruction set.
template <typename T>
struct DenseKernels {
  void (*subtract_product)(int, int, int, const T*, int, const T*, int, T*, int);
  void (*multiply)(int, int, int, const T*, int, const T*, int, T*, int);
  void (*subtract_runs)(const RowRun*, int, const T*, int, T*, int);
  void (*divide_three_columns)(int, const T*, int, T*, int);
  bool (*factorise_three_columns)(int, T*, int);
  void (*substitute_forward)(int, int, const T*, int, T*);
  void (*substitute_backward)(int, int, const T*, int, T*);
};

/// Null where the processor, or T, has none of that set.
template <typename T>
const DenseKernels<T>* denseKernels(InstructionSet set);

}  // namespace haptex::linear
