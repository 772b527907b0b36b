// Which bones of MakeHuman's skeleton make a segment.
#include <algorithm>
#include <array>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "haptex/base/require.h"
#include "haptex/garment/body/makehuman.h"

namespace haptex::garment {
namespace {

using base::refuse;

/// A segment begins with the head of a bone and ends with a joint of another one.
struct SegmentBones {
  const char* name;
  const char* bone;
  const char* end_bone;
  bool end_at_tail;
  const char* parent;
  const char* chain;
  const char* within;
};

// Bones that are none of these belong to the segment of the bone that they hang on. Of the left
// side; the right one has the same.
constexpr std::array<SegmentBones, 3> kMiddle{{
    {"spine", "root", "neck01", false, "", "trunk", ""},
    {"neck", "neck01", "head", false, "spine", "trunk", ""},
    {"head", "head", "head", true, "neck", "trunk", ""},
}};
constexpr std::array<SegmentBones, 6> kSides{{
    {"upper_arm", "upperarm01", "lowerarm01", false, "spine", "arm", ""},
    {"forearm", "lowerarm01", "wrist", false, "upper_arm", "arm", ""},
    {"hand", "wrist", "finger3-3", true, "forearm", "arm", ""},
    {"thigh", "upperleg01", "lowerleg01", false, "spine", "leg", "trunk"},
    {"shank", "lowerleg01", "foot", false, "thigh", "leg", "trunk"},
    {"foot", "foot", "toe2-3", true, "shank", "leg", "trunk"},
}};

class FigureMaker {
 public:
  FigureMaker(FigureMesh mesh, const Skeleton& skeleton, std::string name)
      : skeleton_(skeleton), name_(std::move(name)) {
    figure_.mesh = std::move(mesh);
    for (std::size_t i = 0; i < skeleton.bones.size(); ++i) bones_[skeleton.bones[i].name] = i;
    for (const SegmentBones& segment : kMiddle) addSegment(segment, "", "");
    for (const auto& [side, suffix] : {std::pair("left_", ".L"), std::pair("right_", ".R")}) {
      for (const SegmentBones& segment : kSides) addSegment(segment, side, suffix);
    }
    const std::size_t count = figure_.mesh.positions.size();
    std::vector<bool> used(count, false);
    for (const auto& triangle : figure_.mesh.triangles) {
      for (const int vertex : triangle) used[vertex] = true;
    }
    for (std::size_t i = 0; i < count; ++i) {
      if (used[i]) figure_.surface.push_back(static_cast<int>(i));
    }
  }

  Figure make(const nlohmann::json& weights) {
    std::vector<std::map<int, double>> sums(figure_.mesh.positions.size());
    for (const auto& [bone_name, pairs] : weights.items()) addWeights(bone_name, pairs, sums);
    for (const int vertex : figure_.surface) {
      double sum = 0.0;
      for (const auto& weight : sums[vertex]) sum += weight.second;
      if (!(sum > 0.0)) refuse(name_, ": vertex ", vertex, " of the body has no weight");
      std::vector<SegmentShare> shares;
      for (const auto& [segment, weight] : sums[vertex]) {
        if (weight > 0.0) shares.push_back({segment, weight / sum});
      }
      std::stable_sort(shares.begin(), shares.end(),
                       [](const auto& a, const auto& b) { return a.weight > b.weight; });
      figure_.shares.push_back(std::move(shares));
    }
    return std::move(figure_);
  }

 private:
  const Skeleton::Bone& bone(const std::string& name) const {
    const auto found = bones_.find(name);
    if (found == bones_.end()) refuse(name_, ": the skeleton must have a bone '", name, "'");
    return skeleton_.bones[found->second];
  }

  void addSegment(const SegmentBones& of, const std::string& side, const std::string& suffix) {
    const std::string parent = of.parent;
    const std::string parent_name = parent.empty() || parent == "spine" ? parent : side + parent;
    int parent_index = -1;
    for (std::size_t i = 0; i < figure_.segments.size(); ++i) {
      if (figure_.segments[i].name == parent_name) parent_index = static_cast<int>(i);
    }
    const std::string first = of.bone + suffix;
    segment_of_[first] = static_cast<int>(figure_.segments.size());
    figure_.segments.push_back({side + of.name, parent_index, side + of.chain, of.within});
    const Skeleton::Bone& last = bone(of.end_bone + suffix);
    figure_.joints.push_back({bone(first).head, of.end_at_tail ? last.tail : last.head});
  }

  int segmentOf(const std::string& bone_name) const {
    std::set<std::string> seen;
    for (std::string name = bone_name; !name.empty(); name = bone(name).parent) {
      if (const auto found = segment_of_.find(name); found != segment_of_.end()) {
        return found->second;
      }
      if (!seen.insert(name).second) break;
    }
    refuse(name_, ": bone '", bone_name, "' must hang on 'root', through others");
  }

  void addWeights(const std::string& bone_name, const nlohmann::json& pairs,
                  std::vector<std::map<int, double>>& sums) const {
    const int segment = segmentOf(bone_name);
    const auto where = [&] { return name_ + ": weights of '" + bone_name + "'"; };
    if (!pairs.is_array()) refuse(where(), " must be a list");
    for (const auto& pair : pairs) {
      if (!pair.is_array() || pair.size() != 2 || !pair[0].is_number() || !pair[1].is_number()) {
        refuse(where(), " must be pairs of a vertex and a number");
      }
      const double vertex = pair[0].get<double>(), weight = pair[1].get<double>();
      if (!pair[0].is_number_integer() || !(vertex >= 0.0) ||
          vertex >= static_cast<double>(sums.size())) {
        refuse(where(), ": vertex ", vertex, " must be one of 0 to ", sums.size() - 1);
      }
      if (!(weight >= 0.0 && weight <= 1.0)) {
        refuse(where(), ": ", weight, " must be from 0 to 1");
      }
      sums[static_cast<std::size_t>(vertex)][segment] += weight;
    }
  }

  const Skeleton& skeleton_;
  std::string name_;
  std::map<std::string, std::size_t> bones_;
  std::map<std::string, int> segment_of_;
  Figure figure_;
};

}  // namespace

Figure makeFigure(FigureMesh mesh, const Skeleton& skeleton, const std::string& weights,
                  const std::string& name) {
  const nlohmann::json file = nlohmann::json::parse(weights, nullptr, false);
  if (!file.is_object() || !file.contains("weights") || !file["weights"].is_object()) {
    refuse(name, ": must be JSON with an object 'weights'");
  }
  return FigureMaker(std::move(mesh), skeleton, name).make(file["weights"]);
}

}  // namespace haptex::garment
