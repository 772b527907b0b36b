#include "haptex/nodes/common/cloth_fabric.h"

#include <stdexcept>
#include <string>

#include "haptex/material/fabric_file.h"

namespace haptex::nodes {
namespace {

void requireAtMost(const char* field, std::size_t bytes, std::size_t allowed) {
  if (bytes <= allowed) return;
  throw std::invalid_argument(std::string(field) + " has " + std::to_string(bytes) +
                              " bytes: allowed are up to " + std::to_string(allowed));
}

}  // namespace

material::Fabric fabricOfCloth(const haptex::ClothMesh& message) {
  if (message.fabrics.size() != 1 || message.fabric_files.size() != 1) {
    throw std::invalid_argument(
        "fabrics has " + std::to_string(message.fabrics.size()) + " elements and fabric_files " +
        std::to_string(message.fabric_files.size()) + ": allowed is one name and its file");
  }
  const std::string& name = message.fabrics[0];
  const std::string& file = message.fabric_files[0];
  requireAtMost("fabrics[0]", name.size(), kLongestFabricName);
  requireAtMost("fabric_files[0]", file.size(), kLongestFabricFile);
  material::Fabric fabric = material::parseFabric(file, "fabric '" + name + "' in cloth/mesh");
  if (fabric.name != name) {
    throw std::invalid_argument("fabric '" + name + "' in cloth/mesh: its file is of the fabric '" +
                                fabric.name + "'");
  }
  return fabric;
}

}  // namespace haptex::nodes
