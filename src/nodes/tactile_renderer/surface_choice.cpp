#include "haptex/nodes/tactile_renderer/surface_choice.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "haptex/base/quoted.h"
#include "haptex/material/fabric_file.h"
#include "haptex/nodes/common/cloth_fabric.h"
#include "haptex/nodes/common/config_files.h"

namespace haptex::nodes {

std::string SurfaceChoice::withoutSurface(const FabricOfFile& read) {
  return "the fabric " + base::quoted(read.fabric.name) + " has no surface: " + read.path +
         " needs the key surface";
}

SurfaceChoice::FabricOfFile SurfaceChoice::readFabric(const std::string& path) {
  return {material::loadFabric(path), path};
}

SurfaceChoice::SurfaceChoice(const std::string& scene_fabric) {
  if (scene_fabric.empty()) {
    choices_ = {
        none({}, "no fabric is known yet: no message on cloth/mesh, and no parameter scene")};
    return;
  }
  const FabricOfFile read = readFabric(scene_fabric);
  cloth_names_ = {read.fabric.name};
  cloth_files_ = {read.fabric.file};
  choices_ = {chosenIfAny(read)};
}

bool SurfaceChoice::receiveCloth(const haptex::ClothMesh& message) {
  if (message.fabrics == cloth_names_ && message.fabric_files == cloth_files_) return false;
  cloth_names_ = message.fabrics;
  cloth_files_ = message.fabric_files;
  asked_ = false;
  choices_.clear();
  try {
    requireFabrics(message);
    for (std::size_t i = 0; i < message.fabrics.size(); ++i) {
      choices_.push_back(ofCloth(message, i));
    }
  } catch (const std::exception& error) {
    choices_ = {none({}, error.what())};
  }
  return true;
}

SurfaceChoice::Choice SurfaceChoice::ofCloth(const haptex::ClothMesh& message, std::size_t index) {
  FabricOfFile read;
  read.fabric.name = message.fabrics[index];
  read.path = "its file, as in cloth/mesh,";
  try {
    read.fabric = fabricOfCloth(message, index);
    return chosenIfAny(read);
  } catch (const std::exception& error) {
    return none(read, error.what());
  }
}

void SurfaceChoice::ask(const std::string& fabric) {
  const FabricOfFile read = readFabric(findConfigFile("fabrics", fabric));
  if (!read.fabric.surface) throw std::invalid_argument(withoutSurface(read));
  Choice choice = chosen(read);
  choices_.clear();
  choices_.push_back(std::move(choice));
  asked_ = true;
}

const tactile::Surface* SurfaceChoice::surface(std::size_t fabric) const {
  const std::size_t index = asked_ ? 0 : fabric;
  if (index >= choices_.size() || !choices_[index].surface) return nullptr;
  return &*choices_[index].surface;
}

const std::string& SurfaceChoice::trouble() const {
  const auto troubled = std::find_if(choices_.begin(), choices_.end(),
                                     [](const Choice& choice) { return !choice.trouble.empty(); });
  return (troubled == choices_.end() ? choices_.front() : *troubled).trouble;
}

std::string SurfaceChoice::fabric() const {
  std::string names;
  for (const Choice& choice : choices_) names += (names.empty() ? "" : ", ") + choice.fabric;
  return names;
}

SurfaceChoice::Choice SurfaceChoice::chosen(const FabricOfFile& read) {
  return {tactile::buildSurface(read.fabric), read.fabric.surface, read.fabric.name, read.path, ""};
}

SurfaceChoice::Choice SurfaceChoice::none(const FabricOfFile& read, const std::string& why) {
  return {std::nullopt, std::nullopt, read.fabric.name, read.path, why};
}

SurfaceChoice::Choice SurfaceChoice::chosenIfAny(const FabricOfFile& read) {
  return read.fabric.surface ? chosen(read) : none(read, withoutSurface(read));
}

}  // namespace haptex::nodes
