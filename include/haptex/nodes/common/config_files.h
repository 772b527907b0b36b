// Files of the package by name.
#pragma once

#include <string>

namespace haptex::nodes {

/// `name` itself if it contains a path separator, otherwise the path of
/// config/<directory>/<name>.yaml in the package, where it is built or installed.
/// @throws std::invalid_argument if there is no such file, naming those that the package has
std::string findConfigFile(const std::string& directory, const std::string& name);

}  // namespace haptex::nodes
