#include "haptex/material/fabric_file.h"

#include <yaml-cpp/yaml.h>

#include <filesystem>
#include <stdexcept>
#include <variant>
#include <vector>

#include "haptex/base/yaml_reader.h"
#include "haptex/material/fabric_values.h"
#include "haptex/material/glued_layers.h"

namespace haptex::material {
namespace {

/// With the whole path of the file of heights, if there is one.
YAML::Node readableAnywhere(YAML::Node values, const Fabric& fabric) {
  const HeightFile* heights =
      fabric.surface ? std::get_if<HeightFile>(&fabric.surface->relief) : nullptr;
  if (heights != nullptr) {
    values["surface"]["heights"]["file"] = std::filesystem::absolute(heights->path).string();
  }
  return values;
}

std::string readableAnywhere(const std::string& text, const Fabric& fabric) {
  const bool names_a_file =
      fabric.surface && std::holds_alternative<HeightFile>(fabric.surface->relief);
  return names_a_file ? YAML::Dump(readableAnywhere(YAML::Load(text), fabric)) : text;
}

/// A layer, as a map, and what it says.
struct Layer {
  YAML::Node values;
  Fabric fabric;
};

/// Of a map as a fabric file is one, or of the path of such a file.
Layer readLayer(const base::YamlValue& layer, const YAML::Node& node) {
  if (layer.isMap()) {
    const Fabric fabric = readFabricValues(layer);
    return {readableAnywhere(YAML::Clone(node), fabric), fabric};
  }
  const std::filesystem::path path =
      std::filesystem::path(layer.file()).parent_path() / layer.text();
  try {
    const std::string text = base::readTextFile(path.string());
    const Fabric fabric = readFabricValues(base::YamlValue::parse(text, path.string()));
    return {readableAnywhere(YAML::Load(text), fabric), fabric};
  } catch (const std::exception& error) {
    layer.refuseBecause(std::string("is no fabric that can be glued: ") + error.what());
  }
}

/// Its text has the layers in it, so that it can be read where their files are not.
Fabric readGlued(const base::YamlValue& file, const std::string& text) {
  file.requireKeys({"name", "layers"}, {"description"});
  const base::YamlValue list = file.at("layers");
  const std::vector<base::YamlValue> items = list.items();
  YAML::Node values = YAML::Load(text);
  std::vector<Fabric> layers;
  for (std::size_t i = 0; i < items.size(); ++i) {
    const Layer layer = readLayer(items[i], values["layers"][i]);
    values["layers"][i] = layer.values;
    layers.push_back(layer.fabric);
  }
  Fabric fabric;
  try {
    fabric = glue(layers, file.at("name").text());
  } catch (const std::invalid_argument& error) {
    list.refuseBecause(error.what());
  }
  if (file.has("description")) fabric.description = file.at("description").text();
  fabric.file = YAML::Dump(values);
  return fabric;
}

}  // namespace

Fabric loadFabric(const std::string& path) { return parseFabric(base::readTextFile(path), path); }

Fabric parseFabric(const std::string& text, const std::string& name) {
  const base::YamlValue file = base::YamlValue::parse(text, name);
  if (file.isMap() && file.has("layers")) return readGlued(file, text);
  Fabric fabric = readFabricValues(file);
  fabric.file = readableAnywhere(text, fabric);
  return fabric;
}

}  // namespace haptex::material
