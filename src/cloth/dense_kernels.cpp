#include "haptex/cloth/dense_kernels.h"

namespace haptex::cloth {
namespace {

// Four doubles at any address; one register with AVX, two with the baseline.
typedef double Lanes __attribute__((vector_size(32), aligned(8), may_alias));

constexpr int kLanes = 4;

/// kVectors * 4 rows by three columns of C: nine accumulators at most, so that they, the loads and
/// one broadcast stay in sixteen registers.
template <int kVectors>
[[gnu::always_inline]] inline void tile(int depth, const double* a, int lda, const double* b,
                                        int ldb, double* c, int ldc) {
  Lanes sum[3][kVectors] = {};
  for (int k = 0; k < depth; ++k) {
    Lanes column[kVectors];
    for (int v = 0; v < kVectors; ++v) column[v] = *reinterpret_cast<const Lanes*>(a + v * kLanes);
    for (int j = 0; j < 3; ++j) {
      for (int v = 0; v < kVectors; ++v) sum[j][v] += column[v] * b[j];
    }
    a += lda;
    b += ldb;
  }
  for (int j = 0; j < 3; ++j) {
    for (int v = 0; v < kVectors; ++v) {
      *reinterpret_cast<Lanes*>(c + j * ldc + v * kLanes) -= sum[j][v];
    }
  }
}

[[gnu::always_inline]] inline void element(int depth, const double* a, int lda, const double* b,
                                           int ldb, double* c) {
  double sum = 0.0;
  for (int k = 0; k < depth; ++k) sum += a[k * lda] * b[k * ldb];
  *c -= sum;
}

[[gnu::always_inline]] inline void product(int rows, int columns, int depth, const double* a,
                                           int lda, const double* b, int ldb, double* c, int ldc) {
  int j = 0;
  for (; j + 3 <= columns; j += 3) {
    int i = 0;
    for (; i + 3 * kLanes <= rows; i += 3 * kLanes) {
      tile<3>(depth, a + i, lda, b + j, ldb, c + i + j * ldc, ldc);
    }
    for (; i + kLanes <= rows; i += kLanes) {
      tile<1>(depth, a + i, lda, b + j, ldb, c + i + j * ldc, ldc);
    }
    for (; i < rows; ++i) {
      for (int k = j; k < j + 3; ++k) element(depth, a + i, lda, b + k, ldb, c + i + k * ldc);
    }
  }
  for (; j < columns; ++j) {
    for (int i = 0; i < rows; ++i) element(depth, a + i, lda, b + j, ldb, c + i + j * ldc);
  }
}

using Product = void (*)(int, int, int, const double*, int, const double*, int, double*, int);

void productBaseline(int rows, int columns, int depth, const double* a, int lda, const double* b,
                     int ldb, double* c, int ldc) {
  product(rows, columns, depth, a, lda, b, ldb, c, ldc);
}

#if defined(__x86_64__)
[[gnu::target("avx2,fma")]] void productAvx2(int rows, int columns, int depth, const double* a,
                                             int lda, const double* b, int ldb, double* c,
                                             int ldc) {
  product(rows, columns, depth, a, lda, b, ldb, c, ldc);
}

Product chooseProduct() {
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") ? productAvx2
                                                                         : productBaseline;
}
#else
Product chooseProduct() { return productBaseline; }
#endif

}  // namespace

void subtractProduct(int rows, int columns, int depth, const double* a, int lda, const double* b,
                     int ldb, double* c, int ldc) {
  static const Product chosen = chooseProduct();
  chosen(rows, columns, depth, a, lda, b, ldb, c, ldc);
}

}  // namespace haptex::cloth
