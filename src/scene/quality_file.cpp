#include "haptex/scene/quality_file.h"

#include <algorithm>
#include <set>
#include <utility>

#include "haptex/base/quoted.h"
#include "haptex/base/yaml_reader.h"
#include "haptex/scene/scene_values.h"
#include "haptex/scene/step_values.h"

namespace haptex::scene {
namespace {

using base::YamlValue;

double readError(const YamlValue& value) {
  const double error = value.number();
  if (error < 0.0) value.refuse("must be a finite number >= 0");
  return error;
}

double readCost(const YamlValue& value) {
  const double cost = value.number();
  if (cost <= 0.0) value.refuse("must be a finite number > 0");
  return cost;
}

MeasuredQuality readMeasured(const YamlValue& value) {
  value.requireKeys({"motion", "fabric", "position_error", "force_error", "energy_error", "cost"});
  MeasuredQuality measured;
  measured.motion = value.at("motion").text();
  measured.fabric = value.at("fabric").text();
  measured.position_error = readError(value.at("position_error"));
  measured.force_error = readError(value.at("force_error"));
  measured.energy_error = readError(value.at("energy_error"));
  measured.cost = readCost(value.at("cost"));
  return measured;
}

/// One of the fabrics that were measured.
std::string readFabric(const YamlValue& value, const std::vector<MeasuredQuality>& measured) {
  std::set<std::string> fabrics;
  for (const MeasuredQuality& of : measured) fabrics.insert(of.fabric);
  std::vector<const char*> names;
  for (const std::string& name : fabrics) names.push_back(name.c_str());
  return value.oneOf(names);
}

Quality readQuality(const YamlValue& value) {
  value.requireKeys({"name", "cell_size", "time_step", "measured"},
                    {"fabric", "integrator", "solver"});
  Quality quality;
  quality.name = value.at("name").text();
  quality.cell_size = readSize(value.at("cell_size"));
  quality.time_step = readTimeStep(value.at("time_step"));
  quality.step = readStepSettings(value);
  std::set<std::pair<std::string, std::string>> seen;
  for (const YamlValue& item : value.at("measured").items()) {
    quality.measured.push_back(readMeasured(item));
    const MeasuredQuality& measured = quality.measured.back();
    if (!seen.insert({measured.motion, measured.fabric}).second) {
      item.refuseBecause("the motion " + base::quoted(measured.motion) + " of the fabric " +
                         base::quoted(measured.fabric) + " is listed twice");
    }
  }
  if (quality.measured.empty()) value.at("measured").refuse("must have at least one item");
  if (value.has("fabric")) quality.fabric = readFabric(value.at("fabric"), quality.measured);
  return quality;
}

/// Whether two of one name could be meant for the same fabric.
bool clash(const Quality& a, const Quality& b) {
  return a.name == b.name && (a.fabric.empty() || b.fabric.empty() || a.fabric == b.fabric);
}

}  // namespace

std::vector<Quality> loadQualities(const std::string& path) {
  const YamlValue file = YamlValue::load(path);
  file.requireKeys({"machine", "qualities"});
  file.at("machine").text();
  std::vector<Quality> qualities;
  for (const YamlValue& item : file.at("qualities").items()) {
    const Quality quality = readQuality(item);
    const auto same = [&](const Quality& other) { return clash(quality, other); };
    if (std::any_of(qualities.begin(), qualities.end(), same)) {
      item.at("name").refuse("is listed twice" + (quality.fabric.empty()
                                                      ? ""
                                                      : " for " + base::quoted(quality.fabric)));
    }
    qualities.push_back(quality);
  }
  if (qualities.empty()) file.at("qualities").refuse("must have at least one item");
  return qualities;
}

}  // namespace haptex::scene
