// Bodies: whether they are closed, and their girths and lengths against those asked for.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "haptex/garment/body/measured_body.h"
#include "haptex/garment/body/measurements.h"
#include "haptex/oracles/checks/garment_oracles.h"

namespace haptex::oracles {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using garment::Body;

constexpr int kDirections = 40000;  // from which a section is looked at

/// m, around the convex hull of points: half the turn's integral of their width (Cauchy).
double girthOf(const std::vector<Vector2d>& points) {
  double sum = 0.0;
  for (int i = 0; i < kDirections; ++i) {
    const double angle = M_PI * i / kDirections;
    const Vector2d direction(std::cos(angle), std::sin(angle));
    double low = 1e9, high = -1e9;
    for (const Vector2d& point : points) {
      low = std::min(low, direction.dot(point));
      high = std::max(high, direction.dot(point));
    }
    sum += high - low;
  }
  return sum * M_PI / kDirections;
}

/// Where the triangles of some segments meet the plane of a measurement, in two axes of the plane.
std::vector<Vector2d> sectionOf(const Body& body, const garment::Measurement& measurement) {
  const garment::Segment& segment = body.segments[garment::segmentNamed(body, measurement.segment)];
  const bool level = measurement.kind == garment::Measurement::Kind::kLevelGirth;
  const Vector3d normal = level ? Vector3d(0, 0, 1) : (segment.end - segment.start).normalized();
  const Vector3d point =
      (1.0 - measurement.along) * segment.start + measurement.along * segment.end;
  const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(normal, Vector3d::UnitZ());
  const auto belongs = [&](int vertex) {
    const std::string& name = body.segments[body.shares[vertex].front().segment].name;
    return std::count(measurement.around.begin(), measurement.around.end(), name) > 0;
  };
  std::vector<Vector2d> section;
  for (const auto& triangle : body.triangles) {
    if (std::none_of(triangle.begin(), triangle.end(), belongs)) continue;
    for (int i = 0; i < 3; ++i) {
      const Vector3d a = turn * (body.vertices[triangle[i]] - point);
      const Vector3d b = turn * (body.vertices[triangle[(i + 1) % 3]] - point);
      if ((a.z() < 0.0) == (b.z() < 0.0)) continue;
      section.push_back((a + (b - a) * (a.z() / (a.z() - b.z()))).head<2>());
    }
  }
  return section;
}

double measured(const Body& body, const std::string& name) {
  const garment::Measurement& measurement = garment::measurementNamed(name);
  const bool girth = measurement.kind == garment::Measurement::Kind::kGirth ||
                     measurement.kind == garment::Measurement::Kind::kLevelGirth;
  return girth ? girthOf(sectionOf(body, measurement)) : garment::measure(body, name);
}

/// m^3, by the flux of (x, 0, 0) or the like through the surface: the same for all axes if it is
/// closed.
double fluxVolume(const Body& body, int axis) {
  double volume = 0.0;
  for (const auto& [a, b, c] : body.triangles) {
    const Vector3d &p = body.vertices[a], &q = body.vertices[b], &r = body.vertices[c];
    volume += (p + q + r)[axis] / 3.0 * 0.5 * (q - p).cross(r - p)[axis];
  }
  return volume;
}

}  // namespace

void validateBodies(const std::string& config_directory, const Sink& sink) {
  using garment::FigureShape;
  const std::vector<std::pair<FigureShape, garment::Measures>> asked = {
      {FigureShape::kFemale, {{"height", 1.60}, {"chest", 0.84}, {"waist", 0.66}, {"hips", 0.92}}},
      {FigureShape::kFemale, {{"height", 1.75}, {"chest", 0.99}, {"waist", 0.80}, {"hips", 1.10}}},
      {FigureShape::kMale,
       {{"height", 1.70}, {"chest", 0.92}, {"waist", 0.76}, {"hips", 0.92}, {"neck", 0.37}}},
      {FigureShape::kMale,
       {{"height", 1.90},
        {"chest", 1.10},
        {"waist", 0.92},
        {"hips", 1.06},
        {"upper_arm", 0.34},
        {"thigh", 0.60},
        {"calf", 0.42},
        {"upper_arm_length", 0.29},
        {"shank_length", 0.48}}},
  };
  const std::string directory = config_directory + "/bodies/makehuman";
  for (std::size_t i = 0; i < asked.size(); ++i) {
    const Body body = garment::measuredBody(directory, asked[i].first, asked[i].second);
    const std::string name = "garment/body/" + std::to_string(i) + "/";
    for (const auto& [measurement, value] : asked[i].second) {
      const double here = measured(body, measurement);
      sink({name + measurement + "_m", value, here, std::abs(here - value),
            garment::kMeasureTolerance});
    }
    const double volume = fluxVolume(body, 2), other = fluxVolume(body, 0);
    sink(base::relativeTo(volume, name + "volume_by_two_axes", volume, other, 1e-11));
    sink({name + "is_closed", 1.0, garment::isClosed(body.triangles) ? 1.0 : 0.0,
          garment::isClosed(body.triangles) ? 0.0 : 1.0, 0.0});
  }
}

}  // namespace haptex::oracles
