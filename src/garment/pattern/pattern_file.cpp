#include "haptex/garment/pattern/pattern_file.h"

#include <filesystem>
#include <stdexcept>

#include "haptex/base/require.h"
#include "haptex/base/yaml_reader.h"
#include "haptex/garment/pattern/seam_reader.h"

namespace haptex::garment {
namespace {

using base::YamlValue;
using Eigen::Vector2d;

class PatternReader {
 public:
  explicit PatternReader(const YamlValue& file) : file_(file) {}

  Pattern read() {
    file_.requireKeys({"source", "panels"}, {"carriers", "seams", "darts", "fasteners"});
    pattern_.source = file_.at("source").text();
    if (file_.has("carriers")) {
      for (const YamlValue& value : itemsOf(file_.at("carriers"), kMostPanels)) {
        pattern_.carriers.push_back(readCarrier(value));
      }
    }
    for (const YamlValue& value : itemsOf(file_.at("panels"), kMostPanels)) {
      pattern_.panels.push_back(readPanel(value));
    }
    for (const char* list : {"seams", "darts", "fasteners"}) {
      if (file_.has(list)) itemsOf(file_.at(list), kMostSeams);
    }
    readSeams(file_, pattern_);
    readFastenings(file_, pattern_);
    return std::move(pattern_);
  }

 private:
  static std::vector<YamlValue> itemsOf(const YamlValue& value, std::size_t most) {
    std::vector<YamlValue> items = value.items();
    if (items.size() > most) value.refuse("is too long: allowed are up to " + std::to_string(most));
    return items;
  }

  static Carrier readCarrier(const YamlValue& value) {
    value.requireKeys({"name", "shape", "segment"});
    const bool cone = value.at("shape").oneOf({"cylinder", "cone"}) == "cone";
    return {value.at("name").text(), cone ? Carrier::Shape::kCone : Carrier::Shape::kCylinder,
            value.at("segment").text()};
  }

  Panel readPanel(const YamlValue& value) {
    value.requireKeys({"name", "fabric", "outline"},
                      {"holes", "marks", "layer", "grain", "placement"});
    Panel panel;
    panel.name = value.at("name").text();
    panel.fabric = value.at("fabric").text();
    if (value.has("layer")) panel.layer = value.at("layer").integer();
    if (value.has("grain")) panel.warp = readDirection(value.at("grain"));
    if (value.has("placement")) panel.placement = readPlacement(value.at("placement"));
    panel.outlines.push_back(readOutline(value.at("outline"), panel));
    if (value.has("holes")) {
      for (const YamlValue& hole : itemsOf(value.at("holes"), kMostEdges)) {
        panel.outlines.push_back(readOutline(hole, panel));
      }
    }
    if (value.has("marks")) {
      for (const YamlValue& mark : itemsOf(value.at("marks"), kMostEdges)) {
        panel.marks.push_back(readPoints(mark, kMostLines));
      }
    }
    return panel;
  }

  static Vector2d readDirection(const YamlValue& value) {
    const Vector2d direction = readPoint(value);
    if (!(direction.norm() >= 1e-6)) value.refuse("must be a direction, longer than 1e-6");
    return direction.normalized();
  }

  static std::variant<Eigen::Isometry3d, OnCarrier> readPlacement(const YamlValue& value) {
    if (value.isMap() && value.has("carrier")) {
      value.requireKeys({"carrier"}, {"angle", "along", "turn"});
      OnCarrier on{value.at("carrier").text()};
      if (value.has("angle")) on.angle = value.at("angle").number();
      if (value.has("along")) on.along = value.at("along").number();
      if (value.has("turn")) on.turn = value.at("turn").number();
      return on;
    }
    value.requireKeys({"position", "rpy"});
    const Eigen::Vector3d rpy = readVector(value.at("rpy"));
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation() = readVector(value.at("position"));
    pose.linear() = (Eigen::AngleAxisd(rpy.z(), Eigen::Vector3d::UnitZ()) *
                     Eigen::AngleAxisd(rpy.y(), Eigen::Vector3d::UnitY()) *
                     Eigen::AngleAxisd(rpy.x(), Eigen::Vector3d::UnitX()))
                        .toRotationMatrix();
    return pose;
  }

  Outline readOutline(const YamlValue& value, const Panel& panel) {
    Outline outline;
    for (const YamlValue& item : itemsOf(value, kMostEdges)) {
      Edge edge = readEdge(item, panel);
      // Ends that differ by rounding are one corner.
      if (!outline.empty() && (edge.curve.start() - outline.back().curve.end()).norm() <= kJoin) {
        edge.curve = edge.curve.withStart(outline.back().curve.end());
      }
      outline.push_back(std::move(edge));
    }
    return outline;
  }

  Edge readEdge(const YamlValue& value, const Panel& panel) {
    value.requireKeys({}, {"line", "quadratic", "cubic", "arc", "name"});
    std::string kind;
    for (const char* word : {"line", "quadratic", "cubic", "arc"}) {
      if (!value.has(word)) continue;
      if (!kind.empty()) value.refuseBecause("has " + kind + " and " + word + ": allowed is one");
      kind = word;
    }
    if (kind.empty()) value.refuseBecause("must have one of line, quadratic, cubic, arc");
    Edge edge{readCurve(value.at(kind), kind, panel)};
    if (value.has("name")) edge.name = readName(value.at("name"));
    return edge;
  }

  Curve readCurve(const YamlValue& value, const std::string& kind, const Panel& panel) {
    if (kind != "line") value.items(kind == "cubic" ? 4 : 3);
    const std::vector<Vector2d> points = readPoints(value, kMostLines);
    try {
      if (kind == "line") return Curve::line(points);
      if (kind == "quadratic") return Curve::quadratic(points[0], points[1], points[2]);
      if (kind == "cubic") return Curve::cubic(points[0], points[1], points[2], points[3]);
      return Curve::arc(points[0], points[1], points[2]);
    } catch (const std::invalid_argument& error) {
      value.refuseBecause("panel '" + panel.name + "': " + error.what());
    }
  }

  std::vector<Vector2d> readPoints(const YamlValue& value, std::size_t most) {
    const std::vector<YamlValue> items = itemsOf(value, most);
    points_ += items.size();
    if (points_ > kMostPatternPoints) {
      value.refuse("is too much: allowed are up to " + std::to_string(kMostPatternPoints) +
                   " points in a file");
    }
    std::vector<Vector2d> points;
    for (const YamlValue& item : items) points.push_back(readPoint(item));
    return points;
  }

  static std::string readName(const YamlValue& value) {
    const std::string name = value.text();
    if (name.find_first_not_of("0123456789") == name.npos) {
      value.refuse("is a number: names of edges must have another character");
    }
    return name;
  }

  static Vector2d readPoint(const YamlValue& value) {
    const auto items = value.items(2);
    return {items[0].number(), items[1].number()};
  }

  static Eigen::Vector3d readVector(const YamlValue& value) {
    const auto items = value.items(3);
    return {items[0].number(), items[1].number(), items[2].number()};
  }

  const YamlValue& file_;
  Pattern pattern_;
  std::size_t points_ = 0;
};

}  // namespace

std::string readPatternText(const std::string& path) {
  std::error_code error;
  if (std::filesystem::exists(path, error) && !std::filesystem::is_directory(path, error)) {
    if (!std::filesystem::is_regular_file(path, error)) {
      throw std::runtime_error(path + ": is not a regular file");
    }
    const auto size = std::filesystem::file_size(path, error);
    if (!error && size > kLargestPatternFile) {
      base::refuse(path, ": has ", size, " bytes: allowed are up to ", kLargestPatternFile);
    }
  }
  return base::readTextFile(path, kLargestPatternFile);
}

Pattern parsePattern(const std::string& text, const std::string& name) {
  const YamlValue file = YamlValue::parse(text, name, {kLargestPatternFile, kMostPatternValues});
  Pattern pattern = PatternReader(file).read();
  requireSound(pattern, name);
  return pattern;
}

Pattern loadPattern(const std::string& path) { return parsePattern(readPatternText(path), path); }

}  // namespace haptex::garment
