#include "haptex/base/quantity.h"

#include <cmath>
#include <iomanip>
#include <ostream>
#include <utility>

namespace haptex::base {

double largerOrNaN(double a, double b) {
  if (std::isnan(a)) return a;
  return b <= a ? a : b;
}

void keepWorse(Quantity& worst, const Quantity& candidate) {
  if (std::isnan(worst.error)) return;
  if (!(candidate.error < worst.error)) worst = candidate;
}

Quantity relativeTo(double scale, std::string name, double exact, double measured,
                    double tolerance) {
  return {std::move(name), exact, measured, std::abs(measured - exact) / std::abs(scale),
          tolerance};
}

void print(std::ostream& out, const Quantity& quantity) {
  out << quantity.name << '\t' << std::setprecision(10) << quantity.exact << '\t'
      << quantity.measured << '\t' << std::setprecision(3) << quantity.error << '\t'
      << quantity.tolerance << '\t' << (quantity.pass() ? "pass" : "FAIL") << std::endl;
}

}  // namespace haptex::base
