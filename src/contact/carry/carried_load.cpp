#include "haptex/contact/carry/carried_load.h"

namespace haptex::contact {
namespace {

using Eigen::Vector3d;

constexpr double kSlowness = 0.1;  // s, time constant of what K (x - p) tells
constexpr double kMost = 0.05;     // N, that it may tell at a time

}  // namespace

void CarriedLoad::send(const std::vector<cloth::PointLoad>& loads, double gain) {
  loads_.assign(loads.begin(), loads.end());
  for (cloth::PointLoad& load : loads_) {
    load.force *= gain;
    load.stiffness *= gain;
  }
}

void CarriedLoad::receive(const LargeScaleMotion& motion) {
  begin_ = end_;
  if (loads_.empty()) {
    end_.setZero();
    slow_.setZero();
    return;
  }
  Vector3d sent = Vector3d::Zero(), by_stiffness = Vector3d::Zero();
  velocity_.setZero();
  for (const cloth::PointLoad& load : loads_) {
    Vector3d place = Vector3d::Zero();
    for (int k = 0; k < 3; ++k) {
      const int corner = triangles_[load.triangle][k];
      place += load.weights[k] * motion.target(corner);
      velocity_ += load.weights[k] / static_cast<double>(loads_.size()) * motion.velocity(corner);
    }
    sent += load.force;
    by_stiffness -= load.stiffness * (place - load.position);
  }
  const double size = by_stiffness.norm();
  if (size > kMost) by_stiffness *= kMost / size;
  slow_ += motion.period() / (kSlowness + motion.period()) * (by_stiffness - slow_);
  end_ = sent + slow_;
  loads_.clear();
}

}  // namespace haptex::contact
