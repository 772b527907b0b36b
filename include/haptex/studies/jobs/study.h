// Studies that are computed in parts, on one machine or on several.
#pragma once

#include <cstddef>
#include <iosfwd>
#include <string>
#include <utility>
#include <vector>

namespace haptex::studies {

/// All that results depend on, by name, in the order in which files list it: a name is one word, a
/// value a line.
using StudyInputs = std::vector<std::pair<std::string, std::string>>;

/// Many units, each computed from its number alone: not from those before it, the job that it is
/// part of, threads or the time.
class Study {
 public:
  virtual ~Study() = default;

  /// One word, part of the names of files.
  virtual std::string name() const = 0;
  virtual std::size_t unitCount() const = 0;
  /// Without what inputsOfProgram() tells.
  virtual StudyInputs inputs() const = 0;
  /// The result of a unit: one line, not empty and the same in every run.
  virtual std::string run(std::size_t unit) const = 0;
  /// Writes what follows from all results, one quantity per line: name, value and unit with tabs
  /// between. @param records of run(), of all units in their order
  /// @throws std::invalid_argument naming a record that run() cannot have written
  virtual void summarise(const std::vector<std::string>& records, std::ostream& out) const = 0;
};

/// What results depend on beside a study's own inputs: `program`, a checksum of this program, of
/// the package's libraries that it has loaded and of the C library's mathematics, and
/// `instructions`, those of this processor that kernels choose by.
StudyInputs inputsOfProgram();

}  // namespace haptex::studies
