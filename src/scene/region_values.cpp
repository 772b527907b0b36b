#include "haptex/scene/region_values.h"

#include <algorithm>
#include <string>
#include <vector>

#include "haptex/base/quoted.h"
#include "haptex/base/require.h"
#include "haptex/scene/scene_values.h"

namespace haptex::scene {
namespace {

using base::YamlValue;
using Eigen::Vector2d;

/// A corner of a region (m), on the sheet.
Vector2d readCorner(const YamlValue& value, const Vector2d& size) {
  const double rounding = 1e-9 * size.norm();
  const std::vector<YamlValue> coordinates = value.items(2);
  Vector2d corner;
  for (int i = 0; i < 2; ++i) {
    corner[i] = coordinates[i].number();
    if (corner[i] >= 0.0 && corner[i] <= size[i] + rounding) continue;
    coordinates[i].refuse("must be from 0 to " + base::shortNumber(size[i]) +
                          " m, which the sheet measures");
  }
  return corner;
}

/// Of a cell of which the triangle is one half.
Vector2d middleOfCell(const mesh::ClothMesh& mesh, std::size_t triangle) {
  const auto& [a, b, c] = mesh.triangles[triangle];
  const std::vector<Vector2d>& rest = mesh.rest_coordinates;
  return 0.5 * (rest[a].cwiseMin(rest[b]).cwiseMin(rest[c]) +
                rest[a].cwiseMax(rest[b]).cwiseMax(rest[c]));
}

std::vector<int> readRectangle(const YamlValue& region, const mesh::ClothMesh& mesh) {
  region.requireKeys({"fabric", "from", "to"});
  const Vector2d& size = mesh.rest_coordinates.back();
  const Vector2d from = readCorner(region.at("from"), size);
  const Vector2d to = readCorner(region.at("to"), size);
  for (int i = 0; i < 2; ++i) {
    if (!(from[i] < to[i])) region.at("to").items(2)[i].refuse("must be > from");
  }
  std::vector<int> triangles;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vector2d middle = middleOfCell(mesh, t);
    const bool inside =
        (middle.array() >= from.array()).all() && (middle.array() < to.array()).all();
    if (inside) triangles.push_back(static_cast<int>(t));
  }
  if (triangles.empty()) {
    region.refuseBecause("has the middle of no cell within: it must be wider, or cells smaller");
  }
  return triangles;
}

const std::vector<int>& readRegionGroup(const YamlValue& region, const mesh::MeshGroups& groups) {
  region.requireKeys({"fabric", "group"});
  return readGroup(region.at("group"), groups);
}

/// Which of the cloth's fabrics; a new one is added.
int readFabric(const YamlValue& value, const std::string& fabric_path,
               std::vector<std::string>& paths) {
  const std::string path = resolveFile(value, "fabrics", ".yaml");
  if (path == fabric_path) {
    value.refuse("is the fabric of all that is in no region: a region must be of another");
  }
  const auto known = std::find(paths.begin(), paths.end(), path);
  const int fabric = 1 + static_cast<int>(known - paths.begin());
  if (known == paths.end()) paths.push_back(path);
  return fabric;
}

void requireKnown(const YamlValue& regions, const cloth::ModelledEffects& effects) {
  const auto refuse_with = [&](bool has, const std::string& what) {
    if (has) regions.refuseBecause("is not allowed " + what + ", which knows one fabric");
  };
  refuse_with(effects.bending_hysteresis, "if model lists bending_hysteresis");
  refuse_with(effects.elasticity == cloth::Elasticity::kMassSpring,
              "with the elasticity mass_spring");
}

}  // namespace

std::vector<std::string> readRegions(const YamlValue& file, const std::string& fabric_path,
                                     const cloth::ModelledEffects& effects,
                                     const mesh::MeshGroups& groups, mesh::ClothMesh& mesh) {
  const YamlValue value = file.at("regions");
  const std::vector<YamlValue> regions = value.items();
  if (regions.empty() || regions.size() > kMostRegions) {
    value.refuseBecause("has " + std::to_string(regions.size()) + " regions: allowed are 1 to " +
                        std::to_string(kMostRegions));
  }
  requireKnown(value, effects);
  const std::size_t triangles = mesh.triangles.size();
  std::vector<int> region_of(triangles, -1);
  mesh.triangle_fabrics.assign(triangles, 0);
  std::vector<std::string> paths;
  for (std::size_t r = 0; r < regions.size(); ++r) {
    const std::vector<int> members =
        file.has("sheet") ? readRectangle(regions[r], mesh) : readRegionGroup(regions[r], groups);
    const int fabric = readFabric(regions[r].at("fabric"), fabric_path, paths);
    for (const int triangle : members) {
      if (region_of[triangle] >= 0) {
        regions[r].refuseBecause("has triangle " + std::to_string(triangle) + ", which region " +
                                 std::to_string(region_of[triangle]) +
                                 " has, too: regions must not overlap");
      }
      region_of[triangle] = static_cast<int>(r);
      mesh.triangle_fabrics[triangle] = fabric;
    }
  }
  return paths;
}

}  // namespace haptex::scene
