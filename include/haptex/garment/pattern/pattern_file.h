// Garment files: docs/garments.md describes them.
#pragma once

#include <string>

#include "haptex/garment/pattern/pattern.h"

namespace haptex::garment {

constexpr std::size_t kLargestPatternFile = 8u << 20;  ///< bytes
constexpr std::size_t kMostPatternValues = 2'000'000;  ///< of its YAML

/// The text of a file of at most kLargestPatternFile bytes.
/// @throws std::runtime_error naming the path if it cannot be read
/// @throws std::invalid_argument naming it and its size if it is larger
std::string readPatternText(const std::string& path);

/// @throws std::runtime_error naming the path if the file cannot be read or is not YAML
/// @throws std::invalid_argument naming file, key or panel and edge, value and what is allowed
Pattern loadPattern(const std::string& path);
/// The same of a text. @param name of it in messages
Pattern parsePattern(const std::string& text, const std::string& name);

/// A garment file that gives the pattern back: its numbers have 17 digits where they need them.
/// @param pattern sound
std::string writePattern(const Pattern& pattern);

}  // namespace haptex::garment
