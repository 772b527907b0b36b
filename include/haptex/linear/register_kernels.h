// The dense kernels of dense_kernels.h, written once for registers of any size. They become machine
// code where a function of one instruction set calls them.
#pragma once

#include <cstddef>

#include "haptex/linear/row_run.h"
#include "haptex/linear/top_triangle.h"

namespace haptex::linear::registers {

/// kBytes of numbers: one register, or two with the baseline.
template <typename T, int kBytes>
struct Register {
  static constexpr int kLanes = kBytes / sizeof(T);
  typedef T Lanes __attribute__((vector_size(kBytes)));
  /// At any address. A struct, because Clang forgets the alignment of a vector type in a template.
  struct [[gnu::packed, gnu::may_alias]] Memory {
    Lanes lanes;
  };
  using Number = T;
  using Half = Register<T, kBytes / 2>;
};

template <typename R>
[[gnu::always_inline]] inline typename R::Memory& at(typename R::Number* address) {
  return *reinterpret_cast<typename R::Memory*>(address);
}

template <typename R>
[[gnu::always_inline]] inline const typename R::Memory& at(const typename R::Number* address) {
  return *reinterpret_cast<const typename R::Memory*>(address);
}

enum class Store { kSubtract, kAssign };

/// kVectors registers of rows by kColumns columns of A B^T. The accumulators, the loads and one
/// broadcast have to stay in the sixteen registers: three by three.
template <typename R, int kVectors, int kColumns, typename T>
[[gnu::always_inline]] inline void sumTile(int depth, const T* a, int lda, const T* b, int ldb,
                                           typename R::Lanes (&sum)[kColumns][kVectors]) {
  for (int k = 0; k < depth; ++k) {
    typename R::Lanes column[kVectors];
    for (int v = 0; v < kVectors; ++v) column[v] = at<R>(a + v * R::kLanes).lanes;
    for (int j = 0; j < kColumns; ++j) {
      for (int v = 0; v < kVectors; ++v) sum[j][v] += column[v] * b[j];
    }
    a += lda;
    b += ldb;
  }
}

template <Store kStore, typename R, int kVectors, int kColumns, typename T>
[[gnu::always_inline]] inline void tile(int depth, const T* a, int lda, const T* b, int ldb, T* c,
                                        int ldc) {
  typename R::Lanes sum[kColumns][kVectors] = {};
  sumTile<R, kVectors, kColumns>(depth, a, lda, b, ldb, sum);
  for (int j = 0; j < kColumns; ++j) {
    for (int v = 0; v < kVectors; ++v) {
      auto& target = at<R>(c + j * ldc + v * R::kLanes);
      if constexpr (kStore == Store::kSubtract) {
        target.lanes -= sum[j][v];
      } else {
        target.lanes = sum[j][v];
      }
    }
  }
}

/// The last lanes of `rows` rows, of which those before `begin` are done.
template <Store kStore, typename R, int kColumns, typename T>
[[gnu::always_inline]] inline void lastTile(int begin, int rows, int depth, const T* a, int lda,
                                            const T* b, int ldb, T* c, int ldc) {
  const int last = rows - R::kLanes;
  if constexpr (kStore == Store::kAssign) {
    tile<kStore, R, 1, kColumns>(depth, a + last, lda, b, ldb, c + last, ldc);
  } else {
    typename R::Lanes sum[kColumns][1] = {};
    sumTile<R, 1, kColumns>(depth, a + last, lda, b, ldb, sum);
    for (int j = 0; j < kColumns; ++j) {
      for (int r = begin; r < rows; ++r) c[r + j * ldc] -= sum[j][0][r - last];
    }
  }
}

template <Store kStore, typename T>
[[gnu::always_inline]] inline void element(int depth, const T* a, int lda, const T* b, int ldb,
                                           T* c) {
  T sum = 0;
  for (int k = 0; k < depth; ++k) sum += a[k * lda] * b[k * ldb];
  if constexpr (kStore == Store::kSubtract) {
    *c -= sum;
  } else {
    *c = sum;
  }
}

/// kColumns columns of A B^T.
template <Store kStore, typename R, int kColumns, typename T>
[[gnu::always_inline]] inline void someColumns(int rows, int depth, const T* a, int lda, const T* b,
                                               int ldb, T* c, int ldc) {
  constexpr int kLanes = R::kLanes;
  int i = 0;
  for (; i + 3 * kLanes <= rows; i += 3 * kLanes) {
    tile<kStore, R, 3, kColumns>(depth, a + i, lda, b, ldb, c + i, ldc);
  }
  if (i + 2 * kLanes <= rows) {
    tile<kStore, R, 2, kColumns>(depth, a + i, lda, b, ldb, c + i, ldc);
    i += 2 * kLanes;
  } else if (i + kLanes <= rows) {
    tile<kStore, R, 1, kColumns>(depth, a + i, lda, b, ldb, c + i, ldc);
    i += kLanes;
  }
  if (i == rows) return;
  if (rows >= kLanes) {
    lastTile<kStore, R, kColumns>(i, rows, depth, a, lda, b, ldb, c, ldc);
  } else if constexpr (sizeof(typename R::Lanes) > 16) {
    someColumns<kStore, typename R::Half, kColumns>(rows, depth, a, lda, b, ldb, c, ldc);
  } else {
    for (; i < rows; ++i) {
      for (int j = 0; j < kColumns; ++j) {
        element<kStore>(depth, a + i, lda, b + j, ldb, c + i + j * ldc);
      }
    }
  }
}

/// C -= A B^T by parts of A that stay in the first-level cache while all columns pass.
template <typename R, typename T>
[[gnu::always_inline]] inline void subtractProductOf(int rows, int columns, int depth, const T* a,
                                                     int lda, const T* b, int ldb, T* c, int ldc) {
  constexpr int kRows = 3 * R::kLanes;
  constexpr int kDepth = 192;
  if (columns == 3) {  // A passes once
    return someColumns<Store::kSubtract, R, 3>(rows, depth, a, lda, b, ldb, c, ldc);
  }
  for (int k = 0; k < depth; k += kDepth) {
    const int part = depth - k < kDepth ? depth - k : kDepth;
    const T* const a_part = a + static_cast<std::ptrdiff_t>(lda) * k;
    const T* const b_part = b + static_cast<std::ptrdiff_t>(ldb) * k;
    for (int i = 0; i < rows;) {
      // The last part takes up what is too short for a register.
      const int height = rows - i < kRows + R::kLanes ? rows - i : kRows;
      int j = 0;
      for (; j + 3 <= columns; j += 3) {
        someColumns<Store::kSubtract, R, 3>(height, part, a_part + i, lda, b_part + j, ldb,
                                            c + i + static_cast<std::ptrdiff_t>(ldc) * j, ldc);
      }
      for (; j < columns; ++j) {
        for (int r = i; r < i + height; ++r) {
          element<Store::kSubtract>(part, a_part + r, lda, b_part + j, ldb,
                                    c + r + static_cast<std::ptrdiff_t>(ldc) * j);
        }
      }
      i += height;
    }
  }
}

/// C = A B^T by parts of A as above. The depths are small.
template <typename R, typename T>
[[gnu::always_inline]] inline void multiplyOf(int rows, int columns, int depth, const T* a, int lda,
                                              const T* b, int ldb, T* c, int ldc) {
  constexpr int kRows = 3 * R::kLanes;
  for (int i = 0; i < rows;) {
    const int height = rows - i < kRows + R::kLanes ? rows - i : kRows;
    for (int j = 0; j < columns; j += 3) {
      someColumns<Store::kAssign, R, 3>(height, depth, a + i, lda, b + j, ldb, c + i + j * ldc,
                                        ldc);
    }
    i += height;
  }
}

template <typename R, typename T>
[[gnu::always_inline]] inline void subtractRun(int count, const T* a, T* c) {
  int i = 0;
  for (; i + R::kLanes <= count; i += R::kLanes) at<R>(c + i).lanes -= at<R>(a + i).lanes;
  if constexpr (sizeof(typename R::Lanes) > 16) {
    subtractRun<typename R::Half>(count - i, a + i, c + i);
  } else {
    for (; i < count; ++i) c[i] -= a[i];
  }
}

template <typename R, typename T>
[[gnu::always_inline]] inline void subtractRunsOf(const RowRun* runs, int run_count, const T* a,
                                                  int lda, T* c, int ldc) {
  for (const RowRun* run = runs; run != runs + run_count; ++run) {
    for (int column = 0; column < 3; ++column) {
      subtractRun<R>(run->count, a + run->from + column * lda,
                     c + run->to + static_cast<std::ptrdiff_t>(column) * ldc);
    }
  }
}

/// L_below = A_below L_top^-T of kVectors registers of rows.
template <typename R, int kVectors, typename T>
[[gnu::always_inline]] inline void divideRows(const T (&l)[3][3], T* a, int lda) {
  for (int v = 0; v < kVectors; ++v) {
    typename R::Memory* columns[3];
    for (int c = 0; c < 3; ++c) columns[c] = &at<R>(a + c * lda + v * R::kLanes);
    const auto x0 = columns[0]->lanes * l[0][0];
    const auto x1 = (columns[1]->lanes - x0 * l[1][0]) * l[1][1];
    const auto x2 = (columns[2]->lanes - x0 * l[2][0] - x1 * l[2][1]) * l[2][2];
    columns[0]->lanes = x0;
    columns[1]->lanes = x1;
    columns[2]->lanes = x2;
  }
}

template <typename R, typename T>
[[gnu::always_inline]] inline void divideRowsOf(const T (&l)[3][3], int rows, T* a, int lda) {
  constexpr int kLanes = R::kLanes;
  int i = 0;
  for (; i + 2 * kLanes <= rows; i += 2 * kLanes) divideRows<R, 2>(l, a + i, lda);
  for (; i + kLanes <= rows; i += kLanes) divideRows<R, 1>(l, a + i, lda);
  for (; i < rows; ++i) {
    T* const x = a + i;
    x[0] *= l[0][0];
    x[lda] = (x[lda] - x[0] * l[1][0]) * l[1][1];
    x[2 * lda] = (x[2 * lda] - x[0] * l[2][0] - x[lda] * l[2][1]) * l[2][2];
  }
}

template <typename R, typename T>
[[gnu::always_inline]] inline void divideThreeColumnsOf(int rows, const T* top, int ldtop, T* a,
                                                        int lda) {
  divideRowsOf<R>(TopTriangle<T>::read(top, ldtop).l, rows, a, lda);
}

template <typename R, typename T>
[[gnu::always_inline]] inline bool factoriseThreeColumnsOf(int rows, T* a, int lda) {
  TopTriangle<T> top;
  if (!top.factorise(a, lda)) return false;
  divideRowsOf<R>(top.l, rows - 3, a + 3, lda);
  return true;
}

template <typename R, typename T>
[[gnu::always_inline]] inline void substituteForwardOf(int rows, int columns, const T* l, int ldl,
                                                       T* x) {
  constexpr int kLanes = R::kLanes;
  for (int c = 0; c < columns; c += 3) {
    const T* l0 = l + static_cast<std::ptrdiff_t>(ldl) * c;
    const T* l1 = l0 + ldl;
    const T* l2 = l1 + ldl;
    const T x0 = x[c] * l0[c];
    const T x1 = (x[c + 1] - l0[c + 1] * x0) * l1[c + 1];
    const T x2 = (x[c + 2] - l0[c + 2] * x0 - l1[c + 2] * x1) * l2[c + 2];
    x[c] = x0;
    x[c + 1] = x1;
    x[c + 2] = x2;
    int r = c + 3;
    for (; r + kLanes <= rows; r += kLanes) {
      at<R>(x + r).lanes -=
          at<R>(l0 + r).lanes * x0 + at<R>(l1 + r).lanes * x1 + at<R>(l2 + r).lanes * x2;
    }
    for (; r < rows; ++r) x[r] -= l0[r] * x0 + l1[r] * x1 + l2[r] * x2;
  }
}

/// The sum of all lanes, halves first.
template <typename R>
[[gnu::always_inline]] inline typename R::Number sumOf(typename R::Lanes& lanes) {
  for (int half = R::kLanes / 2; half > 0; half /= 2) {
    for (int i = 0; i < half; ++i) lanes[i] += lanes[i + half];
  }
  return lanes[0];
}

template <typename R, typename T>
[[gnu::always_inline]] inline void substituteBackwardOf(int rows, int columns, const T* l, int ldl,
                                                        T* x) {
  constexpr int kLanes = R::kLanes;
  for (int c = columns - 3; c >= 0; c -= 3) {
    const T* l0 = l + static_cast<std::ptrdiff_t>(ldl) * c;
    const T* l1 = l0 + ldl;
    const T* l2 = l1 + ldl;
    typename R::Lanes sum[3] = {};
    int r = c + 3;
    for (; r + kLanes <= rows; r += kLanes) {
      const auto below = at<R>(x + r).lanes;
      sum[0] += at<R>(l0 + r).lanes * below;
      sum[1] += at<R>(l1 + r).lanes * below;
      sum[2] += at<R>(l2 + r).lanes * below;
    }
    T s0 = sumOf<R>(sum[0]), s1 = sumOf<R>(sum[1]), s2 = sumOf<R>(sum[2]);
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

}  // namespace haptex::linear::registers
