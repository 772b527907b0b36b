#include "haptex/base/command_line.h"

#include <unistd.h>

#include <algorithm>
#include <exception>
#include <filesystem>
#include <iostream>

#include "haptex/base/require.h"

namespace haptex::base {
namespace {

/// "--a and --b".
std::string listed(const std::vector<std::string>& options) {
  std::string text;
  for (std::size_t i = 0; i < options.size(); ++i) {
    if (i > 0) text += i + 1 == options.size() ? " and " : ", ";
    text += options[i];
  }
  return text;
}

}  // namespace

std::string CommandLine::value(const std::string& option, const std::string& otherwise) const {
  const auto found = options.find(option);
  return found == options.end() ? otherwise : found->second;
}

CommandLine readCommandLine(const std::vector<std::string>& arguments,
                            const std::vector<std::string>& options) {
  CommandLine line;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const std::string& argument = arguments[i];
    if (argument.rfind("--", 0) != 0) {
      line.files.push_back(argument);
    } else if (argument == "--help") {
      throw HelpAsked();
    } else if (std::find(options.begin(), options.end(), argument) == options.end()) {
      refuse(argument, " is unknown; allowed ", options.size() == 1 ? "is " : "are ",
             listed(options));
    } else if (++i == arguments.size()) {
      refuse(argument, " needs a value");
    } else {
      line.options[argument] = arguments[i];
    }
  }
  return line;
}

void requireTwoFiles(const CommandLine& line, const char* what) {
  const std::vector<std::string>& files = line.files;
  if (files.size() < 2) refuse("two files are needed, the ", what, " and the one to write");
  if (files.size() > 2) {
    refuse(files[2], ": two files are allowed, ", files[0], " and ", files[1]);
  }
}

void requireOutput(const std::string& path, const std::vector<std::string>& inputs) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::path directory = fs::absolute(path, error).parent_path();
  if (!fs::is_directory(directory, error)) {
    refuse(path, ": cannot be written: there is no directory ", directory.string());
  }
  if (fs::is_directory(path, error)) refuse(path, ": is a directory, not a file");
  const std::string written = fs::exists(path, error) ? path : directory.string();
  if (access(written.c_str(), W_OK) != 0) refuse(path, ": cannot be written");
  for (const std::string& input : inputs) {
    const bool same = fs::path(path).lexically_normal() == fs::path(input).lexically_normal();
    if (same || fs::equivalent(path, input, error)) {
      refuse(path, ": is read, too: allowed is another file");
    }
  }
}

int runProgram(const char* usage, std::ostream& err, const std::function<void()>& read,
               const std::function<int()>& work) {
  try {
    read();
  } catch (const HelpAsked&) {
    std::cout << usage;
    return 0;
  } catch (const std::exception& error) {
    err << error.what() << '\n' << usage;
    return 2;
  }
  try {
    return work();
  } catch (const std::exception& error) {
    err << error.what() << '\n';
    return 1;
  }
}

int runPlainProgram(const char* name, const char* usage, const std::vector<std::string>& arguments,
                    std::size_t least, std::size_t most,
                    const std::function<void(const std::vector<std::string>&)>& work) {
  if (!arguments.empty() && arguments.front() == "--help") {
    std::cout << usage;
    return 0;
  }
  if (arguments.size() < least || arguments.size() > most) {
    std::cerr << usage;
    return 2;
  }
  try {
    work(arguments);
  } catch (const std::exception& error) {
    std::cerr << name << ": " << error.what() << '\n';
    return 1;
  }
  return 0;
}

}  // namespace haptex::base
