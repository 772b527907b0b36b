#include "haptex/dressing/worn_scene.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <ostream>

#include "haptex/garment/triangulation/threads.h"

namespace haptex::dressing {
namespace {

namespace fs = std::filesystem;

constexpr double kTimeStep = 0.04;     // s
constexpr double kStiffness = 1000.0;  // N/m, of buttons
constexpr double kRelease = 30.0;      // N

class Writer {
 public:
  Writer(const WornScene& scene, const std::string& path, std::ostream& out)
      : scene_(scene), directory_(fs::absolute(path).parent_path()), out_(out), yaml_(out) {
    yaml_.SetDoublePrecision(12);
  }

  void write() {
    yaml_ << YAML::Comment("Written by drape_garment: docs/scene_files.md says what may be changed")
          << YAML::Newline << YAML::BeginMap;
    add("fabric", pathOf(scene_.fabrics.front()));
    writeRegions();
    add("mesh", pathOf(scene_.cloth));
    yaml_ << YAML::Key << "attach" << YAML::Value << YAML::Flow << YAML::BeginSeq << YAML::EndSeq;
    writeFasteners();
    yaml_ << YAML::Key << "model" << YAML::Value << YAML::Flow << YAML::BeginSeq;
    for (const char* effect :
         {"gravity", "viscosity", "bending", "self_collision", "obstacles", "fingers"}) {
      yaml_ << effect;
    }
    yaml_ << YAML::EndSeq;
    add("time_step", kTimeStep);
    begin("solver");
    add("newton_iterations", 1);
    yaml_ << YAML::EndMap;
    writeHaptics();
    yaml_ << YAML::Key << "obstacles" << YAML::Value << YAML::BeginSeq << YAML::Flow
          << YAML::BeginMap;
    add("name", "body");
    add("mesh", pathOf(scene_.body));
    yaml_ << YAML::Key << "position" << YAML::Value << YAML::Flow << YAML::BeginSeq << 0 << 0 << 0
          << YAML::EndSeq << YAML::EndMap << YAML::EndSeq << YAML::EndMap;
    out_ << '\n';
  }

 private:
  template <typename Value>
  void add(const char* key, const Value& value) {
    yaml_ << YAML::Key << key << YAML::Value << value;
  }
  void begin(const char* key) {
    yaml_ << YAML::Key << key << YAML::Value << YAML::Flow << YAML::BeginMap;
  }

  /// With a slash in it, which makes it a path for scene files.
  std::string pathOf(const std::string& file) const {
    const fs::path whole = fs::absolute(file).lexically_normal();
    const fs::path from_here = whole.lexically_relative(directory_.lexically_normal());
    const bool is_here = !from_here.empty() && *from_here.begin() != "..";
    return is_here ? "./" + from_here.generic_string() : whole.generic_string();
  }

  void writeRegions() {
    const auto is_other = [&](std::size_t panel) {
      return scene_.fabrics[panel] != scene_.fabrics.front();
    };
    bool any = false;
    for (std::size_t p = 0; p < scene_.fabrics.size(); ++p) {
      if (!is_other(p)) continue;
      if (!any) yaml_ << YAML::Key << "regions" << YAML::Value << YAML::BeginSeq;
      any = true;
      yaml_ << YAML::Flow << YAML::BeginMap;
      add("fabric", pathOf(scene_.fabrics[p]));
      add("group", scene_.pattern.panels[p].name);
      yaml_ << YAML::EndMap;
    }
    if (any) yaml_ << YAML::EndSeq;
  }

  void writeFasteners() {
    if (scene_.pattern.fastenings.empty()) return;
    yaml_ << YAML::Key << "fasteners" << YAML::Value << YAML::BeginSeq;
    for (const garment::Fastening& fastening : scene_.pattern.fastenings) {
      yaml_ << YAML::Flow << YAML::BeginMap;
      add("name", nameOf(fastening));
      add("kind", "button");
      yaml_ << YAML::Key << "between" << YAML::Value << YAML::Flow << YAML::BeginSeq;
      for (const garment::PlaceOnPanel& place : fastening.places) {
        const garment::Panel& panel = scene_.pattern.panels[place.panel];
        const Eigen::Vector2d rest = garment::Threads(panel).restOf(place.at);
        yaml_ << YAML::Flow << YAML::BeginMap;
        add("group", panel.name);
        yaml_ << YAML::Key << "at" << YAML::Value << YAML::Flow << YAML::BeginSeq << rest.x()
              << rest.y() << YAML::EndSeq << YAML::EndMap;
      }
      yaml_ << YAML::EndSeq;
      add("stiffness", kStiffness);
      add("release_force", kRelease);
      yaml_ << YAML::EndMap;
    }
    yaml_ << YAML::EndSeq;
  }

  /// With the characters that a scene allows: an outfit's has a slash.
  static std::string nameOf(const garment::Fastening& fastening) {
    std::string name = fastening.name;
    std::replace_if(
        name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
    return std::isalpha(static_cast<unsigned char>(name[0])) != 0 ? name : "fastener_" + name;
  }

  /// Elements of a patch of 6 mm at most, and as many of the scene's as cover what eight of 30 mm
  /// do.
  void writeHaptics() {
    constexpr double kFine = 6e-3, kKnown = 0.03;  // m
    constexpr int kMost = 8;
    int refinement = 0;
    while (refinement < 4 && std::ldexp(scene_.edge_length, -refinement) > kFine) ++refinement;
    const double ratio = kKnown / scene_.edge_length;
    begin("haptics");
    add("layer", "patch");
    add("refinement", refinement);
    add("most_elements", std::max(kMost, static_cast<int>(std::ceil(kMost * ratio * ratio))));
    yaml_ << YAML::EndMap;
  }

  const WornScene& scene_;
  fs::path directory_;
  std::ostream& out_;
  YAML::Emitter yaml_;
};

}  // namespace

void writeWornScene(const WornScene& scene, const std::string& path, std::ostream& out) {
  Writer(scene, path, out).write();
}

}  // namespace haptex::dressing
