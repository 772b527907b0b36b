// What a scene will model, what that takes on this machine, and what error to expect.
#pragma once

#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "haptex/scene/quality.h"
#include "haptex/scene/scene.h"

namespace haptex::simulation {

/// An entry that `model` may have.
struct Effect {
  std::string name;
  std::string meaning;  ///< for people
  bool listed;
};

/// All that there are, in the order of docs/scene_files.md.
std::vector<Effect> effectsOf(const scene::Scene& scene);

/// Without an effect and what builds on it.
/// @throws std::invalid_argument if there is no effect of this name, or it does not change the
///   steps of the cloth, as tactile and recording do not
scene::Scene withoutEffect(scene::Scene scene, const std::string& name);

/// Edge length (m) of the cells of a sheet, of a mesh the like: the median, over its triangles, of
/// the second longest edge at rest.
double medianCellSize(const mesh::ClothMesh& mesh);

/// The studied quality that is nearest to a scene, of those with the same integrator, as many
/// solves and the same error, a time step that differs by less than a factor of 1.5, and cells more
/// than two thirds as large. They may be much larger: the errors of the study are those of the step
/// nearly all.
/// @returns null if there is none
const scene::Quality* nearestQuality(const scene::Scene& scene,
                                     const std::vector<scene::Quality>& studied);

/// Reads a scene and tells in plain text what is modelled and what is not, mesh, integrator and
/// solver, the memory of the cloth, and, measured on this machine for some seconds, the time of a
/// step while the scene is shaken, the share of everything that is listed in it, and what patches
/// and tactile arrays take. The error to expect is that of nearestQuality().
/// @param studied  qualities with measured errors, may be empty
/// @param out      the text
/// @param progress what is being measured
/// @throws std::exception naming why the scene is refused
void explainScene(const std::string& scene_path, const std::vector<scene::Quality>& studied,
                  std::ostream& out, std::ostream& progress);

}  // namespace haptex::simulation
