#include "haptex/contact/bodies/obstacle_path.h"

#include <algorithm>

namespace haptex::contact {

using Eigen::Vector3d;
using proximity::RigidObstacle;

double firstTouch(const RigidObstacle& shape, const Path& path, double clearance) {
  const double length = (path.end - path.begin).norm();
  const double least = std::max(0.25 * clearance, 1e-5 * length);
  double way = 0.0;
  while (true) {
    const double share = length > 0.0 ? std::min(1.0, way / length) : 1.0;
    const double distance = shape.distance(path.begin + share * (path.end - path.begin)).distance;
    if (distance < clearance) return length > 0.0 ? share : 0.0;
    if (share >= 1.0) return 2.0;
    way += std::max(distance - clearance, least);
  }
}

Vector3d slidingEnd(const RigidObstacle& shape, const Path& path, double touch) {
  if (touch > 1.0) return path.end;
  const Vector3d hit = path.begin + touch * (path.end - path.begin);
  const Vector3d normal = shape.distance(hit).normal;
  return path.end + std::max(0.0, normal.dot(hit - path.end)) * normal;
}

}  // namespace haptex::contact
