#include "haptex/cloth/forces/bending/bending_stencils.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>

namespace haptex::cloth {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kCollinear = 1e-9;  // weight below which a particle has no part

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

/// What weights sum_i w_i w(x_i) make of the second derivatives, exactly for a quadratic w.
Vector3d resisted(const mesh::ClothMesh& mesh, const BendingStencil& stencil) {
  Vector3d sum = Vector3d::Zero();
  const Vector2d origin = mesh.rest_coordinates[stencil.particles[0]];
  for (int i = 1; i < 4; ++i) {
    const Vector2d x = mesh.rest_coordinates[stencil.particles[i]] - origin;
    sum += stencil.weights[i] * Vector3d(0.5 * x.x() * x.x(), 0.5 * x.y() * x.y(), x.x() * x.y());
  }
  return sum;
}

/// Makes `stencil` one of the neighbourhoods of some of its particles.
void add(const mesh::ClothMesh& mesh, BendingStencil stencil, const std::vector<int>& around,
         BendingStencils& result) {
  stencil.resists = resisted(mesh, stencil);
  const int index = static_cast<int>(result.stencils.size());
  result.stencils.push_back(stencil);
  for (int particle : around) result.neighbourhoods[particle].stencils.push_back(index);
}

struct Edge {
  std::vector<int> opposite;  // corners of its triangles
};
using Edges = std::map<std::array<int, 2>, Edge>;

Edges edgesOf(const mesh::ClothMesh& mesh) {
  Edges edges;
  for (const std::array<int, 3>& triangle : mesh.triangles) {
    for (int i = 0; i < 3; ++i) {
      const int a = triangle[(i + 1) % 3], b = triangle[(i + 2) % 3];
      edges[{std::min(a, b), std::max(a, b)}].opposite.push_back(triangle[i]);
    }
  }
  return edges;
}

/// The corners of two triangles with a common edge: c and d are resolved along the edge a b, so
/// that the weights have neither a sum nor a first moment.
void addTrianglePair(const mesh::ClothMesh& mesh, int a, int b, int c, int d,
                     BendingStencils& result) {
  const Vector2d ab = mesh.rest_coordinates[b] - mesh.rest_coordinates[a];
  const Vector2d ac = mesh.rest_coordinates[c] - mesh.rest_coordinates[a];
  const Vector2d ad = mesh.rest_coordinates[d] - mesh.rest_coordinates[a];
  const double height_c = std::abs(cross(ab, ac)), height_d = std::abs(cross(ab, ad));
  const double of_c = height_d / (height_c + height_d), of_d = 1.0 - of_c;
  const double of_b = -(of_c * ac + of_d * ad).dot(ab) / ab.squaredNorm();
  add(mesh, {{a, b, c, d}, {-1.0 - of_b, of_b, of_c, of_d}, -1}, {a, b, c, d}, result);
}

/// The line from neighbour `p` through `centre` leaves by the triangle (centre, q, r).
void addLine(const mesh::ClothMesh& mesh, int centre, int p, const std::array<int, 3>& triangle,
             BendingStencils& result) {
  const int at =
      static_cast<int>(std::find(triangle.begin(), triangle.end(), centre) - triangle.begin());
  int q = triangle[(at + 1) % 3], r = triangle[(at + 2) % 3];
  if (p == q || p == r) return;
  const Vector2d origin = mesh.rest_coordinates[centre];
  const Vector2d to_p = mesh.rest_coordinates[p] - origin;
  const Vector2d to_q = mesh.rest_coordinates[q] - origin;
  const Vector2d to_r = mesh.rest_coordinates[r] - origin;
  double of_q = -cross(to_p, to_r) / cross(to_q, to_r);
  double of_r = -cross(to_q, to_p) / cross(to_q, to_r);
  if (of_q < of_r) {
    std::swap(q, r);
    std::swap(of_q, of_r);
  }
  if (of_r < -kCollinear) return;
  if (of_r < kCollinear) {
    of_r = 0.0;
    if (q < p) return;  // the same from the other side
  }
  const double scale = 1.0 / (1.0 + of_q + of_r);
  const BendingStencil line{{centre, p, q, r}, {-1.0, scale, scale * of_q, scale * of_r}, centre};
  // Both triangles beside a collinear neighbour find it.
  for (int other : result.neighbourhoods[centre].stencils) {
    const BendingStencil& found = result.stencils[other];
    if (found.particles[0] == centre && found.particles[1] == p && found.particles[2] == q &&
        std::abs(found.weights[3]) < kCollinear && of_r == 0.0) {
      return;
    }
  }
  add(mesh, line, {centre}, result);
}

/// Shares every triangle out to the nearest corners; where it is obtuse, half of it to the obtuse
/// corner (Meyer, Desbrun, Schroeder and Barr 2003).
void shareAreas(const mesh::ClothMesh& mesh, BendingStencils& result) {
  for (const std::array<int, 3>& triangle : mesh.triangles) {
    std::array<Vector2d, 3> corner;
    for (int i = 0; i < 3; ++i) corner[i] = mesh.rest_coordinates[triangle[i]];
    const double doubled = std::abs(cross(corner[1] - corner[0], corner[2] - corner[0]));
    std::array<double, 3> cosine_part;  // of the angle at i, times both sides
    for (int i = 0; i < 3; ++i) {
      cosine_part[i] = (corner[(i + 1) % 3] - corner[i]).dot(corner[(i + 2) % 3] - corner[i]);
    }
    const int obtuse = static_cast<int>(std::min_element(cosine_part.begin(), cosine_part.end()) -
                                        cosine_part.begin());
    for (int i = 0; i < 3; ++i) {
      double share = (i == obtuse ? 0.25 : 0.125) * doubled;
      if (cosine_part[obtuse] > 0.0) {
        share = 0.0;
        for (int side : {1, 2}) {  // the opposite angle's cotangent times the side's square
          const int j = (i + side) % 3, k = (i + 3 - side) % 3;
          share += 0.125 * cosine_part[k] / doubled * (corner[j] - corner[i]).squaredNorm();
        }
      }
      result.neighbourhoods[triangle[i]].area += share;
    }
  }
}

}  // namespace

BendingStencils findBendingStencils(const mesh::ClothMesh& mesh) {
  BendingStencils result;
  result.neighbourhoods.resize(mesh.rest_coordinates.size());
  shareAreas(mesh, result);
  const Edges edges = edgesOf(mesh);
  std::vector<std::vector<int>> triangles_of(mesh.rest_coordinates.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (int particle : mesh.triangles[t]) triangles_of[particle].push_back(static_cast<int>(t));
  }
  for (const auto& entry : edges) {
    const auto [a, b] = entry.first;
    for (const auto& [centre, p] : {std::array<int, 2>{a, b}, std::array<int, 2>{b, a}}) {
      for (int t : triangles_of[centre]) addLine(mesh, centre, p, mesh.triangles[t], result);
    }
  }
  for (const auto& [ends, edge] : edges) {
    const auto [a, b] = ends;
    if (edge.opposite.size() == 2) {
      addTrianglePair(mesh, a, b, edge.opposite[0], edge.opposite[1], result);
    } else {
      const Vector2d along = (mesh.rest_coordinates[b] - mesh.rest_coordinates[a]).normalized();
      const Vector2d normal(along.y(), -along.x());
      result.neighbourhoods[a].free_normals.push_back(normal);
      result.neighbourhoods[b].free_normals.push_back(normal);
    }
  }
  return result;
}

Eigen::VectorXd nonNegativeLeastSquares(const Eigen::MatrixXd& columns,
                                        const Eigen::VectorXd& target) {
  const Eigen::Index count = columns.cols();
  const double tolerance = 1e-10 * target.norm();
  Eigen::VectorXd x = Eigen::VectorXd::Zero(count);
  std::vector<Eigen::Index> active;  // columns that may be positive
  for (Eigen::Index added = 0; added < 3 * count; ++added) {
    const Eigen::VectorXd gradient = columns.transpose() * (target - columns * x);
    Eigen::Index best = -1;
    for (Eigen::Index i = 0; i < count; ++i) {
      const bool free = std::find(active.begin(), active.end(), i) != active.end();
      const double least = best < 0 ? tolerance * columns.col(i).norm() : gradient[best];
      if (!free && gradient[i] > least) best = i;
    }
    if (best < 0) break;
    active.push_back(best);
    while (!active.empty()) {
      Eigen::MatrixXd chosen(columns.rows(), active.size());
      for (std::size_t i = 0; i < active.size(); ++i) chosen.col(i) = columns.col(active[i]);
      const Eigen::VectorXd trial = chosen.colPivHouseholderQr().solve(target);
      double step = 1.0;  // towards the trial, as far as all stay non-negative
      for (std::size_t i = 0; i < active.size(); ++i) {
        const double now = x[active[i]];
        if (trial[i] <= 0.0) step = std::min(step, now > 0.0 ? now / (now - trial[i]) : 0.0);
      }
      for (std::size_t i = 0; i < active.size(); ++i) {
        x[active[i]] += step * (trial[i] - x[active[i]]);
      }
      if (step == 1.0) break;
      const auto gone = [&](Eigen::Index i) {
        if (x[i] > 1e-14 * target.norm()) return false;
        x[i] = 0.0;
        return true;
      };
      active.erase(std::remove_if(active.begin(), active.end(), gone), active.end());
    }
  }
  return x;
}

}  // namespace haptex::cloth
