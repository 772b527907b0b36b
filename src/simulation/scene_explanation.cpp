#include "haptex/simulation/scene_explanation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <ostream>
#include <stdexcept>

#include "haptex/base/quoted.h"
#include "haptex/contact/haptic_settings.h"
#include "haptex/scene/scene_fabric.h"
#include "haptex/simulation/step_cost.h"
#include "haptex/simulation/touch_cost.h"

namespace haptex::simulation {
namespace {

constexpr double kTurn = 0.15;      // s of computing time, about, of a turn of a measurement
constexpr int kRounds = 5;          // base, scene, base
constexpr int kMilliseconds = 300;  // of touch
constexpr double kNear = 1.5;       // factor, of cells and time steps

__attribute__((format(printf, 1, 2))) std::string text(const char* format, ...) {
  char buffer[400];
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(buffer, sizeof(buffer), format, arguments);
  va_end(arguments);
  return buffer;
}

void printRow(std::ostream& out, const std::string& name, const std::string& value) {
  out << text("  %-20s ", name.c_str()) << value << '\n';
}

std::string solverName(linear::LinearSolverMethod method) {
  switch (method) {
    case linear::LinearSolverMethod::kAutomatic:
      return "the cheaper solver";
    case linear::LinearSolverMethod::kCholesky:
      return "Cholesky";
    default:
      return "conjugate gradient";
  }
}

std::string elasticityName(cloth::Elasticity elasticity) {
  switch (elasticity) {
    case cloth::Elasticity::kBilinear:
      return "cells of two triangles with the fabric's curves (bilinear)";
    case cloth::Elasticity::kMassSpring:
      return "springs (mass_spring)";
    case cloth::Elasticity::kCorotational:
      return "linear finite elements (corotational)";
    default:
      return "finite elements with the fabric's curves (green_lagrange)";
  }
}

/// A scene that is measured, with as many steps per turn as its cost allows.
class Measurement {
 public:
  Measurement(const scene::Scene& scene, const std::vector<material::Fabric>& fabrics)
      : scene_(scene), fabrics_(fabrics) {
    const std::size_t before = allocatedBytes();
    SteppedScene stepped(scene, fabrics);
    bytes_ = allocatedBytes() - before;
    const int period =
        std::max(1, static_cast<int>(std::lround(SteppedScene::kPeriod / scene.time_step)));
    stepped.secondsFor(1);  // the first step is not like the others
    const double step = stepped.secondsFor(std::min(3, period)) / std::min(3, period);
    steps_ = std::clamp(static_cast<int>(kTurn / std::max(step, 1e-9)), 1, period);
    seconds_ = stepped.secondsFor(steps_) / steps_;
  }

  std::size_t bytes() const { return bytes_; }
  double stepSeconds() const { return seconds_; }

  /// What of a step goes to what a scene has less.
  StepCost against(const scene::Scene& less) const {
    SteppedScene stepped(scene_, fabrics_), base(less, fabrics_);
    return compareSteps(stepped, base, kRounds, steps_);
  }

 private:
  const scene::Scene& scene_;
  const std::vector<material::Fabric>& fabrics_;
  std::size_t bytes_;
  int steps_;
  double seconds_;  // computing time of a step
};

void printFabrics(const scene::Scene& scene, const std::vector<material::Fabric>& fabrics,
                  std::ostream& out) {
  printRow(out, "fabric", fabrics.front().name + ", " + scene.fabric_path);
  const std::vector<int>& named = scene.mesh.triangle_fabrics;
  for (std::size_t f = 1; f < fabrics.size(); ++f) {
    const auto triangles = std::count(named.begin(), named.end(), static_cast<int>(f));
    printRow(out, "fabric of regions",
             text("%s, %s, %td triangles", fabrics[f].name.c_str(),
                  scene.region_fabric_paths[f - 1].c_str(), triangles));
  }
}

void printScene(const std::string& path, const scene::Scene& scene,
                const std::vector<material::Fabric>& fabrics, std::ostream& out) {
  out << "scene " << path << "\n\n";
  printFabrics(scene, fabrics, out);
  printRow(out, "mesh",
           text("%zu triangles, %zu particles of which %zu are attached, cells of %.3g mm",
                scene.mesh.triangles.size(), scene.mesh.initial_positions.size(),
                scene.attached_particles.size(), 1e3 * medianCellSize(scene.mesh)));
  printRow(out, "stretch and shear", elasticityName(scene.effects.elasticity));
  std::string step = text("%g ms, %s", 1e3 * scene.time_step, nameOf(scene.step.method));
  if (const auto& adaptive = scene.adaptive_steps) {
    step = text("%g to ", 1e3 * adaptive->shortest) + step +
           text(", as long as each misses at most %g mm", 1e3 * adaptive->error);
  }
  if (cloth::isImplicit(scene.step.method)) {
    step += text(", %d linear solve%s by %s to %g, %d thread%s", scene.step.newton_iterations,
                 scene.step.newton_iterations == 1 ? "" : "s at most",
                 solverName(scene.step.solver).c_str(), scene.step.tolerance, scene.step.threads,
                 scene.step.threads == 1 ? "" : "s");
    if (scene.step.newton_error > 0.0) step += text(", error %g", scene.step.newton_error);
  }
  printRow(out, "step", step);
  if (!scene.obstacles.empty()) {
    const auto bodies =
        std::count_if(scene.obstacles.begin(), scene.obstacles.end(),
                      [](const mesh::Obstacle& obstacle) { return obstacle.body.has_value(); });
    const std::string with_mass = bodies > 0 ? text(", %td with mass", bodies) : std::string();
    printRow(out, "obstacles",
             text("%zu%s, %s", scene.obstacles.size(), with_mass.c_str(),
                  scene.effects.contacts ? "with which the cloth collides"
                                         : "to be asked about only: the cloth goes through them"));
  }
}

void printCost(const std::string& path, const scene::Scene& scene,
               const std::vector<material::Fabric>& fabrics, const Measurement& measurement,
               std::ostream& out, std::ostream& progress) {
  out << "\nmodelled, and its share of a step\n";
  for (const Effect& effect : effectsOf(scene)) {
    if (!effect.listed) continue;
    std::string cost;
    if (effect.name == "tactile") {
      progress << "explain_scene: measuring tactile\n";
      cost = text("beside the steps: %.3g ms of every 25 ms, while a finger touches",
                  1e3 * measureTactile(fabrics.front(), kMilliseconds));
    } else if (effect.name == "recording") {
      cost = "beside the steps: not measured";
    } else {
      progress << "explain_scene: measuring " << effect.name << '\n';
      const StepCost against = measurement.against(withoutEffect(scene, effect.name));
      const double without = 1.0 / against.ratio, share = 1.0 - without;
      if (std::abs(share) <= against.noise) {
        cost = text("within the noise of %.0f %%", 100.0 * against.noise);
      } else if (share > 0.0) {
        cost = text("%.0f %%, noise %.0f %%", 100.0 * share, 100.0 * against.noise);
      } else {  // the cloth goes elsewhere then: what is worn falls, or is not pressed together
        cost = text("none: without it a step takes %.1f times as long", without);
      }
    }
    printRow(out, effect.name, text("%-52s ", effect.meaning.c_str()) + cost);
  }
  if (!scene.fingers) return;
  progress << "explain_scene: measuring the cloth under two fingertips\n";
  const TouchCost touch = measureTouch(scene.mesh, fabrics, scene.effects,
                                       contact::loadHapticSettings(path), kMilliseconds);
  printRow(out, "  at 1 kHz",
           text("%.2g ms of every millisecond while two fingertips touch %zu particles; %.2g ms "
                "and no patch while none is near",
                1e3 * touch.near_seconds, touch.near_particles, 1e3 * touch.far_seconds));
}

void printNotModelled(const scene::Scene& scene, std::ostream& out) {
  out << "\nnot modelled: it takes neither time nor memory\n";
  for (const Effect& effect : effectsOf(scene)) {
    if (!effect.listed) printRow(out, effect.name, effect.meaning);
  }
}

void printTotal(const scene::Scene& scene, const Measurement& measurement, std::ostream& out) {
  out << "\non this machine\n";
  const double step = measurement.stepSeconds();
  printRow(out, "step of the cloth",
           text("%.3g ms while it moves, %.3g times as fast as real time; nothing while it rests",
                1e3 * step, scene.time_step / step));
  if (step > scene.time_step) {
    printRow(out, "", "it falls behind: simulated time will pass more slowly than real time");
  }
  if (measurement.bytes() > 0) {
    printRow(out, "memory of the cloth", text("%.3g MB", 1e-6 * measurement.bytes()));
  }
}

/// As the elements of the study do.
bool followsTheCurves(cloth::Elasticity elasticity) {
  return elasticity == cloth::Elasticity::kGreenLagrange ||
         elasticity == cloth::Elasticity::kBilinear;
}

void printErrors(const scene::Scene& scene, const material::Fabric& fabric,
                 const std::vector<scene::Quality>& studied, std::ostream& out) {
  out << "\nerror to expect\n";
  const scene::Quality* quality = nearestQuality(scene, studied);
  if (quality == nullptr || quality->measured.empty()) {
    printRow(out, "not studied", "no setting like this one is in config/presets/front.yaml");
    return;
  }
  printRow(out, "nearest studied",
           text("%s: cells of %.3g mm, steps of %.3g ms, %s", quality->name.c_str(),
                1e3 * quality->cell_size, 1e3 * quality->time_step, nameOf(quality->step.method)));
  if (scene.effects.elasticity == cloth::Elasticity::kBilinear) {
    printRow(out, "", "with triangles (green_lagrange)");
  }
  if (kNear * medianCellSize(scene.mesh) < quality->cell_size) {
    printRow(out, "", "the scene's cells are finer; most of these errors comes from the step");
  }
  const bool same =
      std::any_of(quality->measured.begin(), quality->measured.end(),
                  [&](const auto& measured) { return measured.fabric == fabric.name; });
  if (!same) printRow(out, "", "not with " + fabric.name + "; with other fabrics it was");
  for (const scene::MeasuredQuality& measured : quality->measured) {
    if (same && measured.fabric != fabric.name) continue;
    printRow(out, measured.motion,
             text("%s: %.2g mm in position, %.2g N in the force that holds it, %.2g mJ in energy",
                  measured.fabric.c_str(), 1e3 * measured.position_error, measured.force_error,
                  1e3 * measured.energy_error));
  }
}

}  // namespace

std::vector<Effect> effectsOf(const scene::Scene& scene) {
  const cloth::ModelledEffects& effects = scene.effects;
  const bool wind =
      effects.air && !(effects.air->wind.mean.isZero(0.0) && effects.air->wind.gusts.empty());
  return {
      {"gravity", "weight", !effects.gravity.isZero(0.0)},
      {"viscosity", "stress by rates of strain", effects.viscosity},
      {"membrane_hysteresis", "friction within the fabric against stretch and shear",
       effects.membrane_hysteresis},
      {"bending", "resistance to bending", effects.bending},
      {"bending_hysteresis", "friction within the fabric against bending",
       effects.bending_hysteresis},
      {"contraction", "stretched fabric becomes narrower", effects.contraction},
      {"self_collision", "layers that touch, and do not pass through each other",
       effects.self_collision},
      {"stuffing", "pressure of what is inside", effects.stuffing.has_value()},
      {"air", "drag and lift of air", effects.air.has_value()},
      {"wind", "air that moves", wind},
      {"obstacles", "collision with rigid bodies", effects.contacts},
      {"fingers", "touch by fingertips", scene.fingers},
      {"tactile", "the surface under the fingertips", scene.tactile},
      {"recording", "a bag of everything", scene.recording},
  };
}

scene::Scene withoutEffect(scene::Scene scene, const std::string& name) {
  cloth::ModelledEffects& effects = scene.effects;
  if (name == "gravity") {
    effects.gravity.setZero();
  } else if (name == "viscosity") {
    effects.viscosity = false;
  } else if (name == "membrane_hysteresis") {
    effects.membrane_hysteresis = false;
  } else if (name == "bending") {
    effects.bending = effects.bending_hysteresis = false;
  } else if (name == "bending_hysteresis") {
    effects.bending_hysteresis = false;
  } else if (name == "contraction") {
    effects.contraction = false;
  } else if (name == "self_collision") {
    effects.self_collision = false;
    // What is stuffed touches obstacles in no other way.
    if (effects.stuffing) effects.contacts = false;
  } else if (name == "stuffing") {
    effects.stuffing.reset();
  } else if (name == "air") {
    effects.air.reset();
  } else if (name == "wind") {
    if (effects.air) effects.air->wind = {};
  } else if (name == "obstacles") {
    effects.contacts = false;
  } else if (name == "fingers") {
    scene.fingers = scene.tactile = effects.point_loads = false;
  } else {
    throw std::invalid_argument(base::quoted(name) +
                                " is no effect that a step of the cloth knows");
  }
  return scene;
}

double medianCellSize(const mesh::ClothMesh& mesh) {
  std::vector<double> sizes;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::array<Eigen::Vector2d, 3> rest = mesh.restCorners(t);
    std::array<double, 3> edges;
    for (int i = 0; i < 3; ++i) edges[i] = (rest[(i + 1) % 3] - rest[i]).norm();
    std::sort(edges.begin(), edges.end());
    sizes.push_back(edges[1]);
  }
  std::nth_element(sizes.begin(), sizes.begin() + sizes.size() / 2, sizes.end());
  return sizes[sizes.size() / 2];
}

const scene::Quality* nearestQuality(const scene::Scene& scene,
                                     const std::vector<scene::Quality>& studied) {
  const scene::Quality* nearest = nullptr;
  double least = HUGE_VAL;
  for (const scene::Quality& quality : studied) {
    if (!followsTheCurves(scene.effects.elasticity) || quality.step.method != scene.step.method ||
        quality.step.newton_iterations != scene.step.newton_iterations ||
        quality.step.newton_error != scene.step.newton_error) {
      continue;
    }
    const double coarser = std::log(medianCellSize(scene.mesh) / quality.cell_size);
    const double steps = std::abs(std::log(quality.time_step / scene.time_step));
    if (std::max(coarser, steps) > std::log(kNear)) continue;
    if (std::abs(coarser) + steps >= least) continue;
    least = std::abs(coarser) + steps;
    nearest = &quality;
  }
  return nearest;
}

void explainScene(const std::string& scene_path, const std::vector<scene::Quality>& studied,
                  std::ostream& out, std::ostream& progress) {
  const scene::Scene scene = scene::loadScene(scene_path);
  const std::vector<material::Fabric> fabrics = scene::loadSceneFabrics(scene_path, scene);
  printScene(scene_path, scene, fabrics, out);
  progress << "explain_scene: measuring a step\n";
  const Measurement measurement(scene, fabrics);
  printCost(scene_path, scene, fabrics, measurement, out, progress);
  printNotModelled(scene, out);
  printTotal(scene, measurement, out);
  printErrors(scene, fabrics.front(), studied, out);
}

}  // namespace haptex::simulation
