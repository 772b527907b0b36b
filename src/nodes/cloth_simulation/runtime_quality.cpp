#include "haptex/nodes/cloth_simulation/runtime_quality.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "haptex/base/quoted.h"
#include "haptex/material/fabric_file.h"
#include "haptex/nodes/common/cloth_messages.h"
#include "haptex/nodes/common/config_files.h"
#include "haptex/nodes/common/node_parameters.h"
#include "haptex/nodes/wire/frame_names.h"
#include "haptex/scene/quality_file.h"
#include "haptex/scene/scene_fabric.h"
#include "haptex/simulation/quality_calibration.h"
#include "haptex/simulation/quality_controller.h"

namespace haptex::nodes {
namespace {

// What takes longer than this many budgets is not worth measuring.
constexpr double kLongestInBudgets = 4.0;

/// Legs of right-angled triangles of the mean area, m.
double meanCellSize(const mesh::ClothMesh& mesh) {
  double doubled_area = 0.0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = mesh.restCorners(t);
    const Eigen::Vector2d first = b - a, second = c - a;
    doubled_area += std::abs(first.x() * second.y() - first.y() * second.x());
  }
  return std::sqrt(doubled_area / static_cast<double>(mesh.triangles.size()));
}

/// @throws std::invalid_argument if there is not one for the fabric
scene::Quality presetFor(const material::Fabric& fabric, const std::string& path,
                         const std::vector<scene::Quality>& of_file,
                         const std::vector<simulation::StudiedFabric>& studied) {
  const std::vector<scene::Quality> qualities = qualitiesFor(fabric, of_file, studied);
  if (qualities.size() != 1) {
    throw std::invalid_argument(path + ": has " + std::to_string(qualities.size()) +
                                " qualities for " + base::quoted(fabric.name) +
                                ": allowed is a file with one for every fabric");
  }
  return qualities.front();
}

/// By how much a cycle of a scene takes longer than of another, about.
double growthOf(const scene::Scene& scene, const scene::Scene& other) {
  return static_cast<double>(scene.mesh.triangles.size()) /
         static_cast<double>(other.mesh.triangles.size());
}

double milliseconds(double seconds) { return 1e3 * seconds; }

}  // namespace

QualityRequest QualityRequest::read(const ros::NodeHandle& private_node) {
  QualityRequest request;
  request.budget = 1e-3 * readPositive(private_node, "budget_ms", 0.0);
  if (!private_node.hasParam("quality")) return request;
  std::string quality;
  request.of_scene =
      private_node.getParam("quality", quality) && quality == QualityRequest::kOfScene;
  if (!request.of_scene) request.preset_path = readConfigPath(private_node, "quality", "presets");
  return request;
}

RuntimeQuality::RuntimeQuality(const std::string& scene_path, const QualityRequest& request)
    : scene_(scene::loadScene(scene_path)),
      fabrics_(scene::loadSceneFabrics(scene_path, scene_)),
      budget_(request.budget > 0.0 ? request.budget : std::numeric_limits<double>::infinity()),
      reducible_(request.reducible()) {
  const double cycle = scene_.time_step;
  if (reducible_) budget_ = std::min(budget_, kMaxShare * cycle);
  std::vector<scene::Quality> front = scene::loadQualities(findConfigFile("presets", "front"));
  std::vector<scene::Quality> preset;
  if (!request.preset_path.empty()) preset = scene::loadQualities(request.preset_path);
  study(front);
  study(preset);
  front = qualitiesFor(fabrics_.front(), front, studied_);
  if (!preset.empty())
    preset = {presetFor(fabrics_.front(), request.preset_path, preset, studied_)};
  if (!scene_.any_cells) front = simulation::settingsAlone(front, meanCellSize(scene_.mesh));
  const auto measure = [&](const scene::Quality& quality, int substeps) {
    return simulation::measureCycle(scene_path, fabrics_, simulation::knownTo(scene_, quality),
                                    substeps);
  };
  candidates_ = simulation::calibrate(
      front, cycle, measure,
      {reducible_ ? 0.0 : kAllowance, kLongestInBudgets * std::min(budget_, cycle)});
  for (simulation::Candidate& candidate : candidates_) {
    candidate.quality = simulation::knownTo(scene_, candidate.quality);
  }
  if (!scene_.any_cells) simulation::sortByTime(candidates_);
  if (reducible_) {
    reduce(scene_path,
           preset.empty() ? qualityOfScene() : simulation::knownTo(scene_, preset.front()));
  } else if (preset.empty()) {
    choose(scene_path);
  } else {
    rungs_ = simulation::calibrate(preset, cycle, measure, {});
    rungs_.front().quality = simulation::knownTo(scene_, rungs_.front().quality);
  }
  if (!std::isfinite(rungs_[first_].seconds)) {
    throw std::invalid_argument("quality " + base::quoted(rungs_[first_].quality.name) +
                                " cannot compute this scene: its steps are not finite");
  }
  cell_size_ = rungs_[first_].quality.cell_size;
  if (scene_.any_cells && !request.of_scene) scene_ = scene::loadScene(scene_path, cell_size_);
}

void RuntimeQuality::study(const std::vector<scene::Quality>& qualities) {
  for (const std::string& name : simulation::studiedFabricNames(qualities)) {
    const auto same = [&](const simulation::StudiedFabric& of) { return of.name == name; };
    if (std::any_of(studied_.begin(), studied_.end(), same)) continue;
    const material::Fabric fabric = material::loadFabric(findConfigFile("fabrics", name));
    studied_.push_back({name, simulation::tensileModulus(fabric)});
  }
}

void RuntimeQuality::reduce(const std::string& scene_path, const scene::Quality& wanted) {
  const int substeps = simulation::substepsOf(scene_.time_step, wanted.time_step);
  double seconds = simulation::measureCycle(scene_path, fabrics_, wanted, substeps).seconds;
  // The load tells what a cycle takes; the measurement is but where it begins.
  if (!std::isfinite(seconds)) seconds = budget_;
  // At half the rate of states a fabric that is pulled creeps out of a pinch (docs/quality.md).
  const int most_cycles = scene_.fingers ? 1 : 2;
  rungs_ = simulation::reductions(wanted, scene_.time_step, seconds, most_cycles);
  first_ = rungs_.size() - 1;
}

scene::Quality RuntimeQuality::qualityOfScene() const {
  scene::Quality quality;
  quality.name = QualityRequest::kOfScene;
  quality.cell_size = meanCellSize(scene_.mesh);
  quality.time_step = scene_.time_step;
  quality.step = scene_.step;
  return quality;
}

bool RuntimeQuality::reduced(const haptex::ClothQuality& message) const {
  return reducible_ && message.quality.name != wanted();
}

void RuntimeQuality::choose(const std::string& scene_path) {
  const std::size_t chosen =
      simulation::mostAccurateWithin(candidates_, budget_, 1.0).value_or(cheapest(candidates_));
  const std::string name = candidates_[chosen].quality.name;
  if (scene_.any_cells) {
    const double cell_size = candidates_[chosen].quality.cell_size;
    rungs_ = ladder(candidates_, cell_size, borrowed(scene_path, chosen));
  } else {
    rungs_ = ladder(candidates_);
  }
  const auto found =
      std::find_if(rungs_.begin(), rungs_.end(),
                   [&](const simulation::Candidate& rung) { return rung.quality.name == name; });
  if (found == rungs_.end()) {
    throw std::invalid_argument("no quality can compute this scene: their steps are not finite");
  }
  first_ = static_cast<std::size_t>(found - rungs_.begin());
}

/// Ways down from the chosen quality, measured on its cells.
std::vector<simulation::Candidate> RuntimeQuality::borrowed(const std::string& scene_path,
                                                            std::size_t chosen) const {
  std::vector<scene::Quality> front;
  for (const simulation::Candidate& candidate : candidates_) front.push_back(candidate.quality);
  const std::vector<scene::Quality> settings = simulation::borrowedSettings(front, chosen);
  if (settings.empty()) return {};
  const auto measure = [&](scene::Quality quality, int substeps) {
    quality.cell_size = front[chosen].cell_size;
    return simulation::measureCycle(scene_path, fabrics_, quality, substeps);
  };
  return simulation::calibrate(settings, scene_.time_step, measure,
                               {kBorrowedAllowance, std::numeric_limits<double>::infinity()});
}

simulation::SimulatedCloth RuntimeQuality::simulate(const scene::Scene& scene,
                                                    std::vector<material::Fabric> fabrics) const {
  const double growth = growthOf(scene, scene_);
  std::vector<simulation::StepPlan> plans;
  std::vector<double> costs;
  for (const simulation::Candidate& rung : rungs_) {
    plans.push_back(simulation::planOf(rung, scene_.step.threads));
    costs.push_back(growth * rung.seconds);
  }
  simulation::SimulatedCloth simulation(scene, std::move(fabrics), std::move(plans));
  simulation.setController(
      simulation::QualityController(std::move(costs), budget_, scene_.time_step, first_));
  return simulation;
}

void RuntimeQuality::setScene(const scene::Scene& scene) {
  const double growth = growthOf(scene, scene_);
  for (std::vector<simulation::Candidate>* candidates : {&candidates_, &rungs_}) {
    for (simulation::Candidate& candidate : *candidates) candidate.seconds *= growth;
  }
  scene_ = scene;
  cell_size_ = 0.0;  // none that was measured
}

haptex::QualityPoint RuntimeQuality::pointMessage(const simulation::Candidate& candidate,
                                                  const material::Fabric& fabric) const {
  const scene::Quality& quality = candidate.quality;
  haptex::QualityPoint point;
  point.name = quality.name;
  point.integrator = nameOf(quality.step.method);
  point.time_step = candidate.cycles * scene_.time_step / candidate.substeps;
  point.substeps = static_cast<std::uint32_t>(candidate.substeps);
  point.solver_tolerance = quality.step.tolerance;
  point.newton_iterations = static_cast<std::uint32_t>(quality.step.newton_iterations);
  point.cell_size = quality.cell_size;
  // If need be after a restart.
  point.cells_as_measured = scene_.any_cells && !quality.measured.empty();
  point.fabric = simulation::nearestStudied(fabric, studied_).name;
  for (const scene::MeasuredQuality& measured : simulation::measurementsOf(quality, point.fabric)) {
    point.motion.push_back(measured.motion);
    point.position_error.push_back(measured.position_error);
    point.force_error.push_back(measured.force_error);
    point.energy_error.push_back(measured.energy_error);
  }
  return point;
}

haptex::ClothQuality RuntimeQuality::message(const simulation::SimulatedCloth& simulation,
                                             const ros::Time& stamp) const {
  const simulation::QualityController& controller = *simulation.controller();
  const simulation::CycleTimes times = controller.times();
  haptex::ClothQuality message;
  message.header.stamp = stamp;
  message.header.frame_id = fixedFrame();
  const simulation::Candidate& running = rungs_[simulation.plan()];
  message.quality = pointMessage(running, simulation.cloth().fabric());
  message.quality.cells_as_measured = scene_.any_cells && !running.quality.measured.empty() &&
                                      running.quality.cell_size == cell_size_;
  for (const simulation::Candidate& rung : rungs_) message.qualities.push_back(rung.quality.name);
  message.budget_ms = std::isinf(budget_) ? 0.0 : milliseconds(budget_);
  message.cycle_ms = milliseconds(times.smoothed);
  message.worst_cycle_ms = milliseconds(times.worst);
  message.within_budget = times.within_budget;
  message.load = controller.load();
  message.changes = static_cast<std::uint32_t>(controller.changes());
  return message;
}

std::size_t RuntimeQuality::rungOf(const std::string& name) const {
  std::string names;
  for (std::size_t i = 0; i < rungs_.size(); ++i) {
    if (rungs_[i].quality.name == name) return i;
    names += (i == 0 ? "" : ", ") + rungs_[i].quality.name;
  }
  throw std::invalid_argument("quality = " + base::quoted(name) + ": allowed are " + names +
                              ", or none, for one that keeps the budget; others need a restart");
}

std::string RuntimeQuality::set(simulation::SimulatedCloth& simulation, const std::string& name,
                                double budget) {
  if (!std::isfinite(budget) || budget < 0.0) {
    std::ostringstream message;
    message << "budget_ms = " << milliseconds(budget) << ": allowed are finite numbers >= 0";
    throw std::invalid_argument(message.str());
  }
  const bool kept = name.empty() && budget > 0.0;
  const std::size_t first = !name.empty() ? rungOf(name)
                            : kept        ? simulation.plan()
                                          : rungs_.size() - 1;
  std::vector<double> costs;
  for (const simulation::Candidate& rung : rungs_) costs.push_back(rung.seconds);
  budget_ = kept ? budget : std::numeric_limits<double>::infinity();
  if (kept && reducible_) budget_ = std::min(budget_, kMaxShare * scene_.time_step);
  first_ = first;
  simulation.setController(
      simulation::QualityController(std::move(costs), budget_, scene_.time_step, first_));
  std::ostringstream message;
  message << "runs by " << rungs_[first].quality.name;
  if (kept) message << ", and by others to keep " << milliseconds(budget_) << " ms a step";
  return message.str();
}

std::string RuntimeQuality::query(const simulation::SimulatedCloth& simulation, double budget,
                                  haptex::QueryBudget::Response& response) const {
  if (!std::isfinite(budget) || budget <= 0.0) {
    std::ostringstream message;
    message << "budget_ms = " << milliseconds(budget) << ": allowed are finite numbers > 0";
    throw std::invalid_argument(message.str());
  }
  const double load = simulation.controller()->load();
  const std::optional<std::size_t> fits = simulation::mostAccurateWithin(candidates_, budget, load);
  const simulation::Candidate& candidate = candidates_[fits.value_or(cheapest(candidates_))];
  response.quality = pointMessage(candidate, simulation.cloth().fabric());
  response.affordable = fits.has_value();
  response.cycle_ms = milliseconds(load * candidate.seconds);
  response.measured = candidate.measured;
  response.needs_restart = scene_.any_cells && candidate.quality.cell_size != cell_size_;
  std::ostringstream message;
  if (fits) {
    message << milliseconds(budget) << " ms buy " << candidate.quality.name << ", which takes "
            << response.cycle_ms << " ms";
  } else {
    message << milliseconds(budget) << " ms buy nothing: the cheapest, " << candidate.quality.name
            << ", takes " << response.cycle_ms << " ms";
  }
  if (response.needs_restart) message << "; it has other cells, so the node has to start anew";
  return message.str();
}

}  // namespace haptex::nodes
