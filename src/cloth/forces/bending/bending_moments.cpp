#include "haptex/cloth/forces/bending/bending_moments.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <map>

namespace haptex::cloth {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

/// Pivots below this part of the largest are not used: particles near a conic section say too
/// little of what lies across it.
constexpr double kMinPivot = 1e-3;
/// How much sooner the corners of the edge's own triangles are used than those around them.
constexpr double kNearness = 3.0;

struct Weighted {
  int particle;
  double weight;
};

struct Side {
  int triangle;
  int opposite;  // its corner
};

/// An edge from the particle `a` to `b`, a < b. Its normal turns to the right of its direction.
struct SharedEdge {
  std::vector<Side> sides;
  std::vector<Weighted> slope;  // dw/dn in its middle; empty at a free edge
};
using Edges = std::map<std::array<int, 2>, SharedEdge>;

std::array<int, 2> edgeOf(const std::array<int, 3>& triangle, int opposite) {
  const int a = triangle[(opposite + 1) % 3], b = triangle[(opposite + 2) % 3];
  return {std::min(a, b), std::max(a, b)};
}

Vector2d normalOf(const Vector2d& direction) { return {direction.y(), -direction.x()}; }

Edges edgesOf(const mesh::ClothMesh& mesh) {
  Edges edges;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (int i = 0; i < 3; ++i) {
      edges[edgeOf(mesh.triangles[t], i)].sides.push_back(
          {static_cast<int>(t), mesh.triangles[t][i]});
    }
  }
  return edges;
}

/// The corners of the edge's triangles, first, and of those around these.
std::vector<int> particlesAround(const mesh::ClothMesh& mesh, const Edges& edges,
                                 const std::array<int, 2>& ends, const SharedEdge& edge) {
  std::vector<int> particles(ends.begin(), ends.end());
  for (const Side& side : edge.sides) particles.push_back(side.opposite);
  for (const Side& side : edge.sides) {
    for (int i = 0; i < 3; ++i) {
      for (const Side& beyond : edges.at(edgeOf(mesh.triangles[side.triangle], i)).sides) {
        if (std::find(particles.begin(), particles.end(), beyond.opposite) == particles.end()) {
          particles.push_back(beyond.opposite);
        }
      }
    }
  }
  return particles;
}

/// Weights of the particles that give dw/dn for every affine w, of these the ones nearest to it for
/// quadratic w, and of these the smallest.
std::vector<Weighted> slopeAcross(const mesh::ClothMesh& mesh, const std::array<int, 2>& ends,
                                  const std::vector<int>& particles) {
  const Vector2d& a = mesh.rest_coordinates[ends[0]];
  const Vector2d along = mesh.rest_coordinates[ends[1]] - a;
  const double length = along.norm();
  const Eigen::Index count = static_cast<Eigen::Index>(particles.size());
  MatrixXd affine(3, count), quadratic(3, count);
  VectorXd use(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Vector2d from = (mesh.rest_coordinates[particles[i]] - a - 0.5 * along) / length;
    const double t = from.dot(along) / length, n = from.dot(normalOf(along)) / length;
    use[i] = i < 4 ? kNearness : 1.0;
    affine.col(i) = use[i] * Vector3d(1.0, t, n);
    quadratic.col(i) = use[i] * Vector3d(t * t, t * n, n * n);
  }
  // affine^T = Q R: the first columns of Q give the smallest weights, the others are free.
  const Eigen::HouseholderQR<MatrixXd> qr(affine.transpose());
  const MatrixXd q = qr.householderQ();
  const Vector3d wanted(0.0, 0.0, 1.0 / length);
  const Matrix3d r = qr.matrixQR().topRows<3>();
  const Vector3d fixed = r.triangularView<Eigen::Upper>().transpose().solve(wanted);
  VectorXd weights = q.leftCols(3) * fixed;
  const MatrixXd freedom = q.rightCols(count - 3);
  Eigen::CompleteOrthogonalDecomposition<MatrixXd> correction;
  correction.setThreshold(kMinPivot);
  correction.compute(quadratic * freedom);
  weights += freedom * correction.solve(-quadratic * weights);
  std::vector<Weighted> slope;
  for (Eigen::Index i = 0; i < count; ++i) slope.push_back({particles[i], use[i] * weights[i]});
  return slope;
}

/// What length n (gradient)^T of an edge is in (wuu, wvv, wuv), for a gradient along `direction`.
Vector3d dyad(const Vector2d& normal, const Vector2d& direction) {
  return {normal.x() * direction.x(), normal.y() * direction.y(),
          0.5 * (normal.x() * direction.y() + normal.y() * direction.x())};
}

CurvatureStencil curvatureOf(const mesh::ClothMesh& mesh, const Edges& edges,
                             const std::array<int, 3>& triangle) {
  const std::vector<Vector2d>& rest = mesh.rest_coordinates;
  const Vector2d side = rest[triangle[1]] - rest[triangle[0]];
  const Vector2d other = rest[triangle[2]] - rest[triangle[0]];
  CurvatureStencil stencil;
  stencil.area = 0.5 * std::abs(side.x() * other.y() - side.y() * other.x());
  std::map<int, Vector3d> weights;  // by particle
  const auto add = [&](int particle, const Vector3d& weight) {
    weights.emplace(particle, Vector3d::Zero()).first->second += weight / stencil.area;
  };
  for (int i = 0; i < 3; ++i) {
    const std::array<int, 2> ends = edgeOf(triangle, i);
    const SharedEdge& edge = edges.at(ends);
    const Vector2d along = rest[ends[1]] - rest[ends[0]];
    const double length = along.norm();
    const Vector2d tangent = along / length, normal = normalOf(tangent);
    const double outwards = normal.dot(rest[triangle[i]] - rest[ends[0]]) < 0.0 ? 1.0 : -1.0;
    const Vector3d twist = outwards * dyad(normal, tangent);
    add(ends[0], -twist);
    add(ends[1], twist);
    if (edge.slope.empty()) stencil.free_normals.push_back(normal);
    for (const Weighted& part : edge.slope) {
      add(part.particle, outwards * length * part.weight * dyad(normal, normal));
    }
  }
  stencil.weights.resize(3, static_cast<Eigen::Index>(weights.size()));
  for (const auto& [particle, weight] : weights) {
    stencil.weights.col(static_cast<Eigen::Index>(stencil.particles.size())) = weight;
    stencil.particles.push_back(particle);
  }
  return stencil;
}

}  // namespace

std::vector<CurvatureStencil> findCurvatureStencils(const mesh::ClothMesh& mesh) {
  Edges edges = edgesOf(mesh);
  for (auto& [ends, edge] : edges) {
    if (edge.sides.size() != 2) continue;
    edge.slope = slopeAcross(mesh, ends, particlesAround(mesh, edges, ends, edge));
  }
  std::vector<CurvatureStencil> stencils;
  stencils.reserve(mesh.triangles.size());
  for (const std::array<int, 3>& triangle : mesh.triangles) {
    stencils.push_back(curvatureOf(mesh, edges, triangle));
  }
  return stencils;
}

}  // namespace haptex::cloth
