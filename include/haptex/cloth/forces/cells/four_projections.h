// The nearest matrices that are positive semidefinite, for four bilinear cells at a time
// (four_lanes.h).
#pragma once

#if defined(__x86_64__)
#include <immintrin.h>

#include "haptex/cloth/forces/batches/four_lanes.h"

namespace haptex::cloth::kernels {

/// Strains of cells, or symmetric 3 x 3 matrices: the entries 11, 22, 33, 12, 13, 23.
using Six = __m256d[6];

/// Turns the axes p and q of a symmetric matrix so that its entry pq becomes 0, and their vectors
/// with them. @param r the third axis
HAPTEX_AVX2_INLINE void turn(__m256d& pp, __m256d& qq, __m256d& pq, __m256d& pr, __m256d& qr,
                             __m256d* p, __m256d* q) {
  const __m256d one = _mm256_set1_pd(1.0), sign = _mm256_set1_pd(-0.0);
  const __m256d difference = qq - pp, twice = pq + pq;
  const __m256d length = _mm256_sqrt_pd(difference * difference + twice * twice);
  const __m256d divisor = _mm256_andnot_pd(sign, difference) + length + 1e-300;
  const __m256d tangent = _mm256_xor_pd(twice / divisor, _mm256_and_pd(sign, difference));
  const __m256d cosine = one / _mm256_sqrt_pd(one + tangent * tangent);
  const __m256d sine = tangent * cosine;
  pp -= tangent * pq;
  qq += tangent * pq;
  pq = _mm256_setzero_pd();
  const __m256d old_pr = pr;
  pr = cosine * old_pr - sine * qr;
  qr = sine * old_pr + cosine * qr;
  for (int i = 0; i < 3; ++i) {
    const __m256d old_p = p[i];
    p[i] = cosine * old_p - sine * q[i];
    q[i] = sine * old_p + cosine * q[i];
  }
}

HAPTEX_AVX2_INLINE bool anyAbove(const Six& matrix, __m256d limit) {
  const __m256d sum = matrix[3] * matrix[3] + matrix[4] * matrix[4] + matrix[5] * matrix[5];
  return _mm256_movemask_pd(_mm256_cmp_pd(sum, limit, _CMP_GT_OQ)) != 0;
}

/// The nearest matrix that is positive semidefinite, by Jacobi's rotations.
HAPTEX_AVX2_INLINE void projectMatrix(Six& matrix) {
  constexpr int kMostSweeps = 10;
  const __m256d zero = _mm256_setzero_pd(), one = _mm256_set1_pd(1.0);
  __m256d axes[3][3] = {{one, zero, zero}, {zero, one, zero}, {zero, zero, one}};
  __m256d limit = matrix[0] * matrix[0] + matrix[1] * matrix[1] + matrix[2] * matrix[2];
  for (int q = 3; q < 6; ++q) limit += 2.0 * matrix[q] * matrix[q];
  limit *= 1e-32;
  for (int sweep = 0; sweep < kMostSweeps && anyAbove(matrix, limit); ++sweep) {
    turn(matrix[0], matrix[1], matrix[3], matrix[4], matrix[5], axes[0], axes[1]);
    turn(matrix[0], matrix[2], matrix[4], matrix[3], matrix[5], axes[0], axes[2]);
    turn(matrix[1], matrix[2], matrix[5], matrix[3], matrix[4], axes[1], axes[2]);
  }
  Six values;
  for (int k = 0; k < 3; ++k) values[k] = _mm256_max_pd(zero, matrix[k]);  // NaN stays
  constexpr int kPlaces[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}};
  for (int q = 0; q < 6; ++q) {
    const auto [i, j] = kPlaces[q];
    matrix[q] = values[0] * axes[0][i] * axes[0][j] + values[1] * axes[1][i] * axes[1][j] +
                values[2] * axes[2][i] * axes[2][j];
  }
}

/// Of which lanes the matrix has negative pivots; also those with numbers that are not finite.
HAPTEX_AVX2_INLINE __m256d indefinite(const Six& matrix) {
  const __m256d zero = _mm256_setzero_pd();
  const __m256d second = matrix[1] - matrix[3] * matrix[3] / matrix[0];
  const __m256d mixed = matrix[5] - matrix[3] * matrix[4] / matrix[0];
  const __m256d third = matrix[2] - matrix[4] * matrix[4] / matrix[0] - mixed * mixed / second;
  return _mm256_or_pd(_mm256_or_pd(_mm256_cmp_pd(matrix[0], zero, _CMP_NGT_UQ),
                                   _mm256_cmp_pd(second, zero, _CMP_NGT_UQ)),
                      _mm256_cmp_pd(third, zero, _CMP_NGE_UQ));
}

/// projectPulls() of four cells. In the basis of the three vectors with the elements 1/2 and -1/2
/// that are orthogonal to the common motion, the diagonal is made of the sums of the pulls of
/// opposite distances, and the rest are their differences.
HAPTEX_AVX2_INLINE void projectStiffness(Six& stiffness) {
  const __m256d outside = indefinite(stiffness);
  if (_mm256_movemask_pd(outside) == 0) return;
  const __m256d ba = stiffness[0] + stiffness[3] + stiffness[4],
                ca = stiffness[1] + stiffness[3] + stiffness[5],
                da = stiffness[2] + stiffness[4] + stiffness[5];
  // With cb = -stiffness[3], db = -stiffness[4], dc = -stiffness[5].
  const __m256d first = ba - stiffness[5], second = ca - stiffness[4], third = da - stiffness[3];
  Six matrix = {second + third,    first + third,     first + second,
                da + stiffness[3], ca + stiffness[4], ba + stiffness[5]};
  projectMatrix(matrix);
  const __m256d new_first = 0.5 * (matrix[1] + matrix[2] - matrix[0]),
                new_second = 0.5 * (matrix[0] + matrix[2] - matrix[1]),
                new_third = 0.5 * (matrix[0] + matrix[1] - matrix[2]);
  const __m256d new_ba = 0.5 * (new_first + matrix[5]), dc = 0.5 * (new_first - matrix[5]),
                new_ca = 0.5 * (new_second + matrix[4]), db = 0.5 * (new_second - matrix[4]),
                new_da = 0.5 * (new_third + matrix[3]), cb = 0.5 * (new_third - matrix[3]);
  const __m256d zero = _mm256_setzero_pd();
  const Six projected = {new_ba + cb + db, new_ca + cb + dc, new_da + db + dc,
                         zero - cb,        zero - db,        zero - dc};
  for (int q = 0; q < 6; ++q) {
    stiffness[q] = _mm256_blendv_pd(stiffness[q], projected[q], outside);
  }
}

}  // namespace haptex::cloth::kernels

#endif
