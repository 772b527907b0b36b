// Prints the oracles of one room or of all, one quantity per line, then those at random.
#include <cstdint>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <limits>
#include <optional>
#include <random>
#include <stdexcept>
#include <string>

#include "haptex/base/quoted.h"
#include "haptex/oracles/checks/random_checks.h"
#include "haptex/oracles/checks/validation.h"

namespace {

using namespace haptex;

struct Arguments {
  std::string config_directory, room;
  std::uint64_t seed;
};

std::uint64_t seedOf(const std::string& text) {
  constexpr std::size_t kDigits = std::numeric_limits<std::uint64_t>::digits10;
  if (text.empty() || text.size() > kDigits ||
      text.find_first_not_of("0123456789") != std::string::npos) {
    throw std::invalid_argument("--seed is " + base::quoted(text) +
                                "; it must be a whole number of up to " + std::to_string(kDigits) +
                                " digits");
  }
  return std::stoull(text);
}

/// Nothing if they are not what usage says.
std::optional<Arguments> parse(int argc, char** argv) {
  Arguments arguments{"", "", std::random_device{}()};
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    const bool option = !argument.empty() && argument.front() == '-';
    if (argument == "--seed") {
      if (++i == argc) return std::nullopt;
      arguments.seed = seedOf(argv[i]);
    } else if (!option && arguments.config_directory.empty()) {
      arguments.config_directory = argument;
    } else if (!option && arguments.room.empty()) {
      arguments.room = argument;
    } else {
      return std::nullopt;
    }
  }
  if (arguments.config_directory.empty()) return std::nullopt;
  return arguments;
}

bool known(const std::string& room) {
  for (const oracles::Validation& validation : oracles::validations()) {
    if (room.empty() || validation.room == room) return true;
  }
  std::cerr << "validate: no room " << base::quoted(room) << "; rooms with oracles:";
  for (const oracles::Validation& validation : oracles::validations())
    std::cerr << ' ' << validation.room;
  std::cerr << '\n';
  return false;
}

/// Whether all pass; what does not is told with the command that repeats it.
bool validate(const Arguments& arguments) {
  bool failed = false;
  std::cout << "seed\t" << arguments.seed << std::endl;
  const auto for_each_room = [&](const auto& run) {
    for (const oracles::Validation& validation : oracles::validations()) {
      if (arguments.room.empty() || validation.room == arguments.room) run(validation);
    }
  };
  for_each_room([&](const oracles::Validation& validation) {
    int failures = 0;
    validation.run(arguments.config_directory, [&](const base::Quantity& quantity) {
      print(std::cout, quantity);
      failures += !quantity.pass();
    });
    if (failures == 0) return;
    failed = true;
    std::cerr << "validate: " << failures << " of the fixed cases of " << validation.room
              << " fail; again: scripts/validate --seed " << arguments.seed << ' '
              << validation.room << std::endl;
  });
  for_each_room([&](const oracles::Validation& validation) {
    failed = !oracles::printAtRandom(validation.room, arguments.seed, arguments.config_directory,
                                     std::cout, std::cerr) ||
             failed;
  });
  return !failed;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const std::optional<Arguments> arguments = parse(argc, argv);
    if (!arguments) {
      std::cerr << "usage: validate CONFIG_DIRECTORY [--seed S] [ROOM]\n";
      return EXIT_FAILURE;
    }
    return known(arguments->room) && validate(*arguments) ? EXIT_SUCCESS : EXIT_FAILURE;
  } catch (const std::exception& error) {
    std::cerr << "validate: " << error.what() << '\n';
    return EXIT_FAILURE;
  }
}
