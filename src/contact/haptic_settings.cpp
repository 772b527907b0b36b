#include "haptex/contact/haptic_settings.h"

#include "haptex/base/yaml_reader.h"

namespace haptex::contact {
namespace {

using base::YamlValue;

constexpr int kMaxRefinement = 4;
constexpr double kMaxMargin = 0.1;    // m
constexpr double kMaxSurround = 0.2;  // m

HapticSettings readSettings(const YamlValue& value) {
  value.requireKeys({}, {"layer", "refinement", "margin", "most_elements", "surround", "predict"});
  HapticSettings settings;
  if (value.has("layer")) {
    const bool patch = value.at("layer").oneOf({"patch", "whole_cloth"}) == "patch";
    settings.layer = patch ? HapticSettings::Layer::kPatch : HapticSettings::Layer::kWholeCloth;
  }
  for (const char* key : {"refinement", "margin", "most_elements", "surround", "predict"}) {
    if (settings.layer == HapticSettings::Layer::kPatch || !value.has(key)) continue;
    value.at(key).refuse("is not allowed with layer: whole_cloth, which has no patches");
  }
  if (value.has("refinement")) {
    settings.refinement = value.at("refinement").integer();
    if (settings.refinement < 0 || settings.refinement > kMaxRefinement) {
      value.at("refinement").refuse("must be an integer from 0 to 4");
    }
  }
  if (value.has("margin")) {
    settings.margin = value.at("margin").number();
    if (settings.margin <= 0.0 || settings.margin > kMaxMargin) {
      value.at("margin").refuse("must be > 0 and <= 0.1 m");
    }
  }
  if (value.has("most_elements")) {
    settings.most_elements = value.at("most_elements").integer();
    if (settings.most_elements < 1) value.at("most_elements").refuse("must be an integer >= 1");
  }
  if (value.has("surround")) {
    settings.surround = value.at("surround").number();
    if (settings.surround < 0.0 || settings.surround > kMaxSurround) {
      value.at("surround").refuse("must be from 0 to 0.2 m");
    }
  }
  if (value.has("predict")) {
    settings.predict = value.at("predict").oneOf({"true", "false"}) == "true";
  }
  return settings;
}

}  // namespace

HapticSettings loadHapticSettings(const std::string& scene_path) {
  const YamlValue scene = YamlValue::load(scene_path);
  if (!scene.isMap()) scene.refuse("must be a map");
  return scene.has("haptics") ? readSettings(scene.at("haptics")) : HapticSettings();
}

}  // namespace haptex::contact
