#include "haptex/base/require.h"

#include <sstream>

namespace haptex::base {

void require(bool holds, const char* where, const char* name, double value,
             const std::string& allowed) {
  if (!holds) refuse(where, ": ", name, " is ", shortNumber(value), "; it must be ", allowed);
}

std::string shortNumber(double value) {
  std::ostringstream text;
  text.precision(10);
  text << value;
  return text.str();
}

}  // namespace haptex::base
