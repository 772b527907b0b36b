#include "haptex/cloth/forces/cells/bilinear_kernel.h"

#include "haptex/cloth/forces/batches/four_curves.h"
#include "haptex/cloth/forces/cells/four_projections.h"

namespace haptex::cloth::kernels {

BilinearBatch batchOf(const BilinearCell* cells) {
  BilinearBatch batch;
  for (int lane = 0; lane < kBatch; ++lane) {
    const BilinearCell& cell = cells[lane];
    batch.area[lane] = cell.area;
    for (int i = 0; i < 4; ++i) batch.particles[i][lane] = cell.particles[i];
    for (int e = 0; e < 6; ++e) batch.slots[e][lane] = cell.slots[e];
    for (int m = 0; m < 6; ++m) {
      const auto by = cell.by_squares.row(m);  // |x_2 - x_1|^2 = s_11 + s_22 - 2 s_12, and so on
      const double form[6] = {by[0] + by[2] + by[4],
                              by[1] + by[2] + by[5],
                              by[3] + by[4] + by[5],
                              -by[2],
                              -by[4],
                              -by[5]};
      for (int q = 0; q < 6; ++q) batch.forms[m][q][lane] = form[q];
    }
    const CellStrain& at_rest = cell.rest_squares;
    const double products[6] = {at_rest[0],
                                at_rest[1],
                                at_rest[3],
                                0.5 * (at_rest[0] + at_rest[1] - at_rest[2]),
                                0.5 * (at_rest[0] + at_rest[3] - at_rest[4]),
                                0.5 * (at_rest[1] + at_rest[3] - at_rest[5])};
    for (int q = 0; q < 6; ++q) batch.rest_products[q][lane] = products[q];
  }
  return batch;
}

}  // namespace haptex::cloth::kernels

#if defined(__x86_64__)

namespace haptex::cloth::kernels {
namespace {

HAPTEX_AVX2_INLINE void edgesIn(const BilinearBatch& batch, const double* points, Vector* edges) {
  const Vector origin = gather(points, batch.particles[0]);
  for (int a = 0; a < 3; ++a) edges[a] = gather(points, batch.particles[a + 1]) - origin;
}

/// All six strains. @param products s - those at rest, or what else they are linear in
HAPTEX_AVX2_INLINE void strainsBy(const BilinearBatch& batch, const Six& products, Six& strain) {
  for (int m = 0; m < 6; ++m) {
    __m256d q[6];
    for (int k = 0; k < 6; ++k) q[k] = _mm256_load_pd(batch.forms[m][k]);
    const __m256d beside = q[3] * products[3] + q[4] * products[4] + q[5] * products[5];
    strain[m] = q[0] * products[0] + q[1] * products[1] + q[2] * products[2] + (beside + beside);
  }
}

HAPTEX_AVX2_INLINE void strainOf(const BilinearBatch& batch, const Vector* x, Six& strain) {
  Six products = {dot(x[0], x[0]), dot(x[1], x[1]), dot(x[2], x[2]),
                  dot(x[0], x[1]), dot(x[0], x[2]), dot(x[1], x[2])};
  for (int q = 0; q < 6; ++q) products[q] -= _mm256_load_pd(batch.rest_products[q]);
  strainsBy(batch, products, strain);
}

/// @param v the rates of x
HAPTEX_AVX2_INLINE void rateOf(const BilinearBatch& batch, const Vector* x, const Vector* v,
                               Six& rate) {
  const Six products = {2.0 * dot(x[0], v[0]),
                        2.0 * dot(x[1], v[1]),
                        2.0 * dot(x[2], v[2]),
                        dot(x[0], v[1]) + dot(v[0], x[1]),
                        dot(x[0], v[2]) + dot(v[0], x[2]),
                        dot(x[1], v[2]) + dot(v[1], x[2])};
  strainsBy(batch, products, rate);
}

/// Mean rates from the strains at the beginning, six numbers per cell.
HAPTEX_AVX2_INLINE void rateSince(const double* begin, const Six& strain, __m256d h, Six& rate) {
  for (int m = 0; m < 6; ++m) {
    rate[m] = (strain[m] - _mm256_set_pd(begin[18 + m], begin[12 + m], begin[6 + m], begin[m])) / h;
  }
}

/// The symmetric matrix K whose forces are F_a = -sum_b K_ab x_b.
/// @param loads derivatives of the energy by the strains, J
HAPTEX_AVX2_INLINE void stiffnessOf(const BilinearBatch& batch, const Six& loads, Six& stiffness) {
  for (int q = 0; q < 6; ++q) {
    __m256d sum = loads[0] * _mm256_load_pd(batch.forms[0][q]);
    for (int m = 1; m < 6; ++m) sum += loads[m] * _mm256_load_pd(batch.forms[m][q]);
    stiffness[q] = sum + sum;
  }
}

/// Row a of a symmetric matrix times the vectors x.
template <int kRow>
HAPTEX_AVX2_INLINE Vector rowTimes(const __m256d* matrix, const Vector* x) {
  constexpr int kEntry[3][3] = {{0, 3, 4}, {3, 1, 5}, {4, 5, 2}};
  const __m256d a = matrix[kEntry[kRow][0]], b = matrix[kEntry[kRow][1]],
                c = matrix[kEntry[kRow][2]];
  return {a * x[0].x + b * x[1].x + c * x[2].x, a * x[0].y + b * x[1].y + c * x[2].y,
          a * x[0].z + b * x[1].z + c * x[2].z};
}

HAPTEX_AVX2_INLINE Block outer(const Vector& row, const Vector& column) {
  return {{row.x * column.x, row.y * column.x, row.z * column.x, row.x * column.y, row.y * column.y,
           row.z * column.y, row.x * column.z, row.y * column.z, row.z * column.z}};
}

/// sum_m rows[m] columns[m]^T + turning I
HAPTEX_AVX2_INLINE Block tangentBlock(const Vector* rows, const Vector* columns, __m256d turning) {
  Block sum = outer(rows[0], columns[0]);
  for (int m = 1; m < 6; ++m) {
    const Block more = outer(rows[m], columns[m]);
    for (int k = 0; k < 9; ++k) sum.columns[k] += more.columns[k];
  }
  for (int k : {0, 4, 8}) sum.columns[k] += turning;
  return sum;
}

/// The same, where it is symmetric.
HAPTEX_AVX2_INLINE Block diagonalBlock(const Vector* rows, const Vector* columns, __m256d turning) {
  Symmetric sum = {turning, _mm256_setzero_pd(), _mm256_setzero_pd(),
                   turning, _mm256_setzero_pd(), turning};
  for (int m = 0; m < 6; ++m) {
    sum.xx += rows[m].x * columns[m].x;
    sum.xy += rows[m].x * columns[m].y;
    sum.xz += rows[m].x * columns[m].z;
    sum.yy += rows[m].y * columns[m].y;
    sum.yz += rows[m].y * columns[m].z;
    sum.zz += rows[m].z * columns[m].z;
  }
  return full(sum);
}

HAPTEX_AVX2_INLINE Block transposed(const Block& block) {
  const __m256d* c = block.columns;
  return {{c[0], c[3], c[6], c[1], c[4], c[7], c[2], c[5], c[8]}};
}

/// What makes the sum of a row of blocks 0.
HAPTEX_AVX2_INLINE Block remainder(const Block& a, const Block& b, const Block& c) {
  Block result;
  for (int k = 0; k < 9; ++k) {
    result.columns[k] = _mm256_setzero_pd() - (a.columns[k] + b.columns[k] + c.columns[k]);
  }
  return result;
}

/// @param slope of the loads, times what the tangent is multiplied by @param turning K, likewise
HAPTEX_AVX2_INLINE void addTangent(const BilinearBatch& batch, const Vector* x, const Six& slope,
                                   const Six& turning, const MembraneSystem& system) {
  Vector gradients[3][6], scaled[3][6];  // half of those of the strains by x
  for (int m = 0; m < 6; ++m) {
    Six form;
    for (int q = 0; q < 6; ++q) form[q] = _mm256_load_pd(batch.forms[m][q]);
    gradients[0][m] = rowTimes<0>(form, x);
    gradients[1][m] = rowTimes<1>(form, x);
    gradients[2][m] = rowTimes<2>(form, x);
    const __m256d factor = 4.0 * slope[m];
    for (int a = 0; a < 3; ++a) {
      const Vector& g = gradients[a][m];
      scaled[a][m] = {factor * g.x, factor * g.y, factor * g.z};
    }
  }
  const Block b11 = diagonalBlock(scaled[0], gradients[0], turning[0]);
  const Block b22 = diagonalBlock(scaled[1], gradients[1], turning[1]);
  const Block b33 = diagonalBlock(scaled[2], gradients[2], turning[2]);
  const Block b21 = tangentBlock(scaled[1], gradients[0], turning[3]);
  const Block b31 = tangentBlock(scaled[2], gradients[0], turning[4]);
  const Block b32 = tangentBlock(scaled[2], gradients[1], turning[5]);
  // Blocks with particle 0 follow from the others because a common motion changes no strain.
  const Block b10 = remainder(b11, transposed(b21), transposed(b31));
  const Block b20 = remainder(b21, b22, transposed(b32));
  const Block b30 = remainder(b31, b32, b33);
  scatter(b11, batch.particles[1], system.diagonal);
  scatter(b22, batch.particles[2], system.diagonal);
  scatter(b33, batch.particles[3], system.diagonal);
  scatter(b21, batch.slots[2], system.lower);
  scatter(b31, batch.slots[4], system.lower);
  scatter(b32, batch.slots[5], system.lower);
  scatter(b10, batch.slots[0], system.lower);
  scatter(b20, batch.slots[1], system.lower);
  scatter(b30, batch.slots[3], system.lower);
  scatter(transposed(remainder(b10, b20, b30)), batch.particles[0], system.diagonal);
}

/// Adds to the right-hand side what the forces on the last three particles do.
HAPTEX_AVX2_INLINE void scatterForces(const BilinearBatch& batch, const Vector* forces,
                                      double* rhs) {
  const __m256d zero = _mm256_setzero_pd();
  scatter(Vector{zero, zero, zero} - (forces[0] + forces[1] + forces[2]), batch.particles[0], rhs);
  for (int a = 0; a < 3; ++a) scatter(forces[a], batch.particles[a + 1], rhs);
}

/// Adds the response of both points to the loads and their slopes by the strains.
/// @param by_strain what the curves' argument changes by with the strain
HAPTEX_AVX2_INLINE void addResponse(const std::array<material::StrainStressCurve, 3>& curves,
                                    const Six& at, __m256d by_strain, Six& load, Six& slope) {
  for (int point : {0, 3}) {
    const Response response = kernels::respond<3>(curves, at + point);
    for (int m = 0; m < 3; ++m) {
      load[point + m] += response.stress[m];
      slope[point + m] += response.slope[m] * by_strain;
    }
  }
}

HAPTEX_AVX2_INLINE void setZero(Six& six) {
  for (__m256d& number : six) number = _mm256_setzero_pd();
}

HAPTEX_AVX2_INLINE void addBatch(const BilinearBatch& batch, const MembraneStep& step) {
  const __m256d zero = _mm256_setzero_pd(), a = _mm256_set1_pd(step.a);
  Vector x[3], v[3];
  edgesIn(batch, step.positions, x);
  edgesIn(batch, step.velocities, v);
  Six strain, rate, load, slope, end;
  strainOf(batch, x, strain);
  rateOf(batch, x, v, rate);
  setZero(load);
  setZero(slope);
  addResponse(*step.law.elastic, strain, _mm256_set1_pd(1.0), load, slope);
  for (int m = 0; m < 6; ++m) end[m] = step.ahead * _mm256_max_pd(zero, slope[m]) * rate[m];
  if (step.law.viscous) addResponse(*step.law.viscous, rate, 1.0 / a, load, slope);
  const __m256d impulse = 0.5 * _mm256_load_pd(batch.area) * a;  // of a stress of 1 N/m
  for (int m = 0; m < 6; ++m) {
    load[m] *= impulse;
    end[m] = load[m] + impulse * end[m];
    slope[m] = impulse * a * _mm256_max_pd(zero, slope[m]);
  }
  Six pulling, turning;
  stiffnessOf(batch, end, pulling);
  stiffnessOf(batch, load, turning);
  projectStiffness(turning);
  for (__m256d& entry : pulling) entry = zero - entry;
  Six by_velocity;
  const __m256d ahead = _mm256_set1_pd(-step.ahead);
  for (int q = 0; q < 6; ++q) by_velocity[q] = ahead * turning[q];
  const Vector forces[3] = {rowTimes<0>(pulling, x) + rowTimes<0>(by_velocity, v),
                            rowTimes<1>(pulling, x) + rowTimes<1>(by_velocity, v),
                            rowTimes<2>(pulling, x) + rowTimes<2>(by_velocity, v)};
  scatterForces(batch, forces, step.system.rhs);
  for (__m256d& entry : turning) entry *= a;
  addTangent(batch, x, slope, turning, step.system);
}

HAPTEX_AVX2_INLINE void addNewtonBatch(const BilinearBatch& batch, const double* begin_strains,
                                       const MembraneNewton& newton) {
  const __m256d zero = _mm256_setzero_pd(), a = _mm256_set1_pd(newton.h);
  Vector x[3];
  edgesIn(batch, newton.positions, x);
  Six strain, load, slope;
  strainOf(batch, x, strain);
  setZero(load);
  setZero(slope);
  addResponse(*newton.law.elastic, strain, _mm256_set1_pd(1.0), load, slope);
  if (newton.law.viscous) {
    Six rate;
    rateSince(begin_strains, strain, a, rate);
    addResponse(*newton.law.viscous, rate, 1.0 / a, load, slope);
  }
  const __m256d impulse = 0.5 * _mm256_load_pd(batch.area) * a;
  for (int m = 0; m < 6; ++m) {
    load[m] *= impulse;
    slope[m] = impulse * a * (newton.exact ? slope[m] : _mm256_max_pd(zero, slope[m]));
  }
  Six turning, pulling;
  stiffnessOf(batch, load, turning);
  for (int q = 0; q < 6; ++q) pulling[q] = zero - turning[q];
  const Vector forces[3] = {rowTimes<0>(pulling, x), rowTimes<1>(pulling, x),
                            rowTimes<2>(pulling, x)};
  scatterForces(batch, forces, newton.system.rhs);
  if (!newton.exact) projectStiffness(turning);
  for (__m256d& entry : turning) entry *= a;
  addTangent(batch, x, slope, turning, newton.system);
}

HAPTEX_AVX2 void addStepAvx2(const BilinearBatch* batches, int count, const MembraneStep& step) {
  for (int b = 0; b < count; ++b) addBatch(batches[b], step);
}

HAPTEX_AVX2 void addNewtonAvx2(const BilinearBatch* batches, int count,
                               const MembraneNewton& newton) {
  for (int b = 0; b < count; ++b) {
    addNewtonBatch(batches[b], newton.begin_strains + std::ptrdiff_t{6} * kBatch * b, newton);
  }
}

HAPTEX_AVX2 double potentialAvx2(const BilinearBatch* batches, int count, const double* positions,
                                 const double* begin_strains, double interval,
                                 const MembraneLaw& law) {
  const __m256d h = _mm256_set1_pd(interval), one = _mm256_set1_pd(1.0);
  __m256d sum = _mm256_setzero_pd();
  for (int b = 0; b < count; ++b) {
    Vector x[3];
    edgesIn(batches[b], positions, x);
    Six strain, rate;
    strainOf(batches[b], x, strain);
    __m256d density = _mm256_setzero_pd();
    for (int point : {0, 3}) addEnergies(*law.elastic, strain + point, one, density);
    if (law.viscous) {
      rateSince(begin_strains + std::ptrdiff_t{6} * kBatch * b, strain, h, rate);
      for (int point : {0, 3}) addEnergies(*law.viscous, rate + point, h, density);
    }
    sum += 0.5 * _mm256_load_pd(batches[b].area) * density;
  }
  return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

}  // namespace

void addStep(const BilinearBatch* batches, int count, const MembraneStep& step) {
  addStepAvx2(batches, count, step);
}

void addNewton(const BilinearBatch* batches, int count, const MembraneNewton& newton) {
  addNewtonAvx2(batches, count, newton);
}

double potential(const BilinearBatch* batches, int count, const double* positions,
                 const double* begin_strains, double h, const MembraneLaw& law) {
  return potentialAvx2(batches, count, positions, begin_strains, h, law);
}

}  // namespace haptex::cloth::kernels

#else

namespace haptex::cloth::kernels {

void addStep(const BilinearBatch*, int, const MembraneStep&) {}

void addNewton(const BilinearBatch*, int, const MembraneNewton&) {}

double potential(const BilinearBatch*, int, const double*, const double*, double,
                 const MembraneLaw&) {
  return 0.0;
}

}  // namespace haptex::cloth::kernels

#endif
