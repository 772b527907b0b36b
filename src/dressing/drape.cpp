#include "haptex/dressing/drape.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "haptex/base/constants.h"
#include "haptex/base/processors.h"
#include "haptex/base/require.h"
#include "haptex/cloth/forces/self_contact/rest_surface.h"
#include "haptex/dressing/fastened.h"
#include "haptex/dressing/overdamped_cloth.h"
#include "haptex/dressing/seam_pull.h"
#include "haptex/garment/placement/overlaps.h"

namespace haptex::dressing {
namespace {

using Eigen::Vector3d;

// N/m, of threads at most while seams close, and layers come to lie on each other: stiff ones make
// each step several times as long. A garment's weight stretches them by less than 1 %.
constexpr double kSoftModulus = 500.0;
// m, of the longest edges with which panels are sewn if shorter ones are asked for.
constexpr double kSewnEdge = 0.045;
constexpr int kMostHalvings = 8;
// Layers do not come nearer by more than a fifth in an iteration (cloth::SafeMotion).
constexpr double kThinner = 0.8;
constexpr double kThinningSpeed = 0.05;       // m/s, of the fastest particle, from turn to turn
constexpr double kFastenerStiffness = 200.0;  // N/m
constexpr double kNearer = 0.98;              // than a gap, worth waiting for
constexpr int kSlowSteps = 2;                 // at least, of what is at rest

/// A way to close seams, and what is done where they would be sewn through themselves.
struct Closing {
  double onwards;    // see SeamPull::loads()
  bool glides;       // whether what touches the body may take its time to glide along it
  bool thins;        // whether panels get thinner
  bool pulls_apart;  // whether they are sewn all the same, and then pulled apart
};

// What is expected to go on reaches its seam in a few steps, and mostly is sewn there. Where the
// sides of a seam come to lie over each other instead, all begins anew and goes slower, and then
// slower still. Where that does not help either, the first way is gone once more and what it leads
// to is pulled apart.
constexpr Closing kClosings[] = {{1.0, false, false, false},
                                 {0.5, true, false, false},
                                 {0.2, true, true, true},
                                 {1.0, false, false, true}};

// Panels whose seams do not close get thinner by so much each time, down to (m).
constexpr double kThinnerOpen = 0.5, kThinnestOpen = 0.5e-3;
constexpr double kStepGrowth = 1.5;  // of a time step from step to step, at most

void requireSound(const DrapeSettings& settings) {
  const auto require = [](const char* name, double value) {
    base::require(std::isfinite(value) && value > 0.0, "drape", name, value, "finite and > 0");
  };
  require("time_step", settings.time_step);
  require("damping", settings.damping);
  require("closing_speed", settings.closing_speed);
  require("tension", settings.tension);
  base::require(std::isfinite(settings.lift) && settings.lift >= 0.0, "drape", "lift",
                settings.lift, "finite and >= 0");
  require("thickness", settings.thickness);
  require("sewn_gap", settings.sewn_gap);
  require("patience", settings.patience);
  base::require(settings.halvings >= 0 && settings.halvings <= kMostHalvings, "drape", "halvings",
                settings.halvings, "0 to 8");
  require("most_closing_time", settings.most_closing_time);
  require("halved_speed", settings.halved_speed);
  require("farthest", settings.farthest);
  require("longest_step", settings.longest_step);
  require("rest_speed", settings.rest_speed);
  require("rest_time", settings.rest_time);
  require("most_time", settings.most_time);
}

/// With linear threads that are no stiffer than kSoftModulus.
std::vector<material::Fabric> withSoftThreads(std::vector<material::Fabric> fabrics) {
  for (material::Fabric& fabric : fabrics) {
    for (material::MembraneCurves* threads : {&fabric.weft, &fabric.warp}) {
      const double modulus = threads->elastic.evaluate(0.0).slope;
      threads->elastic = material::StrainStressCurve::linear(std::min(modulus, kSoftModulus));
    }
  }
  return fabrics;
}

class Dressing {
 public:
  Dressing(const garment::GarmentMesh& garment, const std::vector<material::Fabric>& fabrics,
           const mesh::ObstacleMesh& body, const DrapeSettings& settings)
      : garment_(garment),
        fabrics_(fabrics),
        body_(body),
        settings_(settings),
        soft_(withSoftThreads(fabrics)) {}

  DrapeOutcome run() {
    const auto begin = std::chrono::steady_clock::now();
    closeSeams();
    if (hasLayers()) thin();
    for (int i = 0; i < settings_.halvings; ++i) {
      settle(fabrics_, settings_.halved_speed);
      halveEdges();
    }
    settle(fabrics_, settings_.rest_speed);
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
    outcome_.wall_seconds = taken.count();
    countIntersections();
    return std::move(outcome_);
  }

 private:
  OverdampedCloth makeCloth(const mesh::ClothMesh& mesh,
                            const std::vector<material::Fabric>& fabrics,
                            cloth::ModelledEffects effects, std::optional<double> friction) const {
    effects.fasteners = fastened(garment_.pattern, mesh, kFastenerStiffness);
    mesh::Obstacle body{"body", body_, Eigen::Isometry3d::Identity()};
    body.friction = friction;
    return {mesh, fabrics, effects, {std::move(body)}, {settings_.damping, settings_.threads}};
  }

  void step(OverdampedCloth& cloth, double time_step, double& time) {
    outcome_.fastest = cloth.step(time_step) / time_step;
    ++outcome_.steps;
    outcome_.intersecting_states += cloth.report().tangle.pairs > 0 ? 1 : 0;
    time += time_step;
  }

  /// With soft threads, and at least so thick (m).
  std::vector<material::Fabric> thickened(double thickness) const {
    std::vector<material::Fabric> thick = soft_;
    for (material::Fabric& fabric : thick) {
      if (!fabric.compression) continue;  // which is refused
      fabric.compression->thickness = std::max(thickness, fabric.compression->thickness);
    }
    return thick;
  }

  /// m, while seams close.
  double closingThickness() const {
    const double altitude = cloth::RestSurface(garment_.mesh).shortestAltitude();
    return std::min(settings_.thickness, 0.5 * altitude);
  }

  /// m, of the fabrics as they are.
  double leastThickness() const {
    const auto thinner = [](const material::Fabric& a, const material::Fabric& b) {
      return a.compression->thickness < b.compression->thickness;
    };
    return std::min_element(fabrics_.begin(), fabrics_.end(), thinner)->compression->thickness;
  }

  bool hasLayers() const {
    const std::vector<garment::Panel>& panels = garment_.pattern.panels;
    return std::any_of(panels.begin(), panels.end(), [&](const garment::Panel& panel) {
      return panel.layer != panels.front().layer;
    });
  }

  /// From what the garment was sewn with to its fabrics as they are, in turns: where layers lie on
  /// each other they would be out of equilibrium everywhere otherwise, and too near to move.
  void thin() {
    const double least = leastThickness();
    double thickness = closingThickness();
    settle(thickened(thickness), settings_.halved_speed);
    while ((thickness *= kThinner) > least) settle(thickened(thickness), kThinningSpeed);
    settle(soft_, settings_.halved_speed);
  }

  void closeSeams() {
    const Closing* closing = std::begin(kClosings);
    while (!closeIn(*closing, closing + 1 == std::end(kClosings))) ++closing;
  }

  /// How far seams are closed.
  struct Closed {
    SeamPull pull;
    std::vector<Vector3d> positions;
    double time = 0.0;  // s
  };

  /// From the start. @return whether it is sewn: if not, it is to be tried in another way
  bool closeIn(const Closing& closing, bool is_last) {
    Closed closed{SeamPull(garment_, settings_.tension), garment_.mesh.initial_positions};
    double thickness = closingThickness();
    bool is_sewn = closeAt(thickness, closing, is_last, closed), goes_on = !is_sewn;
    while (goes_on) {
      const double thinnest = std::max(kThinnestOpen, leastThickness());
      const bool is_late = closed.time > settings_.most_closing_time;
      const bool is_thinnest = !closing.thins || thickness <= thinnest || is_late;
      const bool intersects_body = outcome_.with_body > 0;
      is_sewn = closing.pulls_apart && is_thinnest && !intersects_body && pullApart();
      goes_on = !is_sewn && closing.pulls_apart && !is_late && !(closing.thins && intersects_body);
      if (goes_on) {
        if (closing.thins) thickness = std::max(kThinnerOpen * thickness, thinnest);
        is_sewn = closeAt(thickness, closing, is_last, closed);
        goes_on = !is_sewn;
      }
    }
    outcome_.closing_time += closed.time;
    return is_sewn;
  }

  /// With panels of one thickness (m).
  /// @return whether it is sewn: otherwise it would intersect, and waiting does not help
  bool closeAt(double thickness, const Closing& closing, bool is_last, Closed& closed) {
    OverdampedCloth cloth = makeOpenCloth(closed.positions, thickness);
    const double farthest = 0.5 * settings_.closing_speed * settings_.time_step;
    double tried_at = closed.time;  // or it was not to be tried, or seams came nearer
    double moved_at = closed.time;
    double narrowest = std::numeric_limits<double>::infinity();  // m, gap, then
    while (true) {
      closed.positions = cloth.state().positions;
      outcome_.closed_gap = closed.pull.gap(closed.positions);
      const bool is_near = outcome_.closed_gap < settings_.sewn_gap;
      if (is_near && sew(closed.positions)) return true;
      if (!is_near || outcome_.closed_gap < kNearer * narrowest) {
        tried_at = closed.time;
        narrowest = outcome_.closed_gap;
      }
      const bool is_late = closed.time > settings_.most_closing_time;
      if (is_late && (is_last || !is_near)) refuseGap(closed.pull, closed.positions);
      // What intersects itself alone does not get better; what touches the body mostly glides on.
      const bool glides =
          closing.glides && outcome_.with_body > 0 && closed.time - moved_at < settings_.patience;
      if (is_late || (closed.time - tried_at >= settings_.patience && !glides)) return false;
      cloth.cloth().setPointLoads(closed.pull.loads(closed.positions, farthest, closing.onwards));
      step(cloth, settings_.time_step, closed.time);
      if (outcome_.fastest > 0.0) moved_at = closed.time;
    }
  }

  /// Panels whose seams close. @param positions m @param thickness m
  OverdampedCloth makeOpenCloth(const std::vector<Vector3d>& positions, double thickness) const {
    mesh::ClothMesh mesh = garment_.mesh;
    mesh.initial_positions = positions;
    std::vector<material::Fabric> smooth = thickened(thickness);
    for (material::Fabric& fabric : smooth) fabric.friction = 0.0;
    cloth::ModelledEffects effects;
    effects.gravity = {0.0, 0.0, settings_.lift};
    effects.bending = effects.contacts = effects.self_collision = effects.point_loads = true;
    return makeCloth(mesh, smooth, effects, 0.0);
  }

  /// @return whether what is sewn there intersects nothing
  bool sew(const std::vector<Vector3d>& positions) {
    mesh::ClothMesh mesh = garment_.mesh;
    mesh.initial_positions = positions;
    merge(mesh);
    countIntersections();
    return outcome_.with_body == 0 && outcome_.with_itself == 0;
  }

  void countIntersections() {
    outcome_.with_itself = outcome_.with_body = 0;
    const auto overlaps = garment::findOverlaps(outcome_.mesh, body_.vertices, body_.triangles);
    for (const auto& [panels, pairs] : overlaps) {
      const bool is_body = panels[1] == outcome_.mesh.panelCount();
      (is_body ? outcome_.with_body : outcome_.with_itself) += pairs;
    }
  }

  [[noreturn]] void refuseGap(const SeamPull& pull, const std::vector<Vector3d>& positions) const {
    std::ostringstream message;
    const double gap = pull.gap(positions);
    message << "after " << settings_.most_closing_time << " s ";
    if (gap < settings_.sewn_gap) {
      message << "the seams are closed to " << gap
              << " m, and sewn they would intersect: " << outcome_.with_itself
              << " pairs of triangles with themselves, " << outcome_.with_body << " with the body";
    } else {
      const mesh::Seam& seam = garment_.seams[pull.widestSeam(positions)];
      message << "the seam of the panels '" << panelOf(seam.first) << "' and '"
              << panelOf(seam.second) << "' is open by " << gap << " m, allowed are "
              << settings_.sewn_gap << " m";
    }
    message << ". Panels have to lie beside the body so that their seams can close around it";
    throw std::runtime_error(message.str());
  }

  const std::string& panelOf(const std::vector<int>& particles) const {
    const mesh::ClothMesh& mesh = garment_.mesh;
    std::size_t t = 0;
    while (std::count(mesh.triangles[t].begin(), mesh.triangles[t].end(), particles[1]) == 0) ++t;
    return garment_.panel_names[mesh.panelOf(t)];
  }

  /// Of the sewn garment, where it is.
  void halveEdges() {
    std::vector<Vector3d>& positions = garment_.mesh.initial_positions;
    for (std::size_t i = 0; i < positions.size(); ++i) {
      positions[i] = outcome_.mesh.initial_positions[merged_[i]];
    }
    garment_ = garment::halved(garment_);
    merge(garment_.mesh);
  }

  void merge(const mesh::ClothMesh& mesh) {
    mesh::MergedMesh merged = mesh::merge(mesh, garment_.seams);
    outcome_.mesh = std::move(merged.mesh);
    merged_ = std::move(merged.particles);
  }

  OverdampedCloth makeSewnCloth(const std::vector<material::Fabric>& fabrics) const {
    cloth::ModelledEffects effects;
    effects.gravity = {0.0, 0.0, -base::kStandardGravity};
    effects.bending = effects.contacts = effects.self_collision = true;
    return makeCloth(outcome_.mesh, fabrics, effects, std::nullopt);
  }

  /// Lets the sewn garment come out of itself (cloth::Untangling).
  /// @return whether it has in patience times 2
  bool pullApart() {
    OverdampedCloth cloth = makeSewnCloth(fabrics_);
    double time = 0.0;
    do {
      step(cloth, settings_.time_step, time);
    } while (cloth.report().tangle.pairs > 0 && time < 2.0 * settings_.patience);
    outcome_.settling_time += time;
    outcome_.mesh.initial_positions = cloth.state().positions;
    return cloth.report().tangle.pairs == 0;
  }

  /// @param rest_speed m/s, below which the garment is at rest
  void settle(const std::vector<material::Fabric>& fabrics, double rest_speed) {
    OverdampedCloth cloth = makeSewnCloth(fabrics);
    outcome_.at_rest = false;
    double time = 0.0, fast_at = 0.0, time_step = settings_.time_step;
    int slow_steps = 0;
    while (!outcome_.at_rest && time < settings_.most_time) {
      step(cloth, time_step, time);
      const bool tangled = cloth.report().tangle.pairs > 0;
      const bool is_fast = tangled || outcome_.fastest > rest_speed;
      if (is_fast) fast_at = time;
      slow_steps = is_fast ? 0 : slow_steps + 1;
      outcome_.at_rest = slow_steps >= kSlowSteps && time - fast_at >= settings_.rest_time;
      time_step = nextTimeStep(time_step);
    }
    outcome_.settling_time += time;
    outcome_.mesh.initial_positions = cloth.state().positions;
  }

  /// Longer as the garment slows down. @param time_step s, of the last step
  double nextTimeStep(double time_step) const {
    const double wanted =
        std::min(settings_.farthest / std::max(outcome_.fastest, 1e-9), kStepGrowth * time_step);
    return std::clamp(wanted, settings_.time_step,
                      std::max(settings_.time_step, settings_.longest_step));
  }

  garment::GarmentMesh garment_;
  const std::vector<material::Fabric>& fabrics_;
  const mesh::ObstacleMesh& body_;
  DrapeSettings settings_;
  const std::vector<material::Fabric> soft_;
  DrapeOutcome outcome_;
  std::vector<int> merged_;  // particles of the sewn mesh, for those of the garment
};

}  // namespace

int allThreads() { return std::min(base::processorCount(), cloth::kMaxThreads); }

CoarseStart coarseStart(double edge_length) {
  CoarseStart start{edge_length, 0};
  while (2.0 * start.edge_length <= kSewnEdge && start.halvings < kMostHalvings) {
    start.edge_length *= 2.0;
    ++start.halvings;
  }
  return start;
}

DrapeOutcome drape(const garment::GarmentMesh& garment,
                   const std::vector<material::Fabric>& fabrics, const mesh::ObstacleMesh& body,
                   const DrapeSettings& settings) {
  requireSound(settings);
  if (fabrics.size() != garment.fabrics.size()) {
    base::refuse("drape: there are ", fabrics.size(), " fabrics: allowed are ",
                 garment.fabrics.size(), ", those that the garment names");
  }
  return Dressing(garment, fabrics, body, settings).run();
}

}  // namespace haptex::dressing
