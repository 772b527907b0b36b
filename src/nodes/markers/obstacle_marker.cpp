#include "haptex/nodes/markers/obstacle_marker.h"

#include <Eigen/Geometry>
#include <variant>
#include <vector>

#include "haptex/nodes/common/transforms.h"
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

/// Darkens every other octant around the origin.
void addStripes(Marker& marker) {
  constexpr float kDark = 0.45F;
  for (std::size_t i = 0; i + 2 < marker.points.size(); i += 3) {
    double product = 1.0;
    for (const auto coordinate :
         {&geometry_msgs::Point::x, &geometry_msgs::Point::y, &geometry_msgs::Point::z}) {
      product *= marker.points[i].*coordinate + marker.points[i + 1].*coordinate +
                 marker.points[i + 2].*coordinate;
    }
    if (product >= 0.0) continue;
    for (std::size_t corner = i; corner < i + 3; ++corner) {
      marker.colors[corner].r *= kDark;
      marker.colors[corner].g *= kDark;
      marker.colors[corner].b *= kDark;
    }
  }
}

}  // namespace

Marker obstacleMarker(const mesh::Obstacle& obstacle, int id) {
  Marker marker = makeMarker("obstacles", id, Marker::TRIANGLE_LIST);
  marker.pose = poseMessage(obstacle.pose);
  std::visit(AppendShape{marker.points}, obstacle.shape);
  shadeTriangles(marker, kObstacleColour, 1.0F);
  if (obstacle.body) addStripes(marker);
  return marker;
}

}  // namespace haptex::nodes
