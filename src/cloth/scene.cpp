#include "haptex/cloth/scene.h"

#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "haptex/cloth/obj_file.h"
#include "haptex/cloth/obstacle_file.h"
#include "haptex/cloth/scene_values.h"
#include "haptex/material/yaml_reader.h"

namespace haptex::cloth {
namespace {

using material::YamlValue;

constexpr double kShortestTimeStep = 1e-6;  // s
constexpr double kLongestTimeStep = 10.0;   // s
constexpr int kMostNewtonIterations = 1000;
const Eigen::Vector3d kStandardGravity(0.0, 0.0, -9.80665);  // m/s^2

int readCells(const YamlValue& value) {
  const int cells = value.integer();
  if (cells < 1) value.refuse("must be an integer >= 1");
  return cells;
}

ClothMesh readSheet(const YamlValue& value) {
  value.requireKeys({"size", "cells", "diagonals"});
  const auto size = value.at("size").items(2);
  const auto cells = value.at("cells").items(2);
  const double width = readSize(size[0]), height = readSize(size[1]);
  const int cells_u = readCells(cells[0]), cells_v = readCells(cells[1]);
  // Each factor alone is bounded first, so that the product cannot overflow.
  requireTriangleCount(cells[0], 2LL * cells_u);
  requireTriangleCount(value.at("cells"), 2LL * cells_u * cells_v);
  const bool one_way = value.at("diagonals").oneOf({"one_way", "alternating"}) == "one_way";
  ClothMesh mesh = makeRectangle(width, height, cells_u, cells_v,
                                 one_way ? Triangulation::kOneWay : Triangulation::kAlternating);
  try {
    requireSound(mesh);
  } catch (const std::invalid_argument& defects) {
    value.refuseBecause(defects.what());
  }
  return mesh;
}

ClothMesh readMesh(const YamlValue& scene) {
  if (scene.has("sheet") == scene.has("mesh")) {
    scene.refuseBecause("must have exactly one of sheet, mesh");
  }
  if (scene.has("sheet")) return readSheet(scene.at("sheet"));
  ClothMesh mesh = loadObj(resolveFile(scene.at("mesh"), "meshes", ".obj"));
  requireTriangleCount(scene.at("mesh"), static_cast<long long>(mesh.triangles.size()));
  return mesh;
}

Side readSide(const YamlValue& value) {
  const std::string side = value.oneOf({"top", "bottom", "left", "right"});
  if (side == "top") return Side::kTop;
  if (side == "bottom") return Side::kBottom;
  return side == "left" ? Side::kLeft : Side::kRight;
}

int readParticle(const YamlValue& value, const ClothMesh& mesh) {
  const int particle = value.integer();
  const int count = static_cast<int>(mesh.rest_coordinates.size());
  if (particle < 0 || particle >= count) {
    value.refuse("must be a particle from 0 to " + std::to_string(count - 1));
  }
  return particle;
}

// Ascending, each particle once: sides share their corners.
std::vector<int> readAttachedParticles(const YamlValue& value, const ClothMesh& mesh) {
  std::set<int> attached;
  for (const YamlValue& item : value.items()) {
    if (item.isMap()) {
      item.requireKeys({"particles"});
      for (const YamlValue& particle : item.at("particles").items()) {
        attached.insert(readParticle(particle, mesh));
      }
    } else {
      const std::vector<int> side = sideParticles(mesh, readSide(item));
      attached.insert(side.begin(), side.end());
    }
  }
  return std::vector<int>(attached.begin(), attached.end());
}

ModelledEffects readEffects(const YamlValue& scene) {
  ModelledEffects effects;
  bool gravity = false;
  for (const YamlValue& item : scene.at("model").items()) {
    const std::string name = item.oneOf({"gravity", "viscosity", "bending"});
    bool& effect = name == "gravity"     ? gravity
                   : name == "viscosity" ? effects.viscosity
                                         : effects.bending;
    if (effect) item.refuse("is listed twice");
    effect = true;
  }
  if (gravity) effects.gravity = kStandardGravity;
  if (scene.has("gravity")) {
    if (!gravity) {
      scene.at("gravity").refuseBecause(
          "is allowed only if model lists gravity, which it does not");
    }
    const auto components = scene.at("gravity").items(3);
    for (int i = 0; i < 3; ++i) effects.gravity[i] = components[i].number();
  }
  return effects;
}

double readTimeStep(const YamlValue& value) {
  const double time_step = value.number();
  if (time_step < kShortestTimeStep || time_step > kLongestTimeStep) {
    value.refuse("must be from 1e-6 to 10 s");
  }
  return time_step;
}

IntegrationMethod readIntegrator(const YamlValue& value) {
  const std::string name =
      value.oneOf({"backward_euler", "backward_midpoint", "bdf2", "tr_bdf2", "explicit_euler",
                   "midpoint", "runge_kutta_4", "two_step_euler"});
  for (const NamedIntegrationMethod& named : kIntegrationMethods) {
    if (name == named.name) return named.method;
  }
  throw std::logic_error("the integrator " + name + " has no method");
}

LinearSolverMethod readMethod(const YamlValue& value) {
  const std::string method = value.oneOf({"automatic", "conjugate_gradient", "cholesky"});
  if (method == "automatic") return LinearSolverMethod::kAutomatic;
  return method == "cholesky" ? LinearSolverMethod::kCholesky
                              : LinearSolverMethod::kConjugateGradient;
}

void readSolver(const YamlValue& value, StepSettings& settings) {
  value.requireKeys({}, {"method", "tolerance", "newton_iterations"});
  if (value.has("method")) settings.solver = readMethod(value.at("method"));
  if (value.has("tolerance")) {
    settings.tolerance = value.at("tolerance").number();
    if (settings.tolerance <= 0.0 || settings.tolerance >= 1.0) {
      value.at("tolerance").refuse("must be > 0 and < 1");
    }
  }
  if (value.has("newton_iterations")) {
    settings.newton_iterations = value.at("newton_iterations").integer();
    if (settings.newton_iterations < 1 || settings.newton_iterations > kMostNewtonIterations) {
      value.at("newton_iterations").refuse("must be an integer from 1 to 1000");
    }
  }
}

StepSettings readStep(const YamlValue& scene) {
  StepSettings settings;
  if (scene.has("integrator")) settings.method = readIntegrator(scene.at("integrator"));
  if (!scene.has("solver")) return settings;
  if (!isImplicit(settings.method)) {
    scene.at("solver").refuseBecause("is allowed only with an implicit integrator, which " +
                                     scene.at("integrator").text() + " is not");
  }
  readSolver(scene.at("solver"), settings);
  return settings;
}

}  // namespace

Scene loadScene(const std::string& path) {
  const YamlValue file = YamlValue::load(path);
  file.requireKeys({"fabric", "attach", "model", "time_step"},
                   {"sheet", "mesh", "gravity", "integrator", "solver", "obstacles", "haptics"});
  Scene scene;
  scene.fabric_path = resolveFile(file.at("fabric"), "fabrics", ".yaml");
  scene.mesh = readMesh(file);
  scene.attached_particles = readAttachedParticles(file.at("attach"), scene.mesh);
  scene.effects = readEffects(file);
  scene.time_step = readTimeStep(file.at("time_step"));
  scene.step = readStep(file);
  if (file.has("obstacles")) scene.obstacles = readObstacles(file.at("obstacles"));
  return scene;
}

}  // namespace haptex::cloth
