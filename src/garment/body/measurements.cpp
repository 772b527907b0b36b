#include "haptex/garment/body/measurements.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "haptex/base/require.h"

namespace haptex::garment {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

double cross(const Vector2d& o, const Vector2d& a, const Vector2d& b) {
  return (a.x() - o.x()) * (b.y() - o.y()) - (a.y() - o.y()) * (b.x() - o.x());
}

/// Of the convex hull, by Andrew's monotone chain (1979).
double hullPerimeter(std::vector<Vector2d> points) {
  if (points.size() < 3) return 0.0;
  std::sort(points.begin(), points.end(), [](const Vector2d& a, const Vector2d& b) {
    return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
  });
  double perimeter = 0.0;
  for (int side = 0; side < 2; ++side) {
    std::vector<Vector2d> chain;
    for (const Vector2d& point : points) {
      while (chain.size() > 1 && cross(chain[chain.size() - 2], chain.back(), point) <= 0.0) {
        chain.pop_back();
      }
      chain.push_back(point);
    }
    for (std::size_t i = 1; i < chain.size(); ++i) perimeter += (chain[i] - chain[i - 1]).norm();
    std::reverse(points.begin(), points.end());
  }
  return perimeter;
}

double heightOf(const Body& body) {
  const auto lower = [](const Vector3d& a, const Vector3d& b) { return a.z() < b.z(); };
  const auto ends = std::minmax_element(body.vertices.begin(), body.vertices.end(), lower);
  return ends.second->z() - ends.first->z();
}

}  // namespace

const std::vector<Measurement>& measurements() {
  using Kind = Measurement::Kind;
  // Levels: the chest at the tips of the breasts, the waist where the trunk is narrowest, the hips
  // where they are widest, as they are in the two figures.
  static const std::vector<Measurement> all = {
      {"height", Kind::kHeight, "", 0.0, {}},
      {"chest", Kind::kLevelGirth, "spine", 0.64, {"spine"}},
      {"waist", Kind::kLevelGirth, "spine", 0.345, {"spine"}},
      {"hips", Kind::kLevelGirth, "left_thigh", 0.1, {"spine", "left_thigh", "right_thigh"}},
      {"neck", Kind::kGirth, "neck", 0.35, {"neck"}},
      {"upper_arm", Kind::kGirth, "left_upper_arm", 0.5, {"left_upper_arm"}},
      {"wrist", Kind::kGirth, "left_forearm", 0.95, {"left_forearm", "left_hand"}},
      {"thigh", Kind::kGirth, "left_thigh", 0.5, {"left_thigh"}},
      {"knee", Kind::kGirth, "left_shank", 0.0, {"left_thigh", "left_shank"}},
      {"calf", Kind::kGirth, "left_shank", 0.3, {"left_shank"}},
      {"ankle", Kind::kGirth, "left_shank", 0.9, {"left_shank", "left_foot"}},
      {"upper_arm_length", Kind::kLength, "left_upper_arm", 0.0, {}},
      {"forearm_length", Kind::kLength, "left_forearm", 0.0, {}},
      {"thigh_length", Kind::kLength, "left_thigh", 0.0, {}},
      {"shank_length", Kind::kLength, "left_shank", 0.0, {}},
  };
  return all;
}

const Measurement& measurementNamed(const std::string& name) {
  std::string known;
  for (const Measurement& measurement : measurements()) {
    if (measurement.name == name) return measurement;
    known += (known.empty() ? "" : ", ") + measurement.name;
  }
  base::refuse("measurement '", name, "' is unknown: there are ", known);
}

Tape::Tape(const Measurement& measurement, const Body& body) : measurement_(measurement) {
  if (measurement.kind == Measurement::Kind::kHeight) return;
  segment_ = segmentNamed(body, measurement.segment);
  std::vector<bool> around(body.segments.size(), false);
  for (const std::string& name : measurement.around) around[segmentNamed(body, name)] = true;
  for (std::size_t i = 0; i < body.triangles.size(); ++i) {
    const auto& triangle = body.triangles[i];
    if (std::any_of(triangle.begin(), triangle.end(),
                    [&](int vertex) { return around[body.shares[vertex].front().segment]; })) {
      triangles_.push_back(static_cast<int>(i));
    }
  }
}

double Tape::measure(const Body& body) const {
  if (measurement_.kind == Measurement::Kind::kHeight) return heightOf(body);
  const Segment& segment = body.segments[segment_];
  if (measurement_.kind == Measurement::Kind::kLength) return (segment.end - segment.start).norm();
  return girth(body);
}

double Tape::girth(const Body& body) const {
  const Segment& segment = body.segments[segment_];
  const Vector3d direction = segment.end - segment.start;
  const Vector3d point = segment.start + measurement_.along * direction;
  const bool level = measurement_.kind == Measurement::Kind::kLevelGirth;
  const Vector3d normal = level ? Vector3d(Vector3d::UnitZ()) : direction.normalized();
  const Vector3d first = normal.unitOrthogonal(), second = normal.cross(first);
  std::vector<Vector2d> section;
  for (const int index : triangles_) {
    const auto& triangle = body.triangles[index];
    for (int i = 0; i < 3; ++i) {
      const Vector3d a = body.vertices[triangle[i]] - point;
      const Vector3d b = body.vertices[triangle[(i + 1) % 3]] - point;
      const double above = normal.dot(a), below = normal.dot(b);
      if ((above < 0.0) == (below < 0.0)) continue;
      const Vector3d cut = a + (b - a) * (above / (above - below));
      section.emplace_back(first.dot(cut), second.dot(cut));
    }
  }
  return hullPerimeter(std::move(section));
}

double measure(const Body& body, const std::string& measurement) {
  return Tape(measurementNamed(measurement), body).measure(body);
}

}  // namespace haptex::garment
