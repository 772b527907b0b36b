// What became of many extreme cases.
#pragma once

#include <functional>
#include <map>
#include <string>

#include "haptex/studies/extreme_case.h"
#include "haptex/studies/extreme_outcome.h"

namespace haptex::studies {

/// Counts cases with implicit integrators, all together and by kind, and those with explicit ones.
/// The order in which cases are added does not matter.
class ExtremeTally {
 public:
  /// Is given the name of a quantity, its value and its unit.
  using Print = std::function<void(const std::string& name, double value, const char* unit)>;

  void add(const ExtremeCase& extreme, const ExtremeOutcome& outcome);

  long cases() const { return implicit_.cases + explicit_.cases; }
  long failures() const { return implicit_.failures + explicit_.failures; }

  /// @param name before each, with its slash: NAMEcases, NAMEKIND/cases, ...
  void print(const std::string& name, const Print& print) const;

 private:
  struct Counts {
    long cases = 0;
    long failures = 0;
    long other_rests = 0;
    long slow = 0;
    long unsettled = 0;
    long rejected = 0;
    double growth = 0.0;        // the worst
    double return_error = 0.0;  // likewise

    void add(const ExtremeOutcome& outcome);
    void print(const std::string& name, const Print& print) const;
  };

  Counts implicit_;
  Counts explicit_;
  std::map<std::string, Counts> by_kind_;
};

}  // namespace haptex::studies
