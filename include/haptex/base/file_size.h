// Files are refused by their size before they are read.
#pragma once

#include <cstdint>
#include <string>

namespace haptex::base {

/// @param size and the @param largest that is allowed, bytes
/// @throws std::runtime_error "name: has size bytes: allowed are up to largest" if it is larger
void requireSize(const std::string& name, std::uintmax_t size, std::uintmax_t largest);

/// The same of a file; what has no size, a pipe for example, is not refused.
void requireFileSize(const std::string& path, std::uintmax_t largest);

}  // namespace haptex::base
