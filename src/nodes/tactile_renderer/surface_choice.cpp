#include "haptex/nodes/tactile_renderer/surface_choice.h"

#include <stdexcept>

#include "haptex/material/fabric_file.h"
#include "haptex/nodes/common/cloth_fabric.h"
#include "haptex/nodes/common/config_files.h"

namespace haptex::nodes {

std::string SurfaceChoice::withoutSurface(const FabricOfFile& read) {
  return "the fabric '" + read.fabric.name + "' has no surface: " + read.path +
         " needs the key surface";
}

SurfaceChoice::FabricOfFile SurfaceChoice::readFabric(const std::string& path) {
  return {material::loadFabric(path), path};
}

SurfaceChoice::SurfaceChoice(const std::string& scene_fabric) {
  if (scene_fabric.empty()) {
    trouble_ = "no fabric is known yet: no message on cloth/mesh, and no parameter scene";
    return;
  }
  const FabricOfFile read = readFabric(scene_fabric);
  cloth_names_ = {read.fabric.name};
  cloth_files_ = {read.fabric.file};
  useIfAny(read);
}

bool SurfaceChoice::receiveCloth(const haptex::ClothMesh& message) {
  if (message.fabrics == cloth_names_ && message.fabric_files == cloth_files_) return false;
  cloth_names_ = message.fabrics;
  cloth_files_ = message.fabric_files;
  asked_ = false;
  FabricOfFile read;
  if (!message.fabrics.empty()) read.fabric.name = message.fabrics.front();
  read.path = "its file, as in cloth/mesh,";
  try {
    read.fabric = fabricOfCloth(message);
    useIfAny(read);
  } catch (const std::exception& error) {
    useNone(read, error.what());
  }
  return true;
}

void SurfaceChoice::ask(const std::string& fabric) {
  const FabricOfFile read = readFabric(findConfigFile("fabrics", fabric));
  if (!read.fabric.surface) throw std::invalid_argument(withoutSurface(read));
  use(read);
  asked_ = true;
}

void SurfaceChoice::use(const FabricOfFile& read) {
  surface_ = tactile::buildSurface(read.fabric);
  values_ = read.fabric.surface;
  fabric_ = read.fabric.name;
  path_ = read.path;
  trouble_.clear();
}

void SurfaceChoice::useIfAny(const FabricOfFile& read) {
  if (read.fabric.surface) {
    use(read);
  } else {
    useNone(read, withoutSurface(read));
  }
}

void SurfaceChoice::useNone(const FabricOfFile& read, const std::string& why) {
  surface_.reset();
  values_.reset();
  fabric_ = read.fabric.name;
  path_ = read.path;
  trouble_ = why;
}

}  // namespace haptex::nodes
