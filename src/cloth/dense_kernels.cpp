#include "haptex/cloth/dense_kernels.h"

#include <cmath>
#include <cstddef>
#include <limits>

namespace haptex::cloth {
namespace {

// Four doubles at any address; one register with AVX, two with the baseline.
typedef double Lanes __attribute__((vector_size(32), aligned(8), may_alias));

constexpr int kLanes = 4;

enum class Store { kSubtract, kAssign };

/// kVectors * 4 rows by three columns of A B^T: nine accumulators at most, so that they, the loads
/// and one broadcast stay in sixteen registers.
template <int kVectors>
[[gnu::always_inline]] inline void sumTile(int depth, const double* a, int lda, const double* b,
                                           int ldb, Lanes (&sum)[3][kVectors]) {
  for (int k = 0; k < depth; ++k) {
    Lanes column[kVectors];
    for (int v = 0; v < kVectors; ++v) column[v] = *reinterpret_cast<const Lanes*>(a + v * kLanes);
    for (int j = 0; j < 3; ++j) {
      for (int v = 0; v < kVectors; ++v) sum[j][v] += column[v] * b[j];
    }
    a += lda;
    b += ldb;
  }
}

template <Store kStore, int kVectors>
[[gnu::always_inline]] inline void tile(int depth, const double* a, int lda, const double* b,
                                        int ldb, double* c, int ldc) {
  Lanes sum[3][kVectors] = {};
  sumTile<kVectors>(depth, a, lda, b, ldb, sum);
  for (int j = 0; j < 3; ++j) {
    for (int v = 0; v < kVectors; ++v) {
      Lanes* target = reinterpret_cast<Lanes*>(c + j * ldc + v * kLanes);
      if constexpr (kStore == Store::kSubtract) {
        *target -= sum[j][v];
      } else {
        *target = sum[j][v];
      }
    }
  }
}

template <Store kStore>
[[gnu::always_inline]] inline void element(int depth, const double* a, int lda, const double* b,
                                           int ldb, double* c) {
  double sum = 0.0;
  for (int k = 0; k < depth; ++k) sum += a[k * lda] * b[k * ldb];
  if constexpr (kStore == Store::kSubtract) {
    *c -= sum;
  } else {
    *c = sum;
  }
}

/// Three columns of A B^T.
template <Store kStore>
[[gnu::always_inline]] inline void threeColumns(int rows, int depth, const double* a, int lda,
                                                const double* b, int ldb, double* c, int ldc) {
  int i = 0;
  for (; i + 3 * kLanes <= rows; i += 3 * kLanes) {
    tile<kStore, 3>(depth, a + i, lda, b, ldb, c + i, ldc);
  }
  if (i + 2 * kLanes <= rows) {
    tile<kStore, 2>(depth, a + i, lda, b, ldb, c + i, ldc);
    i += 2 * kLanes;
  } else if (i + kLanes <= rows) {
    tile<kStore, 1>(depth, a + i, lda, b, ldb, c + i, ldc);
    i += kLanes;
  }
  if (i == rows) return;
  if (rows < kLanes) {
    for (; i < rows; ++i) {
      for (int j = 0; j < 3; ++j) element<kStore>(depth, a + i, lda, b + j, ldb, c + i + j * ldc);
    }
    return;
  }
  // The last four rows: some of them are done.
  const int last = rows - kLanes;
  if constexpr (kStore == Store::kAssign) {
    tile<kStore, 1>(depth, a + last, lda, b, ldb, c + last, ldc);
  } else {
    Lanes sum[3][1] = {};
    sumTile<1>(depth, a + last, lda, b, ldb, sum);
    for (int j = 0; j < 3; ++j) {
      for (int r = i; r < rows; ++r) c[r + j * ldc] -= sum[j][0][r - last];
    }
  }
}

[[gnu::always_inline]] inline void subtractProductOf(int rows, int columns, int depth,
                                                     const double* a, int lda, const double* b,
                                                     int ldb, double* c, int ldc) {
  int j = 0;
  for (; j + 3 <= columns; j += 3) {
    threeColumns<Store::kSubtract>(rows, depth, a, lda, b + j, ldb, c + j * ldc, ldc);
  }
  for (; j < columns; ++j) {
    for (int i = 0; i < rows; ++i) {
      element<Store::kSubtract>(depth, a + i, lda, b + j, ldb, c + i + j * ldc);
    }
  }
}

[[gnu::always_inline]] inline void multiplyByOwnTopOf(int rows, int columns, int depth,
                                                      const double* a, int lda, double* c,
                                                      int ldc) {
  for (int j = 0; j < columns; j += 3) {
    threeColumns<Store::kAssign>(rows - j, depth, a + j, lda, a + j, lda, c + j + j * ldc, ldc);
  }
}

/// L_below = A_below L_top^-T of kVectors * 4 rows.
template <int kVectors>
[[gnu::always_inline]] inline void divideRows(const double (&l)[3][3], double* a, int lda) {
  for (int v = 0; v < kVectors; ++v) {
    Lanes* columns[3];
    for (int c = 0; c < 3; ++c) columns[c] = reinterpret_cast<Lanes*>(a + c * lda + v * kLanes);
    const Lanes x0 = *columns[0] * l[0][0];
    const Lanes x1 = (*columns[1] - x0 * l[1][0]) * l[1][1];
    const Lanes x2 = (*columns[2] - x0 * l[2][0] - x1 * l[2][1]) * l[2][2];
    *columns[0] = x0;
    *columns[1] = x1;
    *columns[2] = x2;
  }
}

[[gnu::always_inline]] inline bool factoriseThreeColumnsOf(int rows, double* a, int lda) {
  double l[3][3];  // the top, with its diagonal inverted
  for (int c = 0; c < 3; ++c) {
    for (int r = c; r < 3; ++r) {
      l[r][c] = a[r + c * lda];
      for (int k = 0; k < c; ++k) l[r][c] -= l[r][k] * l[c][k];
    }
    if (!(l[c][c] > 0.0 && l[c][c] <= std::numeric_limits<double>::max())) return false;
    l[c][c] = 1.0 / std::sqrt(l[c][c]);
    for (int r = c + 1; r < 3; ++r) l[r][c] *= l[c][c];
    for (int r = c; r < 3; ++r) a[r + c * lda] = l[r][c];
  }
  int i = 3;
  for (; i + 2 * kLanes <= rows; i += 2 * kLanes) divideRows<2>(l, a + i, lda);
  for (; i + kLanes <= rows; i += kLanes) divideRows<1>(l, a + i, lda);
  for (; i < rows; ++i) {
    double* const x = a + i;
    x[0] *= l[0][0];
    x[lda] = (x[lda] - x[0] * l[1][0]) * l[1][1];
    x[2 * lda] = (x[2 * lda] - x[0] * l[2][0] - x[lda] * l[2][1]) * l[2][2];
  }
  return true;
}

[[gnu::always_inline]] inline void substituteForwardOf(int rows, int columns, const double* l,
                                                       int ldl, double* x) {
  for (int c = 0; c < columns; c += 3) {
    const double* l0 = l + static_cast<std::ptrdiff_t>(ldl) * c;
    const double* l1 = l0 + ldl;
    const double* l2 = l1 + ldl;
    const double x0 = x[c] * l0[c];
    const double x1 = (x[c + 1] - l0[c + 1] * x0) * l1[c + 1];
    const double x2 = (x[c + 2] - l0[c + 2] * x0 - l1[c + 2] * x1) * l2[c + 2];
    x[c] = x0;
    x[c + 1] = x1;
    x[c + 2] = x2;
    int r = c + 3;
    for (; r + kLanes <= rows; r += kLanes) {
      *reinterpret_cast<Lanes*>(x + r) -= *reinterpret_cast<const Lanes*>(l0 + r) * x0 +
                                          *reinterpret_cast<const Lanes*>(l1 + r) * x1 +
                                          *reinterpret_cast<const Lanes*>(l2 + r) * x2;
    }
    for (; r < rows; ++r) x[r] -= l0[r] * x0 + l1[r] * x1 + l2[r] * x2;
  }
}

[[gnu::always_inline]] inline void substituteBackwardOf(int rows, int columns, const double* l,
                                                        int ldl, double* x) {
  for (int c = columns - 3; c >= 0; c -= 3) {
    const double* l0 = l + static_cast<std::ptrdiff_t>(ldl) * c;
    const double* l1 = l0 + ldl;
    const double* l2 = l1 + ldl;
    Lanes sum[3] = {};
    int r = c + 3;
    for (; r + kLanes <= rows; r += kLanes) {
      const Lanes below = *reinterpret_cast<const Lanes*>(x + r);
      sum[0] += *reinterpret_cast<const Lanes*>(l0 + r) * below;
      sum[1] += *reinterpret_cast<const Lanes*>(l1 + r) * below;
      sum[2] += *reinterpret_cast<const Lanes*>(l2 + r) * below;
    }
    double s0 = (sum[0][0] + sum[0][1]) + (sum[0][2] + sum[0][3]);
    double s1 = (sum[1][0] + sum[1][1]) + (sum[1][2] + sum[1][3]);
    double s2 = (sum[2][0] + sum[2][1]) + (sum[2][2] + sum[2][3]);
    for (; r < rows; ++r) {
      s0 += l0[r] * x[r];
      s1 += l1[r] * x[r];
      s2 += l2[r] * x[r];
    }
    x[c + 2] = (x[c + 2] - s2) * l2[c + 2];
    x[c + 1] = (x[c + 1] - s1 - l1[c + 2] * x[c + 2]) * l1[c + 1];
    x[c] = (x[c] - s0 - l0[c + 1] * x[c + 1] - l0[c + 2] * x[c + 2]) * l0[c];
  }
}

struct Kernels {
  void (*subtract_product)(int, int, int, const double*, int, const double*, int, double*, int);
  void (*multiply_by_own_top)(int, int, int, const double*, int, double*, int);
  bool (*factorise_three_columns)(int, double*, int);
  void (*substitute_forward)(int, int, const double*, int, double*);
  void (*substitute_backward)(int, int, const double*, int, double*);
};

// One class per instruction set, because a template cannot be given the attribute.
#define HAPTEX_DENSE_KERNELS(Name, ...)                                                         \
  struct Name {                                                                                 \
    __VA_ARGS__ static void subtractProduct(int rows, int columns, int depth, const double* a,  \
                                            int lda, const double* b, int ldb, double* c,       \
                                            int ldc) {                                          \
      subtractProductOf(rows, columns, depth, a, lda, b, ldb, c, ldc);                          \
    }                                                                                           \
    __VA_ARGS__ static void multiplyByOwnTop(int rows, int columns, int depth, const double* a, \
                                             int lda, double* c, int ldc) {                     \
      multiplyByOwnTopOf(rows, columns, depth, a, lda, c, ldc);                                 \
    }                                                                                           \
    __VA_ARGS__ static bool factoriseThreeColumns(int rows, double* a, int lda) {               \
      return factoriseThreeColumnsOf(rows, a, lda);                                             \
    }                                                                                           \
    __VA_ARGS__ static void substituteForward(int rows, int columns, const double* l, int ldl,  \
                                              double* x) {                                      \
      substituteForwardOf(rows, columns, l, ldl, x);                                            \
    }                                                                                           \
    __VA_ARGS__ static void substituteBackward(int rows, int columns, const double* l, int ldl, \
                                               double* x) {                                     \
      substituteBackwardOf(rows, columns, l, ldl, x);                                           \
    }                                                                                           \
    static constexpr Kernels kKernels{subtractProduct, multiplyByOwnTop, factoriseThreeColumns, \
                                      substituteForward, substituteBackward};                   \
  };

HAPTEX_DENSE_KERNELS(Baseline, )
#if defined(__x86_64__)
HAPTEX_DENSE_KERNELS(Avx2, [[gnu::target("avx2,fma")]])
#endif
#undef HAPTEX_DENSE_KERNELS

const Kernels& kernels() {
#if defined(__x86_64__)
  static const bool wide = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  if (wide) return Avx2::kKernels;
#endif
  return Baseline::kKernels;
}

}  // namespace

void subtractProduct(int rows, int columns, int depth, const double* a, int lda, const double* b,
                     int ldb, double* c, int ldc) {
  kernels().subtract_product(rows, columns, depth, a, lda, b, ldb, c, ldc);
}

void multiplyByOwnTop(int rows, int columns, int depth, const double* a, int lda, double* c,
                      int ldc) {
  kernels().multiply_by_own_top(rows, columns, depth, a, lda, c, ldc);
}

bool factoriseThreeColumns(int rows, double* a, int lda) {
  return kernels().factorise_three_columns(rows, a, lda);
}

void substituteForward(int rows, int columns, const double* l, int ldl, double* x) {
  kernels().substitute_forward(rows, columns, l, ldl, x);
}

void substituteBackward(int rows, int columns, const double* l, int ldl, double* x) {
  kernels().substitute_backward(rows, columns, l, ldl, x);
}

}  // namespace haptex::cloth
