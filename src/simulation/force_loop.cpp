#include "haptex/simulation/force_loop.h"

#include <algorithm>

namespace haptex::simulation {
namespace {

using base::kFingers;
using base::Time;

constexpr double kUsualPeriod = 0.0125;   // s, of simulated time, until two states have come
constexpr double kLongestPeriod = 0.2;    // s, likewise; what comes later is another simulation
constexpr int kTicksPerView = 3;          // between two views without a new state
constexpr double kMinNormalForce = 1e-9;  // N, weight of a contact without force

std::optional<Time> timeOf(std::int64_t nanoseconds) {
  return nanoseconds < 0 ? std::nullopt : std::optional<Time>(Time(nanoseconds));
}

}  // namespace

void fillActingLoads(const LoopView& view, std::vector<cloth::PointLoad>& loads) {
  loads.clear();
  if (!(view.load_gain > 0.0)) return;
  loads.assign(view.loads.begin(), view.loads.end());
  for (cloth::PointLoad& load : loads) {
    load.force *= view.load_gain;
    load.stiffness *= view.load_gain;
  }
}

ContactPicture::ContactPicture() {
  positions.reserve(kMaxParticles);
  contact_forces.reserve(kMaxParticles);
  triangles.reserve(2 * kMaxParticles);
  for (contact::FingertipContact& contact : contacts.values) {
    contact.points.reserve(contact::HapticLayer::kMaxContactPoints);
  }
}

ForceLoop::ForceLoop(const base::PerFinger<double>& radii)
    : radii_(radii), state_period_(kUsualPeriod) {
  for (Rendered& rendered : rendered_.values) {
    rendered.contact.points.reserve(contact::HapticLayer::kMaxContactPoints);
  }
}

void ForceLoop::receivePose(Finger finger, const Eigen::Isometry3d& in_hand_base, Time arrival,
                            Time measured) {
  FingerInput& input = inputs_[finger];
  const std::lock_guard<std::mutex> lock(input.writers);
  input.pose.write({in_hand_base, arrival, measured, true});
}

void ForceLoop::receiveTwist(Finger finger, const FingertipTwist& in_hand_base, Time arrival) {
  FingerInput& input = inputs_[finger];
  const std::lock_guard<std::mutex> lock(input.writers);
  input.twist.write({in_hand_base, arrival, true});
}

void ForceLoop::receiveHandBase(const Eigen::Isometry3d& in_world, Time time, Time arrival,
                                bool fixed) {
  hand_base_.write({in_world, time, arrival, fixed});
}

void ForceLoop::receiveHeartbeat(Time arrival) { heartbeat_ = arrival.count(); }

void ForceLoop::receiveState(const LargeScaleState& state, Time arrival) {
  incoming_state_.state = state;
  incoming_state_.arrival = arrival;
  states_.write(incoming_state_);
}

void ForceLoop::receiveArray(Finger finger, const Eigen::Isometry3d& in_fingertip) {
  inputs_[finger].array.write({in_fingertip, true});
}

void ForceLoop::reportAnswer(bool good) {
  answered_ = good;
  question_ = kNever;
}

const LoopView& ForceLoop::view() {
  views_.update();
  return views_.value();
}

const ContactPicture& ForceLoop::picture() {
  pictures_.update();
  return pictures_.value();
}

ForceLoopStatus ForceLoop::status() const {
  const std::lock_guard<std::mutex> lock(status_readers_);
  shown_status_.update();
  return shown_status_.value();
}

void ForceLoop::tick(Time now) {
  takeUpdate();
  const bool state_taken = takeClothState();
  takeFingers(now);
  liveness_.update(news_, now);
  step();
  const bool loads_due = loadsAreDue(state_taken, now);
  if (loads_due) ++view_.loadings;
  showView(state_taken || loads_due);
  if (picture_wanted_.exchange(false)) showPicture();
  ++status_.ticks;
  showStatus();
}

void ForceLoop::takeUpdate() {
  LayerUpdate* update = updates_.offered();
  if (update == nullptr) return;
  if (update->replaces_layer) {
    std::swap(layer_, update->layer);
    layer_particles_ = update->particles;
    layer_mesh_ = update->mesh;
    liveness_.restart();
    receiveState(state_period_);
  }
  if (update->replaces_patch && layer_) {
    update->patch = layer_->exchange(std::move(update->patch));
    ++status_.patches;
  }
  updates_.finish();
}

/// @returns whether there was one that fits the mesh
bool ForceLoop::takeClothState() {
  if (!states_.update()) return false;
  const State& state = states_.value();
  const double period =
      simulated_time_ ? state.state.simulated_time - *simulated_time_ : kUsualPeriod;
  simulated_time_ = state.state.simulated_time;
  news_.cloth_state = state.arrival;
  if (period == 0.0) return false;  // the same state again, of a simulation that is paused
  if (period > 0.0 && period <= kLongestPeriod) {
    state_period_ = period;
  } else {
    liveness_.restart();  // reset or started anew: the cloth jumps
  }
  news_.cloth_period =
      std::chrono::duration_cast<Time>(std::chrono::duration<double>(state_period_));
  receiveState(state_period_);
  ++status_.states;
  return true;
}

/// Not of another sheet, though that may have as many particles.
bool ForceLoop::isOfLayer(const LargeScaleState& state) const {
  return state.mesh == layer_mesh_ && state.positions.size() == layer_particles_;
}

/// Also a new layer starts from the last state.
void ForceLoop::receiveState(double period) {
  const LargeScaleState& state = states_.value().state;
  if (!layer_ || state.positions.empty()) return;
  if (!isOfLayer(state)) {
    ++status_.other_sizes;
    return;
  }
  layer_->receive(state.positions, state.velocities, period, state.simulated_time);
}

void ForceLoop::takeFingers(Time now) {
  if (hand_base_.update()) {
    const HandBase& hand = hand_base_.value();
    follower_.receive(hand.pose, hand.time, now);
    news_.hand_base = hand.arrival;
    news_.hand_base_fixed = hand.fixed;
  }
  hand_ = follower_.at(now);
  for (const Finger finger : kFingers) {
    FingerInput& input = inputs_[finger];
    input.pose.update();
    input.twist.update();
    input.array.update();
    const Pose& pose = input.pose.value();
    const Twist& twist = input.twist.value();
    if (pose.known && twist.known) {
      news_.fingertips[finger] = std::min(pose.arrival, twist.arrival);
    }
  }
  news_.heartbeat = timeOf(heartbeat_);
  news_.proximity_answered = answered_;
  news_.question = timeOf(question_);
  news_.proximity_needed =
      layer_ && layer_->settings().layer == contact::HapticSettings::Layer::kPatch;
  news_.layer_ready = layer_ready_ && layer_ && isOfLayer(states_.value().state);
}

/// Whether it is known where the fingertip is, or was until a moment ago.
bool ForceLoop::isPresent(Finger finger) const {
  const bool silent = liveness_.isSilent(finger, RendererSource::kFingertip) ||
                      liveness_.isSilent(finger, RendererSource::kHandBase);
  return !silent || liveness_.gain(finger) > 0.0;
}

/// In the world frame.
contact::Fingertip ForceLoop::fingertip(Finger finger) const {
  const Pose& pose = inputs_[finger].pose.value();
  const FingertipTwist& twist = inputs_[finger].twist.value().twist;
  const Eigen::Matrix3d turn = hand_.pose.linear();
  const Eigen::Vector3d arm = turn * pose.pose.translation();
  contact::Fingertip fingertip;
  fingertip.position = hand_.pose.translation() + arm;
  fingertip.orientation = Eigen::Quaterniond(turn * pose.pose.linear()).normalized();
  fingertip.velocity = hand_.velocity + hand_.angular_velocity.cross(arm) + turn * twist.velocity;
  fingertip.angular_velocity = hand_.angular_velocity + turn * twist.angular_velocity;
  fingertip.radius = radii_[finger];
  return fingertip;
}

void ForceLoop::step() {
  for (const Finger finger : kFingers) {
    if (isPresent(finger)) {
      fingertips_[finger] = view_.fingertips[finger] = fingertip(finger);
    } else {
      fingertips_[finger].reset();
    }
  }
  if (layer_) {
    layer_->step(fingertips_);
    if (!layer_->lastStepAccepted()) {
      ++status_.rejected_steps;
      liveness_.restart();
    }
  }
  for (const Finger finger : kFingers) {
    // The patch is needed where the cloth holds the fingertip.
    if (layer_ && layer_->held(finger)) view_.fingertips[finger] = layer_->held(finger);
  }
  static const contact::FingertipContact no_contact;
  for (const Finger finger : kFingers) {
    Rendered& rendered = rendered_[finger];
    const std::optional<contact::Fingertip>& fingertip = fingertips_[finger];
    rendered.contact = layer_ && fingertip ? layer_->contacts()[finger] : no_contact;
    rendered.gain = liveness_.gain(finger);
    rendered.measured = inputs_[finger].pose.value().measured;
    rendered.contactor_forces.fill(0.0);
    rendered.array = {Eigen::Vector2d::Zero(), Eigen::Matrix2d::Zero()};
    if (!fingertip) {
      rendered.contact.position = hand_.pose * inputs_[finger].pose.value().pose.translation();
      continue;
    }
    rendered.contact.position = fingertip->position;
    rendered.contact.velocity = fingertip->velocity;
    const Array& array = inputs_[finger].array.value();
    if (array.known && rendered.contact.touching && contactors_wanted_[finger]) {
      rendered.contactor_forces =
          contact::contactorForces(rendered.contact, *fingertip, array.pose);
      rendered.array = contact::arrayOnFabric(rendered.contact, *fingertip, array.pose);
    }
  }
}

/// The loads of both fingertips are one list, and in a pinch they act on the same points. Their
/// gain is the mean by normal force, so that a finger that comes back to the cloth does not take
/// away what another one holds.
double ForceLoop::loadGain() const {
  double sum = 0.0, weights = 0.0;
  for (const Finger finger : kFingers) {
    const Rendered& rendered = rendered_[finger];
    if (!rendered.contact.touching) continue;
    const double weight = rendered.contact.normal_force + kMinNormalForce;
    sum += weight * rendered.gain;
    weights += weight;
  }
  return weights > 0.0 ? sum / weights : 0.0;
}

/// Once per state: kLoadLead before the next step, or with the state after it if that is sooner.
bool ForceLoop::loadsAreDue(bool state_taken, Time now) {
  const bool overdue = state_taken && loads_due_;
  if (state_taken) {
    const State& state = states_.value();
    const std::chrono::duration<double> until_next(state.state.until_next);
    loads_due_ = state.arrival + std::chrono::round<Time>(until_next) - kLoadLead;
  }
  const bool due = loads_due_ && now >= *loads_due_;
  if (due) loads_due_.reset();
  return due || overdue;
}

void ForceLoop::showView(bool has_news) {
  if (!has_news && ++ticks_to_view_ < kTicksPerView) return;
  ticks_to_view_ = 0;
  view_.states = status_.states;
  view_.state_period = state_period_;
  view_.loads.clear();
  if (layer_) view_.loads.assign(layer_->loads().begin(), layer_->loads().end());
  view_.is_pinched = layer_ && layer_->isPinched();
  view_.mesh = layer_mesh_;
  view_.load_gain = loadGain();
  views_.write(view_);
  if (has_news) news_came_.post();
}

void ForceLoop::showPicture() {
  for (const Finger finger : kFingers) {
    picture_.contacts[finger] = rendered_[finger].contact;
    picture_.gains[finger] = rendered_[finger].gain;
  }
  picture_.positions.clear();
  picture_.contact_forces.clear();
  picture_.triangles.clear();
  const contact::Patch* patch = layer_ ? layer_->patch() : nullptr;
  if (patch != nullptr && patch->particleCount() <= ContactPicture::kMaxParticles &&
      patch->triangles().size() <= 2 * ContactPicture::kMaxParticles) {
    picture_.positions = patch->positions();
    picture_.contact_forces = patch->contactForces();
    picture_.triangles = patch->triangles();
  }
  pictures_.write(picture_);
}

void ForceLoop::showStatus() {
  status_.news = news_;
  for (const Finger finger : kFingers) {
    const Rendered& rendered = rendered_[finger];
    status_.fingers[finger] = {rendered.gain, rendered.contact.touching,
                               rendered.gain * rendered.contact.force.norm(),
                               rendered.gain * rendered.contact.normal_force};
  }
  for (const RendererSource source : kRendererSources) {
    status_.silences[static_cast<std::size_t>(source)] = liveness_.silences(source);
  }
  status_.patch_particles = layer_ ? layer_->particleCount() : 0;
  shown_status_.write(status_);
}

}  // namespace haptex::simulation
