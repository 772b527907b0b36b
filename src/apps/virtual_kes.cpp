// The program virtual_kes: the KES tests on a simulated fabric, see docs/virtual_kes.md.
#include "haptex/kes/virtual_kes.h"

#include <iostream>
#include <string>

#include "haptex/base/command_line.h"
#include "haptex/material/fabric_file.h"
#include "haptex/nodes/common/config_files.h"

namespace {

constexpr const char* kUsage =
    "usage: virtual_kes FABRIC [tensile|shear|bending|compression|surface]\n"
    "FABRIC is the name of a fabric of the package or the path of a fabric file.\n";

}  // namespace

int main(int argc, char** argv) {
  return haptex::base::runPlainProgram(
      "virtual_kes", kUsage, {argv + 1, argv + argc}, 1, 2, [](const auto& arguments) {
        const std::string path = haptex::nodes::findConfigFile("fabrics", arguments[0]);
        haptex::kes::printKes(haptex::material::loadFabric(path),
                              arguments.size() > 1 ? arguments[1] : "", std::cout);
      });
}
