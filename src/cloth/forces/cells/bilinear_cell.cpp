#include "haptex/cloth/forces/cells/bilinear_cell.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "haptex/cloth/forces/element_assembly.h"

namespace haptex::cloth {
namespace {

using Eigen::RowVector3d;
using Eigen::RowVector4d;
using Eigen::Vector2d;
using Eigen::Vector3d;

using Corners = std::array<Vector2d, 4>;            // rest coordinates, m
using StrainForm = Eigen::Matrix<double, 3, 6>;     // strains by the squares, 1/m^2
using SquaresRow = Eigen::Matrix<double, 1, 6>;     // one strain by the squares, 1/m^2
using VariationForm = Eigen::Matrix<double, 2, 6>;  // dp and dq by the squares, 1/m^2
using KeptVariation = Eigen::Matrix<double, 3, 2>;  // h by dp and dq
using CornerOrder = std::array<int, 4>;             // of a pair's particles, in a cell

constexpr double kLeastModulus = 1e-6;  // of the largest

/// Derivatives along weft and warp as weights of the cell's corners.
struct Part {
  RowVector4d weft = RowVector4d::Zero(), warp = RowVector4d::Zero();
  double area;
};

Part partOf(const Corners& rest, const std::array<int, 3>& corners) {
  const RestTriangle triangle =
      restTriangle({rest[corners[0]], rest[corners[1]], rest[corners[2]]});
  Part part;
  for (int i = 0; i < 3; ++i) {
    part.weft[corners[i]] = triangle.weft_weights[i];
    part.warp[corners[i]] = triangle.warp_weights[i];
  }
  part.area = triangle.area;
  return part;
}

/// The strains of the derivatives along weft and warp.
StrainForm formOf(const RowVector4d& weft, const RowVector4d& warp) {
  StrainForm result;
  for (int e = 0; e < 6; ++e) {
    const auto [i, j] = kCellDistances[e];
    result.col(e) << -0.5 * weft[i] * weft[j], -0.5 * warp[i] * warp[j],
        -0.5 * (weft[i] * warp[j] + warp[i] * weft[j]);
  }
  return result;
}

/// E. @param parts the pair's two triangles, then those of the other diagonal
StrainForm meanForm(const std::array<Part, 4>& parts, double area) {
  const RowVector4d weft = (parts[0].area * parts[0].weft + parts[1].area * parts[1].weft) / area;
  const RowVector4d warp = (parts[0].area * parts[0].warp + parts[1].area * parts[1].warp) / area;
  StrainForm form = 2.0 / 3.0 * formOf(weft, warp);
  for (const Part& part : parts) form += part.area / (6.0 * area) * formOf(part.weft, part.warp);
  return form;
}

/// What the strain along a direction is of weft, warp and shear. @param direction unit length
RowVector3d along(const Vector2d& direction) {
  return {direction.x() * direction.x(), direction.y() * direction.y(),
          direction.x() * direction.y()};
}

/// How much more a side is strained than the mean says, so that it is 0 under affine deformations.
SquaresRow excessOf(int i, int j, const Corners& rest, const StrainForm& mean) {
  const auto side = std::find_if(kCellDistances.begin(), kCellDistances.end(),
                                 [&](const std::array<int, 2>& ends) {
                                   return ends[0] == std::max(i, j) && ends[1] == std::min(i, j);
                                 });
  const Vector2d vector = rest[i] - rest[j];
  SquaresRow row = -along(vector.normalized()) * mean;
  row[side - kCellDistances.begin()] += 0.5 / vector.squaredNorm();
  return row;
}

/// h by dp and dq: sqrt(1/12) roots^-1 o sqrt(Y) for both sides, roots those of the moduli, where
/// the o are the orthonormal pair nearest to the directions of roots^-1 (pu^2, pv^2, pu pv).
/// @param p, q unit length, not parallel
KeptVariation keptVariation(const Vector2d& p, const Vector2d& q, const Vector3d& roots) {
  const Vector3d under_p = along(p).transpose().cwiseQuotient(roots);  // length Yp^-1/2
  const Vector3d under_q = along(q).transpose().cwiseQuotient(roots);
  const Vector3d unit_p = under_p.normalized(), unit_q = under_q.normalized();
  const Vector3d sum = (unit_p + unit_q).normalized(), difference = (unit_p - unit_q).normalized();
  KeptVariation kept;
  kept.col(0) = (sum + difference) / (std::sqrt(24.0) * under_p.norm());
  kept.col(1) = (sum - difference) / (std::sqrt(24.0) * under_q.norm());
  return roots.cwiseInverse().asDiagonal() * kept;
}

/// h. @param place of the pair's particles
StrainForm variationForm(const Corners& rest, const CornerOrder& place, const StrainForm& mean,
                         const Vector3d& moduli) {
  const auto [a, b, c, d] = place;  // around: a, d, b, c
  VariationForm differences;
  differences << excessOf(c, b, rest, mean) - excessOf(a, d, rest, mean),
      excessOf(a, c, rest, mean) - excessOf(d, b, rest, mean);
  const Vector2d p = (rest[b] - rest[c] + rest[d] - rest[a]).normalized();
  const Vector2d q = (rest[b] - rest[d] + rest[c] - rest[a]).normalized();
  const double largest = moduli.maxCoeff();
  const Vector3d roots = moduli.cwiseMax(largest > 0.0 ? kLeastModulus * largest : 1.0).cwiseSqrt();
  return keptVariation(p, q, roots) * differences;
}

/// Whether the matrix of these pulls has pivots >= 0 with one particle held.
bool isSemidefinite(const CellStrain& pulls) {
  const double ba = pulls[0], ca = pulls[1], cb = pulls[2], da = pulls[3], db = pulls[4],
               dc = pulls[5];
  const double first = ba + cb + db;
  if (!(first > 0.0)) return false;
  const double second = ca + cb + dc - cb * cb / first;
  if (!(second > 0.0)) return false;
  const double mixed = dc + cb * db / first;
  return da + db + dc - db * db / first - mixed * mixed / second >= 0.0;
}

/// What spans all motions of four particles without that which they have in common.
Eigen::Matrix<double, 4, 3> relativeMotions() {
  Eigen::Matrix<double, 4, 3> motions;
  motions << 0.5, 0.5, 0.5, 0.5, -0.5, -0.5, -0.5, 0.5, -0.5, -0.5, -0.5, 0.5;
  return motions;
}

}  // namespace

BilinearCell restCell(const TrianglePair& pair, const Vector3d& moduli) {
  CornerOrder order = {0, 1, 2, 3};
  std::sort(order.begin(), order.end(),
            [&](int i, int j) { return pair.particles[i] < pair.particles[j]; });
  BilinearCell cell{};
  cell.slots.fill(-1);
  Corners rest;
  CornerOrder place;
  for (int i = 0; i < 4; ++i) {
    cell.particles[i] = pair.particles[order[i]];
    rest[i] = pair.rest[order[i]];
    place[order[i]] = i;
  }
  const auto [a, b, c, d] = place;
  const std::array<Part, 4> parts = {partOf(rest, {a, b, c}), partOf(rest, {b, a, d}),
                                     partOf(rest, {c, d, a}), partOf(rest, {d, c, b})};
  cell.area = parts[0].area + parts[1].area;
  const StrainForm mean = meanForm(parts, cell.area);
  const StrainForm half = variationForm(rest, place, mean, moduli);
  cell.by_squares << mean + half, mean - half;
  for (int e = 0; e < 6; ++e) {
    const auto [i, j] = kCellDistances[e];
    cell.rest_squares[e] = (rest[i] - rest[j]).squaredNorm();
  }
  return cell;
}

CellStrain projectPulls(const CellStrain& pulls) {
  if (isSemidefinite(pulls)) return pulls;
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Zero();
  for (int e = 0; e < 6; ++e) {
    const auto [i, j] = kCellDistances[e];
    matrix(i, j) = matrix(j, i) = -pulls[e];
    matrix(i, i) += pulls[e];
    matrix(j, j) += pulls[e];
  }
  const Eigen::Matrix<double, 4, 3> motions = relativeMotions();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.compute(motions.transpose() * matrix * motions);
  const Eigen::Matrix<double, 4, 3> axes = motions * solver.eigenvectors();
  matrix = axes * solver.eigenvalues().cwiseMax(0.0).asDiagonal() * axes.transpose();
  CellStrain projected;
  for (int e = 0; e < 6; ++e) projected[e] = -matrix(kCellDistances[e][0], kCellDistances[e][1]);
  return projected;
}

}  // namespace haptex::cloth
