// Dense kernels of the supernodal factorisation, compiled for several instruction sets.
#pragma once

namespace haptex::cloth {

// Matrices are column-major; `ld` is the distance between columns. The instruction set (baseline or
// AVX2 with FMA) is chosen once by what the processor has; the build itself keeps the baseline,
// because wider alignment would break the ABI with Debian's libraries.

/// C -= A B^T without aliasing. A is rows x depth, B is columns x depth, C is rows x columns.
void subtractProduct(int rows, int columns, int depth, const double* a, int lda, const double* b,
                     int ldb, double* c, int ldc);

/// C = A B^T without aliasing, where B is the first `columns` rows of A, a multiple of 3. A is rows
/// x depth, C is rows x columns; its numbers above the diagonal of 3x3 blocks are not written.
void multiplyByOwnTop(int rows, int columns, int depth, const double* a, int lda, double* c,
                      int ldc);

/// Cholesky factorisation A = L L_top^T in place, where A is rows x 3 and its symmetric top 3 x 3
/// is read only on and below the diagonal. The diagonal of L is stored inverted.
/// @returns false if the top is not positive definite to rounding, or not finite
bool factoriseThreeColumns(int rows, double* a, int lda);

/// x := [L_top^-1 x_top; x_below - L_below L_top^-1 x_top] with columns of L as
/// factoriseThreeColumns() leaves them. @param columns a multiple of 3
void substituteForward(int rows, int columns, const double* l, int ldl, double* x);

/// x_top := L_top^-T (x_top - L_below^T x_below). @param columns a multiple of 3
void substituteBackward(int rows, int columns, const double* l, int ldl, double* x);

}  // namespace haptex::cloth
