#include "haptex/cloth/forces/membrane_kernel.h"

#include "haptex/cloth/forces/batches/four_curves.h"

#if defined(__x86_64__)
#include <immintrin.h>

#include <cstddef>

namespace haptex::cloth::kernels {
namespace {

/// projectStress() of four elements.
HAPTEX_AVX2_INLINE void project(const __m256d* stress, __m256d* result) {
  const __m256d zero = _mm256_setzero_pd();
  const __m256d mean = 0.5 * (stress[0] + stress[1]);
  const __m256d difference = 0.5 * (stress[0] - stress[1]);
  const __m256d radius = _mm256_sqrt_pd(difference * difference + stress[2] * stress[2]);
  const __m256d half = 0.5 * (mean + radius);
  const __m256d ratio = half / radius;
  const __m256d clamped[3] = {half + ratio * difference, half - ratio * difference,
                              ratio * stress[2]};
  const __m256d keep = _mm256_cmp_pd(mean, radius, _CMP_GE_OQ);
  const __m256d drop = _mm256_cmp_pd(mean, zero - radius, _CMP_LE_OQ);
  for (int m = 0; m < 3; ++m) {
    result[m] = _mm256_blendv_pd(_mm256_blendv_pd(clamped[m], zero, drop), stress[m], keep);
  }
}

/// A tangent block with i = j: weft (p)^T + warp (q)^T is symmetric there.
/// @param coupling of weft and warp, read if they are
template <bool kCoupled>
HAPTEX_AVX2_INLINE Symmetric diagonalBlock(const Vector& weft, const Vector& warp, __m256d ru,
                                           __m256d rv, const __m256d* slope, __m256d coupling,
                                           const __m256d* stress) {
  const __m256d uu = ru * ru, vv = rv * rv, uv = ru * rv;
  const __m256d across = (kCoupled ? slope[2] + coupling : slope[2]) * uv;
  const Vector p = combine(slope[0] * uu + slope[2] * vv, weft, across, warp);
  const Vector q = combine(across, weft, slope[1] * vv + slope[2] * uu, warp);
  const __m256d geometric = stress[0] * uu + stress[1] * vv + stress[2] * (uv + uv);
  return {weft.x * p.x + (warp.x * q.x + geometric),
          weft.x * p.y + warp.x * q.y,
          weft.x * p.z + warp.x * q.z,
          weft.y * p.y + (warp.y * q.y + geometric),
          weft.y * p.z + warp.y * q.z,
          weft.z * p.z + (warp.z * q.z + geometric)};
}

struct Lanes {  // an element's constants
  __m256d weft_weights[2], warp_weights[2], area;
};

template <bool kCoupled>
HAPTEX_AVX2_INLINE void addTangent(const MembraneBatch& batch, const Lanes& at, const Vector& weft,
                                   const Vector& warp, const __m256d* slope, __m256d coupling,
                                   const __m256d* stress, const MembraneSystem& system) {
  const Symmetric b11 = diagonalBlock<kCoupled>(weft, warp, at.weft_weights[0], at.warp_weights[0],
                                                slope, coupling, stress);
  const Symmetric b22 = diagonalBlock<kCoupled>(weft, warp, at.weft_weights[1], at.warp_weights[1],
                                                slope, coupling, stress);
  const __m256d uu = at.weft_weights[1] * at.weft_weights[0];
  const __m256d vv = at.warp_weights[1] * at.warp_weights[0];
  const __m256d uv = at.weft_weights[1] * at.warp_weights[0];
  const __m256d vu = at.warp_weights[1] * at.weft_weights[0];
  __m256d weft_warp = slope[2] * vu, warp_weft = slope[2] * uv;
  if constexpr (kCoupled) {
    weft_warp += coupling * uv;
    warp_weft += coupling * vu;
  }
  const Vector p = combine(slope[0] * uu + slope[2] * vv, weft, weft_warp, warp);
  const Vector q = combine(warp_weft, weft, slope[1] * vv + slope[2] * uu, warp);
  const __m256d geometric = stress[0] * uu + stress[1] * vv + stress[2] * (uv + vu);
  const Block b21 = {{weft.x * p.x + (warp.x * q.x + geometric), weft.y * p.x + warp.y * q.x,
                      weft.z * p.x + warp.z * q.x, weft.x * p.y + warp.x * q.y,
                      weft.y * p.y + (warp.y * q.y + geometric), weft.z * p.y + warp.z * q.y,
                      weft.x * p.z + warp.x * q.z, weft.y * p.z + warp.y * q.z,
                      weft.z * p.z + (warp.z * q.z + geometric)}};
  // Blocks with particle 0 follow from the others because the weights sum to zero.
  const Block b11_full = full(b11), b22_full = full(b22);
  Block b10, b20;
  for (int c = 0; c < 3; ++c) {
    for (int r = 0; r < 3; ++r) {
      b10.columns[3 * c + r] = -b11_full.columns[3 * c + r] - b21.columns[3 * r + c];
      b20.columns[3 * c + r] = -b21.columns[3 * c + r] - b22_full.columns[3 * c + r];
    }
  }
  const Symmetric b00 = {-b10.columns[0] - b20.columns[0], -b10.columns[3] - b20.columns[3],
                         -b10.columns[6] - b20.columns[6], -b10.columns[4] - b20.columns[4],
                         -b10.columns[7] - b20.columns[7], -b10.columns[8] - b20.columns[8]};
  scatter(b21, batch.slots[2], system.lower);
  scatter(b11_full, batch.particles[1], system.diagonal);
  scatter(b22_full, batch.particles[2], system.diagonal);
  scatter(b10, batch.slots[0], system.lower);
  scatter(b20, batch.slots[1], system.lower);
  scatter(full(b00), batch.particles[0], system.diagonal);
}

HAPTEX_AVX2_INLINE Lanes lanesOf(const MembraneBatch& batch) {
  Lanes at;
  for (int i = 0; i < 2; ++i) {
    at.weft_weights[i] = _mm256_load_pd(batch.weft_weights[i]);
    at.warp_weights[i] = _mm256_load_pd(batch.warp_weights[i]);
  }
  at.area = _mm256_load_pd(batch.area);
  return at;
}

struct Frame {  // U and V, or their rates
  Vector weft, warp;
};

HAPTEX_AVX2_INLINE Frame frameOf(const MembraneBatch& batch, const Lanes& at,
                                 const double* points) {
  const Vector origin = gather(points, batch.particles[0]);
  const Vector edge_1 = gather(points, batch.particles[1]) - origin;
  const Vector edge_2 = gather(points, batch.particles[2]) - origin;
  return {combine(at.weft_weights[0], edge_1, at.weft_weights[1], edge_2),
          combine(at.warp_weights[0], edge_1, at.warp_weights[1], edge_2)};
}

HAPTEX_AVX2_INLINE void strainOf(const Frame& frame, __m256d* strain) {
  strain[0] = 0.5 * (dot(frame.weft, frame.weft) - 1.0);
  strain[1] = 0.5 * (dot(frame.warp, frame.warp) - 1.0);
  strain[2] = dot(frame.weft, frame.warp);
}

/// Mean rates from the strains at the beginning, three numbers per element.
HAPTEX_AVX2_INLINE void rateSince(const double* begin, const __m256d* strain, __m256d h,
                                  __m256d* rate) {
  for (int m = 0; m < 3; ++m) {
    rate[m] = (strain[m] - _mm256_set_pd(begin[9 + m], begin[6 + m], begin[3 + m], begin[m])) / h;
  }
}

/// Makes the tangent of weft and warp positive semidefinite; without coupling its slopes are.
template <bool kCoupled>
HAPTEX_AVX2_INLINE void projectTangent(__m256d* slope, __m256d& coupling) {
  if constexpr (kCoupled) {
    const __m256d tangent[3] = {slope[0], slope[1], coupling};
    __m256d projected[3];
    project(tangent, projected);
    slope[0] = projected[0];
    slope[1] = projected[1];
    coupling = projected[2];
  }
}

/// Adds to the right-hand side what the forces on the frames do to the particles.
HAPTEX_AVX2_INLINE void scatterTractions(const MembraneBatch& batch, const Lanes& at,
                                         const Vector& weft, const Vector& warp, double* rhs) {
  const Vector at_1 = combine(at.weft_weights[0], weft, at.warp_weights[0], warp);
  const Vector at_2 = combine(at.weft_weights[1], weft, at.warp_weights[1], warp);
  const __m256d zero = _mm256_setzero_pd();
  scatter(Vector{zero, zero, zero} - (at_1 + at_2), batch.particles[0], rhs);
  scatter(at_1, batch.particles[1], rhs);
  scatter(at_2, batch.particles[2], rhs);
}

template <bool kCoupled>
HAPTEX_AVX2_INLINE void addBatch(const MembraneBatch& batch, const MembraneStep& step) {
  const Lanes at = lanesOf(batch);
  const auto [weft, warp] = frameOf(batch, at, step.positions);
  const auto [weft_rate, warp_rate] = frameOf(batch, at, step.velocities);
  __m256d strain[3];
  strainOf({weft, warp}, strain);
  const __m256d rate[3] = {dot(weft, weft_rate), dot(warp, warp_rate),
                           dot(weft_rate, warp) + dot(weft, warp_rate)};
  const __m256d h = _mm256_set1_pd(step.a);
  const __m256d ahead = _mm256_set1_pd(step.ahead);
  const __m256d turn = _mm256_set1_pd(-step.ahead / step.a);
  const __m256d load = -at.area * h;  // N.s/m per N/m of stress
  const __m256d stiffness = -load * h;
  Response response = respond < kCoupled ? 2 : 0 > (*step.law.elastic, strain);
  __m256d coupling = _mm256_set1_pd(step.law.coupling);
  if constexpr (kCoupled) {
    response.stress[0] += coupling * strain[1];
    response.stress[1] += coupling * strain[0];
  }
  projectTangent<kCoupled>(response.slope, coupling);
  __m256d end[3];
  for (int m = 0; m < 3; ++m) end[m] = ahead * response.slope[m] * rate[m];
  if constexpr (kCoupled) {
    end[0] += ahead * coupling * rate[1];
    end[1] += ahead * coupling * rate[0];
    coupling *= stiffness;
  }
  if (step.law.viscous) {
    const Response viscous = respond<0>(*step.law.viscous, rate);
    const __m256d frequency = 1.0 / h;
    for (int m = 0; m < 3; ++m) {
      response.stress[m] += viscous.stress[m];
      response.slope[m] += viscous.slope[m] * frequency;
    }
  }
  __m256d geometric[3], turning[3];
  project(response.stress, geometric);
  for (int m = 0; m < 3; ++m) {
    end[m] = load * (response.stress[m] + end[m]);
    response.slope[m] *= stiffness;
    geometric[m] *= stiffness;
    turning[m] = turn * geometric[m];
  }
  scatterTractions(
      batch, at,
      combine(end[0], weft, end[2], warp) + combine(turning[0], weft_rate, turning[2], warp_rate),
      combine(end[1], warp, end[2], weft) + combine(turning[1], warp_rate, turning[2], weft_rate),
      step.system.rhs);
  addTangent<kCoupled>(batch, at, weft, warp, response.slope, coupling, geometric, step.system);
}

template <bool kCoupled, bool kExact>
HAPTEX_AVX2_INLINE void addNewtonBatch(const MembraneBatch& batch, const double* begin_strains,
                                       const MembraneNewton& newton) {
  const Lanes at = lanesOf(batch);
  const auto [weft, warp] = frameOf(batch, at, newton.positions);
  __m256d strain[3];
  strainOf({weft, warp}, strain);
  const __m256d h = _mm256_set1_pd(newton.h);
  Response response = respond<3>(*newton.law.elastic, strain);
  __m256d coupling = _mm256_set1_pd(newton.law.coupling);
  if constexpr (kCoupled) {
    response.stress[0] += coupling * strain[1];
    response.stress[1] += coupling * strain[0];
  }
  if (newton.law.viscous) {
    __m256d rate[3];
    rateSince(begin_strains, strain, h, rate);
    const Response viscous = respond<3>(*newton.law.viscous, rate);
    for (int m = 0; m < 3; ++m) {
      response.stress[m] += viscous.stress[m];
      response.slope[m] += viscous.slope[m] / h;
    }
  }
  __m256d geometric[3] = {response.stress[0], response.stress[1], response.stress[2]};
  if constexpr (!kExact) {
    clampSlopes<kCoupled ? 2 : 0>(response.slope);
    projectTangent<kCoupled>(response.slope, coupling);
    project(response.stress, geometric);
  }
  const __m256d load = -at.area * h;  // N.s/m per N/m of stress
  const __m256d stiffness = -load * h;
  coupling *= stiffness;
  for (int m = 0; m < 3; ++m) {
    response.stress[m] *= load;
    response.slope[m] *= stiffness;
    geometric[m] *= stiffness;
  }
  scatterTractions(batch, at, combine(response.stress[0], weft, response.stress[2], warp),
                   combine(response.stress[1], warp, response.stress[2], weft), newton.system.rhs);
  addTangent<kCoupled>(batch, at, weft, warp, response.slope, coupling, geometric, newton.system);
}

HAPTEX_AVX2 void addStepAvx2(const MembraneBatch* batches, int count, const MembraneStep& step) {
  if (step.law.coupling == 0.0) {
    for (int b = 0; b < count; ++b) addBatch<false>(batches[b], step);
  } else {
    for (int b = 0; b < count; ++b) addBatch<true>(batches[b], step);
  }
}

template <bool kExact>
HAPTEX_AVX2 void addNewtonAvx2(const MembraneBatch* batches, int count,
                               const MembraneNewton& newton) {
  constexpr int kStrains = 3 * kBatch;
  const double* strains = newton.begin_strains;
  if (newton.law.coupling == 0.0) {
    for (int b = 0; b < count; ++b, strains += kStrains) {
      addNewtonBatch<false, kExact>(batches[b], strains, newton);
    }
  } else {
    for (int b = 0; b < count; ++b, strains += kStrains) {
      addNewtonBatch<true, kExact>(batches[b], strains, newton);
    }
  }
}

HAPTEX_AVX2 double potentialAvx2(const MembraneBatch* batches, int count, const double* positions,
                                 const double* begin_strains, double interval,
                                 const MembraneLaw& law) {
  const __m256d h = _mm256_set1_pd(interval), one = _mm256_set1_pd(1.0);
  __m256d sum = _mm256_setzero_pd();
  for (int b = 0; b < count; ++b) {
    const Lanes at = lanesOf(batches[b]);
    __m256d strain[3], rate[3];
    strainOf(frameOf(batches[b], at, positions), strain);
    __m256d density = law.coupling * strain[0] * strain[1];
    addEnergies(*law.elastic, strain, one, density);
    if (law.viscous) {
      rateSince(begin_strains + std::ptrdiff_t{3} * kBatch * b, strain, h, rate);
      addEnergies(*law.viscous, rate, h, density);
    }
    sum += at.area * density;
  }
  return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

}  // namespace

bool canAddBatches() { return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"); }

void addStep(const MembraneBatch* batches, int count, const MembraneStep& step) {
  addStepAvx2(batches, count, step);
}

void addNewton(const MembraneBatch* batches, int count, const MembraneNewton& newton) {
  if (newton.exact) {
    addNewtonAvx2<true>(batches, count, newton);
  } else {
    addNewtonAvx2<false>(batches, count, newton);
  }
}

double potential(const MembraneBatch* batches, int count, const double* positions,
                 const double* begin_strains, double h, const MembraneLaw& law) {
  return potentialAvx2(batches, count, positions, begin_strains, h, law);
}

}  // namespace haptex::cloth::kernels

#else

namespace haptex::cloth::kernels {

bool canAddBatches() { return false; }

void addStep(const MembraneBatch*, int, const MembraneStep&) {}

void addNewton(const MembraneBatch*, int, const MembraneNewton&) {}

double potential(const MembraneBatch*, int, const double*, const double*, double,
                 const MembraneLaw&) {
  return 0.0;
}

}  // namespace haptex::cloth::kernels

#endif
