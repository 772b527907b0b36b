// The program virtual_kes: the KES tests on a simulated fabric, see docs/virtual_kes.md.
#include "haptex/kes/virtual_kes.h"

#include <exception>
#include <iostream>
#include <string>

#include "haptex/material/fabric_file.h"
#include "haptex/nodes/common/config_files.h"

namespace {

constexpr const char* kUsage =
    "usage: virtual_kes FABRIC [tensile|shear|bending|compression|surface]\n"
    "FABRIC is the name of a fabric of the package or the path of a fabric file.\n";

}  // namespace

int main(int argc, char** argv) {
  const std::string fabric = argc > 1 ? argv[1] : "";
  if (fabric == "--help") {
    std::cout << kUsage;
    return 0;
  }
  if (argc < 2 || argc > 3) {
    std::cerr << kUsage;
    return 2;
  }
  try {
    const std::string path = haptex::nodes::findConfigFile("fabrics", fabric);
    haptex::kes::printKes(haptex::material::loadFabric(path), argc == 3 ? argv[2] : "", std::cout);
  } catch (const std::exception& error) {
    std::cerr << "virtual_kes: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
