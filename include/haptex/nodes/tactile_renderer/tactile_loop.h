// The steps of the tactile renderer: from contacts to the amplitudes of both arrays.
#pragma once

#include <haptex/Contact.h>
#include <haptex/Tactile.h>
#include <ros/time.h>

#include <cstdint>
#include <optional>

#include "haptex/base/clock.h"
#include "haptex/base/finger.h"
#include "haptex/nodes/tactile_renderer/tactile_input.h"
#include "haptex/tactile/contactor_array.h"

namespace haptex::nodes {

/// By one thread.
class TactileLoop {
 public:
  using Finger = base::Finger;
  using Time = base::Time;

  /// @throws std::invalid_argument what tactile::requireSound() throws
  explicit TactileLoop(const tactile::ArrayLimits& limits);

  void receive(Finger finger, const haptex::Contact& message, Time arrival) {
    inputs_[finger].receive(message, arrival);
  }

  /// Ends a step of both fingers. A finger without contact, and any without a surface, gets zeros,
  /// for which nothing is computed. Allocates nothing.
  /// @param surfaces under each finger; null if there is none to be stroked
  /// @param now of the steady clock @param stamp the same moment by ROS's clock
  void step(const base::PerFinger<const tactile::Surface*>& surfaces, Time now,
            const ros::Time& stamp);

  /// Of the last step; zeros before the first.
  const base::PerFinger<haptex::Tactile>& messages() const { return messages_; }
  bool touching(Finger finger) const { return touching_[finger]; }
  /// Which of the cloth's fabrics is under a finger.
  std::size_t fabric(Finger finger) const { return inputs_[finger].fabric(); }

  const tactile::ArrayLimits& limits() const { return limits_; }
  const TactileInputStatus& input(Finger finger) const { return inputs_[finger].status(); }
  std::uint64_t steps() const { return steps_; }
  /// Steps of a finger for which amplitudes were computed.
  std::uint64_t computed() const { return computed_; }

 private:
  void step(Finger finger, const tactile::Surface* surface, double step_time,
            const ros::Time& stamp);

  const tactile::ArrayLimits limits_;
  base::PerFinger<TactileInput> inputs_;
  base::PerFinger<haptex::Tactile> messages_;
  base::PerFinger<bool> touching_;
  std::optional<Time> last_step_;
  std::uint64_t steps_ = 0;
  std::uint64_t computed_ = 0;
};

}  // namespace haptex::nodes
