// One checked quantity of a validation: what is exact, what was measured, and the verdict.
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

namespace haptex::base {

/// A measured number beside the exact one. `error` is what `tolerance` bounds; the name says
/// of what: it is relative unless it ends in "_N" or the like.
struct Quantity {
  std::string name;
  double exact;
  double measured;
  double error;
  double tolerance;

  /// False for an error that is not a number.
  bool pass() const { return error <= tolerance; }
};

/// The larger number, or NaN if either is one: what std::max() would hide must fail a check.
double largerOrNaN(double a, double b);

/// Keeps the quantity with the larger error in `worst`, or the first whose error is NaN.
void keepWorse(Quantity& worst, const Quantity& candidate);

/// error = |measured - exact| / |scale|.
Quantity relativeTo(double scale, std::string name, double exact, double measured,
                    double tolerance);

/// Writes "name exact measured error tolerance pass|FAIL", separated by tabs, and flushes, so that
/// a reader sees progress.
void print(std::ostream& out, const Quantity& quantity);

}  // namespace haptex::base
