// The program fabric_relief: the relief of a fabric as pictures, see docs/pictures.md.
#include <iostream>
#include <limits>
#include <stdexcept>
#include <string>

#include "haptex/base/command_line.h"
#include "haptex/base/quoted.h"
#include "haptex/material/fabric_file.h"
#include "haptex/nodes/common/config_files.h"
#include "haptex/tactile/relief_picture.h"

namespace {

using namespace haptex;

constexpr const char* kUsage =
    "usage: fabric_relief FABRIC HEIGHTS.png YARNS.png\n"
    "Writes a piece of the fabric's surface that continues at its opposite edges, and which yarns "
    "are seen\n"
    "there (white: warp). FABRIC is the name of a fabric of the package or the path of a fabric "
    "file.\n";

void writeRelief(const std::string& name, const std::string& heights, const std::string& yarns) {
  const material::Fabric fabric = material::loadFabric(nodes::findConfigFile("fabrics", name));
  if (!fabric.surface) {
    throw std::invalid_argument("fabric " + base::quoted(fabric.name) +
                                " has no surface: the key surface says how its yarns lie");
  }
  const tactile::FaceRelief relief = tactile::faceRelief(*fabric.surface);
  const double height = tactile::writeHeights(relief.heights, heights);
  tactile::writeYarns(relief, yarns);
  std::cout.precision(std::numeric_limits<double>::max_digits10);
  // m, between samples along weft and warp, and of white above black.
  std::cout << "weft_spacing: " << relief.heights.weft_spacing
            << "\nwarp_spacing: " << relief.heights.warp_spacing << "\nheight: " << height << '\n';
}

}  // namespace

int main(int argc, char** argv) {
  return base::runPlainProgram(
      "fabric_relief", kUsage, {argv + 1, argv + argc}, 3, 3,
      [](const auto& arguments) { writeRelief(arguments[0], arguments[1], arguments[2]); });
}
