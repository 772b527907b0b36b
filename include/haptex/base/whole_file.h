// Files that are there as a whole or not at all.
#pragma once

#include <string>

namespace haptex::base {

/// Replaces a file: whoever reads it meanwhile, or after this process was killed, finds the old one
/// or the new one. It is written beside it first, as PATH.PROCESS.NUMBER.part.
/// @throws std::runtime_error naming the path and why it cannot be written; then nothing is left
void writeWholeFile(const std::string& path, const std::string& text);

}  // namespace haptex::base
