#include "haptex/oracles/experiments/touch_loop.h"

#include <chrono>
#include <cmath>
#include <stdexcept>

#include "haptex/exoskeleton/control/minimum_jerk.h"

namespace haptex::oracles {
namespace {

using namespace exoskeleton;
using Eigen::Vector3d;

constexpr double kOpen = 0.02;  // m, between the fingertips at first
const PerFinger<double> kRadii{{kIndexRadius, kThumbRadius}};

Pinch requirePinch(const std::string& urdf) {
  const std::optional<Pinch> pinch = findPinch(urdf, Meeting::kPads);
  if (!pinch) throw std::runtime_error("touch loop: the exoskeleton cannot pinch");
  return *pinch;
}

Vector3d towardsIndex(const Pinch& pinch) {
  return (pinch.index_tip - pinch.thumb_tip).normalized();
}

/// m, in hand_base: of a fingertip when the surfaces are `gap` apart around where the pads met.
Vector3d tipAt(const Pinch& pinch, Finger finger, double gap) {
  const Vector3d way = towardsIndex(pinch);
  const Vector3d middle = pinch.thumb_tip + kRadii[Finger::kThumb] * way;
  const double side = finger == Finger::kIndex ? 1.0 : -1.0;
  return middle + side * (0.5 * gap + kRadii[finger]) * way;
}

Eigen::Isometry3d handPose(const Pinch& pinch, const Vector3d& pinched) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() =
      Eigen::Quaterniond::FromTwoVectors(towardsIndex(pinch), Vector3d::UnitX()).toRotationMatrix();
  const Vector3d middle = pinch.thumb_tip + kRadii[Finger::kThumb] * towardsIndex(pinch);
  pose.translation() = pinched - pose.linear() * middle;
  return pose;
}

}  // namespace

TouchLoop::TouchLoop(const std::string& urdf, const FingerMechanics& person,
                     const TouchLoopSettings& settings)
    : settings_(settings),
      pinch_(requirePinch(urdf)),
      device_(urdf, 1, person),
      cloth_(settings.cloth),
      hand_(handPose(pinch_, settings.pinched)),
      hand_velocity_(Vector3d::Zero()),
      gap_(kOpen) {
  aim(gap_);
  device_.makeReady();
  device_.setCommander([this](Finger finger, Time) { return command(finger); });
  for (const Finger finger : kFingers) {
    last_place_[finger] = device_.device().truth(finger).position;
  }
}

void TouchLoop::aim(double gap) {
  for (const Finger finger : kFingers) {
    device_.device().setTarget(finger, tipAt(pinch_, finger, gap));
  }
}

void TouchLoop::close(double gap, double seconds) {
  const int ticks = static_cast<int>(std::lround(seconds * 1e3));
  for (int i = 1; i <= ticks; ++i) {
    aim(gap_ + minimumJerk(static_cast<double>(i) / ticks) * (gap - gap_));
    tick();
  }
  gap_ = gap;
}

void TouchLoop::shift(const Vector3d& by, double seconds) {
  const int ticks = static_cast<int>(std::lround(seconds * 1e3));
  const Vector3d start = hand_.translation();
  for (int i = 1; i <= ticks; ++i) {
    const Vector3d place = start + minimumJerk(static_cast<double>(i) / ticks) * by;
    hand_velocity_ = 1e3 * (place - hand_.translation());
    hand_.translation() = place;
    tick();
  }
  hand_velocity_.setZero();
}

void TouchLoop::rest(double seconds) {
  for (int i = 0; i < std::lround(seconds * 1e3); ++i) tick();
}

void TouchLoop::tick() {
  device_.run(std::chrono::milliseconds(1), [this](const ExoskeletonLoop& loop) {
    for (const Finger finger : kFingers) {
      const EmulatedTruth& truth = loop.device().truth(finger);
      work_[finger] -= truth.contact_force.dot(truth.position - last_place_[finger]);
      last_place_[finger] = truth.position;
    }
  });
  if (observer_) observer_(*this);
}

void TouchLoop::stepCloth() {
  contact::Fingertips fingertips;
  for (const Finger finger : kFingers) {
    const FingerMeasurement& measured = device_.controller().measured(finger);
    contact::Fingertip& tip = fingertips[finger].emplace();
    tip.position = hand_ * measured.pose.translation();
    tip.orientation = Eigen::Quaterniond(hand_.linear() * measured.pose.linear());
    tip.velocity = hand_.linear() * measured.velocity + hand_velocity_;
    tip.radius = kRadii[finger];
  }
  cloth_.step(fingertips);
}

ForceCommand TouchLoop::command(Finger finger) {
  if (finger == Finger::kIndex) stepCloth();  // the first of the two to be asked
  const simulation::ForceLoop::Rendered& rendered = cloth_.forceLoop().rendered(finger);
  const contact::FingertipContact& contact = rendered.contact;
  const FingerMeasurement& measured = device_.controller().measured(finger);
  ForceCommand command;
  command.position = measured.pose.translation();
  command.velocity = measured.velocity;
  if (contact.touching) {
    const Eigen::Matrix3d to_hand = hand_.linear().transpose();
    command.force = rendered.gain * to_hand * contact.force;
    if (settings_.linearised) {
      command.stiffness = rendered.gain * to_hand * contact.stiffness * to_hand.transpose();
      command.damping = rendered.gain * to_hand * contact.damping * to_hand.transpose();
    }
  }
  std::deque<ForceCommand>& line = on_their_way_[finger];
  line.push_back(command);
  const ForceCommand arrived = line.front();
  if (static_cast<int>(line.size()) > settings_.delay) line.pop_front();
  return arrived;
}

Vector3d TouchLoop::felt(Finger finger) const {
  return hand_.linear() * device_.device().truth(finger).contact_force;
}

Vector3d TouchLoop::rendered(Finger finger) const {
  const simulation::ForceLoop::Rendered& rendered = cloth_.forceLoop().rendered(finger);
  return rendered.gain * rendered.contact.force;
}

}  // namespace haptex::oracles
