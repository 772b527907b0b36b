#include "haptex/proximity/kdop_hierarchy.h"
#include "haptex/proximity/rigid_obstacle.h"

namespace haptex::proximity {
namespace {

class ObstacleBody : public Body {
 public:
  explicit ObstacleBody(const RigidObstacle& obstacle) : obstacle_(obstacle) {}

  int parts() const override { return 1; }
  double least(int /*part*/, const Eigen::Vector3d& normal) const override {
    return -obstacle_.support(-normal);
  }
  NearElement near(int index, const Triangle& triangle) const override {
    const TrianglePoint closest = obstacle_.closestPoint(triangle);
    return {index,
            0,
            closest.distance,
            closest.on(triangle),
            closest.barycentric,
            unitNormal(triangle)};
  }

 private:
  const RigidObstacle& obstacle_;
};

}  // namespace

void query(const KdopHierarchy& hierarchy, const RigidObstacle& obstacle, const Range& range,
           std::vector<NearElement>& found) {
  hierarchy.query(ObstacleBody(obstacle), range, found);
}

}  // namespace haptex::proximity
