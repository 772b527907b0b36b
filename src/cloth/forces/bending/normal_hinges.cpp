#include "haptex/cloth/forces/bending/normal_hinges.h"

#include <cmath>

#include "haptex/cloth/forces/cross_matrix.h"

namespace haptex::cloth {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

NormalHinges::NormalHinges(const mesh::ClothMesh& mesh, const std::vector<Hinge>& hinges,
                           const std::vector<HingeCorner>& corners, const Vector2d& curvature) {
  for (const Hinge& hinge : hinges) {
    const double bend = hinge.resists.head<2>().dot(curvature);
    if (std::abs(bend) <= 1e-12 * hinge.resists.norm() * curvature.norm()) continue;
    const int begin = static_cast<int>(corners_.size());
    Vector2d middle = Vector2d::Zero();
    for (int i = hinge.begin; i < hinge.end; ++i) {
      middle += mesh.rest_coordinates[corners[i].particle] / (hinge.end - hinge.begin);
    }
    Eigen::Matrix2d squares = Eigen::Matrix2d::Zero();
    for (int i = hinge.begin; i < hinge.end; ++i) {
      const Vector2d from = mesh.rest_coordinates[corners[i].particle] - middle;
      squares += from * from.transpose();
    }
    const Eigen::Matrix2d inverse = squares.inverse();
    for (int i = hinge.begin; i < hinge.end; ++i) {
      const Vector2d part = inverse * (mesh.rest_coordinates[corners[i].particle] - middle);
      corners_.push_back({corners[i].particle, corners[i].weight, part.x(), part.y()});
    }
    hinges_.push_back({begin, static_cast<int>(corners_.size()), hinge.stiffness, bend,
                       hinge.resists.head<2>().norm()});
  }
}

void NormalHinges::renumber(const std::vector<int>& particles) {
  for (Corner& corner : corners_) corner.particle = particles[corner.particle];
}

Matrix3d NormalHinges::hessian(const Frame& at, const Corner& row, const Corner& column) {
  const Matrix3d weft = crossMatrix(at.weft), warp = crossMatrix(at.warp);
  // Second derivative of b . n by U x V at the same b.
  const Matrix3d outside = Matrix3d::Identity() - at.normal * at.normal.transpose();
  const Matrix3d mixed = at.across * at.normal.transpose();
  const Matrix3d second = -(mixed + mixed.transpose() + at.bend() / at.area * outside) / at.area;
  const auto turn = [&](const Corner& corner) {  // of U x V by the corner's place
    return Matrix3d(corner.warp * weft - corner.weft * warp);
  };
  const Matrix3d turn_row = turn(row), turn_column = turn(column);
  return row.weight / at.area * outside * turn_column +
         column.weight / at.area * turn_row.transpose() * outside +
         turn_row.transpose() * second * turn_column +
         (row.warp * column.weft - row.weft * column.warp) * crossMatrix(at.across);
}

}  // namespace haptex::cloth
