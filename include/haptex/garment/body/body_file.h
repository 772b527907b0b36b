// Body files: docs/bodies.md describes them.
#pragma once

#include <string>

#include "haptex/garment/body/body.h"

namespace haptex::garment {

constexpr std::size_t kMostSegments = 100;

/// A body in its pose: MakeHuman's figure with measurements, or a surface from an OBJ file with
/// segments. Files that it names are looked for beside it.
/// @throws std::runtime_error naming a file that cannot be read or is not YAML
/// @throws std::invalid_argument naming file, key, value and what is allowed
Body loadBody(const std::string& path);
/// The same of a text. @param directory of the files that it names @param name of it in messages
Body parseBody(const std::string& text, const std::string& directory, const std::string& name);

}  // namespace haptex::garment
