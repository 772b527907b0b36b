// Numbers and messages in the records of studies.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "haptex/base/parse_number.h"

namespace haptex::studies {

/// The shortest text that is read back as the same number. One text for every NaN, whose sign and
/// bits differ by how it came about.
std::string textOf(double number);

/// Of an exception, as a part of a line.
std::string asField(const std::string& message);

/// Between its tabs.
std::vector<std::string> fieldsOf(const std::string& record);

/// @throws std::invalid_argument "'record' is no result of WHAT" unless the field is a number
template <typename Number>
Number numberIn(const std::string& field, const std::string& record, const char* what);

/// @throws std::invalid_argument as above
[[noreturn]] void refuseRecord(const std::string& record, const char* what);

template <typename Number>
Number numberIn(const std::string& field, const std::string& record, const char* what) {
  const std::optional<Number> number = base::parseNumber<Number>(field);
  if (!number) refuseRecord(record, what);
  return *number;
}

}  // namespace haptex::studies
