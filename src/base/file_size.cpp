#include "haptex/base/file_size.h"

#include <filesystem>
#include <stdexcept>

#include "haptex/base/quoted.h"

namespace haptex::base {

void requireSize(const std::string& name, std::uintmax_t size, std::uintmax_t largest) {
  if (size <= largest) return;
  throw std::runtime_error(shortened(name) + ": has " + std::to_string(size) +
                           " bytes: allowed are up to " + std::to_string(largest));
}

void requireFileSize(const std::string& path, std::uintmax_t largest) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (!error) requireSize(path, size, largest);
}

}  // namespace haptex::base
