// Files of bidirectional texture functions.
#pragma once

#include <string>

#include "haptex/appearance/btf.h"

namespace haptex::appearance {

/// Writes a file as docs/appearance.md describes it.
/// @returns its size, bytes
/// @throws std::runtime_error naming the path if it cannot be written
std::size_t writeBtf(const Btf& btf, const std::string& path);

/// @throws std::runtime_error naming the path and what is wrong: it cannot be read, is no such file
///   or of another version, has more or fewer bytes than its numbers say, a number that is not
///   allowed or not finite, or a checksum that is not that of its bytes
Btf readBtf(const std::string& path);

}  // namespace haptex::appearance
