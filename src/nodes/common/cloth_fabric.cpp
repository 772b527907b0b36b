#include "haptex/nodes/common/cloth_fabric.h"

#include <stdexcept>
#include <string>
#include <utility>

#include "haptex/base/quoted.h"
#include "haptex/material/fabric_factors.h"
#include "haptex/material/fabric_file.h"

namespace haptex::nodes {
namespace {

void requireAtMost(const std::string& field, std::size_t bytes, std::size_t allowed) {
  if (bytes <= allowed) return;
  throw std::invalid_argument(field + " has " + std::to_string(bytes) +
                              " bytes: allowed are up to " + std::to_string(allowed));
}

material::FabricFactors factorsOf(const haptex::ClothMesh& message) {
  const std::vector<double>& factors = message.factors;
  if (factors.empty()) return {};
  if (factors.size() != 5) {
    throw std::invalid_argument("factors has " + std::to_string(factors.size()) +
                                " elements: allowed are 5, or none");
  }
  return {factors[0], factors[1], factors[2], factors[3], factors[4]};
}

}  // namespace

void requireFabrics(const haptex::ClothMesh& message) {
  const std::size_t names = message.fabrics.size(), files = message.fabric_files.size();
  if (names >= 1 && names <= mesh::kMostFabrics && files == names) return;
  throw std::invalid_argument("fabrics has " + std::to_string(names) +
                              " elements and fabric_files " + std::to_string(files) +
                              ": allowed are 1 to " + std::to_string(mesh::kMostFabrics) +
                              " names, and for each its file");
}

std::vector<material::Fabric> fabricsOfCloth(const haptex::ClothMesh& message) {
  requireFabrics(message);
  std::vector<material::Fabric> fabrics;
  for (std::size_t i = 0; i < message.fabrics.size(); ++i) {
    fabrics.push_back(fabricOfCloth(message, i));
  }
  return fabrics;
}

material::Fabric fabricOfCloth(const haptex::ClothMesh& message, std::size_t index) {
  const std::string& name = message.fabrics[index];
  const std::string& file = message.fabric_files[index];
  const std::string place = "[" + std::to_string(index) + "]";
  requireAtMost("fabrics" + place, name.size(), kLongestFabricName);
  requireAtMost("fabric_files" + place, file.size(), kLongestFabricFile);
  material::Fabric fabric =
      material::parseFabric(file, "fabric " + base::quoted(name) + " in cloth/mesh");
  if (fabric.name != name) {
    throw std::invalid_argument("fabric " + base::quoted(name) +
                                " in cloth/mesh: its file is of the fabric " +
                                base::quoted(fabric.name));
  }
  return material::scaledBy(factorsOf(message), std::move(fabric));
}

}  // namespace haptex::nodes
