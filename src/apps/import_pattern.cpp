// The program import_pattern: from a pattern in JSON or DXF to a garment file, see
// docs/garments.md. Needs no ROS master.
#include "haptex/garment/importers/import_pattern.h"

#include <iostream>
#include <string>
#include <vector>

int main(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  return haptex::garment::importPattern(arguments, std::cout, std::cerr);
}
