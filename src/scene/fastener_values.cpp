#include "haptex/scene/fastener_values.h"

#include <optional>
#include <set>
#include <string>

#include "haptex/base/require.h"
#include "haptex/cloth/forces/fasteners/place_in.h"
#include "haptex/mesh/rest_place.h"
#include "haptex/scene/scene_values.h"

namespace haptex::scene {
namespace {

using base::YamlValue;
using cloth::ClothPlace;

constexpr double kMostStiffness = 1e6;  // N/m
constexpr double kMostForce = 1e4;      // N

double readUpTo(const YamlValue& value, double most, const char* unit) {
  const double number = value.number();
  if (number > 0.0 && number <= most) return number;
  value.refuse("must be > 0 and <= " + base::shortNumber(most) + " " + unit);
}

ClothPlace readCoordinates(const YamlValue& value, const mesh::ClothMesh& mesh,
                           const std::vector<int>* group) {
  const std::vector<YamlValue> items = value.items(2);
  const Eigen::Vector2d rest(items[0].number(), items[1].number());
  const std::optional<mesh::RestPlace> place =
      group != nullptr ? mesh::findRestPlace(mesh, *group, rest) : mesh::findRestPlace(mesh, rest);
  if (!place) {
    value.refuseBecause("[" + base::shortNumber(rest.x()) + ", " + base::shortNumber(rest.y()) +
                        "] must be rest coordinates (m) within the cloth" +
                        (group != nullptr ? ", in this group" : ""));
  }
  return cloth::placeIn(mesh, *place);
}

ClothPlace readPlace(const YamlValue& value, const mesh::ClothMesh& mesh,
                     const mesh::MeshGroups& groups) {
  if (value.isMap()) {
    value.requireKeys({"group", "at"});
    return readCoordinates(value.at("at"), mesh, &readGroup(value.at("group"), groups));
  }
  if (!value.isList()) return ClothPlace{{readParticle(value, mesh), -1, -1}};
  if (!mesh.corner_coordinates.empty()) {
    value.refuse("must be a particle or {group: ..., at: [...]}: the mesh has seams");
  }
  return readCoordinates(value, mesh, nullptr);
}

cloth::FastenerKind readKind(const YamlValue& value) {
  const std::string kind = value.oneOf({"button", "hook", "elastic", "drawstring"});
  if (kind == "button") return cloth::FastenerKind::kButton;
  if (kind == "hook") return cloth::FastenerKind::kHook;
  return kind == "elastic" ? cloth::FastenerKind::kElastic : cloth::FastenerKind::kDrawstring;
}

cloth::Fastener readFastener(const YamlValue& value, const mesh::ClothMesh& mesh,
                             const mesh::MeshGroups& groups) {
  value.requireKeys({"name", "kind", "between", "stiffness", "release_force"},
                    {"length", "fastened"});
  cloth::Fastener fastener;
  fastener.name = readName(value.at("name"));
  fastener.kind = readKind(value.at("kind"));
  const bool drawstring = fastener.kind == cloth::FastenerKind::kDrawstring;
  const YamlValue between = value.at("between");
  for (const YamlValue& place : drawstring ? between.items() : between.items(2)) {
    fastener.places.push_back(readPlace(place, mesh, groups));
  }
  fastener.stiffness = readUpTo(value.at("stiffness"), kMostStiffness, "N/m");
  fastener.release_force = readUpTo(value.at("release_force"), kMostForce, "N");
  const bool has_length = drawstring || fastener.kind == cloth::FastenerKind::kElastic;
  if (value.has("length") != has_length) {
    value.refuseBecause(has_length
                            ? "is of a kind that has a length, and lacks the key length"
                            : "has the key length, which is allowed of the kinds elastic and "
                              "drawstring only");
  }
  if (has_length) fastener.length = readSize(value.at("length"));
  if (value.has("fastened")) {
    fastener.fastened = value.at("fastened").oneOf({"true", "false"}) == "true";
  }
  return fastener;
}

}  // namespace

std::vector<cloth::Fastener> readFasteners(const YamlValue& value, const mesh::ClothMesh& mesh,
                                           const mesh::MeshGroups& groups) {
  std::vector<cloth::Fastener> fasteners;
  std::set<std::string> names;
  for (const YamlValue& item : value.items()) {
    fasteners.push_back(readFastener(item, mesh, groups));
    if (!names.insert(fasteners.back().name).second) {
      item.at("name").refuse("is the name of another fastener, too");
    }
    try {  // what a cloth refuses is told with the place in the file
      cloth::Fasteners({fasteners.back()}, mesh.rest_coordinates.size(), 0.0);
    } catch (const std::invalid_argument& error) {
      item.refuseBecause(error.what());
    }
  }
  return fasteners;
}

bool nameParticles(const YamlValue& fasteners) {
  for (const YamlValue& item : fasteners.items()) {
    if (!item.isMap() || !item.has("between")) continue;
    for (const YamlValue& place : item.at("between").items()) {
      if (!place.isMap() && !place.isList()) return true;
    }
  }
  return false;
}

}  // namespace haptex::scene
