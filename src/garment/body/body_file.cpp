#include "haptex/garment/body/body_file.h"

#include <algorithm>
#include <filesystem>
#include <limits>
#include <optional>
#include <utility>

#include "haptex/base/require.h"
#include "haptex/base/yaml_reader.h"
#include "haptex/garment/body/measured_body.h"
#include "haptex/garment/body/measurements.h"
#include "haptex/mesh/obj_file.h"

namespace haptex::garment {
namespace {

using base::YamlValue;
using Eigen::Vector3d;

constexpr double kFarthestPlace = 100.0;  // m
constexpr double kLeastSegment = 1e-3;    // m

Vector3d readVector(const YamlValue& value) {
  const auto items = value.items(3);
  const Vector3d vector(items[0].number(), items[1].number(), items[2].number());
  if (vector.cwiseAbs().maxCoeff() > kFarthestPlace) value.refuse("must be within 100");
  return vector;
}

/// A segment of a surface, and which part of it goes with the segment.
struct SegmentPart {
  std::optional<double> radius;  // m
  std::string group;
};

class SurfaceReader {
 public:
  SurfaceReader(const YamlValue& file, const std::string& directory) : file_(file) {
    file.requireKeys({"surface", "segments"}, {"pose"});
    path_ = directory + "/" + file.at("surface").text();
  }

  Body read() {
    readSegments();
    mesh::ObstacleMesh surface = mesh::loadObjSurface(path_, groups_);
    body_.vertices = std::move(surface.vertices);
    body_.triangles = std::move(surface.triangles);
    for (const Vector3d& vertex : body_.vertices) {
      if (!(vertex.cwiseAbs().maxCoeff() <= kFarthestPlace)) {
        base::refuse(path_, ": has a vertex at ", vertex.transpose(),
                     ": allowed are coordinates up to ", kFarthestPlace, " m");
      }
    }
    body_.shares.resize(body_.vertices.size());
    for (std::size_t i = 0; i < parts_.size(); ++i) assignGroup(static_cast<int>(i));
    assignNearest();
    setDown(body_);
    return std::move(body_);
  }

 private:
  void readSegments() {
    const std::vector<YamlValue> items = file_.at("segments").items();
    if (items.empty() || items.size() > kMostSegments) {
      file_.at("segments")
          .refuseBecause("has " + std::to_string(items.size()) + " segments: allowed are 1 to " +
                         std::to_string(kMostSegments));
    }
    for (const YamlValue& item : items) readSegment(item);
    for (std::size_t i = 0; i < items.size(); ++i) requireOuterChain(items[i], body_.segments[i]);
  }

  void readSegment(const YamlValue& value) {
    value.requireKeys({"name", "start", "end"}, {"radius", "group", "parent", "chain", "within"});
    Segment segment;
    segment.name = value.at("name").text();
    for (const Segment& other : body_.segments) {
      if (other.name == segment.name) value.at("name").refuse("is there twice: names must differ");
    }
    if (value.has("parent")) segment.parent = readParent(value.at("parent"));
    segment.chain = value.has("chain") ? value.at("chain").text() : segment.name;
    if (value.has("within")) segment.within = value.at("within").text();
    segment.start = readVector(value.at("start"));
    segment.end = readVector(value.at("end"));
    if ((segment.end - segment.start).norm() < kLeastSegment) {
      value.refuseBecause("start and end must be 1 mm or more apart");
    }
    if (value.has("radius") == value.has("group")) {
      value.refuseBecause("must have one of radius, group");
    }
    SegmentPart part;
    if (value.has("group")) part.group = value.at("group").text();
    if (value.has("radius")) {
      part.radius = value.at("radius").number();
      if (!(*part.radius > 0.0)) value.at("radius").refuse("must be > 0 m");
    }
    body_.segments.push_back(std::move(segment));
    parts_.push_back(std::move(part));
  }

  void requireOuterChain(const YamlValue& value, const Segment& segment) const {
    if (segment.within.empty()) return;
    const bool is_there =
        std::any_of(body_.segments.begin(), body_.segments.end(),
                    [&](const Segment& other) { return other.chain == segment.within; });
    if (!is_there || segment.within == segment.chain) {
      value.at("within").refuse("must be the chain of other segments");
    }
  }

  int readParent(const YamlValue& value) const {
    const std::string name = value.text();
    for (std::size_t i = 0; i < body_.segments.size(); ++i) {
      if (body_.segments[i].name == name) return static_cast<int>(i);
    }
    value.refuse("must be an earlier segment");
  }

  void assignGroup(int segment) {
    const std::string& name = parts_[segment].group;
    if (name.empty()) return;
    const auto group = groups_.find(name);
    if (group == groups_.end()) {
      base::refuse(file_.file(), ": segments[", segment, "].group: '", name, "' is no group of ",
                   path_);
    }
    for (const int triangle : group->second) {
      for (const int vertex : body_.triangles[triangle]) {
        if (body_.shares[vertex].empty()) body_.shares[vertex] = {{segment, 1.0}};
      }
    }
  }

  // To the segment with a radius whose capsule is the nearest, or to the nearest of all if none
  // has one.
  void assignNearest() {
    const bool any = std::any_of(parts_.begin(), parts_.end(),
                                 [](const SegmentPart& part) { return part.radius.has_value(); });
    for (std::size_t i = 0; i < body_.vertices.size(); ++i) {
      if (!body_.shares[i].empty()) continue;
      double nearest = std::numeric_limits<double>::infinity();
      for (std::size_t k = 0; k < parts_.size(); ++k) {
        if (any && !parts_[k].radius) continue;
        const double distance =
            distanceTo(body_.segments[k], body_.vertices[i]) - parts_[k].radius.value_or(0.0);
        if (distance >= nearest) continue;
        nearest = distance;
        body_.shares[i] = {{static_cast<int>(k), 1.0}};
      }
    }
  }

  static double distanceTo(const Segment& segment, const Vector3d& point) {
    const Vector3d along = segment.end - segment.start;
    const double share = (point - segment.start).dot(along) / along.squaredNorm();
    return (point - segment.start - std::clamp(share, 0.0, 1.0) * along).norm();
  }

  const YamlValue& file_;
  std::string path_;
  mesh::MeshGroups groups_;
  std::vector<SegmentPart> parts_;
  Body body_;
};

std::vector<std::string> measurementNames() {
  std::vector<std::string> names;
  for (const Measurement& measurement : measurements()) names.push_back(measurement.name);
  return names;
}

Body readFigure(const YamlValue& file, const std::string& directory) {
  file.requireKeys({"makehuman", "shape"}, {"measurements", "pose"});
  const bool female = file.at("shape").oneOf({"female", "male"}) == "female";
  Measures asked;
  if (file.has("measurements")) {
    const YamlValue values = file.at("measurements");
    values.requireKeys({}, measurementNames());
    for (const std::string& name : measurementNames()) {
      if (values.has(name)) asked[name] = values.at(name).number();
    }
  }
  const std::string figure = directory + "/" + file.at("makehuman").text();
  try {
    return measuredBody(figure, female ? FigureShape::kFemale : FigureShape::kMale, asked);
  } catch (const std::invalid_argument& error) {
    base::refuse(file.file(), ": measurements: ", error.what());
  }
}

Pose readPose(const YamlValue& value, const Body& body) {
  std::vector<std::string> names;
  for (const Segment& segment : body.segments) names.push_back(segment.name);
  value.requireKeys({}, names);
  Pose pose;
  for (const std::string& name : names) {
    if (!value.has(name)) continue;
    const Vector3d rpy = readVector(value.at(name));
    pose[name] = Eigen::AngleAxisd(rpy.z(), Vector3d::UnitZ()) *
                 Eigen::AngleAxisd(rpy.y(), Vector3d::UnitY()) *
                 Eigen::AngleAxisd(rpy.x(), Vector3d::UnitX());
  }
  return pose;
}

}  // namespace

Body parseBody(const std::string& text, const std::string& directory, const std::string& name) {
  const YamlValue file = YamlValue::parse(text, name);
  const bool surface = file.isMap() && file.has("surface");
  Body body = surface ? SurfaceReader(file, directory).read() : readFigure(file, directory);
  return file.has("pose") ? posed(body, readPose(file.at("pose"), body)) : body;
}

Body loadBody(const std::string& path) {
  const std::filesystem::path directory = std::filesystem::path(path).parent_path();
  return parseBody(base::readTextFile(path), directory.empty() ? "." : directory.string(), path);
}

}  // namespace haptex::garment
