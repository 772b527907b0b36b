#include "haptex/nodes/force_renderer/contact_markers.h"

#include <cmath>
#include <cstdio>

#include "haptex/nodes/common/vector_messages.h"
#include "haptex/nodes/markers/colour_map.h"
#include "haptex/nodes/markers/marker_shapes.h"
#include "haptex/realtime/rate_meter.h"

namespace haptex::nodes {
namespace {

using base::Finger;
using base::kFingers;
using visualization_msgs::Marker;

enum MarkerIndex { kPoints, kIndexForce, kThumbForce, kPatch, kRates };

constexpr double kArrowScale = 0.03;   // m, of the length at nine times kArrowForce
constexpr double kArrowForce = 0.01;   // N
constexpr double kArrowShaft = 0.002;  // m, diameter
constexpr double kArrowHead = 0.005;   // m, diameter
constexpr double kSkin = 0.011;        // m, from the centre of a fingertip to outside of its cap
constexpr double kPointSize = 0.0015;  // m
constexpr double kFullForce = 0.1;     // N, on a particle, with the last colour
constexpr int kForceDecades = 3;       // that the colours span
constexpr double kPatchDistance = 0.0005;  // m, from the cloth
constexpr double kTextHeight = 0.009;      // m, of a line
constexpr double kTextSide = -0.18;        // m, y: beside a sample of 0.2 m
constexpr double kTextPlace = -0.04;       // m, z

Eigen::Vector3f forceColour(double force) { return viridis(contactForceFraction(force)); }

}  // namespace

double arrowLength(double force) { return kArrowScale * std::log10(1.0 + force / kArrowForce); }

double contactForceFraction(double force) {
  return force > 0.0 ? 1.0 + std::log10(force / kFullForce) / kForceDecades : 0.0;
}

std::string rateText(const LoopRates& rates, const base::PerFinger<double>& forces,
                     const base::PerFinger<std::string>& why) {
  std::string text = realtime::rateLine("force loop", rates.force) + "\n" +
                     realtime::rateLine("cloth", rates.cloth) + "\n" +
                     realtime::rateLine("proximity", rates.proximity) + "\n" +
                     realtime::rateLine("exoskeleton", rates.exoskeleton);
  for (const Finger finger : kFingers) {
    char line[64];
    std::snprintf(line, sizeof(line), "\n%s %.3f N", base::name(finger), forces[finger]);
    text += line;
    if (!why[finger].empty()) text += " (no force: " + why[finger] + ")";
  }
  return text;
}

ContactMarkers::ContactMarkers() {
  auto& markers = markers_.markers;
  markers.push_back(makeMarker("contact_points", 0, Marker::SPHERE_LIST));
  markers.back().scale.x = markers.back().scale.y = markers.back().scale.z = kPointSize;
  for (const Finger finger : kFingers) {
    markers.push_back(makeMarker("contact_force", static_cast<int>(finger), Marker::ARROW));
    markers.back().scale.x = kArrowShaft;
    markers.back().scale.y = kArrowHead;
    markers.back().scale.z = 0.0;  // the head's length is a share of the arrow's
    markers.back().color = colourMessage(Eigen::Vector3f(0.75F, 0.10F, 0.15F));
  }
  markers.push_back(makeMarker("patch", 0, Marker::TRIANGLE_LIST));
  markers.push_back(makeMarker("rates", 0, Marker::TEXT_VIEW_FACING));
  markers.back().pose.position.y = kTextSide;
  markers.back().pose.position.z = kTextPlace;
  markers.back().scale.z = kTextHeight;
  markers.back().color = colourMessage(Eigen::Vector3f(0.1F, 0.1F, 0.1F));
}

const visualization_msgs::MarkerArray& ContactMarkers::update(
    const simulation::ContactPicture& picture, const LoopRates& rates, const ros::Time& stamp,
    const base::PerFinger<std::string>& why) {
  updatePoints(picture);
  updatePatch(picture);
  base::PerFinger<double> forces;
  for (const Finger finger : kFingers) {
    updateForce(finger, picture);
    forces[finger] = picture.gains[finger] * picture.contacts[finger].force.norm();
  }
  markers_.markers[kRates].text = rateText(rates, forces, why);
  for (Marker& marker : markers_.markers) marker.header.stamp = stamp;
  return markers_;
}

void ContactMarkers::updatePoints(const simulation::ContactPicture& picture) {
  Marker& marker = markers_.markers[kPoints];
  marker.points.clear();
  marker.colors.clear();
  for (const contact::FingertipContact& contact : picture.contacts.values) {
    for (const contact::ContactPoint& point : contact.points) {
      if (!point.position.allFinite()) continue;
      marker.points.push_back(pointMessage(point.position));
      marker.colors.push_back(colourMessage(forceColour(point.normal_force)));
    }
  }
  deleteIfEmpty(marker);
}

void ContactMarkers::updateForce(Finger finger, const simulation::ContactPicture& picture) {
  Marker& marker = markers_.markers[finger == Finger::kIndex ? kIndexForce : kThumbForce];
  const contact::FingertipContact& contact = picture.contacts[finger];
  const Eigen::Vector3d force = picture.gains[finger] * contact.force;
  const double norm = force.norm();
  marker.points.clear();
  if (norm >= kMinShownForce) {
    const Eigen::Vector3d direction = force / norm;
    const Eigen::Vector3d tail = contact.position + kSkin * direction;
    marker.points = {pointMessage(tail), pointMessage(tail + arrowLength(norm) * direction)};
  }
  deleteIfEmpty(marker);
}

void ContactMarkers::updatePatch(const simulation::ContactPicture& picture) {
  Marker& marker = markers_.markers[kPatch];
  marker.points.clear();
  marker.colors.clear();
  for (const auto& triangle : picture.triangles) {
    const Eigen::Vector3d& first = picture.positions[triangle[0]];
    const Eigen::Vector3d normal = (picture.positions[triangle[1]] - first)
                                       .cross(picture.positions[triangle[2]] - first)
                                       .normalized();
    for (const double side : {-kPatchDistance, kPatchDistance}) {
      for (const int particle : triangle) {
        marker.points.push_back(pointMessage(picture.positions[particle] + side * normal));
        marker.colors.push_back(
            colourMessage(shade(normal) * forceColour(picture.contact_forces[particle])));
      }
    }
  }
  deleteIfEmpty(marker);
}

}  // namespace haptex::nodes
