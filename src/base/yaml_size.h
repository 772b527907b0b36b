// How large a YAML text is, found before its values are held.
#pragma once

#include <cstddef>
#include <string>

namespace haptex::base {

/// Reads the text event by event, in memory that does not grow with it beyond its anchors and the
/// tokens of a line, which yaml-cpp reads ahead (some 220 bytes for each bracket).
/// @throws std::invalid_argument with the line if it has more than `most_values`, an alias
///   counted as what it stands for, is nested deeper than kDeepestYaml, or has an alias within what
///   that stands for
/// @throws YAML::Exception if it is not YAML
void requireSmallYaml(const std::string& text, std::size_t most_values);

}  // namespace haptex::base
