#include "haptex/contact/fabric_directions.h"

#include <Eigen/LU>
#include <array>
#include <cmath>

namespace haptex::contact {

using Eigen::Matrix2d;

std::vector<int> fabricsOfTriangles(const mesh::ClothMesh& mesh) {
  std::vector<int> fabrics;
  bool several = !mesh.triangle_fabrics.empty();
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    fabrics.push_back(mesh.fabricOf(t));
    several = several || fabrics.back() != 0;
  }
  return several ? fabrics : std::vector<int>();
}

Eigen::Matrix<double, 3, 2> fabricDirections(const mesh::ClothMesh& mesh, int triangle,
                                             const LargeScaleMotion& motion) {
  const std::array<int, 3>& corners = mesh.triangles[triangle];
  Matrix2d rest;
  const std::array<Eigen::Vector2d, 3> places = mesh.restCorners(triangle);
  rest << places[1] - places[0], places[2] - places[0];
  Eigen::Matrix<double, 3, 2> deformed;
  deformed << motion.position(corners[1]) - motion.position(corners[0]),
      motion.position(corners[2]) - motion.position(corners[0]);
  return deformed * rest.inverse();
}

Eigen::Matrix<double, 2, 3> toFabric(const Eigen::Matrix<double, 3, 2>& directions) {
  const Matrix2d metric = directions.transpose() * directions;
  if (!(std::abs(metric.determinant()) > 1e-12)) return Eigen::Matrix<double, 2, 3>::Zero();
  return metric.inverse() * directions.transpose();
}

}  // namespace haptex::contact
