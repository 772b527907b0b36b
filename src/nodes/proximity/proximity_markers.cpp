#include "haptex/nodes/proximity/proximity_markers.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "haptex/nodes/common/vector_messages.h"
#include "haptex/nodes/markers/colour_map.h"
#include "haptex/nodes/markers/marker_shapes.h"
#include "haptex/nodes/markers/obstacle_marker.h"

namespace haptex::nodes {
namespace {

using visualization_msgs::Marker;

enum MarkerIndex { kElements, kOutlines, kCursor };

constexpr double kLift = 4e-4;           // m, between the cloth and the elements on either side
constexpr double kOutlineWidth = 6e-4;   // m
constexpr double kEdgeWidth = 5e-4;      // m
constexpr double kPointRadius = 1.5e-3;  // m, of the ball that stands for a point
constexpr double kResolution = 1e-5;     // m, of the polytopes
constexpr float kFaceOpacity = 0.15F;
constexpr float kCursorOpacity = 0.5F;

const Eigen::Vector3f kRed(0.9F, 0.05F, 0.05F);
const Eigen::Vector3f kDarkRed(0.45F, 0.0F, 0.0F);
const Eigen::Vector3f kCursorColour(0.35F, 0.6F, 1.0F);

void appendPolygon(const std::vector<Eigen::Vector3d>& polygon, Marker& faces, Marker& edges) {
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    edges.points.push_back(pointMessage(polygon[i]));
    edges.points.push_back(pointMessage(polygon[(i + 1) % polygon.size()]));
    if (i < 2) continue;
    for (const std::size_t corner : {std::size_t{0}, i - 1, i}) {
      faces.points.push_back(pointMessage(polygon[corner]));
    }
  }
}

}  // namespace

ProximityMarkers::ProximityMarkers(const std::vector<mesh::Obstacle>& obstacles) {
  auto& markers = markers_.markers;
  markers.push_back(makeMarker("near_elements", 0, Marker::TRIANGLE_LIST));
  markers.push_back(makeMarker("near_elements", 1, Marker::LINE_LIST));
  markers.push_back(makeMarker("cursor", 0, Marker::TRIANGLE_LIST));
  markers[kOutlines].scale.x = kOutlineWidth;
  markers[kOutlines].color = colourMessage(kDarkRed);
  addGroup("volumes");
  for (std::size_t i = 0; i < obstacles.size(); ++i) {
    if (!obstacles[i].moves()) {
      markers.push_back(obstacleMarker(obstacles[i], static_cast<int>(i)));
    }
  }
}

const visualization_msgs::MarkerArray& ProximityMarkers::update(
    const ProximityScene& scene, const std::vector<proximity::TaperedCapsule>& cursor) {
  updateElements(scene.triangles);
  updateCursor(cursor);
  for (const auto& [name, first] : groups_) {
    for (const std::size_t index : {first, first + 1}) {
      markers_.markers[index].points.clear();
      markers_.markers[index].colors.clear();
    }
  }
  for (const VolumeGroup& group : scene.volumes) updateVolumes(group);
  for (const MarkerIndex index : {kElements, kOutlines, kCursor}) {
    deleteIfEmpty(markers_.markers[index]);
  }
  for (const auto& [name, first] : groups_) {
    for (const std::size_t index : {first, first + 1}) deleteIfEmpty(markers_.markers[index]);
  }
  for (Marker& marker : markers_.markers) marker.header.stamp = scene.stamp;
  return markers_;
}

void ProximityMarkers::updateElements(const std::vector<proximity::Triangle>& triangles) {
  Marker& elements = markers_.markers[kElements];
  Marker& outlines = markers_.markers[kOutlines];
  elements.points.clear();
  outlines.points.clear();
  for (const proximity::Triangle& triangle : triangles) {
    const Eigen::Vector3d lift = kLift * proximity::unitNormal(triangle);
    for (const double side : {1.0, -1.0}) {
      for (int i = 0; i < 3; ++i) {
        const Eigen::Vector3d begin = triangle[i] + side * lift;
        elements.points.push_back(pointMessage(begin));
        outlines.points.push_back(pointMessage(begin));
        outlines.points.push_back(pointMessage(triangle[(i + 1) % 3] + side * lift));
      }
    }
  }
  // Not shaded: the red is the same however they lie.
  elements.colors.assign(elements.points.size(), colourMessage(kRed));
}

void ProximityMarkers::updateCursor(const std::vector<proximity::TaperedCapsule>& cursor) {
  Marker& marker = markers_.markers[kCursor];
  marker.points.clear();
  for (proximity::TaperedCapsule part : cursor) {
    if (part.begin.radius == 0.0 && part.end.radius == 0.0) {
      part.begin.radius = part.end.radius = kPointRadius;
    }
    appendSurface(part, marker.points);
  }
  shadeTriangles(marker, kCursorColour, kCursorOpacity);
}

void ProximityMarkers::addGroup(const std::string& name) {
  auto& markers = markers_.markers;
  groups_[name] = markers.size();
  markers.push_back(makeMarker(name, 0, Marker::TRIANGLE_LIST));
  markers.push_back(makeMarker(name, 1, Marker::LINE_LIST));
  markers.back().scale.x = kEdgeWidth;
}

void ProximityMarkers::updateVolumes(const VolumeGroup& group) {
  if (groups_.count(group.name) == 0) addGroup(group.name);
  Marker& faces = markers_.markers[groups_[group.name]];
  Marker& edges = markers_.markers[groups_[group.name] + 1];
  for (std::size_t i = 0; i < group.volumes.size(); ++i) {
    for (const auto& polygon : proximity::polytopeFaces(group.volumes[i], kResolution)) {
      appendPolygon(polygon, faces, edges);
    }
    const Eigen::Vector3f colour = distinctColour(group.colours[i]);
    faces.colors.resize(faces.points.size(), colourMessage(colour, kFaceOpacity));
    edges.colors.resize(edges.points.size(), colourMessage(0.6F * colour));
  }
}

}  // namespace haptex::nodes
