#include <link.h>

#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "haptex/base/checksum.h"
#include "haptex/base/yaml_reader.h"
#include "haptex/studies/jobs/study.h"

namespace haptex::studies {
namespace {

/// Of the shared libraries in the order in which they were loaded, which is that of the program.
int addPath(dl_phdr_info* info, std::size_t /*size*/, void* paths) {
  const std::string path = info->dlpi_name;
  const std::string file = std::filesystem::path(path).filename().string();
  const bool matters = file.rfind("libhaptex_", 0) == 0 || file.rfind("libm.so", 0) == 0;
  if (matters) static_cast<std::vector<std::string>*>(paths)->push_back(path);
  return 0;
}

std::string checksumOfProgram() {
  std::vector<std::string> paths = {"/proc/self/exe"};
  dl_iterate_phdr(addPath, &paths);
  std::uint64_t sum = base::kChecksumOfNothing;
  for (const std::string& path : paths) {
    sum = base::checksum(base::readTextFile(path, std::numeric_limits<std::size_t>::max()), sum);
  }
  return base::digitsOf(sum);
}

std::string instructions() {
#if defined(__x86_64__)
  std::string text = "x86-64";
  if (__builtin_cpu_supports("avx2")) text += " avx2";
  if (__builtin_cpu_supports("fma")) text += " fma";
  if (__builtin_cpu_supports("avx512f")) text += " avx512f";
  return text;
#else
  return "baseline";
#endif
}

}  // namespace

StudyInputs inputsOfProgram() {
  return {{"program", checksumOfProgram()}, {"instructions", instructions()}};
}

}  // namespace haptex::studies
