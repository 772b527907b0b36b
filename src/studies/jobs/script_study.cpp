#include "haptex/studies/jobs/script_study.h"

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <ostream>
#include <sstream>
#include <stdexcept>

#include "haptex/base/parse_number.h"

namespace haptex::studies {
namespace {

std::string joined(const std::vector<std::string>& command) {
  std::string text;
  for (const std::string& word : command) text += (text.empty() ? "" : " ") + word;
  return text;
}

[[noreturn]] void refuseCall(const std::vector<std::string>& command, const std::string& what) {
  throw std::runtime_error(joined(command) + ": " + what);
}

/// A file without a name, gone when it is closed.
std::unique_ptr<std::FILE, int (*)(std::FILE*)> temporaryFile() {
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::tmpfile(), std::fclose);
  if (!file) throw std::runtime_error("no temporary file can be made");
  return file;
}

/// What a program prints. @throws std::runtime_error as ScriptStudy()
std::string outputOf(std::vector<std::string> command, const std::string& input) {
  const auto in = temporaryFile(), out = temporaryFile();
  if (std::fwrite(input.data(), 1, input.size(), in.get()) != input.size() ||
      std::fflush(in.get()) != 0)
    throw std::runtime_error("a temporary file cannot be written");
  std::rewind(in.get());
  std::vector<char*> arguments;
  for (std::string& word : command) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_adddup2(&files, fileno(in.get()), STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&files, fileno(out.get()), STDOUT_FILENO);
  pid_t child = 0;
  const int error = posix_spawn(&child, arguments[0], &files, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  if (error != 0) refuseCall(command, std::strerror(error));
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (!WIFEXITED(status)) refuseCall(command, "was killed");
  if (WEXITSTATUS(status) != 0) {
    refuseCall(command, "ended with " + std::to_string(WEXITSTATUS(status)));
  }
  std::rewind(out.get());
  std::string output;
  char part[4096];
  while (const std::size_t size = std::fread(part, 1, sizeof part, out.get())) {
    output.append(part, size);
  }
  return output;
}

std::vector<std::string> with(std::vector<std::string> command,
                              const std::vector<std::string>& words) {
  command.insert(command.end(), words.begin(), words.end());
  return command;
}

}  // namespace

ScriptStudy::ScriptStudy(std::string name, std::vector<std::string> command)
    : name_(std::move(name)), command_(std::move(command)) {
  const std::vector<std::string> call = with(command_, {"describe"});
  std::istringstream lines(outputOf(call, ""));
  for (std::string line; std::getline(lines, line);) {
    const std::size_t tab = line.find('\t');
    if (tab == std::string::npos)
      refuseCall(call, "has printed a line that is no name with a value");
    inputs_.emplace_back(line.substr(0, tab), line.substr(tab + 1));
  }
  const bool has_units = !inputs_.empty() && inputs_.front().first == "units";
  const auto units =
      has_units ? base::parseNumber<std::size_t>(inputs_.front().second) : std::nullopt;
  if (!units || *units < 1) refuseCall(call, "must first print units, 1 or more");
  units_ = *units;
  inputs_.erase(inputs_.begin());
}

std::string ScriptStudy::run(std::size_t unit) const {
  const std::vector<std::string> call = with(command_, {"run", std::to_string(unit)});
  std::string record = outputOf(call, "");
  if (record.size() < 2 || record.find('\n') != record.size() - 1) {
    refuseCall(call, "must print one line");
  }
  record.pop_back();
  return record;
}

void ScriptStudy::summarise(const std::vector<std::string>& records, std::ostream& out) const {
  std::string input;
  for (const std::string& record : records) input += record + '\n';
  out << outputOf(with(command_, {"summary"}), input);
}

}  // namespace haptex::studies
