#include "haptex/nodes/markers/workspace_markers.h"

#include "haptex/exoskeleton/control/workspace.h"
#include "haptex/nodes/common/driver_messages.h"
#include "haptex/nodes/common/vector_messages.h"
#include "haptex/nodes/markers/marker_shapes.h"
#include "haptex/nodes/wire/frame_names.h"

namespace haptex::nodes {
namespace {

using base::Finger;
using Eigen::Vector3d;
using visualization_msgs::Marker;

constexpr double kEdge = 0.001;   // m
constexpr int kReachCells = 12;   // of each face of the surface
constexpr float kOpacity = 0.3F;  // of the surface: the finger in it is to be seen

Marker cubeMarker() {
  Marker marker = makeMarker("workspace", 0, Marker::LINE_LIST);
  marker.frame_locked = true;
  marker.scale.x = kEdge;
  marker.color = colourMessage({0.35F, 0.35F, 0.40F});
  const auto corner = [](int i) -> Vector3d {
    const Vector3d sides((i & 1) - 0.5, ((i >> 1) & 1) - 0.5, ((i >> 2) & 1) - 0.5);
    return exoskeleton::kWorkspaceMiddle + exoskeleton::kWorkspaceSide * sides;
  };
  for (int i = 0; i < 8; ++i) {
    for (const int axis : {1, 2, 4}) {
      if ((i & axis) != 0) continue;
      marker.points.push_back(pointMessage(corner(i)));
      marker.points.push_back(pointMessage(corner(i | axis)));
    }
  }
  return marker;
}

Marker reachMarker(const std::string& urdf, Finger finger) {
  Marker marker =
      makeMarker(std::string("reach of the ") + base::name(finger), 0, Marker::TRIANGLE_LIST);
  marker.header.frame_id = handFrame();
  marker.frame_locked = true;
  for (const Vector3d& corner : exoskeleton::ReachRim(urdf, finger).surface(kReachCells)) {
    marker.points.push_back(pointMessage(corner));
  }
  shadeTriangles(marker,
                 finger == Finger::kIndex ? Eigen::Vector3f(0.80F, 0.36F, 0.10F)
                                          : Eigen::Vector3f(0.10F, 0.45F, 0.75F),
                 kOpacity);
  return marker;
}

}  // namespace

visualization_msgs::MarkerArray workspaceMarkers(const std::string& urdf) {
  visualization_msgs::MarkerArray markers;
  markers.markers.push_back(cubeMarker());
  for (const Finger finger : base::kFingers) markers.markers.push_back(reachMarker(urdf, finger));
  return markers;
}

}  // namespace haptex::nodes
