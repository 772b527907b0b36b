#include "haptex/garment/pattern/outfit.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "haptex/base/yaml_reader.h"
#include "haptex/garment/pattern/pattern_file.h"

namespace haptex::garment {
namespace {

namespace fs = std::filesystem;

std::string pathOf(const base::YamlValue& value) {
  const std::string name = value.text();
  const fs::path directory = fs::path(value.file()).parent_path();
  const bool is_path = name.find('/') != name.npos;
  return (directory / (is_path ? name : name + ".yaml")).lexically_normal().string();
}

void add(Pattern garment, const std::string& name, int first_layer, Pattern& all) {
  const std::string before = name + "/";
  for (Carrier& carrier : garment.carriers) {
    carrier.name = before + carrier.name;
    all.carriers.push_back(std::move(carrier));
  }
  const int first_panel = static_cast<int>(all.panels.size());
  for (Panel& panel : garment.panels) {
    panel.name = before + panel.name;
    panel.layer += first_layer;
    if (auto* on = std::get_if<OnCarrier>(&panel.placement)) on->carrier = before + on->carrier;
    all.panels.push_back(std::move(panel));
  }
  for (Seam& seam : garment.seams) {
    for (SeamSide& side : seam.sides) side.panel += first_panel;
    all.seams.push_back(seam);
  }
  for (Fastening& fastening : garment.fastenings) {
    fastening.name = before + fastening.name;
    for (PlaceOnPanel& place : fastening.places) place.panel += first_panel;
    all.fastenings.push_back(std::move(fastening));
  }
}

Pattern readList(const base::YamlValue& file) {
  file.requireKeys({"source", "garments"});
  const std::vector<base::YamlValue> items = file.at("garments").items();
  if (items.empty() || items.size() > kMostGarments) {
    file.at("garments")
        .refuseBecause("has " + std::to_string(items.size()) + " garments: allowed are 1 to " +
                       std::to_string(kMostGarments));
  }
  Pattern all;
  all.source = file.at("source").text();
  std::vector<std::string> paths;
  int layer = 0;
  for (const base::YamlValue& item : items) {
    const std::string path = pathOf(item);
    if (std::count(paths.begin(), paths.end(), path) > 0) item.refuse("is there twice");
    paths.push_back(path);
    Pattern garment = parsePattern(readPatternText(path), path);
    int highest = 0;
    for (const Panel& panel : garment.panels) highest = std::max(highest, panel.layer);
    add(std::move(garment), fs::path(path).stem().string(), layer, all);
    layer += highest + 1;
  }
  requireSound(all, file.file());
  return all;
}

/// Of a panel, as a group of an OBJ file can have it.
void makePlain(std::string& name) {
  for (char& c : name) {
    const auto code = static_cast<unsigned char>(c);
    if (code <= ' ' || code == 0x7f) c = '_';
  }
}

}  // namespace

Pattern loadOutfit(const std::string& path) {
  const std::string text = readPatternText(path);
  const auto file = base::YamlValue::parse(text, path, {kLargestPatternFile, kMostPatternValues});
  Pattern pattern =
      file.isMap() && file.has("garments") ? readList(file) : parsePattern(text, path);
  for (Panel& panel : pattern.panels) makePlain(panel.name);
  requireSound(pattern, path);
  return pattern;
}

}  // namespace haptex::garment
