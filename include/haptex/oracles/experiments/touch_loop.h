// A person who touches cloth through the exoskeleton: device, driver, small-scale layer and cloth
// in one loop of simulated time, without clocks.
#pragma once

#include <Eigen/Geometry>
#include <deque>
#include <functional>
#include <string>

#include "haptex/oracles/experiments/exoskeleton_loop.h"
#include "haptex/oracles/experiments/haptic_loop.h"
#include "haptex/oracles/experiments/pinch.h"

namespace haptex::oracles {

struct TouchLoopSettings {
  HapticLoopSettings cloth;
  Eigen::Vector3d pinched = Eigen::Vector3d::Zero();  ///< m, world: where the pads would meet
  bool linearised = true;  ///< commands carry stiffness and damping; if not, the force alone
  int delay = 0;           ///< ms: how much later the force for a measured position is commanded
};

/// The fingers close along the world's x axis, the index finger on the side of +x. The hand's
/// fixation to the world moves with shift().
class TouchLoop {
 public:
  /// Homes and enables the device with open fingers.
  /// @throws std::runtime_error if there is no pinch, or what ExoskeletonLoop throws
  TouchLoop(const std::string& urdf, const exoskeleton::FingerMechanics& person,
            const TouchLoopSettings& settings);

  /// The person closes or opens both fingers along a minimum-jerk path.
  /// @param gap m, between the surfaces of the fingertips where the person wants to have them
  void close(double gap, double seconds);
  /// The hand moves along a minimum-jerk path. @param by m, world
  void shift(const Eigen::Vector3d& by, double seconds);
  void rest(double seconds);

  /// Called after every millisecond.
  using Observer = std::function<void(const TouchLoop&)>;
  void observe(Observer observer) { observer_ = std::move(observer); }

  /// N, world: the device's on the person, and what the cloth asked for.
  Eigen::Vector3d felt(base::Finger finger) const;
  Eigen::Vector3d rendered(base::Finger finger) const;
  /// J, work that the person has done on the device, less what came back.
  double work(base::Finger finger) const { return work_[finger]; }

  const HapticLoop& cloth() const { return cloth_; }
  const ExoskeletonLoop& device() const { return device_; }

 private:
  void aim(double gap);
  void tick();
  exoskeleton::ForceCommand command(base::Finger finger);
  void stepCloth();

  TouchLoopSettings settings_;
  Pinch pinch_;
  ExoskeletonLoop device_;
  HapticLoop cloth_;
  Eigen::Isometry3d hand_;         // hand_base to world
  Eigen::Vector3d hand_velocity_;  // m/s, world
  double gap_ = 0.0;               // m
  base::PerFinger<std::deque<exoskeleton::ForceCommand>> on_their_way_;
  base::PerFinger<double> work_{};
  base::PerFinger<Eigen::Vector3d> last_place_;
  Observer observer_;
};

}  // namespace haptex::oracles
