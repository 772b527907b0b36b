#include "haptex/nodes/common/config_files.h"

#include <ros/package.h>

#include <filesystem>
#include <set>
#include <stdexcept>

#include "haptex/base/quoted.h"

namespace haptex::nodes {

std::string findConfigFile(const std::string& directory, const std::string& name) {
  namespace fs = std::filesystem;
  const bool is_path = name.find('/') != std::string::npos;
  const fs::path folder = fs::path(ros::package::getPath("haptex")) / "config" / directory;
  const fs::path path = is_path ? fs::path(name) : folder / (name + ".yaml");
  std::error_code ignored;
  if (fs::is_regular_file(path, ignored)) return path.string();
  if (is_path) throw std::invalid_argument("there is no file " + base::quoted(name));

  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    if (entry.path().extension() == ".yaml") names.insert(entry.path().stem().string());
  }
  std::string message = "there is no " + base::quoted(name) + " in " + folder.string() +
                        ": allowed is the path of a file, or a name of";
  for (const std::string& known : names) message += " " + known;
  throw std::invalid_argument(message);
}

}  // namespace haptex::nodes
