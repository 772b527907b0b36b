#include "haptex/nodes/markers/marker_shapes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "haptex/nodes/common/cloth_messages.h"
#include "haptex/nodes/common/vector_messages.h"
#include "haptex/nodes/wire/frame_names.h"

namespace haptex::nodes {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr int kMeridians = 24;
constexpr int kParallels = 16;  // of both caps together, about

// From the viewer's side, above and left, so that a hanging cloth is neither the brightest nor the
// darkest orientation and waves show both ways.
const Eigen::Vector3d kTowardsSun = Eigen::Vector3d(0.62, -0.52, 0.58).normalized();

/// A circle around the axis of a surface of revolution.
struct Ring {
  Eigen::Vector3d centre;
  double radius;  // 0 at the poles
};

/// Appends rings of a sphere between two angles from the axis.
void appendRings(const proximity::Sphere& sphere, const Eigen::Vector3d& axis, double begin,
                 double end, std::vector<Ring>& rings) {
  const int steps = std::max(1, static_cast<int>(std::lround(kParallels * (end - begin) / kPi)));
  for (int i = 0; i <= steps; ++i) {
    const double angle = begin + (end - begin) * i / steps;
    rings.push_back(
        {sphere.centre + sphere.radius * std::cos(angle) * axis, sphere.radius * std::sin(angle)});
  }
}

/// From the pole of the end to that of the begin. A tangent plane touches both spheres where its
/// normal is at this angle to the axis: cos(angle) = (radius of begin - radius of end) / length.
std::vector<Ring> ringsOf(const proximity::TaperedCapsule& capsule, const Eigen::Vector3d& axis,
                          double length) {
  const auto& [begin, end] = capsule;
  std::vector<Ring> rings;
  if (length <= std::abs(begin.radius - end.radius)) {  // one sphere holds the other
    appendRings(begin.radius > end.radius ? begin : end, axis, 0.0, kPi, rings);
    return rings;
  }
  const double tangent = std::acos((begin.radius - end.radius) / length);
  appendRings(end, axis, 0.0, tangent, rings);
  appendRings(begin, axis, tangent, kPi, rings);
  return rings;
}

}  // namespace

visualization_msgs::Marker makeMarker(const std::string& name, int id, int type) {
  visualization_msgs::Marker marker;
  marker.header.frame_id = fixedFrame();
  marker.ns = name;
  marker.id = id;
  marker.type = type;
  marker.action = visualization_msgs::Marker::ADD;
  marker.pose.orientation.w = 1.0;
  marker.scale.x = marker.scale.y = marker.scale.z = 1.0;
  marker.color.a = 1.0F;
  return marker;
}

std_msgs::ColorRGBA colourMessage(const Eigen::Vector3f& colour, float opacity) {
  std_msgs::ColorRGBA message;
  message.r = colour[0];
  message.g = colour[1];
  message.b = colour[2];
  message.a = opacity;
  return message;
}

Eigen::Vector3d towardsSun() { return kTowardsSun; }

float shade(const Eigen::Vector3d& normal) {
  return static_cast<float>(kAmbient + (1.0 - kAmbient) * std::abs(normal.dot(kTowardsSun)));
}

void shadeTriangles(visualization_msgs::Marker& marker, const Eigen::Vector3f& colour,
                    float opacity) {
  const geometry_msgs::Quaternion& pose = marker.pose.orientation;
  const Eigen::Quaterniond rotation(pose.w, pose.x, pose.y, pose.z);
  marker.colors.resize(marker.points.size());
  for (std::size_t i = 0; i + 2 < marker.points.size(); i += 3) {
    const Eigen::Vector3d first = fromMessage(marker.points[i]);
    const Eigen::Vector3d normal = (fromMessage(marker.points[i + 1]) - first)
                                       .cross(fromMessage(marker.points[i + 2]) - first);
    // Normalising leaves the zero of a triangle without area.
    const Eigen::Vector3f shaded = shade(rotation * normal.normalized()) * colour;
    std::fill_n(marker.colors.begin() + static_cast<std::ptrdiff_t>(i), 3,
                colourMessage(shaded, opacity));
  }
}

void deleteIfEmpty(visualization_msgs::Marker& marker) {
  using visualization_msgs::Marker;
  marker.action = marker.points.empty() ? Marker::DELETE : Marker::ADD;
}

void appendSurface(const proximity::TaperedCapsule& capsule,
                   std::vector<geometry_msgs::Point>& corners) {
  const Eigen::Vector3d along = capsule.end.centre - capsule.begin.centre;
  const double length = along.norm();
  const Eigen::Vector3d axis =
      length > 0.0 ? Eigen::Vector3d(along / length) : Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d right = axis.unitOrthogonal();
  const Eigen::Vector3d ahead = axis.cross(right);
  const std::vector<Ring> rings = ringsOf(capsule, axis, length);
  const auto at = [&](std::size_t ring, int meridian) {
    const double angle = 2.0 * kPi * meridian / kMeridians;
    return pointMessage(rings[ring].centre +
                        rings[ring].radius * (std::cos(angle) * right + std::sin(angle) * ahead));
  };
  for (std::size_t ring = 0; ring + 1 < rings.size(); ++ring) {
    for (int meridian = 0; meridian < kMeridians; ++meridian) {
      const auto near_first = at(ring, meridian), near_second = at(ring, meridian + 1);
      const auto far_first = at(ring + 1, meridian), far_second = at(ring + 1, meridian + 1);
      corners.insert(corners.end(), {near_first, far_first, far_second});
      corners.insert(corners.end(), {near_first, far_second, near_second});
    }
  }
}

void appendBox(const Eigen::Vector3d& sides, std::vector<geometry_msgs::Point>& corners) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {0.5, -0.5}) {
      const Eigen::Vector3d middle = side * sides[axis] * Eigen::Vector3d::Unit(axis);
      const int first = (axis + 1) % 3, second = (axis + 2) % 3;
      const Eigen::Vector3d right = 0.5 * sides[first] * Eigen::Vector3d::Unit(first);
      const Eigen::Vector3d up =
          (side > 0.0 ? 0.5 : -0.5) * sides[second] * Eigen::Vector3d::Unit(second);
      for (const Eigen::Vector3d& corner :
           {Eigen::Vector3d(-right - up), Eigen::Vector3d(right - up), Eigen::Vector3d(right + up),
            Eigen::Vector3d(-right - up), Eigen::Vector3d(right + up),
            Eigen::Vector3d(-right + up)}) {
        corners.push_back(pointMessage(middle + corner));
      }
    }
  }
}

}  // namespace haptex::nodes
