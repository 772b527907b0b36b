// Dense kernels of the supernodal factorisation, compiled for several instruction sets.
#pragma once

namespace haptex::cloth {

/// C -= A B^T for column-major matrices, without aliasing.
/// A is rows x depth with leading dimension lda, B is columns x depth with ldb, C is rows x columns
/// with ldc. The instruction set (baseline or AVX2 with FMA) is chosen once by what the processor
/// has; the build itself keeps the baseline, because wider alignment would break the ABI with
/// Debian's libraries.
void subtractProduct(int rows, int columns, int depth, const double* a, int lda, const double* b,
                     int ldb, double* c, int ldc);

}  // namespace haptex::cloth
