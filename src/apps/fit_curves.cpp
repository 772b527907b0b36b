// The program fit_curves: from a tester's readings to a fabric file, see docs/fit_curves.md. Needs
// no ROS master.
#include "haptex/material/fit_curves.h"

#include <iostream>
#include <string>
#include <vector>

int main(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  return haptex::material::fitCurves(arguments, std::cout, std::cerr);
}
