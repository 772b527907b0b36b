#include "haptex/studies/jobs/records.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "haptex/base/quoted.h"
#include "haptex/base/require.h"

namespace haptex::studies {

std::string textOf(double number) {
  if (std::isnan(number)) return "nan";
  char digits[32];
  const std::to_chars_result end = std::to_chars(digits, digits + sizeof(digits), number);
  return {digits, end.ptr};
}

std::string asField(const std::string& message) {
  std::string text = base::shortened(message);  // no line breaks or tabs
  std::replace(text.begin(), text.end(), '\t', ' ');
  return text;
}

std::vector<std::string> fieldsOf(const std::string& record) {
  std::vector<std::string> fields(1);
  for (const char letter : record) {
    if (letter == '\t') {
      fields.emplace_back();
    } else {
      fields.back() += letter;
    }
  }
  return fields;
}

void refuseRecord(const std::string& record, const char* what) {
  base::refuse(base::quoted(record), " is no result of ", what);
}

}  // namespace haptex::studies
