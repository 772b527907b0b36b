// A study whose units another program computes, one that is no C++.
#pragma once

#include <string>
#include <vector>

#include "haptex/studies/jobs/study.h"

namespace haptex::studies {

/// Calls a program with one of these after its arguments, which are the same each time:
///   describe    prints "units", then every input, by lines of a name, a tab and a value
///   run UNIT    prints the record of a unit, from 0 on: a line
///   summary     reads all records in their order, a line each, and prints what follows from them
/// It ends with status 0 unless it has said on standard error what is wrong.
class ScriptStudy final : public Study {
 public:
  /// @param command program, with its path, and arguments
  /// @throws std::runtime_error naming the call if it cannot be started, fails, or has printed
  ///   something else; so do run() and summarise()
  ScriptStudy(std::string name, std::vector<std::string> command);

  std::string name() const override { return name_; }
  std::size_t unitCount() const override { return units_; }
  StudyInputs inputs() const override { return inputs_; }
  std::string run(std::size_t unit) const override;
  void summarise(const std::vector<std::string>& records, std::ostream& out) const override;

 private:
  std::string name_;
  std::vector<std::string> command_;
  std::size_t units_ = 0;
  StudyInputs inputs_;
};

}  // namespace haptex::studies
