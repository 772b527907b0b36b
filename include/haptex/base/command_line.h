// What the package's programs do with their arguments.
#pragma once

#include <functional>
#include <iosfwd>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "haptex/base/parse_number.h"
#include "haptex/base/quoted.h"
#include "haptex/base/require.h"

namespace haptex::base {

struct CommandLine {
  std::vector<std::string> files;  ///< what is neither an option nor its value
  std::map<std::string, std::string>
      options;  ///< values by name; the last where one is there twice

  /// @returns the value of an option, or `otherwise` if it is not there
  std::string value(const std::string& option, const std::string& otherwise = "") const;

  /// @param is_allowed a function of the number @param allowed what it lets pass, in words
  /// @returns the number that an option's value is, or `otherwise` if it is not there
  /// @throws std::invalid_argument naming option, value and what is allowed
  template <typename Number, typename Rule>
  Number number(const std::string& option, Number otherwise, const Rule& is_allowed,
                const std::string& allowed) const {
    const auto found = options.find(option);
    if (found == options.end()) return otherwise;
    const std::optional<Number> number = parseNumber<Number>(found->second);
    if (!number || !is_allowed(*number)) {
      refuse(option, " is ", quoted(found->second), ": allowed ", allowed);
    }
    return *number;
  }
};

/// What readCommandLine() throws if it finds --help, and runProgram() catches.
struct HelpAsked {};

/// @param options that are allowed, such as "--edge", at least one; each has a value
/// @throws std::invalid_argument naming an option that is not allowed and those that are, or one
///   without a value
/// @throws HelpAsked
CommandLine readCommandLine(const std::vector<std::string>& arguments,
                            const std::vector<std::string>& options);

/// For a program that makes one file of another.
/// @param what the first is, for example "pattern"
/// @throws std::invalid_argument naming what lacks or is too much, unless there are two files
void requireTwoFiles(const CommandLine& line, const char* what);

/// Before work that takes long.
/// @throws std::invalid_argument naming the path if no file can be written there, or if it is one
/// of
///   the inputs
void requireOutput(const std::string& path, const std::vector<std::string>& inputs);

/// A program that first reads its arguments and then works.
/// @returns its exit status: 0 if `read` throws HelpAsked, and the usage is shown; 2 if it throws
///   something else, which `err` tells with the usage; 1 if `work` throws, which `err` tells;
///   otherwise what `work` returns
int runProgram(const char* usage, std::ostream& err, const std::function<void()>& read,
               const std::function<int()>& work);

/// A program with `least` to `most` arguments and no options but --help, which shows the usage.
/// @param name of the program, before its errors @param work is given the arguments
/// @returns its exit status: 2 for another number of arguments, 1 if `work` throws, otherwise 0
int runPlainProgram(const char* name, const char* usage, const std::vector<std::string>& arguments,
                    std::size_t least, std::size_t most,
                    const std::function<void(const std::vector<std::string>&)>& work);

}  // namespace haptex::base
