// Strain-stress curves of weft, warp and shear for four elements at a time (four_lanes.h).
#pragma once

#if defined(__x86_64__)
#include <immintrin.h>

#include <array>

#include "haptex/cloth/forces/batches/four_lanes.h"
#include "haptex/material/strain_stress_curve.h"

namespace haptex::cloth::kernels {

struct Response {
  __m256d stress[3];
  __m256d slope[3];
};

/// Clamps slopes to >= 0 from the first one on.
template <int kFirst>
HAPTEX_AVX2_INLINE void clampSlopes(__m256d* slope) {
  // NaN is the second operand and therefore stays.
  for (int m = kFirst; m < 3; ++m) slope[m] = _mm256_max_pd(_mm256_setzero_pd(), slope[m]);
}

/// Slopes clamped to >= 0 from the first one on.
template <int kFirstClamped>
HAPTEX_AVX2_INLINE Response respond(const std::array<material::StrainStressCurve, 3>& curves,
                                    const __m256d* strain) {
  Response result;
  for (int m = 0; m < 3; ++m) {
    for (int lane = 0; lane < kBatch; ++lane) {
      const material::CurveValue value = curves[m].evaluate(strain[m][lane]);
      result.stress[m][lane] = value.stress;
      result.slope[m][lane] = value.slope;
    }
  }
  clampSlopes<kFirstClamped>(result.slope);
  return result;
}

/// Adds the integrals of the curves times a factor.
HAPTEX_AVX2_INLINE void addEnergies(const std::array<material::StrainStressCurve, 3>& curves,
                                    const __m256d* strain, __m256d factor, __m256d& density) {
  for (int m = 0; m < 3; ++m) {
    __m256d energy;
    for (int lane = 0; lane < kBatch; ++lane) energy[lane] = curves[m].energy(strain[m][lane]);
    density += factor * energy;
  }
}

}  // namespace haptex::cloth::kernels

#endif
