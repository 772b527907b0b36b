// Prints the oracles of one room or of all, one quantity per line.
#include <cstdlib>
#include <exception>
#include <iostream>

#include "haptex/oracles/checks/validation.h"

int main(int argc, char** argv) {
  using namespace haptex;
  if (argc < 2 || argc > 3) {
    std::cerr << "usage: validate CONFIG_DIRECTORY [ROOM]\n";
    return EXIT_FAILURE;
  }
  const std::string asked = argc == 3 ? argv[2] : "";
  bool found = false, failed = false;
  try {
    for (const oracles::Validation& validation : oracles::validations()) {
      if (!asked.empty() && validation.room != asked) continue;
      found = true;
      validation.run(argv[1], [&](const base::Quantity& quantity) {
        print(std::cout, quantity);
        failed = failed || !quantity.pass();
      });
    }
  } catch (const std::exception& error) {
    std::cerr << "validate: " << error.what() << '\n';
    return EXIT_FAILURE;
  }
  if (!found) {
    std::cerr << "validate: no room '" << asked << "'; rooms with oracles:";
    for (const oracles::Validation& validation : oracles::validations())
      std::cerr << ' ' << validation.room;
    std::cerr << '\n';
  }
  return found && !failed ? EXIT_SUCCESS : EXIT_FAILURE;
}
