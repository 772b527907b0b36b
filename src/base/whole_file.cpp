#include "haptex/base/whole_file.h"

#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <system_error>

#include "haptex/base/quoted.h"

namespace haptex::base {
namespace {

/// Of the file beside `path` that becomes it: no other thread or process has the same.
std::string partOf(const std::string& path) {
  static std::atomic<int> count{0};
  return path + "." + std::to_string(getpid()) + "." + std::to_string(++count) + ".part";
}

}  // namespace

void writeWholeFile(const std::string& path, const std::string& text) {
  const std::string part = partOf(path);
  std::error_code error;
  errno = 0;
  std::ofstream stream(part, std::ios::binary);
  stream << text;
  stream.close();
  if (stream.fail()) {
    error = std::error_code(errno, std::generic_category());
  } else {
    std::filesystem::rename(part, path, error);
    if (!error) return;
  }
  std::error_code ignored;
  std::filesystem::remove(part, ignored);
  throw std::runtime_error(shortened(path) + ": cannot be written: " + error.message());
}

}  // namespace haptex::base
