#include "haptex/garment/importers/garment_code.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "haptex/base/require.h"
#include "haptex/garment/importers/imported_seams.h"

namespace haptex::garment {
namespace {

using base::refuse;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Json = nlohmann::ordered_json;  // panels in the order of the file

/// A value in the file together with the way to it, for messages.
class Value {
 public:
  Value(const Json& json, std::string path) : json_(&json), path_(std::move(path)) {}

  [[noreturn]] void refuseIt(const std::string& allowed) const {
    const std::string shown = json_->is_structured() ? json_->type_name() : json_->dump();
    refuse(where(), "is ", shown.substr(0, 60), ", must be ", allowed);
  }

  bool has(const char* key) const { return json_->is_object() && json_->contains(key); }
  Value at(const char* key) const {
    if (!json_->is_object()) refuseIt("an object");
    const auto found = json_->find(key);
    if (found == json_->end()) refuse(where(), "'", key, "' is missing");
    return {*found, below(key)};
  }
  std::vector<std::pair<std::string, Value>> members(std::size_t most) const {
    if (!json_->is_object() || json_->size() > most) {
      refuseIt("an object of up to " + std::to_string(most) + " members");
    }
    std::vector<std::pair<std::string, Value>> members;
    for (const auto& [key, value] : json_->items()) {
      members.emplace_back(key, Value(value, below(key)));
    }
    return members;
  }
  std::vector<Value> items(std::size_t least, std::size_t most) const {
    if (!json_->is_array() || json_->size() < least || json_->size() > most) {
      const std::string range = least == most
                                    ? std::to_string(least)
                                    : std::to_string(least) + " to " + std::to_string(most);
      refuseIt("a list of " + range);
    }
    std::vector<Value> items;
    for (const Json& item : *json_) {
      items.emplace_back(item, path_ + "[" + std::to_string(items.size()) + "]");
    }
    return items;
  }
  bool isList() const { return json_->is_array(); }
  bool isTrue() const { return json_->is_boolean() && json_->get<bool>(); }
  std::string text() const {
    if (!json_->is_string()) refuseIt("a text");
    return json_->get<std::string>();
  }
  double number() const {
    if (!json_->is_number()) refuseIt("a number");
    const double number = json_->get<double>();
    if (!(std::abs(number) <= 1e12)) refuseIt("a number up to 1e12");
    return number;
  }
  int index(std::size_t count) const {
    const bool whole = json_->is_number_unsigned() || json_->is_number_integer();
    if (!whole || json_->get<double>() < 0.0 ||
        json_->get<double>() >= static_cast<double>(count)) {
      refuseIt("a whole number from 0 to " + std::to_string(count - 1));
    }
    return json_->get<int>();
  }
  Vector2d point() const {
    const auto values = items(2, 2);
    return {values[0].number(), values[1].number()};
  }
  Vector3d vector() const {
    const auto values = items(3, 3);
    return {values[0].number(), values[1].number(), values[2].number()};
  }
  const std::string& path() const { return path_; }

 private:
  std::string where() const { return path_ + (path_.back() == ':' ? " " : ": "); }
  std::string below(const std::string& key) const {
    return path_ + (path_.back() == ':' ? " " : ".") + key;
  }

  const Json* json_;
  std::string path_;
};

class GarmentCodeReader {
 public:
  GarmentCodeReader(const Value& file, std::string fabric)
      : file_(file), fabric_(std::move(fabric)) {
    if (!file.has("properties")) return;
    const Value properties = file.at("properties");
    if (properties.has("units_in_meter")) {
      const Value units = properties.at("units_in_meter");
      if (!(units.number() >= 0.01)) units.refuseIt(">= 0.01");
      metre_ = 1.0 / units.number();
    }
    if (properties.has("curvature_coords")) {
      const Value coordinates = properties.at("curvature_coords");
      absolute_ = coordinates.text() == "absolute";
      if (!absolute_ && coordinates.text() != "relative") {
        coordinates.refuseIt("\"relative\" or \"absolute\"");
      }
    }
    centred_ = properties.has("normalize_panel_translation") &&
               properties.at("normalize_panel_translation").isTrue();
  }

  Pattern read(const std::string& name) {
    const Value pattern = file_.at("pattern");
    for (const auto& [panel, value] : pattern.at("panels").members(kMostPanels)) {
      pattern_.panels.push_back(readPanel(panel, value));
    }
    sortPanels(pattern);
    // What the seams speak of has to be sound before.
    requireSound(pattern_, name);
    if (pattern.has("stitches")) {
      for (const Value& stitch : pattern.at("stitches").items(0, kMostSeams)) readStitch(stitch);
    }
    return std::move(pattern_);
  }

 private:
  Panel readPanel(const std::string& name, const Value& value) {
    Panel panel;
    panel.name = name;
    panel.fabric = fabric_;
    std::vector<Vector2d> vertices;
    for (const Value& vertex : value.at("vertices").items(2, kMostEdges)) {
      vertices.push_back(vertex.point() * metre_);
    }
    const auto placed = [&](const char* key) -> Vector3d {
      return value.has(key) ? value.at(key).vector() : Vector3d::Zero();
    };
    Vector3d translation = placed("translation") * metre_;
    if (centred_) {
      Vector2d middle = Vector2d::Zero();
      for (const Vector2d& vertex : vertices)
        middle += vertex / static_cast<double>(vertices.size());
      for (Vector2d& vertex : vertices) vertex -= middle;
      translation.head<2>() += middle;
    }
    panel.placement = placement(translation, placed("rotation") * M_PI / 180.0);
    Outline& outline = panel.outlines.emplace_back();
    for (const Value& edge : value.at("edges").items(1, kMostEdges)) {
      outline.push_back({readEdge(edge, vertices)});
    }
    return panel;
  }

  // Their tools turn about x first, then y, then z.
  static Eigen::Isometry3d placement(const Vector3d& translation, const Vector3d& angles) {
    Eigen::Matrix3d world;  // x forward, y left, z up of z forward, x left, y up
    world << 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0;
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() = world * (Eigen::AngleAxisd(angles.z(), Vector3d::UnitZ()) *
                             Eigen::AngleAxisd(angles.y(), Vector3d::UnitY()) *
                             Eigen::AngleAxisd(angles.x(), Vector3d::UnitX()))
                                .toRotationMatrix();
    pose.translation() = world * translation;
    return pose;
  }

  Curve readEdge(const Value& value, const std::vector<Vector2d>& vertices) const {
    const auto ends = value.at("endpoints").items(2, 2);
    const Vector2d& start = vertices[ends[0].index(vertices.size())];
    const Vector2d& end = vertices[ends[1].index(vertices.size())];
    if (!value.has("curvature")) return made(value, [&] { return Curve::line({start, end}); });
    const Value curvature = value.at("curvature");
    // The older format knows quadratic curves only, by their control point.
    if (curvature.isList()) {
      const Vector2d control = controlPoint(curvature.point(), start, end);
      return made(curvature, [&] { return Curve::quadratic(start, control, end); });
    }
    return readCurve(curvature, start, end);
  }

  Curve readCurve(const Value& value, const Vector2d& start, const Vector2d& end) const {
    const std::string type = value.at("type").text();
    const Value parameters = value.at("params");
    if (type == "quadratic") {
      const Vector2d control = controlPoint(parameters.items(1, 1)[0].point(), start, end);
      return made(value, [&] { return Curve::quadratic(start, control, end); });
    }
    if (type == "cubic") {
      const auto controls = parameters.items(2, 2);
      const Vector2d first = controlPoint(controls[0].point(), start, end);
      const Vector2d second = controlPoint(controls[1].point(), start, end);
      return made(value, [&] { return Curve::cubic(start, first, second, end); });
    }
    if (type == "circle") return readCircle(parameters, start, end);
    value.at("type").refuseIt("\"quadratic\", \"cubic\" or \"circle\"");
  }

  // In the frame of the edge: x from its start to its end, y to the left, both in its length.
  Vector2d controlPoint(const Vector2d& given, const Vector2d& start, const Vector2d& end) const {
    if (absolute_) return given * metre_;
    const Vector2d along = end - start, left(-along.y(), along.x());
    return start + given.x() * along + given.y() * left;
  }

  // As in SVG, with y up: radius, whether it is the larger of the two arcs, whether it turns
  // counter-clockwise.
  Curve readCircle(const Value& value, const Vector2d& start, const Vector2d& end) const {
    const auto parameters = value.items(3, 3);
    const double radius = parameters[0].number() * metre_;
    const bool large = parameters[1].number() != 0.0;
    const bool counter_clockwise = parameters[2].number() != 0.0;
    const Vector2d half = 0.5 * (end - start);
    const double reach = half.norm();
    // A half circle may be too small by rounding.
    if (!(radius >= reach * (1.0 - 1e-6)) || !(radius <= kFarthestPoint)) {
      refuse(value.path(), ": the radius is ", radius, " m: allowed are ", reach,
             ", half the distance of its ends, to ", kFarthestPoint);
    }
    const double to_centre = std::sqrt(std::max(0.0, radius * radius - reach * reach));
    const double height = large ? radius + to_centre : radius - to_centre;
    if (!(height > 1e-6 * reach)) return made(value, [&] { return Curve::line({start, end}); });
    const Vector2d right = Vector2d(half.y(), -half.x()) / reach;
    const Vector2d middle = start + half + (counter_clockwise ? height : -height) * right;
    return made(value, [&] { return Curve::arc(start, middle, end); });
  }

  // A curve, or a refusal that says where.
  template <typename Make>
  static Curve made(const Value& value, const Make& make) {
    try {
      return make();
    } catch (const std::invalid_argument& error) {
      refuse(value.path(), ": ", error.what());
    }
  }

  // As `panel_order` lists them, those that it does not list last.
  void sortPanels(const Value& pattern) {
    if (!pattern.has("panel_order")) return;
    std::vector<std::string> order;
    for (const Value& name : pattern.at("panel_order").items(0, kMostPanels)) {
      order.push_back(name.text());
    }
    const auto place = [&](const Panel& panel) {
      return std::find(order.begin(), order.end(), panel.name) - order.begin();
    };
    std::stable_sort(pattern_.panels.begin(), pattern_.panels.end(),
                     [&](const Panel& a, const Panel& b) { return place(a) < place(b); });
  }

  void readStitch(const Value& value) {
    const auto parts = value.items(2, 3);
    const bool starts_meet = parts.size() == 3 && parts[2].text() == "right_wrong";
    if (parts.size() == 3 && !starts_meet) parts[2].refuseIt("\"right_wrong\"");
    Seam seam;
    for (int i = 0; i < 2; ++i) {
      SeamSide& side = seam.sides[i];
      side.panel = panelOf(parts[i].at("panel"));
      const std::size_t edges = pattern_.panels[side.panel].outlines.front().size();
      side.first = side.last = parts[i].at("edge").index(edges);
    }
    seam.sides[1].reversed = !starts_meet && oppositeEndsMeet(pattern_, seam);
    seam.easing = easingOf(pattern_, seam);
    pattern_.seams.push_back(seam);
  }

  int panelOf(const Value& value) const {
    const std::string name = value.text();
    for (std::size_t p = 0; p < pattern_.panels.size(); ++p) {
      if (pattern_.panels[p].name == name) return static_cast<int>(p);
    }
    value.refuseIt("the name of a panel");
  }

  const Value& file_;
  const std::string fabric_;
  double metre_ = 0.01;
  bool absolute_ = false, centred_ = false;
  Pattern pattern_;
};

}  // namespace

Pattern importGarmentCode(const std::string& text, const std::string& name,
                          const std::string& fabric) {
  Json json;
  try {
    json = Json::parse(text);
  } catch (const Json::exception& error) {
    refuse(name, ": is not JSON: ", error.what());
  }
  const Value file(json, name + ":");
  Pattern pattern = GarmentCodeReader(file, fabric).read(name);
  pattern.source = name;
  requireSound(pattern, name);
  return pattern;
}

}  // namespace haptex::garment
