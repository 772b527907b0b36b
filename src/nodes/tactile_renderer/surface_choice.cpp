#include "haptex/nodes/tactile_renderer/surface_choice.h"

#include <stdexcept>

#include "haptex/material/fabric_file.h"
#include "haptex/nodes/common/config_files.h"

namespace haptex::nodes {
namespace {

std::string withoutSurface(const FabricOfFile& read) {
  return "the fabric '" + read.fabric.name + "' has no surface: " + read.path +
         " needs the key surface";
}

FabricOfFile readFabric(const std::string& path) { return {material::loadFabric(path), path}; }

}  // namespace

SurfaceChoice::SurfaceChoice(const std::string& scene_fabric) : scene_fabric_(scene_fabric) {
  if (scene_fabric.empty()) {
    trouble_ = "no fabric is known yet: no message on cloth/mesh, and no parameter scene";
    return;
  }
  const FabricOfFile read = readFabric(scene_fabric);
  cloth_ = read.fabric.name;
  useIfAny(read);
}

bool SurfaceChoice::receiveCloth(const std::string& fabric) {
  if (fabric == cloth_) return false;
  cloth_ = fabric;
  asked_ = false;
  FabricOfFile read;
  read.fabric.name = fabric;
  try {
    read = fabricOfCloth(fabric, scene_fabric_);
    useIfAny(read);
  } catch (const std::exception& error) {
    useNone(read, "fabric '" + fabric + "': " + error.what());
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
