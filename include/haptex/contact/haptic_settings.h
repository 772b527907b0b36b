// How the small-scale layer of a scene is computed: key `haptics` of a scene file.
#pragma once

#include <string>

namespace haptex::contact {

struct HapticSettings {
  /// kPatch: the cloth near the fingertips, refined, at 1 kHz. kWholeCloth: the contact is with the
  /// particles of the large-scale layer, which the scene then steps at 1 kHz itself.
  enum class Layer { kPatch, kWholeCloth };
  Layer layer = Layer::kPatch;
  int refinement = 2;      ///< every element becomes 4^refinement, 0 to 4
  double margin = 0.008;   ///< m, how far from the fingertip's surface the patch reaches, > 0
  int most_elements = 24;  ///< of the large-scale mesh, that come into a patch, per fingertip, >= 1
  /// m, how far around these the patch of a pinch goes on with whole elements, >= 0. 0.06 feels
  /// carried cloth as light as it is, and takes up to twice the time of a tick in a pinch.
  double surround = 0.0;
  bool predict = true;      ///< the patch also covers where the fingertip will be
  double time_step = 1e-3;  ///< s
};

/// The defaults above where the scene says nothing.
/// @throws std::runtime_error if the file cannot be read or is not YAML
/// @throws std::invalid_argument naming file, key, value and what is allowed
HapticSettings loadHapticSettings(const std::string& scene_path);

}  // namespace haptex::contact
