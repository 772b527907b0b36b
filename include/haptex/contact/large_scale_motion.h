// The large-scale cloth between two of its states.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace haptex::contact {

/// Moves every particle in a straight line from where it is to the newest state within the time
/// that the large-scale layer took for it, and then waits there. So positions never jump, and lag
/// the states by one period. Nothing allocates after the constructor.
class LargeScaleMotion {
 public:
  explicit LargeScaleMotion(std::size_t particles);

  /// @param positions m, one per particle, finite
  /// @param period    s, > 0, until they are reached
  /// @param time      s, simulated, of the positions
  void receive(const std::vector<Eigen::Vector3d>& positions, double period, double time = 0.0);
  /// @param seconds > 0
  void advance(double seconds);

  bool hasState() const { return has_state_; }
  double period() const { return period_; }  ///< s, of the newest state
  /// s, until the newest state is reached.
  double remaining() const { return (1.0 - progress_) * period_; }
  /// s, simulated, at which the cloth was where it is now: one period before that of the newest
  /// state when it comes.
  double time() const { return time_ - remaining(); }
  std::size_t particleCount() const { return target_.size(); }
  Eigen::Vector3d position(int particle) const {  ///< m
    return start_[particle] + progress_ * (target_[particle] - start_[particle]);
  }
  Eigen::Vector3d velocity(int particle) const {  ///< m/s
    if (progress_ >= 1.0) return Eigen::Vector3d::Zero();
    return (target_[particle] - start_[particle]) / period_;
  }

 private:
  std::vector<Eigen::Vector3d> start_;
  std::vector<Eigen::Vector3d> target_;
  double period_ = 1.0;    // s
  double time_ = 0.0;      // s, of the target
  double progress_ = 1.0;  // from start to target, 0 to 1
  bool has_state_ = false;
};

}  // namespace haptex::contact
