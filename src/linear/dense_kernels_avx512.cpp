#include "haptex/linear/dense_kernels_avx512.h"

#if defined(__x86_64__)
#include <immintrin.h>

#include <algorithm>
#include <cstddef>

#include "haptex/linear/top_triangle.h"

// Every function that touches a wide register carries the attribute and is inlined, so that no
// wide value crosses a call: the rest of the library keeps the ABI of the baseline.
#define HAPTEX_AVX512 [[gnu::target("avx512f")]]
#define HAPTEX_AVX512_INLINE [[gnu::target("avx512f"), gnu::always_inline]] inline

namespace haptex::linear::avx512 {
namespace {

constexpr int kLanes = 16;
constexpr int kMaxVectors = 4;  // by six columns, with the loads and a broadcast, in 32 registers
constexpr int kDepth = 192;     // of A's part that stays in the first-level cache

enum class Store { kSubtract, kAssign };

/// The first lanes, of which there may be more than a register has.
HAPTEX_AVX512_INLINE __mmask16 firstLanes(int count) {
  return static_cast<__mmask16>(count >= kLanes ? 0xffffU : (1U << count) - 1U);
}

/// The sum of all lanes, halves first.
HAPTEX_AVX512_INLINE float sumOf(__m512 v) {
  const __m256 eight = __builtin_shufflevector(v, v, 0, 1, 2, 3, 4, 5, 6, 7) +
                       __builtin_shufflevector(v, v, 8, 9, 10, 11, 12, 13, 14, 15);
  const __m128 four = __builtin_shufflevector(eight, eight, 0, 1, 2, 3) +
                      __builtin_shufflevector(eight, eight, 4, 5, 6, 7);
  return (four[0] + four[2]) + (four[1] + four[3]);
}

/// kVectors registers of rows, the last one masked, by kColumns columns of A B^T.
template <Store kStore, int kVectors, int kColumns>
HAPTEX_AVX512_INLINE void tile(__mmask16 last, int depth, const float* a, int lda, const float* b,
                               int ldb, float* c, int ldc) {
  __m512 sum[kColumns][kVectors];
  for (int j = 0; j < kColumns; ++j) {
    for (int v = 0; v < kVectors; ++v) sum[j][v] = _mm512_setzero_ps();
  }
  for (int k = 0; k < depth; ++k) {
    __m512 column[kVectors];
    for (int v = 0; v + 1 < kVectors; ++v) column[v] = _mm512_loadu_ps(a + v * kLanes);
    column[kVectors - 1] = _mm512_maskz_loadu_ps(last, a + (kVectors - 1) * kLanes);
    for (int j = 0; j < kColumns; ++j) {
      const __m512 factor = _mm512_set1_ps(b[j]);
      for (int v = 0; v < kVectors; ++v) {
        sum[j][v] = _mm512_fmadd_ps(column[v], factor, sum[j][v]);
      }
    }
    a += lda;
    b += ldb;
  }
  for (int j = 0; j < kColumns; ++j) {
    float* const target = c + static_cast<std::ptrdiff_t>(ldc) * j;
    for (int v = 0; v < kVectors; ++v) {
      float* const place = target + v * kLanes;
      const __mmask16 mask = v + 1 < kVectors ? static_cast<__mmask16>(0xffffU) : last;
      __m512 value = sum[j][v];
      if constexpr (kStore == Store::kSubtract) {
        value = _mm512_sub_ps(_mm512_maskz_loadu_ps(mask, place), value);
      }
      _mm512_mask_storeu_ps(place, mask, value);
    }
  }
}

/// kColumns columns of A B^T.
template <Store kStore, int kVectors, int kColumns>
HAPTEX_AVX512_INLINE void someColumns(int rows, int depth, const float* a, int lda, const float* b,
                                      int ldb, float* c, int ldc) {
  tile<kStore, kVectors, kColumns>(firstLanes(rows - (kVectors - 1) * kLanes), depth, a, lda, b,
                                   ldb, c, ldc);
}

/// Rows that fit into kVectors registers, of all columns.
template <Store kStore, int kVectors>
HAPTEX_AVX512_INLINE void someRows(int rows, int columns, int depth, const float* a, int lda,
                                   const float* b, int ldb, float* c, int ldc) {
  int j = 0;
  const auto target = [&] { return c + static_cast<std::ptrdiff_t>(ldc) * j; };
  for (; j + 6 <= columns; j += 6) {
    someColumns<kStore, kVectors, 6>(rows, depth, a, lda, b + j, ldb, target(), ldc);
  }
  for (; j + 3 <= columns; j += 3) {
    someColumns<kStore, kVectors, 3>(rows, depth, a, lda, b + j, ldb, target(), ldc);
  }
  for (; j < columns; ++j) {
    someColumns<kStore, kVectors, 1>(rows, depth, a, lda, b + j, ldb, target(), ldc);
  }
}

/// By parts of A that stay in the first-level cache while all columns pass.
template <Store kStore>
HAPTEX_AVX512_INLINE void product(int rows, int columns, int depth, const float* a, int lda,
                                  const float* b, int ldb, float* c, int ldc) {
  for (int i = 0; i < rows;) {
    const int left = (rows - i + kLanes - 1) / kLanes;  // registers
    // Two of three registers rather than one of four and one of two.
    const int vectors = left <= kMaxVectors ? left : left < 2 * kMaxVectors - 1 ? 3 : kMaxVectors;
    const int height = std::min(rows - i, vectors * kLanes);
    switch (vectors) {
      case 1:
        someRows<kStore, 1>(height, columns, depth, a + i, lda, b, ldb, c + i, ldc);
        break;
      case 2:
        someRows<kStore, 2>(height, columns, depth, a + i, lda, b, ldb, c + i, ldc);
        break;
      case 3:
        someRows<kStore, 3>(height, columns, depth, a + i, lda, b, ldb, c + i, ldc);
        break;
      default:
        someRows<kStore, 4>(height, columns, depth, a + i, lda, b, ldb, c + i, ldc);
    }
    i += height;
  }
}

/// A := A L^-T, of which `l` holds the inverted diagonal and what is below it.
HAPTEX_AVX512_INLINE void divideRows(const float (&l)[3][3], int rows, float* a, int lda) {
  for (int i = 0; i < rows; i += kLanes) {
    const __mmask16 mask = firstLanes(rows - i);
    float* const x = a + i;
    const __m512 x0 = _mm512_mul_ps(_mm512_maskz_loadu_ps(mask, x), _mm512_set1_ps(l[0][0]));
    __m512 x1 = _mm512_maskz_loadu_ps(mask, x + lda);
    x1 = _mm512_fnmadd_ps(x0, _mm512_set1_ps(l[1][0]), x1);
    x1 = _mm512_mul_ps(x1, _mm512_set1_ps(l[1][1]));
    __m512 x2 = _mm512_maskz_loadu_ps(mask, x + std::ptrdiff_t{2} * lda);
    x2 = _mm512_fnmadd_ps(x0, _mm512_set1_ps(l[2][0]), x2);
    x2 = _mm512_fnmadd_ps(x1, _mm512_set1_ps(l[2][1]), x2);
    x2 = _mm512_mul_ps(x2, _mm512_set1_ps(l[2][2]));
    _mm512_mask_storeu_ps(x, mask, x0);
    _mm512_mask_storeu_ps(x + lda, mask, x1);
    _mm512_mask_storeu_ps(x + std::ptrdiff_t{2} * lda, mask, x2);
  }
}

}  // namespace

HAPTEX_AVX512 void subtractProduct(int rows, int columns, int depth, const float* a, int lda,
                                   const float* b, int ldb, float* c, int ldc) {
  for (int k = 0; k < depth; k += kDepth) {
    product<Store::kSubtract>(rows, columns, std::min(depth - k, kDepth),
                              a + static_cast<std::ptrdiff_t>(lda) * k, lda,
                              b + static_cast<std::ptrdiff_t>(ldb) * k, ldb, c, ldc);
  }
}

HAPTEX_AVX512 void multiply(int rows, int columns, int depth, const float* a, int lda,
                            const float* b, int ldb, float* c, int ldc) {
  product<Store::kAssign>(rows, columns, depth, a, lda, b, ldb, c, ldc);
}

HAPTEX_AVX512 void subtractRuns(const RowRun* runs, int run_count, const float* a, int lda,
                                float* c, int ldc) {
  for (const RowRun* run = runs; run != runs + run_count; ++run) {
    for (int i = 0; i < run->count; i += kLanes) {
      const __mmask16 mask = firstLanes(run->count - i);
      const float* const from = a + run->from + i;
      float* const to = c + run->to + i;
      for (int column = 0; column < 3; ++column) {
        const float* const source = from + static_cast<std::ptrdiff_t>(lda) * column;
        float* const target = to + static_cast<std::ptrdiff_t>(ldc) * column;
        _mm512_mask_storeu_ps(target, mask,
                              _mm512_sub_ps(_mm512_maskz_loadu_ps(mask, target),
                                            _mm512_maskz_loadu_ps(mask, source)));
      }
    }
  }
}

HAPTEX_AVX512 void divideThreeColumns(int rows, const float* top, int ldtop, float* a, int lda) {
  divideRows(TopTriangle<float>::read(top, ldtop).l, rows, a, lda);
}

HAPTEX_AVX512 bool factoriseThreeColumns(int rows, float* a, int lda) {
  TopTriangle<float> top;
  if (!top.factorise(a, lda)) return false;
  divideRows(top.l, rows - 3, a + 3, lda);
  return true;
}

HAPTEX_AVX512 void substituteForward(int rows, int columns, const float* l, int ldl, float* x) {
  for (int c = 0; c < columns; c += 3) {
    const float* const l0 = l + static_cast<std::ptrdiff_t>(ldl) * c;
    const float* const l1 = l0 + ldl;
    const float* const l2 = l1 + ldl;
    x[c] *= l0[c];
    x[c + 1] = (x[c + 1] - l0[c + 1] * x[c]) * l1[c + 1];
    x[c + 2] = (x[c + 2] - l0[c + 2] * x[c] - l1[c + 2] * x[c + 1]) * l2[c + 2];
    const __m512 x0 = _mm512_set1_ps(x[c]);
    const __m512 x1 = _mm512_set1_ps(x[c + 1]);
    const __m512 x2 = _mm512_set1_ps(x[c + 2]);
    for (int r = c + 3; r < rows; r += kLanes) {
      const __mmask16 mask = firstLanes(rows - r);
      __m512 below = _mm512_maskz_loadu_ps(mask, x + r);
      below = _mm512_fnmadd_ps(_mm512_maskz_loadu_ps(mask, l0 + r), x0, below);
      below = _mm512_fnmadd_ps(_mm512_maskz_loadu_ps(mask, l1 + r), x1, below);
      below = _mm512_fnmadd_ps(_mm512_maskz_loadu_ps(mask, l2 + r), x2, below);
      _mm512_mask_storeu_ps(x + r, mask, below);
    }
  }
}

HAPTEX_AVX512 void substituteBackward(int rows, int columns, const float* l, int ldl, float* x) {
  for (int c = columns - 3; c >= 0; c -= 3) {
    const float* const l0 = l + static_cast<std::ptrdiff_t>(ldl) * c;
    const float* const l1 = l0 + ldl;
    const float* const l2 = l1 + ldl;
    __m512 s0 = _mm512_setzero_ps(), s1 = s0, s2 = s0;
    for (int r = c + 3; r < rows; r += kLanes) {
      const __mmask16 mask = firstLanes(rows - r);
      const __m512 below = _mm512_maskz_loadu_ps(mask, x + r);
      s0 = _mm512_fmadd_ps(_mm512_maskz_loadu_ps(mask, l0 + r), below, s0);
      s1 = _mm512_fmadd_ps(_mm512_maskz_loadu_ps(mask, l1 + r), below, s1);
      s2 = _mm512_fmadd_ps(_mm512_maskz_loadu_ps(mask, l2 + r), below, s2);
    }
    x[c + 2] = (x[c + 2] - sumOf(s2)) * l2[c + 2];
    x[c + 1] = (x[c + 1] - sumOf(s1) - l1[c + 2] * x[c + 2]) * l1[c + 1];
    x[c] = (x[c] - sumOf(s0) - l0[c + 1] * x[c + 1] - l0[c + 2] * x[c + 2]) * l0[c];
  }
}

}  // namespace haptex::linear::avx512
#endif
