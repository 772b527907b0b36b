// Whether files that results depend on are the same.
#pragma once

#include <string>

namespace haptex::studies {

/// Of the names and the bytes of all files below a directory, wherever that is.
/// @throws std::filesystem::filesystem_error or std::runtime_error naming what cannot be read
std::string checksumOfFolder(const std::string& directory);

}  // namespace haptex::studies
