#include "haptex/contact/contactors.h"

#include <algorithm>
#include <cmath>

namespace haptex::contact {

using tactile::kContactorColumns;
using tactile::kContactorRows;
using tactile::kContactorSpacing;

tactile::PerContactor<double> contactorForces(const FingertipContact& contact,
                                              const Fingertip& fingertip,
                                              const Eigen::Isometry3d& array) {
  tactile::PerContactor<double> forces{};
  const Eigen::Isometry3d to_world =
      Eigen::Translation3d(fingertip.position) * fingertip.orientation * array;
  const Eigen::Isometry3d from_world = to_world.inverse();
  for (const ContactPoint& point : contact.points) {
    const Eigen::Vector3d local = from_world * point.position;
    // In spacings from the contactor of row 0 and column 0.
    const double x = local.x() / kContactorSpacing + 0.5 * (kContactorColumns - 1);
    const double y = local.y() / kContactorSpacing + 0.5 * (kContactorRows - 1);
    if (!(x > -1.0 && x < kContactorColumns && y > -1.0 && y < kContactorRows)) continue;
    const int column = static_cast<int>(std::floor(x)), row = static_cast<int>(std::floor(y));
    for (int r = std::max(row, 0); r <= std::min(row + 1, kContactorRows - 1); ++r) {
      for (int c = std::max(column, 0); c <= std::min(column + 1, kContactorColumns - 1); ++c) {
        const double weight = (1.0 - std::abs(x - c)) * (1.0 - std::abs(y - r));
        forces[kContactorColumns * r + c] += weight * point.normal_force;
      }
    }
  }
  return forces;
}

tactile::ArrayPlacement arrayOnFabric(const FingertipContact& contact, const Fingertip& fingertip,
                                      const Eigen::Isometry3d& array) {
  if (!contact.touching) return {Eigen::Vector2d::Zero(), Eigen::Matrix2d::Zero()};
  const Eigen::Vector3d middle = fingertip.position + fingertip.orientation * array.translation();
  const Eigen::Matrix3d turn = fingertip.orientation * array.linear();
  return {contact.fabric_position + contact.to_fabric * (middle - contact.centre),
          contact.to_fabric * turn.leftCols<2>()};
}

}  // namespace haptex::contact
