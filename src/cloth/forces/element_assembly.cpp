#include "haptex/cloth/forces/element_assembly.h"

#include <algorithm>
#include <cmath>

namespace haptex::cloth {

using Eigen::Vector3d;

namespace {

MembraneElement restElement(const mesh::ClothMesh& mesh, std::size_t triangle) {
  std::array<int, 3> order = {0, 1, 2};
  const std::array<int, 3>& corners = mesh.triangles[triangle];
  std::sort(order.begin(), order.end(), [&](int i, int j) { return corners[i] < corners[j]; });
  const std::array<int, 3> particles = {corners[order[0]], corners[order[1]], corners[order[2]]};
  const std::array<Eigen::Vector2d, 3> rest = mesh.restCorners(triangle);
  const auto [weft, warp, area] = restTriangle({rest[order[0]], rest[order[1]], rest[order[2]]});
  return {particles, {-1, -1, -1}, weft, warp, area};
}

}  // namespace

RestTriangle restTriangle(const std::array<Eigen::Vector2d, 3>& corners) {
  const auto& [a, b, c] = corners;
  const double ua = a.x(), va = a.y(), ub = b.x(), vb = b.y(), uc = c.x(), vc = c.y();
  const double d = ua * (vb - vc) + ub * (vc - va) + uc * (va - vb);
  return {{(vb - vc) / d, (vc - va) / d, (va - vb) / d},
          {(uc - ub) / d, (ua - uc) / d, (ub - ua) / d},
          0.5 * std::abs(d)};
}

std::vector<MembraneElement> restElements(const mesh::ClothMesh& mesh, std::optional<int> fabric) {
  std::vector<MembraneElement> elements;
  elements.reserve(mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (!fabric || *fabric == mesh.fabricOf(t)) elements.push_back(restElement(mesh, t));
  }
  return elements;
}

std::vector<MembraneElement> restElements(const mesh::ClothMesh& mesh,
                                          const std::vector<int>& triangles) {
  std::vector<MembraneElement> elements;
  elements.reserve(triangles.size());
  for (const int triangle : triangles) elements.push_back(restElement(mesh, triangle));
  return elements;
}

void bindElements(const linear::SymmetricBlockMatrix& matrix,
                  std::vector<MembraneElement>& elements) {
  for (MembraneElement& element : elements) {
    const auto& [a, b, c] = element.particles;
    element.slots = {matrix.slot(b, a), matrix.slot(c, a), matrix.slot(c, b)};
  }
}

Vector3d projectStress(const Vector3d& stress) {
  const double mean = 0.5 * (stress[0] + stress[1]);
  const double difference = 0.5 * (stress[0] - stress[1]);
  const double radius = std::sqrt(difference * difference + stress[2] * stress[2]);
  if (mean >= radius) return stress;
  if (mean <= -radius) return Vector3d::Zero();
  const double half = 0.5 * (mean + radius);  // half the one positive eigenvalue; radius > 0 here
  return {half * (1.0 + difference / radius), half * (1.0 - difference / radius),
          half * stress[2] / radius};
}

void addTangent(const MembraneElement& element, const ElementFrame& frame, const Vector3d& slope,
                double coupling, const Vector3d& stress, double factor,
                linear::SymmetricBlockMatrix& matrix) {
  const Eigen::Matrix3d weft_weft = frame.weft * frame.weft.transpose();
  const Eigen::Matrix3d warp_warp = frame.warp * frame.warp.transpose();
  const Eigen::Matrix3d warp_weft = frame.warp * frame.weft.transpose();
  const auto block = [&](int i, int j) {
    const double uu = factor * element.weft_weights[i] * element.weft_weights[j];
    const double vv = factor * element.warp_weights[i] * element.warp_weights[j];
    const double uv = factor * element.weft_weights[i] * element.warp_weights[j];
    const double vu = factor * element.warp_weights[i] * element.weft_weights[j];
    Eigen::Matrix3d result = (slope[0] * uu + slope[2] * vv) * weft_weft +
                             (slope[1] * vv + slope[2] * uu) * warp_warp +
                             (slope[2] * uv + coupling * vu) * warp_weft +
                             (slope[2] * vu + coupling * uv) * warp_weft.transpose();
    result.diagonal().array() += stress[0] * uu + stress[1] * vv + stress[2] * (uv + vu);
    return result;
  };
  addElementBlocks(element, block, matrix);
}

}  // namespace haptex::cloth
