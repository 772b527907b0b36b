// The program preposition: lays the panels of a garment around a body, see docs/bodies.md. Needs no
// ROS master.
#include <iostream>
#include <string>
#include <vector>

#include "haptex/garment/placement/preposition_program.h"

int main(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  return haptex::garment::prepositionProgram(arguments, std::cout, std::cerr);
}
