#include "haptex/nodes/tactile_renderer/sound_request.h"

#include <cmath>
#include <map>
#include <stdexcept>

namespace haptex::nodes {

const char* const kSoundUsage =
    "usage: tactile_sound FABRIC OUT.wav [--speed MM/S] [--angle DEG] [--force N] [--seconds S]\n"
    "       tactile_sound --bag BAG --finger FINGER --contactor N OUT.wav\n"
    "Writes what a contactor of the tactile array drives as sound: a fabric that is rubbed to and\n"
    "fro, by its name or its file (50 mm/s, along weft, 0.5 N, 4 s), or what was recorded from\n"
    "FINGER/tactile. 50 micrometres are full scale.\n";

namespace {

using Options = std::map<std::string, std::string>;

double numberOf(const std::string& option, const std::string& text) {
  std::size_t read = 0;
  double number = 0.0;
  try {
    number = std::stod(text, &read);
  } catch (const std::logic_error&) {
    read = 0;  // not a number, or none that fits
  }
  if (read == 0 || read != text.size()) {
    throw std::invalid_argument(option + " " + text + ": allowed are numbers");
  }
  return number;
}

/// Sets the number if the option is there, and takes it away.
void take(Options& options, const std::string& option, double unit, double& number) {
  const auto found = options.find(option);
  if (found == options.end()) return;
  number = unit * numberOf(option, found->second);
  options.erase(found);
}

std::string takeNeeded(Options& options, const std::string& option) {
  const auto found = options.find(option);
  if (found == options.end()) throw std::invalid_argument(option + " is missing");
  const std::string text = found->second;
  options.erase(found);
  return text;
}

int contactorOf(const std::string& text) {
  const double number = numberOf("--contactor", text);
  if (!(number >= 0.0 && number < tactile::kContactors && number == std::floor(number))) {
    throw std::invalid_argument("--contactor " + text + ": allowed are whole numbers from 0 to " +
                                std::to_string(tactile::kContactors - 1));
  }
  return static_cast<int>(number);
}

void requireCount(const std::vector<std::string>& words, std::size_t count, const char* what) {
  if (words.size() == count) return;
  throw std::invalid_argument(std::to_string(words.size()) + " file names: " + what);
}

}  // namespace

SoundRequest parseSoundRequest(const std::vector<std::string>& arguments) {
  Options options;
  std::vector<std::string> words;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    if (arguments[i].rfind("--", 0) != 0) {
      words.push_back(arguments[i]);
      continue;
    }
    if (i + 1 == arguments.size()) throw std::invalid_argument(arguments[i] + " needs a value");
    if (!options.emplace(arguments[i], arguments[i + 1]).second) {
      throw std::invalid_argument(arguments[i] + " is there twice");
    }
    ++i;
  }
  SoundRequest request;
  if (options.count("--bag") > 0) {
    RecordedSound recorded;
    recorded.bag = takeNeeded(options, "--bag");
    recorded.finger = takeNeeded(options, "--finger");
    recorded.contactor = contactorOf(takeNeeded(options, "--contactor"));
    requireCount(words, 1, "with --bag it takes one, that of the sound");
    request = {recorded, words[0]};
  } else {
    requireCount(words, 2, "it takes a fabric and a sound");
    FabricSound rubbed;
    rubbed.fabric = words[0];
    take(options, "--speed", 1e-3, rubbed.rubbing.speed);
    take(options, "--angle", M_PI / 180.0, rubbed.rubbing.angle);
    take(options, "--force", 1.0, rubbed.rubbing.force);
    take(options, "--seconds", 1.0, rubbed.rubbing.seconds);
    request = {rubbed, words[1]};
  }
  if (!options.empty()) {
    throw std::invalid_argument(options.begin()->first +
                                " is unknown or does not go with the rest");
  }
  return request;
}

}  // namespace haptex::nodes
