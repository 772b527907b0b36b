#include "haptex/garment/body/body.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "haptex/base/require.h"

namespace haptex::garment {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

std::vector<Isometry3d> motionsOf(const std::vector<Segment>& segments, const Pose& pose) {
  std::vector<Isometry3d> motions;
  for (const Segment& segment : segments) {
    Isometry3d motion = Isometry3d::Identity();
    if (const auto turn = pose.find(segment.name); turn != pose.end()) {
      motion = Eigen::Translation3d(segment.start) * turn->second.normalized() *
               Eigen::Translation3d(-segment.start);
    }
    motions.push_back(segment.parent < 0 ? motion : motions[segment.parent] * motion);
  }
  return motions;
}

}  // namespace

int segmentNamed(const Body& body, const std::string& name) {
  std::string known;
  for (std::size_t i = 0; i < body.segments.size(); ++i) {
    if (body.segments[i].name == name) return static_cast<int>(i);
    known += (i == 0 ? "" : ", ") + body.segments[i].name;
  }
  base::refuse("segment '", name, "' is unknown: the body has ", known);
}

Body posed(const Body& body, const Pose& pose) {
  for (const auto& turn : pose) segmentNamed(body, turn.first);
  const std::vector<Isometry3d> motions = motionsOf(body.segments, pose);
  Body result = body;
  for (std::size_t i = 0; i < body.vertices.size(); ++i) {
    Vector3d place = Vector3d::Zero();
    for (const SegmentShare& share : body.shares[i]) {
      place += share.weight * (motions[share.segment] * body.vertices[i]);
    }
    result.vertices[i] = place;
  }
  for (std::size_t i = 0; i < motions.size(); ++i) {
    result.segments[i].start = motions[i] * body.segments[i].start;
    result.segments[i].end = motions[i] * body.segments[i].end;
  }
  setDown(result);
  return result;
}

void setDown(Body& body) {
  double lowest = std::numeric_limits<double>::infinity();
  for (const Vector3d& vertex : body.vertices) lowest = std::min(lowest, vertex.z());
  for (Vector3d& vertex : body.vertices) vertex.z() -= lowest;
  for (Segment& segment : body.segments) {
    segment.start.z() -= lowest;
    segment.end.z() -= lowest;
  }
}

double volumeOf(const Body& body) {
  double volume = 0.0;
  for (const auto& [a, b, c] : body.triangles) {
    volume += body.vertices[a].dot(body.vertices[b].cross(body.vertices[c])) / 6.0;
  }
  return volume;
}

bool isClosed(const std::vector<std::array<int, 3>>& triangles) {
  std::vector<std::pair<int, int>> edges, opposite;
  for (const auto& triangle : triangles) {
    for (int i = 0; i < 3; ++i) {
      edges.emplace_back(triangle[i], triangle[(i + 1) % 3]);
      opposite.emplace_back(triangle[(i + 1) % 3], triangle[i]);
    }
  }
  std::sort(edges.begin(), edges.end());
  std::sort(opposite.begin(), opposite.end());
  const bool once = std::adjacent_find(edges.begin(), edges.end()) == edges.end();
  return once && edges == opposite;
}

}  // namespace haptex::garment
