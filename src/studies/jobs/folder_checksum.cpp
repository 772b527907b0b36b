#include "haptex/studies/jobs/folder_checksum.h"

#include <algorithm>
#include <filesystem>
#include <limits>
#include <vector>

#include "haptex/base/checksum.h"
#include "haptex/base/yaml_reader.h"

namespace haptex::studies {

std::string checksumOfFolder(const std::string& directory) {
  std::vector<std::string> paths;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(directory)) {
    if (entry.is_regular_file()) paths.push_back(entry.path().string());
  }
  std::sort(paths.begin(), paths.end());
  std::uint64_t sum = base::kChecksumOfNothing;
  for (const std::string& path : paths) {
    sum = base::checksum(path.substr(directory.size()), sum);
    sum = base::checksum(base::readTextFile(path, std::numeric_limits<std::size_t>::max()), sum);
  }
  return base::digitsOf(sum);
}

}  // namespace haptex::studies
