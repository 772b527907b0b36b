// Vectors and blocks of four elements at a time, one per lane of an AVX2 register.
#pragma once

#if defined(__x86_64__)
#include <immintrin.h>

#include <cstddef>

#include "haptex/cloth/forces/batches/membrane_batches.h"

// Every function that touches a wide register carries the attribute and is inlined, so that no
// wide value crosses a call: the rest of the library keeps the ABI of the baseline.
#define HAPTEX_AVX2_INLINE [[gnu::target("avx2,fma"), gnu::always_inline]] inline
#define HAPTEX_AVX2 [[gnu::target("avx2,fma")]]

namespace haptex::cloth::kernels {

struct Vector {  // four 3-vectors, one per lane
  __m256d x, y, z;
};

struct Symmetric {
  __m256d xx, xy, xz, yy, yz, zz;
};

struct Block {
  __m256d columns[9];
};

HAPTEX_AVX2_INLINE Vector operator+(const Vector& a, const Vector& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}

HAPTEX_AVX2_INLINE Vector operator-(const Vector& a, const Vector& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}

HAPTEX_AVX2_INLINE Vector combine(__m256d s, const Vector& a, __m256d t, const Vector& b) {
  return {s * a.x + t * b.x, s * a.y + t * b.y, s * a.z + t * b.z};
}

HAPTEX_AVX2_INLINE __m256d dot(const Vector& a, const Vector& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

/// The points of four particles. Reads no number behind the last one.
HAPTEX_AVX2_INLINE Vector gather(const double* points, const int* particles) {
  const double* p0 = points + std::ptrdiff_t{3} * particles[0];
  const double* p1 = points + std::ptrdiff_t{3} * particles[1];
  const double* p2 = points + std::ptrdiff_t{3} * particles[2];
  const double* p3 = points + std::ptrdiff_t{3} * particles[3];
  const __m256d even = _mm256_loadu2_m128d(p2, p0);
  const __m256d odd = _mm256_loadu2_m128d(p3, p1);
  return {_mm256_unpacklo_pd(even, odd), _mm256_unpackhi_pd(even, odd),
          _mm256_set_pd(p3[2], p2[2], p1[2], p0[2])};
}

/// Adds the vectors to the points of four particles, one particle after the other.
HAPTEX_AVX2_INLINE void scatter(const Vector& v, const int* particles, double* points) {
  const __m256d even = _mm256_unpacklo_pd(v.x, v.y);
  const __m256d odd = _mm256_unpackhi_pd(v.x, v.y);
  const __m128d xy[4] = {_mm256_castpd256_pd128(even), _mm256_castpd256_pd128(odd),
                         _mm256_extractf128_pd(even, 1), _mm256_extractf128_pd(odd, 1)};
  for (int lane = 0; lane < kBatch; ++lane) {
    double* point = points + std::ptrdiff_t{3} * particles[lane];
    _mm_storeu_pd(point, _mm_loadu_pd(point) + xy[lane]);
    point[2] += v.z[lane];
  }
}

/// Turns four registers, one lane per element, into one register per element.
HAPTEX_AVX2_INLINE void transpose(const __m256d* rows, __m256d* columns) {
  const __m256d low_01 = _mm256_unpacklo_pd(rows[0], rows[1]);
  const __m256d high_01 = _mm256_unpackhi_pd(rows[0], rows[1]);
  const __m256d low_23 = _mm256_unpacklo_pd(rows[2], rows[3]);
  const __m256d high_23 = _mm256_unpackhi_pd(rows[2], rows[3]);
  columns[0] = _mm256_permute2f128_pd(low_01, low_23, 0x20);
  columns[1] = _mm256_permute2f128_pd(high_01, high_23, 0x20);
  columns[2] = _mm256_permute2f128_pd(low_01, low_23, 0x31);
  columns[3] = _mm256_permute2f128_pd(high_01, high_23, 0x31);
}

/// Adds one block per element to the blocks at `places`.
HAPTEX_AVX2_INLINE void scatter(const Block& block, const int* places, double* blocks) {
  __m256d first[4], second[4];
  transpose(block.columns, first);
  transpose(block.columns + 4, second);
  for (int lane = 0; lane < kBatch; ++lane) {
    double* target = blocks + std::ptrdiff_t{9} * places[lane];
    _mm256_storeu_pd(target, _mm256_loadu_pd(target) + first[lane]);
    _mm256_storeu_pd(target + 4, _mm256_loadu_pd(target + 4) + second[lane]);
    target[8] += block.columns[8][lane];
  }
}

HAPTEX_AVX2_INLINE Block full(const Symmetric& s) {
  return {{s.xx, s.xy, s.xz, s.xy, s.yy, s.yz, s.xz, s.yz, s.zz}};
}

}  // namespace haptex::cloth::kernels

#endif
