// A draped garment as a scene.
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "haptex/garment/pattern/pattern.h"

namespace haptex::dressing {

struct WornScene {
  const garment::Pattern& pattern;          ///< of the garment; its panels are groups of `cloth`
  const std::vector<std::string>& fabrics;  ///< paths of fabric files, one for each panel
  std::string cloth, body;                  ///< paths of OBJ files
  double edge_length;                       ///< m, > 0, of the cloth's triangles
};

/// Writes a scene file (docs/scene_files.md): the garment at rest on the body, touched by fingers,
/// in the steps of the garments that come with the package. Its fastenings are buttons as strong as
/// those of the scene `jacket`, because a garment file does not say.
/// @param path of the scene file: what lies in its directory or below is named from there, all else
///   by its whole path
void writeWornScene(const WornScene& scene, const std::string& path, std::ostream& out);

}  // namespace haptex::dressing
