#include "haptex/scene/scene.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "haptex/base/constants.h"
#include "haptex/base/require.h"
#include "haptex/base/yaml_reader.h"
#include "haptex/cloth/forces/lattice_springs.h"
#include "haptex/mesh/obj_file.h"
#include "haptex/scene/attachment_values.h"
#include "haptex/scene/body_values.h"
#include "haptex/scene/cloth_state_file.h"
#include "haptex/scene/fastener_values.h"
#include "haptex/scene/obstacle_file.h"
#include "haptex/scene/region_values.h"
#include "haptex/scene/scene_values.h"
#include "haptex/scene/step_values.h"
#include "haptex/scene/stuffing_values.h"
#include "haptex/scene/usual_elasticity.h"

namespace haptex::scene {
namespace {

using base::YamlValue;

constexpr double kMaxCurvature = 1000.0;  // 1/m
const Eigen::Vector3d kDownwards(0.0, 0.0, -base::kStandardGravity);

int readCells(const YamlValue& value) {
  const int cells = value.integer();
  if (cells < 1) value.refuse("must be an integer >= 1");
  return cells;
}

/// As few as make none longer than the cell size, but for rounding.
int cellsOf(const YamlValue& sheet, double length, double cell_size) {
  const double cells = std::max(1.0, std::ceil(length / cell_size * (1.0 - 1e-9)));
  requireTriangleCount(sheet, static_cast<long long>(std::min(2.0 * cells, 1e15)));
  return static_cast<int>(cells);
}

/// How a sheet differs from what the file says.
struct OtherSheet {
  double cell_size = 0.0;  // m, of the longest edge along weft or warp; 0: the cells of the file
  SheetChange change = {};
};

/// @throws std::invalid_argument naming what is not allowed
void requireSound(const SheetChange& change) {
  for (int i = 0; change.size && i < 2; ++i) {
    const double length = (*change.size)[i];
    if (length > 0.0 && length <= kMaxSize) continue;
    base::refuse("size[", i, "] = ", length, " m: allowed are numbers > 0 up to ", kMaxSize);
  }
  for (int i = 0; change.cells && i < 2; ++i) {
    if ((*change.cells)[i] >= 1) continue;
    base::refuse("cells[", i, "] = ", (*change.cells)[i], ": allowed are whole numbers >= 1");
  }
}

mesh::ClothMesh readSheet(const YamlValue& value, const OtherSheet& other) {
  value.requireKeys({"size", "cells", "diagonals"}, {"position", "rpy"});
  const auto size = value.at("size").items(2);
  const auto cells = value.at("cells").items(2);
  const SheetChange& change = other.change;
  const auto [width, height] =
      change.size.value_or(std::array{readSize(size[0]), readSize(size[1])});
  auto [cells_u, cells_v] =
      change.cells.value_or(std::array{readCells(cells[0]), readCells(cells[1])});
  // Each factor alone is bounded first, so that the product cannot overflow.
  requireTriangleCount(cells[0], 2LL * cells_u);
  requireTriangleCount(value.at("cells"), 2LL * cells_u * cells_v);
  if (other.cell_size > 0.0) {
    cells_u = cellsOf(value, width, other.cell_size);
    cells_v = cellsOf(value, height, other.cell_size);
    requireTriangleCount(value, 2LL * cells_u * cells_v);
  }
  const bool one_way = value.at("diagonals").oneOf({"one_way", "alternating"}) == "one_way";
  const mesh::Triangulation diagonals =
      one_way ? mesh::Triangulation::kOneWay : mesh::Triangulation::kAlternating;
  mesh::ClothMesh mesh =
      mesh::makeRectangle(width, height, cells_u, cells_v, change.diagonals.value_or(diagonals));
  if (value.has("position") || value.has("rpy")) {
    const Eigen::Isometry3d pose = readPose(value);
    for (Eigen::Vector3d& position : mesh.initial_positions) position = pose * position;
  }
  try {
    requireSound(mesh);
  } catch (const std::invalid_argument& defects) {
    value.refuseBecause(defects.what());
  }
  return mesh;
}

/// @param groups filled in for a mesh from a file
mesh::ClothMesh readMesh(const YamlValue& scene, const OtherSheet& other,
                         mesh::MeshGroups& groups) {
  if (scene.has("sheet") == scene.has("mesh")) {
    scene.refuseBecause("must have exactly one of sheet, mesh");
  }
  if (scene.has("sheet")) return readSheet(scene.at("sheet"), other);
  return mesh::loadObj(resolveFile(scene.at("mesh"), "meshes", ".obj"), groups);
}

/// Lets the scene start from a saved state.
void startFrom(const YamlValue& value, Scene& scene) {
  const std::string path = resolveFile(value, "states", kStateExtension);
  cloth::ClothState state = loadState(path);
  mesh::ClothMesh& mesh = scene.mesh;
  const std::size_t count = mesh.initial_positions.size();
  if (state.positions.size() != count) {
    value.refuseBecause(path + " has " + std::to_string(state.positions.size()) +
                        " particles: allowed are " + std::to_string(count) +
                        ", those of the scene's cloth");
  }
  std::set<int> carried;
  for (const CarryingFrame& frame : scene.frames) {
    carried.insert(frame.particles.begin(), frame.particles.end());
  }
  for (const int particle : scene.attached_particles) {
    if (carried.count(particle) > 0) continue;
    const Eigen::Vector3d& held = mesh.initial_positions[particle];
    const double way = (state.positions[particle] - held).norm();
    if (way <= kHeldTolerance) continue;
    std::ostringstream reason;
    reason << path << " has particle " << particle << " " << way
           << " m from where it is attached, (" << held.x() << ", " << held.y() << ", " << held.z()
           << ") m: allowed are " << kHeldTolerance << " m";
    value.refuseBecause(reason.str());
  }
  mesh.initial_positions = std::move(state.positions);
  scene.start_velocities = std::move(state.velocities);
  scene.start_time = state.time;
}

bool allowsAnyCells(const YamlValue& scene) {
  if (!scene.has("sheet") || scene.has("state") || scene.has("regions")) return false;
  if (scene.has("fasteners") && nameParticles(scene.at("fasteners"))) return false;
  const std::vector<YamlValue> attached = scene.at("attach").items();
  return std::none_of(attached.begin(), attached.end(),
                      [](const YamlValue& item) { return item.isMap(); });
}

double readNotNegative(const YamlValue& value) {
  const double number = value.number();
  if (number < 0.0) value.refuse("must be a finite number >= 0");
  return number;
}

cloth::Wind readWind(const YamlValue& value) {
  value.requireKeys({"velocity"}, {"gusts"});
  cloth::Wind wind;
  wind.mean = readVector(value.at("velocity"));
  if (!value.has("gusts")) return wind;
  for (const YamlValue& item : value.at("gusts").items()) {
    item.requireKeys({"velocity", "frequency"}, {"phase"});
    cloth::Gust gust;
    gust.velocity = readVector(item.at("velocity"));
    gust.frequency = readNotNegative(item.at("frequency"));
    if (item.has("phase")) gust.phase = item.at("phase").number();
    wind.gusts.push_back(gust);
  }
  return wind;
}

cloth::Air readAir(const YamlValue& scene) {
  cloth::Air air;
  if (scene.has("air")) {
    const YamlValue value = scene.at("air");
    value.requireKeys({}, {"normal", "tangential", "lift"});
    const auto read = [&](const char* key, double& coefficient) {
      if (value.has(key)) coefficient = readNotNegative(value.at(key));
    };
    read("normal", air.coefficients.normal);
    read("tangential", air.coefficients.tangential);
    read("lift", air.coefficients.lift);
  }
  if (scene.has("wind")) air.wind = readWind(scene.at("wind"));
  return air;
}

double readCurvature(const YamlValue& value) {
  const double curvature = value.number();
  if (std::abs(curvature) > kMaxCurvature) value.refuse("must be from -1000 to 1000 1/m");
  return curvature;
}

cloth::BendingSettings readBending(const YamlValue& value) {
  value.requireKeys({}, {"model", "rest_curvature"});
  cloth::BendingSettings settings;
  if (value.has("model") && value.at("model").oneOf({"linear", "quadratic"}) == "quadratic") {
    settings.model = cloth::BendingModel::kQuadratic;
  }
  if (value.has("rest_curvature")) {
    const YamlValue curvature = value.at("rest_curvature");
    curvature.requireKeys({"weft", "warp"});
    settings.rest_curvature = {readCurvature(curvature.at("weft")),
                               readCurvature(curvature.at("warp"))};
  }
  return settings;
}

cloth::Elasticity namedElasticity(const YamlValue& value, const mesh::ClothMesh& mesh) {
  const std::string name =
      value.oneOf({"green_lagrange", "bilinear", "mass_spring", "corotational"});
  if (name == "green_lagrange") return cloth::Elasticity::kGreenLagrange;
  if (name == "bilinear") return cloth::Elasticity::kBilinear;
  if (name == "corotational") return cloth::Elasticity::kCorotational;
  try {
    cloth::findLatticeSprings(mesh, false);
  } catch (const std::invalid_argument& error) {
    value.refuseBecause(error.what());
  }
  return cloth::Elasticity::kMassSpring;
}

using Listed = std::set<std::string>;

/// What the scene lists, each once and with what it builds on.
Listed readModel(const YamlValue& scene) {
  Listed listed;
  for (const YamlValue& item : scene.at("model").items()) {
    const std::string name =
        item.oneOf({"gravity", "viscosity", "membrane_hysteresis", "bending", "bending_hysteresis",
                    "contraction", "self_collision", "stuffing", "air", "wind", "obstacles",
                    "fingers", "tactile", "recording"});
    if (!listed.insert(name).second) item.refuse("is listed twice");
  }
  const auto require_both = [&](const std::string& effect, const std::string& base) {
    if (listed.count(effect) == 0 || listed.count(base) > 0) return;
    scene.at("model").refuseBecause("lists " + effect + ", which needs " + base + " listed, too");
  };
  require_both("bending_hysteresis", "bending");
  require_both("wind", "air");
  require_both("tactile", "fingers");
  require_both("stuffing", "self_collision");
  return listed;
}

/// A key that says how something is modelled is a contradiction where it is not modelled.
void requireListedKeys(const YamlValue& scene, const Listed& listed) {
  const auto require_listed = [&](const char* key, const std::string& effect) {
    if (!scene.has(key) || listed.count(effect) > 0) return;
    scene.at(key).refuseBecause("is allowed only if model lists " + effect + ", which it does not");
  };
  require_listed("gravity", "gravity");
  require_listed("air", "air");
  require_listed("wind", "wind");
  require_listed("bending", "bending");
  require_listed("stuffing", "stuffing");
  require_listed("haptics", "fingers");
  if (listed.count("wind") > 0 && !scene.has("wind")) {
    scene.at("model").refuseBecause("lists wind, so the key wind is required");
  }
  if (listed.count("stuffing") > 0) requireStuffing(scene, listed.count("fingers") > 0);
}

cloth::ModelledEffects readEffects(const YamlValue& scene, const Listed& listed) {
  cloth::ModelledEffects effects;
  effects.viscosity = listed.count("viscosity") > 0;
  effects.membrane_hysteresis = listed.count("membrane_hysteresis") > 0;
  effects.bending = listed.count("bending") > 0;
  effects.bending_hysteresis = listed.count("bending_hysteresis") > 0;
  effects.contraction = listed.count("contraction") > 0;
  effects.self_collision = listed.count("self_collision") > 0;
  effects.contacts = listed.count("obstacles") > 0;
  effects.point_loads = listed.count("fingers") > 0;
  if (listed.count("air") > 0) effects.air = readAir(scene);
  if (listed.count("stuffing") > 0) effects.stuffing = readStuffing(scene.at("stuffing"));
  if (listed.count("gravity") > 0) effects.gravity = kDownwards;
  if (scene.has("gravity")) effects.gravity = readVector(scene.at("gravity"));
  if (scene.has("bending")) effects.bending_settings = readBending(scene.at("bending"));
  return effects;
}

/// What the file says, or else what a sheet or a mesh usually has.
/// @param scene with its effects and its mesh
cloth::Elasticity readElasticity(const YamlValue& file, const Listed& listed, const Scene& scene) {
  if (!file.has("elasticity")) {
    return file.has("sheet") ? usualElasticity(scene.effects) : cloth::Elasticity::kGreenLagrange;
  }
  const YamlValue value = file.at("elasticity");
  const cloth::Elasticity elasticity = namedElasticity(value, scene.mesh);
  if (elasticity == cloth::Elasticity::kGreenLagrange) return elasticity;
  for (const char* effect : {"contraction", "membrane_hysteresis"}) {
    if (listed.count(effect) == 0) continue;
    value.refuse(std::string("is not allowed if model lists ") + effect);
  }
  if (elasticity != cloth::Elasticity::kMassSpring) return elasticity;
  if (scene.effects.bending_hysteresis) {
    value.refuse("is not allowed if model lists bending_hysteresis");
  }
  if (file.has("bending")) {
    file.at("bending").refuseBecause("is not allowed with mass_spring, which bends by springs");
  }
  return elasticity;
}

void readTimeSteps(const YamlValue& value, Scene& scene) {
  if (value.isMap()) {
    scene.adaptive_steps = readAdaptiveSteps(value);
    scene.time_step = scene.adaptive_steps->longest;
  } else {
    scene.time_step = readTimeStep(value);
  }
}

Scene readScene(const std::string& path, OtherSheet other) {
  const YamlValue file = YamlValue::load(path);
  file.requireKeys(
      {"fabric", "attach", "model", "time_step"},
      {"sheet", "mesh", "elasticity", "gravity", "bending", "air", "wind", "integrator", "solver",
       "obstacles", "penalty", "haptics", "state", "regions", "frames", "fasteners", "stuffing"});
  Scene scene;
  scene.fabric_path = resolveFile(file.at("fabric"), "fabrics", ".yaml");
  scene.any_cells = allowsAnyCells(file);
  mesh::MeshGroups groups;
  if (!scene.any_cells) other.cell_size = 0.0;
  scene.mesh = readMesh(file, other, groups);
  Attachments attachments = readAttachments(file, scene.mesh);
  scene.attached_particles = std::move(attachments.particles);
  scene.frames = std::move(attachments.frames);
  if (file.has("state")) startFrom(file.at("state"), scene);
  const Listed listed = readModel(file);
  requireListedKeys(file, listed);
  scene.effects = readEffects(file, listed);
  if (file.has("fasteners")) {
    scene.effects.fasteners = readFasteners(file.at("fasteners"), scene.mesh, groups);
  }
  scene.fingers = listed.count("fingers") > 0;
  scene.tactile = listed.count("tactile") > 0;
  scene.recording = listed.count("recording") > 0;
  scene.effects.elasticity = readElasticity(file, listed, scene);
  if (file.has("regions")) {
    scene.region_fabric_paths =
        readRegions(file, scene.fabric_path, scene.effects, groups, scene.mesh);
  }
  readTimeSteps(file.at("time_step"), scene);
  scene.step = readStepSettings(file);
  const bool among_obstacles = scene.effects.contacts;
  if (scene.effects.self_collision &&
      !cloth::collidesWithItself(scene.step.method, among_obstacles)) {
    file.at("integrator")
        .refuse(
            among_obstacles
                ? "is not allowed if model lists self_collision and obstacles: backward_euler is"
                : "is not allowed if model lists self_collision: backward_euler, bdf2 and "
                  "tr_bdf2 are");
  }
  if (file.has("obstacles")) scene.obstacles = readObstacles(file.at("obstacles"));
  requireBodiesKnown(file, scene.obstacles, scene.effects, scene.step.method);
  if (file.has("penalty")) scene.penalty = readPenalty(file, scene.effects, scene.step.method);
  if (scene.effects.contacts && scene.obstacles.empty()) {
    file.at("model").refuseBecause("lists obstacles, so the key obstacles must have at least one");
  }
  if (scene.effects.contacts && scene.effects.self_collision) {
    scene.start_move = contact::moveOutside(scene.mesh, scene.obstacles, scene.attached_particles,
                                            scene.start_time);
  }
  return scene;
}

}  // namespace

Scene loadScene(const std::string& path) { return readScene(path, {}); }

Scene loadScene(const std::string& path, const SheetChange& change) {
  requireSound(change);
  const YamlValue file = YamlValue::load(path);
  if (!file.has("sheet")) file.refuseBecause("has a mesh from a file: allowed is another sheet");
  if (file.has("state")) {
    file.at("state").refuseBecause("is of the cells of the file: allowed is no other sheet");
  }
  return readScene(path, {0.0, change});
}

Scene loadScene(const std::string& path, double cell_size) {
  if (!std::isfinite(cell_size) || cell_size <= 0.0) {
    throw std::invalid_argument("cell_size is " + std::to_string(cell_size) +
                                " m; it must be finite and > 0");
  }
  return readScene(path, {cell_size, {}});
}

}  // namespace haptex::scene
