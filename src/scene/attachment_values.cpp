#include "haptex/scene/attachment_values.h"

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "haptex/base/quoted.h"
#include "haptex/scene/scene_values.h"

namespace haptex::scene {
namespace {

using base::YamlValue;
using Eigen::Vector2d;

constexpr char kWorld[] = "";  // the name of no frame

mesh::Side readSide(const YamlValue& value) {
  const std::string side = value.oneOf({"top", "bottom", "left", "right"});
  if (side == "top") return mesh::Side::kTop;
  if (side == "bottom") return mesh::Side::kBottom;
  return side == "left" ? mesh::Side::kLeft : mesh::Side::kRight;
}

Vector2d readCoordinates(const YamlValue& value) {
  const std::vector<YamlValue> items = value.items(2);
  return {items[0].number(), items[1].number()};
}

/// Those with rest coordinates between two corners, both included.
std::vector<int> particlesBetween(const YamlValue& item, const mesh::ClothMesh& mesh) {
  const Vector2d from = readCoordinates(item.at("from"));
  const Vector2d to = readCoordinates(item.at("to"));
  const double rounding = 1e-9 * (1.0 + from.cwiseAbs().maxCoeff() + to.cwiseAbs().maxCoeff());
  std::vector<int> particles;
  for (std::size_t i = 0; i < mesh.rest_coordinates.size(); ++i) {
    const Vector2d& rest = mesh.rest_coordinates[i];
    const bool within = (rest.array() >= from.array() - rounding).all() &&
                        (rest.array() <= to.array() + rounding).all();
    if (within) particles.push_back(static_cast<int>(i));
  }
  if (particles.empty()) {
    item.refuseBecause("has no particle with rest coordinates (m) from 'from' to 'to'");
  }
  return particles;
}

void requireNoSeams(const YamlValue& item, const mesh::ClothMesh& mesh) {
  if (mesh.corner_coordinates.empty()) return;
  item.refuse("must be {particles: [...]}: the mesh has seams");
}

std::vector<int> readParticles(const YamlValue& item, const mesh::ClothMesh& mesh) {
  if (!item.isMap()) {
    requireNoSeams(item, mesh);
    return mesh::sideParticles(mesh, readSide(item));
  }
  item.requireKeys({}, {"particles", "side", "from", "to", "frame"});
  const int ways = item.has("particles") + item.has("side") + item.has("from");
  if (ways != 1) item.refuseBecause("must have exactly one of particles, side, from (with to)");
  if (item.has("particles")) {
    item.requireKeys({"particles"}, {"frame"});
    std::vector<int> particles;
    for (const YamlValue& particle : item.at("particles").items()) {
      particles.push_back(readParticle(particle, mesh));
    }
    return particles;
  }
  if (!mesh.corner_coordinates.empty()) {
    item.refuseBecause("must be {particles: [...]}: the mesh has seams");
  }
  if (item.has("side")) {
    item.requireKeys({"side"}, {"frame"});
    return mesh::sideParticles(mesh, readSide(item.at("side")));
  }
  item.requireKeys({"from", "to"}, {"frame"});
  return particlesBetween(item, mesh);
}

std::string readFrame(const YamlValue& item, const std::map<std::string, YamlValue>& frames) {
  if (!item.isMap() || !item.has("frame")) return kWorld;
  const YamlValue value = item.at("frame");
  const std::string name = value.text();
  if (frames.count(name) > 0) return name;
  std::string known;
  for (const auto& frame : frames) known += (known.empty() ? "" : ", ") + frame.first;
  value.refuse("must be one of the key frames: " +
               (known.empty() ? "there is none" : base::shortened(known)));
}

/// By name.
std::map<std::string, YamlValue> readFrames(const YamlValue& value) {
  std::map<std::string, YamlValue> frames;
  for (const YamlValue& item : value.items()) {
    item.requireKeys({"name"}, {"position", "rpy"});
    if (!frames.emplace(readName(item.at("name")), item).second) {
      item.at("name").refuse("is the name of another frame, too");
    }
  }
  return frames;
}

/// What carries each particle; kWorld: nothing, it is held.
std::map<int, std::string> readHolders(const YamlValue& attach, const mesh::ClothMesh& mesh,
                                       const std::map<std::string, YamlValue>& frames) {
  std::map<int, std::string> holders;
  for (const YamlValue& item : attach.items()) {
    const std::string frame = readFrame(item, frames);
    for (const int particle : readParticles(item, mesh)) {
      const auto [known, is_new] = holders.emplace(particle, frame);
      if (is_new || known->second == frame) continue;
      item.refuseBecause("attaches particle " + std::to_string(particle) +
                         ", which another item attaches elsewhere: allowed is one frame");
    }
  }
  return holders;
}

}  // namespace

Attachments readAttachments(const YamlValue& file, const mesh::ClothMesh& mesh) {
  std::map<std::string, YamlValue> listed;
  if (file.has("frames")) listed = readFrames(file.at("frames"));
  Attachments attachments;
  std::map<std::string, CarryingFrame> frames;
  for (const auto& [particle, frame] : readHolders(file.at("attach"), mesh, listed)) {
    attachments.particles.push_back(particle);
    if (frame != kWorld) frames[frame].particles.push_back(particle);
  }
  for (const auto& [name, value] : listed) {
    const auto found = frames.find(name);
    if (found == frames.end()) value.refuseBecause("carries nothing: attach must name it");
    CarryingFrame& frame = found->second;
    frame.name = name;
    frame.start = readPose(value);
    for (const int particle : frame.particles) {
      frame.places.push_back(frame.start.inverse() * mesh.initial_positions[particle]);
    }
    attachments.frames.push_back(std::move(frame));
  }
  return attachments;
}

}  // namespace haptex::scene
