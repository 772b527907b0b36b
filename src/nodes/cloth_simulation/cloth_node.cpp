#include "haptex/nodes/cloth_simulation/cloth_node.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <utility>
#include <vector>

#include "haptex/base/quoted.h"
#include "haptex/nodes/cloth_simulation/cloth_properties.h"
#include "haptex/nodes/common/cloth_messages.h"
#include "haptex/nodes/common/diagnostics_timer.h"
#include "haptex/nodes/common/loop_diagnostics.h"
#include "haptex/nodes/common/node_parameters.h"
#include "haptex/nodes/wire/frame_names.h"
#include "haptex/proximity/intersections.h"
#include "haptex/realtime/steady_clock.h"
#include "haptex/scene/scene_fabric.h"

namespace haptex::nodes {
namespace {

constexpr double kDefaultMarkerRate = 25.0;
constexpr double kDefaultStrainScale = 0.01;
constexpr double kRestPeriod = 0.1;  // s, between two messages of a state that does not change
constexpr std::chrono::seconds kQualityPeriod{1};  // between two messages without a change
constexpr double kShareToKeep = 0.95;              // of the cycles, inside the budget

/// How many steps there are between two messages of a rate, to the nearest whole number.
std::uint64_t stepsPerMessage(double rate, double time_step) {
  if (rate == 0.0) return 1;
  return std::max<std::uint64_t>(1, std::llround(std::min(1.0 / (rate * time_step), 1e9)));
}

std::optional<RuntimeQuality> qualityOf(const ClothNodeParameters& parameters) {
  if (!parameters.quality.any()) return std::nullopt;
  return RuntimeQuality(parameters.scene_path, parameters.quality);
}

ClothColours readColours(const ros::NodeHandle& private_node) {
  if (!private_node.hasParam("colour_by")) return ClothColours::kStrain;
  const std::string what = readText(private_node, "colour_by", "strain or fabric");
  if (what == "strain") return ClothColours::kStrain;
  if (what == "fabric") return ClothColours::kFabric;
  throw std::invalid_argument("parameter " + private_node.resolveName("colour_by") + " is " +
                              base::quoted(what) + ": allowed are strain or fabric");
}

simulation::SimulatedCloth simulate(const ClothNodeParameters& parameters,
                                    const std::optional<RuntimeQuality>& quality,
                                    const scene::Scene& scene) {
  if (quality) return quality->simulate();
  return simulation::SimulatedCloth(scene, scene::loadSceneFabrics(parameters.scene_path, scene));
}

/// What a cloth that collides with itself does about a start that intersects it or obstacles.
void warnOfTangles(const scene::Scene& scene) {
  if (!scene.effects.self_collision) return;
  if (const contact::StartMove& move = scene.start_move; move.particles > 0) {
    ROS_WARN(
        "The cloth touches an obstacle at the start, the first is '%s' (triangle %d). %d particles "
        "start up to %.3g m away from there, outside.",
        move.obstacle.c_str(), move.triangle, move.particles, move.longest);
  }
  const std::vector<proximity::TrianglePair> pairs =
      proximity::intersectingTriangles(scene.mesh.initial_positions, scene.mesh.triangles);
  if (pairs.empty()) return;
  ROS_WARN(
      "The cloth intersects itself at the start: %zu pairs of triangles, the first %d and %d. "
      "It is pulled apart there, and passes through nothing else.",
      pairs.size(), pairs[0][0], pairs[0][1]);
}

void addInput(diagnostic_updater::DiagnosticStatusWrapper& status, const std::string& name,
              const InputStatus& input) {
  status.add(name + " taken", input.taken);
  status.add(name + " refused", input.refused);
  status.add("last " + name + " refused for",
             input.refused_why.empty() ? "none" : input.refused_why);
}

void addSubsteps(diagnostic_updater::DiagnosticStatusWrapper& status,
                 const simulation::AdaptiveReport& adaptive) {
  if (adaptive.substeps == 0) return;
  status.add("substeps of the last step", adaptive.substeps);
  status.add("substeps repeated in the last step", adaptive.repeated);
  status.add("shortest substep of the last step (ms)", 1e3 * adaptive.shortest);
  status.addf("error of a substep of the last step (mm)", "%.3g%s", 1e3 * adaptive.error,
              adaptive.missed ? ", more than allowed, with the shortest substep" : "");
}

}  // namespace

ClothNodeParameters ClothNodeParameters::read(const ros::NodeHandle& private_node) {
  ClothNodeParameters parameters;
  parameters.scene_path = readScenePath(private_node);
  parameters.state_rate = readPositive(private_node, "state_rate", 0.0);
  parameters.marker_rate = readPositive(private_node, "marker_rate", kDefaultMarkerRate);
  parameters.strain_scale = readPositive(private_node, "strain_scale", kDefaultStrainScale);
  parameters.colour_by = readColours(private_node);
  parameters.quality = QualityRequest::read(private_node);
  return parameters;
}

ClothNode::ClothNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node)
    : ClothNode(node, private_node, ClothNodeParameters::read(private_node)) {}

ClothNode::ClothNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
                     const ClothNodeParameters& parameters)
    : ClothNode(node, private_node, parameters, qualityOf(parameters)) {}

ClothNode::ClothNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
                     const ClothNodeParameters& parameters,
                     const std::optional<RuntimeQuality>& quality)
    : ClothNode(node, private_node, parameters, quality,
                quality ? quality->scene() : scene::loadScene(parameters.scene_path)) {}

ClothNode::ClothNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
                     const ClothNodeParameters& parameters,
                     const std::optional<RuntimeQuality>& quality, const scene::Scene& scene)
    : node_(node),
      diagnostics_(node, private_node),
      steps_per_state_(stepsPerMessage(parameters.state_rate, scene.time_step)),
      steps_per_markers_(stepsPerMessage(parameters.marker_rate, scene.time_step)),
      markers_(scene.mesh, parameters.strain_scale, scene.obstacles, parameters.colour_by),
      state_stamp_(ros::Time::now()),
      quality_(quality),
      time_step_(scene.time_step),
      tolerance_(scene.step.tolerance),
      scene_path_(parameters.scene_path),
      strain_scale_(parameters.strain_scale),
      colour_by_(parameters.colour_by),
      particle_count_(scene.mesh.initial_positions.size()),
      triangle_count_(scene.mesh.triangles.size()),
      force_input_(node, particle_count_),
      contact_input_(scene.fingers ? std::make_unique<ContactInput>(node, triangle_count_)
                                   : nullptr),
      frames_(node),
      fasteners_(node),
      heartbeat_(node, "cloth/heartbeat"),
      loop_(
          simulate(parameters, quality, scene),
          [this](const simulation::SimulatedCloth& simulation, double until_next) {
            publishStep(simulation, until_next);
          },
          [this](simulation::SimulatedCloth& simulation) { takeForces(simulation); }) {
  ROS_INFO("Scene %s: %zu particles, %zu triangles, steps of %g ms", parameters.scene_path.c_str(),
           particle_count_.load(), triangle_count_.load(), 1e3 * time_step_);
  warnOfTangles(scene);
  advertiseTopics();
  loop_.start();
  loop_.execute([this](simulation::SimulatedCloth& simulation) {
    fabrics_ = simulation.cloth().fabrics();
    properties_ = propertiesOf(simulation.cloth().effects());
    publishMesh(simulation.cloth());
    publishQuality(simulation);
  });
  offerProperties(private_node);
  advertiseServices();
  diagnostics_.setHardwareID("none");
  diagnostics_.add("cloth simulation", [this](diagnostic_updater::DiagnosticStatusWrapper& status) {
    diagnose(status);
  });
  diagnostics_timer_ = publishOnceASecond(node_, diagnostics_);
  // Whoever judges by the age of the messages whether this node lives shall see that it does.
  rest_timer_ =
      node_.createSteadyTimer(ros::WallDuration(kRestPeriod),
                              [this](const ros::SteadyTimerEvent&) { republishIfResting(); });
}

void ClothNode::advertiseTopics() {
  const ros::SubscriberStatusCallback republish = [this](const ros::SingleSubscriberPublisher&) {
    republishIfResting();
  };
  mesh_publisher_ = node_.advertise<haptex::ClothMesh>("cloth/mesh", 1, true);
  state_publisher_ = node_.advertise<haptex::ClothState>("cloth/state", 10, republish);
  marker_publisher_ =
      node_.advertise<visualization_msgs::MarkerArray>("cloth/markers", 2, republish);
  obstacle_publisher_ =
      node_.advertise<visualization_msgs::MarkerArray>("cloth/obstacle_markers", 2, republish);
  if (quality_) {
    quality_publisher_ = node_.advertise<haptex::ClothQuality>("cloth/quality", 1, true);
  }
}

void ClothNode::publishMesh(const cloth::Cloth& cloth) {
  mesh_publisher_.publish(meshMessage(cloth, mesh_, factorsOf(properties_), ros::Time::now()));
}

void ClothNode::publishStep(const simulation::SimulatedCloth& simulation, double until_next) {
  const bool rests = until_next == simulation::RealTimeLoop::kNever;
  if (stamped_step_ != simulation.steps()) {
    stamped_step_ = simulation.steps();
    state_stamp_ = ros::Time::now();
  }
  cloth::ForcesOnce forces(simulation.cloth(), simulation.state(), forces_);
  const bool state_due = rests || stamped_step_ % steps_per_state_ == 0;
  if (state_due && state_publisher_.getNumSubscribers() > 0) {
    publishState(simulation, rests ? 0.0 : until_next, forces);
  }
  const bool markers_due = rests || stamped_step_ % steps_per_markers_ == 0;
  if (markers_due && marker_publisher_.getNumSubscribers() > 0) {
    marker_publisher_.publish(markers_.update(simulation, state_stamp_));
  }
  if (markers_due && markers_.haveMovingObstacles() &&
      obstacle_publisher_.getNumSubscribers() > 0) {
    obstacle_publisher_.publish(markers_.updateMovingObstacles(simulation, state_stamp_));
  }
  frames_.publish(simulation, state_stamp_, forces);
  fasteners_.publish(simulation, state_stamp_, state_due);
  publishQualityIfDue(simulation);
}

void ClothNode::publishQuality(const simulation::SimulatedCloth& simulation) {
  if (!quality_) return;
  const haptex::ClothQuality message = quality_->message(simulation, ros::Time::now());
  quality_publisher_.publish(message);
  published_changes_ = simulation.controller()->changes();
  quality_due_ = realtime::steadyNow() + kQualityPeriod;
  const std::lock_guard<std::mutex> lock(quality_mutex_);
  quality_message_ = message;
}

void ClothNode::publishQualityIfDue(const simulation::SimulatedCloth& simulation) {
  if (!quality_) return;
  const bool changed = published_changes_ != simulation.controller()->changes();
  if (changed || realtime::steadyNow() >= quality_due_) publishQuality(simulation);
}

/// While the cloth sleeps, only the time is new.
void ClothNode::publishState(const simulation::SimulatedCloth& simulation, double until_next,
                             cloth::ForcesOnce& forces) {
  if (simulation.asleep() && filled_step_ == simulation.computedSteps()) {
    restampStateMessage(simulation, state_stamp_, state_message_);
  } else {
    fillStateMessage(simulation, state_stamp_, forces.get(), state_message_);
    filled_step_ = simulation.computedSteps();
  }
  state_message_.until_next = until_next;
  state_publisher_.publish(state_message_);
}

void ClothNode::takeForces(simulation::SimulatedCloth& simulation) {
  // They have been checked when they came, so that this does not throw.
  force_input_.sources().apply(simulation);
  frames_.follow(simulation);
  if (!contact_input_) return;
  if (contact_input_->loads().take(loads_, realtime::steadyNow())) simulation.setPointLoads(loads_);
}

void ClothNode::republishIfResting() {
  const simulation::LoopStatus loop = loop_.status();
  if (!loop.paused && !loop.last_step_rejected) return;
  try {
    loop_.execute([](simulation::SimulatedCloth&) {});  // then every command shows the state
  } catch (const std::runtime_error&) {
    // The node is being shut down: there is nothing to show any more.
  }
}

void ClothNode::diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) {
  using diagnostic_msgs::DiagnosticStatus;
  const simulation::LoopStatus loop = loop_.status();
  if (loop.last_step_rejected) {
    status.summary(DiagnosticStatus::ERROR,
                   "a step was not finite and was rejected: the last good state stays; reset, or "
                   "undo what led to it");
  } else if (loop.paused) {
    status.summary(DiagnosticStatus::OK, "paused");
  } else if (loop.asleep) {
    status.summary(DiagnosticStatus::OK, "asleep: nothing moves, and nothing is computed");
  } else if (loop.dropped_seconds > diagnosed_drop_) {
    status.summaryf(DiagnosticStatus::WARN, "gave up %.3f s of simulated time",
                    loop.dropped_seconds - diagnosed_drop_);
  } else if (loop.real_time_factor < 0.99) {
    status.summaryf(DiagnosticStatus::WARN, "%.1f %% slower than real time",
                    100.0 * (1.0 - loop.real_time_factor));
  } else {
    status.summary(DiagnosticStatus::OK, "in real time");
  }
  diagnosed_drop_ = loop.dropped_seconds;
  addSubsteps(status, loop.last_adaptive_report);
  const bool direct = loop.last_report.solver == linear::LinearSolverMethod::kCholesky;
  status.add("simulated time (s)", loop.simulated_time);
  status.add("steps", loop.steps);
  status.add("step rate (Hz)", loop.step_rate);
  status.add("real-time factor", loop.real_time_factor);
  status.add("dropped simulated time (s)", loop.dropped_seconds);
  status.add("time step (ms)", 1e3 * time_step_);
  status.add("mean computing time of a step (ms)", 1e3 * loop.mean_step_seconds);
  status.add("largest computing time of a step (ms)", 1e3 * loop.largest_step_seconds);
  addQuantiles(status, "computing time of a step", "since the start", loop_.stepTimes());
  status.add("linear solver", direct ? "Cholesky" : "conjugate gradient");
  status.add("linear iterations", loop.last_report.linear_iterations);
  status.add("largest residual", loop.largest_residual);
  if (!quality_) status.add("tolerance", tolerance_);
  status.add("steps that missed the tolerance", loop.unsolved_steps);
  status.add("rejected steps", loop.rejected_steps);
  if (const cloth::MotionCut& cut = loop.last_report.self_cut; cut.particles > 0) {
    status.addf("kept from passing through itself",
                "%d particles, by up to %.3g mm, at particles %d, %d, %d, %d", cut.particles,
                1e3 * cut.longest, cut.between[0], cut.between[1], cut.between[2], cut.between[3]);
  }
  if (const cloth::TangleReport& tangle = loop.last_report.tangle; tangle.pairs > 0) {
    status.addf("intersects itself", "%d pairs of triangles, the first %d and %d", tangle.pairs,
                tangle.first[0], tangle.first[1]);
  }
  if (const cloth::MotionCut& cut = loop.last_report.obstacle_cut; cut.particles > 0) {
    status.addf("obstacles kept from pressing the cloth against each other",
                "by up to %.3g mm, at particles %d, %d, %d, %d (from %d on: of obstacles)",
                1e3 * cut.longest, cut.between[0], cut.between[1], cut.between[2], cut.between[3],
                static_cast<int>(particle_count_));
  }
  status.add("asleep", loop.asleep ? "yes" : "no");
  status.add("particles", particle_count_.load());
  status.add("triangles", triangle_count_.load());
  if (quality_) diagnoseQuality(status);
  diagnoseFrames(status);
  if (const FastenerCount fasteners = fasteners_.count(); fasteners.all > 0) {
    status.addf("open fasteners", "%zu of %zu", fasteners.open, fasteners.all);
    status.add("fasteners opened by force", fasteners.opened);
  }
  addInput(status, "external forces", force_input_.status());
  status.add("sources of external forces", force_input_.sources().size());
  if (contact_input_) addInput(status, "contact forces", contact_input_->status());
}

void ClothNode::diagnoseFrames(diagnostic_updater::DiagnosticStatusWrapper& status) const {
  for (const FrameStatus& frame : frames_.status()) {
    const std::string name = frameCalled(frame.name);
    if (!frame.known) {
      status.mergeSummary(diagnostic_msgs::DiagnosticStatus::WARN,
                          "tf does not connect " + name + " with " + fixedFrame() +
                              ": what it carries stays where it was");
    }
    if (frame.poses.refused > 0) {
      status.mergeSummary(diagnostic_msgs::DiagnosticStatus::WARN,
                          std::to_string(frame.poses.refused) + " poses of " + name +
                              " were refused, the last because " + frame.poses.refused_why);
    }
    status.addf("age of frame " + name + " (s)", "%.3g%s", frame.age, frame.known ? "" : ", none");
    addInput(status, "poses of frame " + name, frame.poses);
  }
}

void ClothNode::diagnoseQuality(diagnostic_updater::DiagnosticStatusWrapper& status) const {
  using diagnostic_msgs::DiagnosticStatus;
  haptex::ClothQuality quality;
  {
    const std::lock_guard<std::mutex> lock(quality_mutex_);
    quality = quality_message_;
  }
  const haptex::QualityPoint& point = quality.quality;
  if (quality.within_budget < kShareToKeep) {
    status.mergeSummaryf(DiagnosticStatus::WARN, "only %.0f %% of the cycles within %g ms",
                         100.0 * quality.within_budget, quality.budget_ms);
  }
  if (quality_->reduced(quality)) {
    status.mergeSummary(
        DiagnosticStatus::WARN,
        "by less quality to keep the budget: " + point.name + " instead of " + quality_->wanted());
  }
  status.add("quality", point.name);
  status.add("integrator", point.integrator);
  status.add("substeps", point.substeps);
  status.add("tolerance", point.solver_tolerance);
  status.add("Newton iterations", point.newton_iterations);
  status.add("budget (ms)", quality.budget_ms > 0.0 ? std::to_string(quality.budget_ms) : "none");
  status.add("smoothed computing time of a cycle (ms)", quality.cycle_ms);
  status.add("cycles within the budget (%)", 100.0 * quality.within_budget);
  status.add("load", quality.load);
  status.add("changes of quality", quality.changes);
  for (std::size_t i = 0; i < point.motion.size(); ++i) {
    status.add("expected error of position in " + point.motion[i] + " of " + point.fabric + " (mm)",
               1e3 * point.position_error[i]);
  }
}

}  // namespace haptex::nodes
