// Between a panel's plane and the threads of its fabric.
#pragma once

#include <Eigen/Core>

#include "haptex/garment/pattern/pattern.h"

namespace haptex::garment {

/// Rest coordinates of a panel are (u along weft, v along warp) as seen from the right side of the
/// fabric; its plane (x, y) is that of its outline. All are in metres.
class Threads {
 public:
  explicit Threads(const Panel& panel) : turned_over_(isTurnedOver(panel)), warp_(panel.warp) {
    if (turned_over_) warp_.x() = -warp_.x();
  }

  Eigen::Vector2d restOf(const Eigen::Vector2d& point) const {
    const double x = turned_over_ ? -point.x() : point.x();
    return {warp_.y() * x - warp_.x() * point.y(), warp_.x() * x + warp_.y() * point.y()};
  }
  Eigen::Vector2d pointOf(const Eigen::Vector2d& rest) const {
    const double x = warp_.y() * rest.x() + warp_.x() * rest.y();
    return {turned_over_ ? -x : x, warp_.y() * rest.y() - warp_.x() * rest.x()};
  }

 private:
  bool turned_over_;
  Eigen::Vector2d warp_;
};

}  // namespace haptex::garment
