#include "haptex/nodes/exoskeleton_emulator/grasp.h"

#include <algorithm>
#include <cmath>

namespace haptex::nodes {
namespace {

using base::Finger;

constexpr double kReached = 1e-6;  // m

}  // namespace

double Grasp::distanceOf(const Fingertips& now) {
  return (now[Finger::kIndex] - now[Finger::kThumb]).norm();
}

Grasp::Fingertips Grasp::atDistance(double distance, const Fingertips& now) {
  const double present = distanceOf(now);
  if (!(present > kReached) || !std::isfinite(distance)) return now;
  const Eigen::Vector3d middle = 0.5 * (now[Finger::kIndex] + now[Finger::kThumb]);
  const double factor = std::clamp(distance, kClosed, kFarthest) / present;
  Fingertips moved;
  for (const Finger finger : base::kFingers) {
    moved[finger] = middle + factor * (now[finger] - middle);
  }
  return moved;
}

void Grasp::close(const Fingertips& now) {
  if (!opened_) opened_ = distanceOf(now);
  wanted_ = kClosed;
}

bool Grasp::open() {
  if (!opened_) return false;
  wanted_ = opened_;
  opened_.reset();
  return true;
}

std::optional<Grasp::Fingertips> Grasp::after(double duration, const Fingertips& now) {
  if (!wanted_) return std::nullopt;
  const double present = distanceOf(now);
  const double step = kSpeed * duration;
  const double next = present + std::clamp(*wanted_ - present, -step, step);
  if (std::abs(*wanted_ - present) < kReached) {
    wanted_.reset();
    return std::nullopt;
  }
  return atDistance(next, now);
}

}  // namespace haptex::nodes
