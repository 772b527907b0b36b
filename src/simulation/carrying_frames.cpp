#include "haptex/simulation/carrying_frames.h"

#include <algorithm>
#include <utility>

#include "haptex/base/quoted.h"
#include "haptex/base/require.h"
#include "haptex/simulation/particle_requests.h"

namespace haptex::simulation {
namespace {

std::vector<Eigen::Isometry3d> startsOf(const std::vector<scene::CarryingFrame>& frames) {
  std::vector<Eigen::Isometry3d> starts;
  for (const scene::CarryingFrame& frame : frames) starts.push_back(frame.start);
  return starts;
}

}  // namespace

void requireFramePose(const std::string& frame, const Eigen::Isometry3d& pose) {
  const bool is_near = pose.translation().cwiseAbs().maxCoeff() <= kMaxCoordinate;
  if (is_near && pose.matrix().allFinite()) return;  // before every step: without a text
  requireWithin("the origin of frame " + base::quoted(frame), pose.translation(), kMaxCoordinate,
                "m");
  if (!pose.linear().allFinite()) {
    base::refuse("the rotation of frame ", base::quoted(frame),
                 " is not finite: allowed are finite numbers");
  }
}

CarryingFrames::CarryingFrames(std::vector<scene::CarryingFrame> frames, std::size_t particle_count)
    : start_(std::move(frames)),
      frames_(start_),
      poses_(startsOf(start_)),
      velocities_(particle_count, Eigen::Vector3d::Zero()) {}

void CarryingFrames::carry(const std::string& name, const Eigen::Isometry3d& pose,
                           const std::vector<int>& particles, const cloth::ClothState& state) {
  for (const int particle : particles) drop(particle);
  const auto known =
      std::find_if(frames_.begin(), frames_.end(),
                   [&](const scene::CarryingFrame& frame) { return frame.name == name; });
  const std::size_t index = static_cast<std::size_t>(known - frames_.begin());
  if (known == frames_.end()) {
    frames_.push_back({name, pose, {}, {}});
    poses_.push_back(pose);
  }
  scene::CarryingFrame& frame = frames_[index];
  for (const int particle : particles) {
    frame.particles.push_back(particle);
    frame.places.push_back(pose.inverse() * state.positions[particle]);
  }
  poses_[index] = pose;
}

void CarryingFrames::drop(int particle) {
  for (scene::CarryingFrame& frame : frames_) {
    const auto found = std::find(frame.particles.begin(), frame.particles.end(), particle);
    if (found == frame.particles.end()) continue;
    frame.places.erase(frame.places.begin() + (found - frame.particles.begin()));
    frame.particles.erase(found);
  }
}

void CarryingFrames::reset() {
  frames_ = start_;
  poses_ = startsOf(start_);
  duration_ = 0.0;
}

bool CarryingFrames::moves(const cloth::Cloth& cloth, const cloth::ClothState& state) const {
  for (std::size_t f = 0; f < frames_.size(); ++f) {
    const std::vector<int>& particles = frames_[f].particles;
    for (std::size_t i = 0; i < particles.size(); ++i) {
      if (!cloth.isAttached(particles[i])) continue;
      if ((placeOf(f, i) - state.positions[particles[i]]).norm() > kStill) return true;
    }
  }
  return false;
}

void CarryingFrames::beginStep(cloth::Cloth& cloth, const cloth::ClothState& state, double duration,
                               const std::vector<char>& excluded) {
  duration_ = duration;
  for (std::size_t f = 0; f < frames_.size(); ++f) {
    const std::vector<int>& particles = frames_[f].particles;
    double longest = 0.0;
    for (std::size_t i = 0; i < particles.size(); ++i) {
      longest = std::max(longest, (placeOf(f, i) - state.positions[particles[i]]).norm());
    }
    const bool moves = longest > kStill;
    const double share = std::min(1.0, kFastest * duration / std::max(longest, kStill));
    for (std::size_t i = 0; i < particles.size(); ++i) {
      const int particle = particles[i];
      if (!excluded.empty() && excluded[particle]) continue;
      const Eigen::Vector3d& from = state.positions[particle];
      velocities_[particle] = state.velocities[particle];
      const Eigen::Vector3d way = share * (placeOf(f, i) - from);
      cloth.attach(particle, moves ? cloth::AttachmentPath{from, way, state.time, duration, true}
                                   : cloth::AttachmentPath{from, {0, 0, 0}, state.time});
    }
  }
}

FrameWrench CarryingFrames::wrench(std::size_t frame, const cloth::Cloth& cloth,
                                   const cloth::ClothState& state,
                                   const std::vector<Eigen::Vector3d>& forces) const {
  FrameWrench wrench;
  for (const int particle : frames_[frame].particles) {
    Eigen::Vector3d force = forces[particle];
    if (duration_ > 0.0) {
      force -= cloth.masses()[particle] / duration_ *
               (state.velocities[particle] - velocities_[particle]);
    }
    wrench.force += force;
    wrench.torque += (state.positions[particle] - poses_[frame].translation()).cross(force);
  }
  return wrench;
}

}  // namespace haptex::simulation
