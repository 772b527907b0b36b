// Files of MakeHuman as text.
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "haptex/base/parse_number.h"
#include "haptex/base/require.h"
#include "haptex/garment/body/makehuman.h"

namespace haptex::garment {
namespace {

using base::refuse;
using Eigen::Vector3d;
using nlohmann::json;

constexpr double kDecimetre = 0.1;              // m
constexpr double kLargestFigureLength = 100.0;  // dm, of a coordinate

Vector3d worldOf(const Vector3d& file) {
  return kDecimetre * Vector3d(file.z(), file.x(), file.y());
}

/// Words of a text line by line; comments left out.
class Lines {
 public:
  Lines(const std::string& text, const std::string& name) : stream_(text), name_(name) {}

  bool next() {
    for (std::string line; std::getline(stream_, line);) {
      ++number_;
      std::istringstream words(line.substr(0, line.find('#')));
      words_.clear();
      for (std::string word; words >> word;) words_.push_back(word);
      if (!words_.empty()) return true;
    }
    return false;
  }
  const std::vector<std::string>& words() const { return words_; }

  template <typename... Parts>
  [[noreturn]] void refuseLine(const Parts&... parts) const {
    refuse(name_, ": line ", number_, ": ", parts...);
  }

  Vector3d vector(std::size_t first) const {
    Vector3d values;
    if (words_.size() != first + 3) refuseLine("must have ", first + 3, " words");
    for (std::size_t i = 0; i < 3; ++i) {
      const std::string& word = words_[first + i];
      const auto value = base::parseNumber<double>(base::withoutPlus(word));
      if (!value || !(std::abs(*value) <= kLargestFigureLength)) {
        refuseLine("coordinate ", i + 1, " must be a number from -", kLargestFigureLength, " to ",
                   kLargestFigureLength);
      }
      values[static_cast<Eigen::Index>(i)] = *value;
    }
    return values;
  }

  /// A whole number from `first` that is less than the count.
  int index(const std::string& word, int first, std::size_t count) const {
    const auto value = base::parseNumber<int>(word);
    if (!value || *value < first || static_cast<std::size_t>(*value - first) >= count) {
      refuseLine("vertices must be whole numbers from ", first, " to ",
                 static_cast<long>(count) + first - 1);
    }
    return *value - first;
  }

 private:
  std::istringstream stream_;
  const std::string& name_;
  long number_ = 0;
  std::vector<std::string> words_;
};

void readFace(const Lines& lines, FigureMesh& mesh) {
  std::vector<int> corners;
  for (std::size_t i = 1; i < lines.words().size(); ++i) {
    const std::string& word = lines.words()[i];
    corners.push_back(lines.index(word.substr(0, word.find('/')), 1, mesh.positions.size()));
  }
  if (corners.size() != 3 && corners.size() != 4) {
    lines.refuseLine("a face has ", corners.size(), " corners: allowed are 3 and 4");
  }
  for (std::size_t i = 2; i < corners.size(); ++i) {
    mesh.triangles.push_back({corners[0], corners[i - 1], corners[i]});
  }
}

json parseObject(const std::string& text, const std::string& name) {
  json file = json::parse(text, nullptr, false);
  if (!file.is_object()) refuse(name, ": must be a JSON object");
  return file;
}

const json& member(const json& object, const std::string& key, const std::string& where) {
  if (!object.is_object() || !object.contains(key)) refuse(where, ": '", key, "' is missing");
  return object[key];
}

std::vector<int> jointNamed(const json& joints, const json& key, const std::string& where,
                            std::size_t vertices) {
  if (!key.is_string()) refuse(where, ": joints must be named by a text");
  const json& list = member(joints, key.get<std::string>(), where);
  std::vector<int> joint;
  for (const json& item : list) {
    if (!item.is_number_integer() || item.get<double>() < 0.0 ||
        item.get<double>() >= static_cast<double>(vertices)) {
      refuse(where, ": a joint's vertices must be whole numbers from 0 to ", vertices - 1);
    }
    joint.push_back(item.get<int>());
  }
  if (joint.empty()) refuse(where, ": a joint must have a vertex or more");
  return joint;
}

}  // namespace

FigureMesh parseFigure(const std::string& text, const std::string& name) {
  FigureMesh mesh;
  Lines lines(text, name);
  bool is_body = false;
  while (lines.next()) {
    const std::string& statement = lines.words().front();
    if (statement == "v") {
      if (mesh.positions.size() == kMostFigureVertices) {
        lines.refuseLine("more than ", kMostFigureVertices, " vertices");
      }
      mesh.positions.push_back(worldOf(lines.vector(1)));
    } else if (statement == "g") {
      is_body = lines.words().size() == 2 && lines.words()[1] == "body";
    } else if (statement == "f" && is_body) {
      readFace(lines, mesh);
    }
  }
  if (mesh.triangles.empty()) refuse(name, ": must have faces in a group 'body'");
  return mesh;
}

Target parseTarget(const std::string& text, const std::string& name, std::size_t vertices) {
  Target target;
  Lines lines(text, name);
  while (lines.next()) {
    const Vector3d by = worldOf(lines.vector(1));
    target.steps.push_back({lines.index(lines.words().front(), 0, vertices), by});
  }
  return target;
}

Skeleton parseSkeleton(const std::string& text, const std::string& name, std::size_t vertices) {
  const json file = parseObject(text, name);
  const json& joints = member(file, "joints", name);
  const json& bones = member(file, "bones", name);
  if (!bones.is_object()) refuse(name, ": bones must be an object");
  Skeleton skeleton;
  for (const auto& [bone, value] : bones.items()) {
    const std::string where = name + ": bone '" + bone.substr(0, 60) + "'";
    const json& parent = member(value, "parent", where);
    if (!parent.is_null() && !parent.is_string()) refuse(where, ": parent must be a text or null");
    skeleton.bones.push_back({bone, parent.is_null() ? "" : parent.get<std::string>(),
                              jointNamed(joints, member(value, "head", where), where, vertices),
                              jointNamed(joints, member(value, "tail", where), where, vertices)});
  }
  return skeleton;
}

}  // namespace haptex::garment
