#include "haptex/studies/jobs/job_file.h"

#include <limits>
#include <optional>
#include <stdexcept>
#include <string_view>

#include "haptex/base/checksum.h"
#include "haptex/base/parse_number.h"
#include "haptex/base/quoted.h"
#include "haptex/base/yaml_reader.h"

namespace haptex::studies {
namespace {

constexpr std::string_view kTitle = "haptex study ";
constexpr std::string_view kInput = "input ";
constexpr std::string_view kEnd = "end ";

bool startsWith(std::string_view text, std::string_view begin) {
  return text.substr(0, begin.size()) == begin;
}

/// Takes lines, or what is before a separator, off the begin of a text.
std::optional<std::string_view> take(std::string_view& text, std::string_view separator) {
  const std::size_t place = text.find(separator);
  if (place == std::string_view::npos) return std::nullopt;
  const std::string_view taken = text.substr(0, place);
  text.remove_prefix(place + separator.size());
  return taken;
}

[[noreturn]] void refuseFile(const std::string& path, const std::string& what) {
  throw std::runtime_error(base::shortened(path) + ": " + what);
}

/// The text without its last line. @throws unless that is the right checksum
std::string_view whole(std::string_view text, const std::string& path) {
  if (text.empty() || text.back() != '\n')
    refuseFile(path, "is incomplete: its last line has no end");
  const std::size_t before = text.rfind('\n', text.size() - 2);
  const std::size_t begin = before == std::string_view::npos ? 0 : before + 1;
  const std::string_view last = text.substr(begin, text.size() - 1 - begin);
  if (!startsWith(last, kEnd))
    refuseFile(path, "is incomplete: its last line must be 'end CHECKSUM'");
  const std::string_view body = text.substr(0, begin);
  const std::string right = base::digitsOf(base::checksum(body));
  if (last.substr(kEnd.size()) != right) {
    refuseFile(path, "is damaged: its checksum is " +
                         base::quoted(std::string(last.substr(kEnd.size()))) +
                         ", that of its lines " + right);
  }
  return body;
}

/// "NAME, job INDEX of COUNT, UNITS units"
bool readTitle(std::string_view line, JobResult& result) {
  if (!startsWith(line, kTitle)) return false;
  line.remove_prefix(kTitle.size());
  const auto name = take(line, ", job "), index = take(line, " of "), count = take(line, ", "),
             units = take(line, " units");
  if (!units || !line.empty()) return false;
  const auto i = base::parseNumber<std::size_t>(*index), n = base::parseNumber<std::size_t>(*count),
             all = base::parseNumber<std::size_t>(*units);
  if (!i || !n || !all || *i < 1 || *i > *n || *n > *all) return false;
  result.study = *name;
  result.job = {*i, *n};
  result.units = *all;
  return true;
}

}  // namespace

std::string toText(const JobResult& result) {
  std::string text = std::string(kTitle) + result.study + ", job " +
                     std::to_string(result.job.index) + " of " + std::to_string(result.job.count) +
                     ", " + std::to_string(result.units) + " units\n";
  for (const auto& [name, value] : result.inputs) {
    text.append(kInput).append(name).append(" ").append(value).append("\n");
  }
  for (const std::string& record : result.records) text.append(record).append("\n");
  return text + std::string(kEnd) + base::digitsOf(base::checksum(text)) + '\n';
}

JobResult parseJobResult(const std::string& text, const std::string& path) {
  std::string_view left = whole(text, path);
  JobResult result;
  const auto title = take(left, "\n");
  if (!title || !readTitle(*title, result)) {
    refuseFile(path, "line 1 must be 'haptex study NAME, job INDEX of COUNT, UNITS units'");
  }
  while (startsWith(left, kInput)) {
    std::string_view line = *take(left, "\n");
    line.remove_prefix(kInput.size());
    const auto name = take(line, " ");
    if (!name) refuseFile(path, "has an input without a value, " + base::quoted(std::string(line)));
    result.inputs.emplace_back(*name, line);
  }
  while (const auto record = take(left, "\n")) result.records.emplace_back(*record);
  const std::size_t wanted = result.job.end(result.units) - result.job.first(result.units);
  if (result.records.size() != wanted) {
    refuseFile(path, "has results of " + std::to_string(result.records.size()) +
                         " units, must have " + std::to_string(wanted) + " as it says");
  }
  return result;
}

JobResult loadJobResult(const std::string& path) {
  return parseJobResult(base::readTextFile(path, std::numeric_limits<std::size_t>::max()), path);
}

}  // namespace haptex::studies
