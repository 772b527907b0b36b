// The first three rows of three columns of a panel, which every kernel of every instruction set
// treats alike, number by number.
#pragma once

#include <cmath>
#include <limits>

namespace haptex::linear {

/// What a factor L has there, with the inverse of its diagonal; nothing above the diagonal is read.
/// Inlined, so that it is compiled for the instruction set of the kernel.
template <typename T>
struct TopTriangle {
  T l[3][3];

  /// @param a column-major, lda from column to column
  [[gnu::always_inline]] static inline TopTriangle read(const T* a, int lda) {
    TopTriangle top;
    for (int c = 0; c < 3; ++c) {
      for (int r = c; r < 3; ++r) top.l[r][c] = a[r + c * lda];
    }
    return top;
  }

  /// Cholesky's factorisation in place.
  /// @returns false, with `a` changed in part, if it is not positive definite or not finite
  [[gnu::always_inline]] inline bool factorise(T* a, int lda) {
    for (int c = 0; c < 3; ++c) {
      for (int r = c; r < 3; ++r) {
        l[r][c] = a[r + c * lda];
        for (int k = 0; k < c; ++k) l[r][c] -= l[r][k] * l[c][k];
      }
      if (!(l[c][c] > 0 && l[c][c] <= std::numeric_limits<T>::max())) return false;
      l[c][c] = 1 / std::sqrt(l[c][c]);
      for (int r = c + 1; r < 3; ++r) l[r][c] *= l[c][c];
      for (int r = c; r < 3; ++r) a[r + c * lda] = l[r][c];
    }
    return true;
  }
};

}  // namespace haptex::linear
