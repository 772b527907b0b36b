// The dense kernels of dense_kernels.h in single precision for processors with AVX-512.
#pragma once

#include "haptex/linear/row_run.h"

#if defined(__x86_64__)
namespace haptex::linear::avx512 {

// Rows that do not fill a register are masked: no number outside the matrices is read or written.
// Each is what the function of the same name in dense_kernels.h says, up to rounding.

void subtractProduct(int rows, int columns, int depth, const float* a, int lda, const float* b,
                     int ldb, float* c, int ldc);
void multiply(int rows, int columns, int depth, const float* a, int lda, const float* b, int ldb,
              float* c, int ldc);
void subtractRuns(const RowRun* runs, int run_count, const float* a, int lda, float* c, int ldc);
void divideThreeColumns(int rows, const float* top, int ldtop, float* a, int lda);
bool factoriseThreeColumns(int rows, float* a, int lda);
void substituteForward(int rows, int columns, const float* l, int ldl, float* x);
void substituteBackward(int rows, int columns, const float* l, int ldl, float* x);

}  // namespace haptex::linear::avx512
#endif
