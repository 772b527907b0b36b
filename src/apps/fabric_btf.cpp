// The program fabric_btf: the bidirectional texture function of a fabric, see docs/appearance.md.
#include <iostream>
#include <stdexcept>
#include <string>

#include "haptex/appearance/brdf.h"
#include "haptex/appearance/btf_file.h"
#include "haptex/appearance/btf_measures.h"
#include "haptex/base/command_line.h"
#include "haptex/base/quoted.h"
#include "haptex/material/fabric_file.h"
#include "haptex/nodes/common/config_files.h"

namespace {

using namespace haptex;

constexpr const char* kUsage =
    "usage: fabric_btf FABRIC OUT.btf\n"
    "Computes how a fabric reflects light from any direction into any other at every place, writes "
    "it,\n"
    "and prints how true it is. FABRIC is the name of a fabric of the package or the path of a "
    "fabric\n"
    "file.\n";

// docs/appearance.md has what others measure.
constexpr appearance::BtfSize kSize{256, 256, {96, 64, 32}};
constexpr unsigned kSeed = 1;

void make(const std::string& name, const std::string& path) {
  const material::Fabric fabric = material::loadFabric(nodes::findConfigFile("fabrics", name));
  if (!fabric.surface || !fabric.look) {
    throw std::invalid_argument("fabric " + base::quoted(fabric.name) +
                                (fabric.surface
                                     ? " has no look: the key look says what colours its yarns have"
                                     : " has no surface: the key surface says how its yarns lie"));
  }
  const tactile::FaceRelief relief = tactile::faceRelief(*fabric.surface);
  const appearance::ReliefSurface surface(relief, kSize.columns, kSize.rows);
  const appearance::Interreflection light(surface, *fabric.look);
  const appearance::Btf btf = appearance::makeBtf(light, kSize.compression);
  std::cout << "file: " << appearance::writeBtf(btf, path) << " bytes, " << kSize.columns << " x "
            << kSize.rows << " texels" << std::endl;
  const appearance::Difference error =
      appearance::unsampledError(btf, light, {48, 32, 1, 1, kSeed});
  std::cout << "error: " << error.of_mean << " of the mean radiance, " << error.of_root_square
            << " of its root mean square" << std::endl;
  std::cout << "reciprocity: " << appearance::reciprocityError(btf, {192, 32, 1, 1, kSeed})
            << std::endl;
  std::cout << "mean over the repeat between sampled directions: "
            << appearance::meanError(btf, appearance::meanOverRepeat(btf), {48, 64, 1, 1, kSeed})
            << std::endl;
  material::Look white = *fabric.look;
  white.warp = white.weft = {1.0, 1.0, 1.0};
  const appearance::Btf of_white =
      appearance::makeBtf(appearance::Interreflection(surface, white), kSize.compression);
  std::cout << "furnace: " << appearance::furnaceError(of_white, {8, 1, 96, 6, kSeed}) << std::endl;
}

}  // namespace

int main(int argc, char** argv) {
  return base::runPlainProgram("fabric_btf", kUsage, {argv + 1, argv + argc}, 2, 2,
                               [](const auto& arguments) { make(arguments[0], arguments[1]); });
}
