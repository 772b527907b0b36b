#include "haptex/oracles/experiments/haptic_loop.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace haptex::oracles {
namespace {

using base::Finger;
using base::kFingers;
using base::Time;
using contact::Fingertips;
using Eigen::Vector3d;

/// Until the force loop renders all of its forces.
constexpr Time kStart = simulation::RendererLiveness::kSettle +
                        simulation::RendererLiveness::kRise + std::chrono::milliseconds(5);
const Vector3d kFarAway(0.0, 0.0, 10.0);  // m
constexpr double kRounding = 1e-9;        // s

Time timeOf(double seconds) {
  return std::chrono::round<Time>(std::chrono::duration<double>(seconds));
}

scene::Scene sceneOf(const HapticLoopSettings& settings) {
  scene::Scene scene;
  scene.mesh = settings.mesh;
  scene.effects = settings.effects;
  scene.effects.point_loads = true;
  scene.attached_particles = settings.attached_particles;
  scene.obstacles = settings.obstacles;
  scene.time_step = settings.large_scale_step;
  scene.step = settings.step;
  return scene;
}

std::vector<material::Fabric> fabricsOf(const HapticLoopSettings& settings) {
  std::vector<material::Fabric> fabrics = {settings.fabric};
  fabrics.insert(fabrics.end(), settings.region_fabrics.begin(), settings.region_fabrics.end());
  return fabrics;
}

}  // namespace

HapticLoop::HapticLoop(HapticLoopSettings settings)
    : settings_(std::move(settings)),
      cloth_(sceneOf(settings_), fabricsOf(settings_)),
      hierarchy_(settings_.mesh.triangles, mesh::flatPositions(settings_.mesh)),
      force_loop_(settings_.radii),
      supply_(settings_.haptics, settings_.mesh.triangles.size()) {
  offerLayer();
  force_loop_.receiveHandBase(Eigen::Isometry3d::Identity(), Time{0}, Time{0}, true);
  force_loop_.reportAnswer(true);
  for (const Finger finger : kFingers) force_loop_.wantContactors(finger, false);
  for (ticks_ = -std::lround(base::seconds(kStart) / settings_.haptics.time_step); ticks_ < 0;) {
    sendState();
    tick({});
  }
}

/// From zero at the beginning of the start.
Time HapticLoop::now() const { return kStart + timeOf(time()); }

void HapticLoop::offerLayer() {
  auto update = std::make_unique<simulation::LayerUpdate>();
  update->layer = std::make_unique<contact::HapticLayer>(settings_.mesh, fabricsOf(settings_),
                                                         settings_.effects, settings_.haptics,
                                                         settings_.obstacles);
  update->replaces_layer = true;
  update->particles = settings_.mesh.rest_coordinates.size();
  force_loop_.offer(std::move(update));
  force_loop_.setLayerReady(true);
}

void HapticLoop::step(const Fingertips& fingertips) {
  const bool steps_cloth = time() > cloth_steps_ * settings_.large_scale_step - kRounding;
  if (steps_cloth) stepCloth();
  tick(fingertips);
  sendLoads();
  if (!steps_cloth) return;
  if (settings_.haptics.layer == contact::HapticSettings::Layer::kPatch) supplyPatch();
}

void HapticLoop::rest(const Fingertips& fingertips, double seconds) {
  const double end = time() + seconds - 0.5 * settings_.haptics.time_step;
  while (time() < end) step(fingertips);
}

void HapticLoop::tick(const Fingertips& fingertips) {
  force_loop_.receiveHeartbeat(now());
  for (const Finger finger : kFingers) sendFingertip(finger, fingertips[finger]);
  force_loop_.tick(now());
  ++ticks_;
}

void HapticLoop::sendFingertip(Finger finger, const std::optional<contact::Fingertip>& fingertip) {
  Eigen::Isometry3d pose(Eigen::Translation3d{kFarAway});
  simulation::FingertipTwist twist;
  if (fingertip) {
    if (fingertip->radius != settings_.radii[finger]) {
      std::ostringstream message;
      message << "the radius of a fingertip is " << fingertip->radius << " m: allowed is "
              << settings_.radii[finger] << " m, as in the settings";
      throw std::invalid_argument(message.str());
    }
    pose = Eigen::Translation3d(fingertip->position) * fingertip->orientation;
    twist = {fingertip->velocity, fingertip->angular_velocity};
  }
  force_loop_.receivePose(finger, pose, now());
  force_loop_.receiveTwist(finger, twist, now());
}

void HapticLoop::stepCloth() {
  std::vector<cloth::PointLoad> loads;
  if (loads_.take(loads, now())) cloth_.setPointLoads(loads);
  ++cloth_steps_;
  if (!cloth_.step()) ++rejected_steps_;
  sendState();
}

void HapticLoop::sendState() {
  sent_.positions = cloth_.state().positions;
  sent_.velocities = cloth_.state().velocities;
  sent_.simulated_time = cloth_.state().time;
  sent_.until_next = std::max(0.0, cloth_steps_ * settings_.large_scale_step - time());
  sent_.attached.clear();
  for (const auto& attachment : cloth_.cloth().attachments()) {
    sent_.attached.push_back(attachment ? 1 : 0);
  }
  force_loop_.receiveState(sent_, now());
}

void HapticLoop::sendLoads() {
  const simulation::LoopView& view = force_loop_.view();
  if (view.loadings == loadings_) return;
  loadings_ = view.loadings;
  std::vector<cloth::PointLoad> loads;
  simulation::fillActingLoads(view, loads);
  loads_.set(std::move(loads), now());
}

void HapticLoop::supplyPatch() {
  const simulation::LoopView& view = force_loop_.view();
  hierarchy_.refit(sent_.positions);
  supply_.ask(view, [&](const contact::SearchVolume& volume, contact::PatchSelection& selection) {
    hierarchy_.query(proximity::Cursor::capsule(volume.begin, volume.end, volume.radius),
                     {volume.distance, volume.count}, near_);
    for (std::size_t rank = 0; rank < near_.size(); ++rank) {
      selection.add(near_[rank].triangle, near_[rank].distance, static_cast<int>(rank),
                    settings_.haptics);
    }
    return true;
  });
  supply_.setAttached(sent_.attached);
  if (!supply_.isOutdated()) return;
  auto update = std::make_unique<simulation::LayerUpdate>();
  update->patch = supply_.prepare(layer());
  update->replaces_patch = true;
  force_loop_.offer(std::move(update));
}

void HapticLoop::releaseAll() {
  std::vector<std::uint32_t> attached;
  const auto& attachments = cloth_.cloth().attachments();
  for (std::size_t i = 0; i < attachments.size(); ++i) {
    if (attachments[i]) attached.push_back(static_cast<std::uint32_t>(i));
  }
  cloth_.release(attached);
}

int HapticLoop::patchChanges() const { return static_cast<int>(force_loop_.status().patches); }

int HapticLoop::rejectedSteps() const {
  return rejected_steps_ + static_cast<int>(force_loop_.status().rejected_steps);
}

Vector3d HapticLoop::attachmentForce() const {
  std::vector<Vector3d> forces;
  cloth_.cloth().computeForces(state(), forces);
  Vector3d sum = Vector3d::Zero();
  for (std::size_t i = 0; i < forces.size(); ++i) {
    if (cloth_.cloth().isAttached(static_cast<int>(i))) sum -= forces[i];
  }
  return sum;
}

}  // namespace haptex::oracles
