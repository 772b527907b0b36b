#include "haptex/scene/cloth_state_file.h"

#include <cmath>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "haptex/base/file_size.h"
#include "haptex/base/parse_number.h"
#include "haptex/base/quoted.h"
#include "haptex/base/require.h"
#include "haptex/base/whole_file.h"
#include "haptex/proximity/cursor.h"

namespace haptex::scene {
namespace {

using base::refuse;
using Eigen::Vector3d;
namespace fs = std::filesystem;

constexpr double kLargest = proximity::kMaxLength;  // m, m/s and s
constexpr char kTitle[] = "haptex cloth state";

/// The shortest text that is read back as the same number.
void append(std::string& text, double number) {
  char digits[32];
  const std::to_chars_result end = std::to_chars(digits, digits + sizeof(digits), number);
  text.append(digits, end.ptr);
}

void append(std::string& text, const Vector3d& vector) {
  for (int axis = 0; axis < 3; ++axis) {
    if (axis > 0) text += ' ';
    append(text, vector[axis]);
  }
}

std::string textOf(const std::string& path, const cloth::ClothState& state) {
  std::string text = std::string(kTitle) + "\nparticles " + std::to_string(state.positions.size());
  text += "\ntime ";
  append(text, state.time);
  text += "\n# of each particle in the world frame: x y z (m), vx vy vz (m/s)\n";
  for (std::size_t i = 0; i < state.positions.size(); ++i) {
    if (!proximity::isPlace(state.positions[i]) || !proximity::isPlace(state.velocities[i])) {
      refuse(path, ": particle ", i,
             " has a position or a velocity that is not allowed in a file: ",
             "finite numbers up to ", kLargest, " are");
    }
    append(text, state.positions[i]);
    text += "  ";
    append(text, state.velocities[i]);
    text += '\n';
  }
  return text;
}

/// Lines of words, without comments and what is blank.
class StateReader {
 public:
  explicit StateReader(const std::string& path) : path_(path), stream_(path) {
    std::error_code error;
    if (!stream_.is_open() || fs::is_directory(path, error)) {
      throw std::runtime_error(base::shortened(path) +
                               ": cannot be read, must be a file of a state of a cloth");
    }
    base::requireFileSize(path, kLargestStateFile);  // before a line is held
  }

  cloth::ClothState read() {
    if (!readLine() || line_ != kTitle) refuseLine(std::string("must be '") + kTitle + "'");
    const double particles = readValue("particles");
    cloth::ClothState state;
    state.time = readValue("time");
    while (readLine()) {
      if (static_cast<double>(state.positions.size()) >= particles) {
        refuseLine("one particle more than the " + base::shortNumber(particles) +
                   " that the file says");
      }
      if (words_.size() != 6) {
        refuseLine("has " + std::to_string(words_.size()) +
                   " words, must be 6 numbers: position (m) and velocity (m/s) of a particle");
      }
      state.positions.emplace_back(number(0), number(1), number(2));
      state.velocities.emplace_back(number(3), number(4), number(5));
    }
    if (stream_.bad()) throw std::runtime_error(path_ + ": cannot be read to its end");
    if (static_cast<double>(state.positions.size()) != particles) {
      refuse(path_, ": has lines of ", state.positions.size(), " particles, must have ", particles,
             " as it says");
    }
    return state;
  }

 private:
  [[noreturn]] void refuseLine(const std::string& what) const {
    refuse(path_, ": line ", line_number_, ": ", what);
  }

  /// @return whether there is one
  bool readLine() {
    words_.clear();
    while (words_.empty() && std::getline(stream_, line_)) {
      ++line_number_;
      std::istringstream words(line_.substr(0, line_.find('#')));
      for (std::string word; words >> word;) words_.push_back(word);
    }
    return !words_.empty();
  }

  /// The next line: a word and a number >= 0.
  double readValue(const std::string& word) {
    const bool has = readLine() && words_.size() == 2 && words_[0] == word;
    if (!has || number(1) < 0.0) refuseLine("must be '" + word + "' and a number >= 0");
    return number(1);
  }

  double number(std::size_t index) const {
    const std::string& word = words_[index];
    const std::optional<double> value = base::parseNumber<double>(word);
    if (!value || !(std::abs(*value) <= kLargest)) {
      refuseLine(base::quoted(word) + " must be a finite number up to " +
                 base::shortNumber(kLargest));
    }
    return *value;
  }

  const std::string& path_;
  std::ifstream stream_;
  std::string line_;
  std::vector<std::string> words_;
  int line_number_ = 0;
};

}  // namespace

void saveState(const std::string& path, const cloth::ClothState& state) {
  const fs::path target(path);
  if (!target.is_absolute() || target.extension() != kStateExtension) {
    refuse("path = ", base::quoted(path), ": allowed are absolute paths that end with ",
           kStateExtension);
  }
  base::writeWholeFile(path, textOf(path, state));
}

cloth::ClothState loadState(const std::string& path) { return StateReader(path).read(); }

}  // namespace haptex::scene
