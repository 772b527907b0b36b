#include "haptex/nodes/markers/obstacle_marker.h"

#include <Eigen/Geometry>
#include <variant>
#include <vector>

#include "haptex/nodes/common/vector_messages.h"
#include "haptex/nodes/markers/colour_map.h"
#include "haptex/nodes/markers/marker_shapes.h"

namespace haptex::nodes {
namespace {

using visualization_msgs::Marker;

const Eigen::Vector3f kObstacleColour(0.75F, 0.76F, 0.78F);

/// The shape of an obstacle in its own frame.
struct AppendShape {
  std::vector<geometry_msgs::Point>& corners;

  void operator()(const mesh::ObstacleSphere& sphere) const {
    const proximity::Sphere centred{Eigen::Vector3d::Zero(), sphere.radius};
    appendSurface({centred, centred}, corners);
  }
  void operator()(const mesh::ObstacleBox& box) const { appendBox(box.sides, corners); }
  void operator()(const mesh::ObstacleCapsule& capsule) const {
    const Eigen::Vector3d end(0.0, 0.0, 0.5 * capsule.length);
    appendSurface({{-end, capsule.radius}, {end, capsule.radius}}, corners);
  }
  void operator()(const mesh::ObstacleMesh& mesh) const {
    for (const auto& triangle : mesh.triangles) {
      for (const int vertex : triangle) {
        corners.push_back(pointMessage(mesh.vertices[vertex]));
      }
    }
  }
};

}  // namespace

void setObstaclePose(const mesh::Obstacle& obstacle, double time, Marker& marker) {
  const Eigen::Isometry3d pose = obstacle.poseAt(time);
  marker.pose.position = pointMessage(pose.translation());
  const Eigen::Quaterniond rotation = Eigen::Quaterniond(pose.rotation()).normalized();
  marker.pose.orientation.x = rotation.x();
  marker.pose.orientation.y = rotation.y();
  marker.pose.orientation.z = rotation.z();
  marker.pose.orientation.w = rotation.w();
}

Marker obstacleMarker(const mesh::Obstacle& obstacle, int id) {
  Marker marker = makeMarker("obstacles", id, Marker::TRIANGLE_LIST);
  setObstaclePose(obstacle, 0.0, marker);
  std::visit(AppendShape{marker.points}, obstacle.shape);
  shadeTriangles(marker, kObstacleColour, 1.0F);
  return marker;
}

}  // namespace haptex::nodes
