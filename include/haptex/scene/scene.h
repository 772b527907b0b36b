// Scene files: what is simulated, how finely, what is modelled and what is attached. YAML.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "haptex/cloth/dynamics/cloth.h"
#include "haptex/cloth/dynamics/step.h"
#include "haptex/cloth/dynamics/step_length_control.h"
#include "haptex/contact/obstacles/start_outside.h"
#include "haptex/mesh/mesh.h"
#include "haptex/mesh/obstacle.h"
#include "haptex/scene/attachment_values.h"

namespace haptex::scene {

struct Scene {
  std::string fabric_path;  ///< absolute, or relative to the working directory
  /// Likewise, of regions: fabrics 1, 2, ... of the mesh; empty: all is of the one above.
  std::vector<std::string> region_fabric_paths;
  mesh::ClothMesh mesh;
  cloth::ModelledEffects effects;
  std::vector<int> attached_particles;  ///< at their initial positions
  std::vector<CarryingFrame> frames;    ///< that carry some of them
  double time_step = 0.0;               ///< s
  /// Taken in shorter steps where their error asks for them; time_step is the longest then.
  std::optional<cloth::AdaptiveSteps> adaptive_steps;
  cloth::StepSettings step;
  std::vector<mesh::Obstacle> obstacles;  ///< names unique; the cloth collides with them if
                                          ///< effects has contacts
  std::optional<double> penalty;  ///< N/m: how an explicit step responds to obstacles, if not by
                                  ///< bringing back what has gone in
  std::vector<Eigen::Vector3d> start_velocities;  ///< m/s, one per particle; empty: at rest
  double start_time = 0.0;                        ///< s, simulated, that of a saved state
  /// What was done to a start that reached into obstacles, where the cloth collides with itself.
  contact::StartMove start_move;
  /// A sheet that is attached by nothing but its sides, has no regions and starts from no saved
  /// state: it may have any cells.
  bool any_cells = false;
  // What is modelled beside the cloth.
  bool fingers = false;    ///< touch the cloth; effects has point loads then
  bool tactile = false;    ///< the surface under the fingertips, only with fingers
  bool recording = false;  ///< a bag is recorded without being asked for
};

/// What a sheet is to have instead of what its scene file says.
struct SheetChange {
  std::optional<std::array<double, 2>> size;  ///< m, along weft and warp
  std::optional<std::array<int, 2>> cells;    ///< along weft and warp
  std::optional<mesh::Triangulation> diagonals;
};

/// m, and m/s: how far a state may have an attached particle from where it is held.
constexpr double kHeldTolerance = 1e-9;

/// Reads a scene file; docs/scene_files.md describes the format. A fabric or mesh name without a
/// path separator is looked up in the directory of its kind beside the scene's directory
/// (config/fabrics for config/scenes); one with a separator is a path from the scene's directory.
/// With a saved state its positions are the mesh's initial ones.
/// @throws std::runtime_error if the scene file, its mesh or its state cannot be read, or the scene
///   is not YAML
/// @throws std::invalid_argument naming file, key, value and what is allowed, or what loadObj() and
///   loadState() say
Scene loadScene(const std::string& path);

/// The same with another sheet; sides, regions and obstacles are those of the file.
/// @throws std::invalid_argument also if the cloth of the scene is no sheet, it starts from a saved
///   state, a size is not > 0 and at most 100 m, or there would be too many
///   triangles
Scene loadScene(const std::string& path, const SheetChange& change);

/// The same, but a sheet of a scene with any_cells has as few cells as make no edge along weft or
/// warp longer than `cell_size` (m). Other scenes keep their mesh.
/// @throws std::invalid_argument also if the cell size is not finite and > 0, or so small that
/// there would be too many triangles
Scene loadScene(const std::string& path, double cell_size);

}  // namespace haptex::scene
