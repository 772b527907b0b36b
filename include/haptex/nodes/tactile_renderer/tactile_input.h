// What the contacts of a finger during one step of the tactile renderer come to.
#pragma once

#include <haptex/Contact.h>

#include <cstdint>
#include <optional>
#include <string>

#include "haptex/base/clock.h"
#include "haptex/tactile/contactor_array.h"

namespace haptex::nodes {

/// Since the construction.
struct TactileInputStatus {
  std::uint64_t taken = 0;                 ///< messages, no unit
  std::uint64_t dropped = 0;               ///< likewise
  std::string dropped_why;                 ///< the last one
  std::optional<base::Time> last_arrival;  ///< of a message that was taken, steady clock
};

/// Gathers messages until the step ends. Those that touchedFabric() refuses are dropped and
/// counted. Which step a message belongs to is decided by its arrival: stamps are another
/// computer's.
class TactileInput {
 public:
  void receive(const haptex::Contact& message, base::Time arrival);

  /// Ends a step and begins the next. Allocates nothing.
  /// @returns means over the step: of the forces over all of its messages, so that a contact of
  ///   half a step counts half, but of the velocity over those that touch, because half of a
  ///   velocity would be a vibration of half the frequency; and the last placement. Nothing if none
  ///   touches, or none came.
  std::optional<tactile::TouchedFabric> endStep();

  const TactileInputStatus& status() const { return status_; }
  /// Which of the cloth's fabrics the newest message that touches names.
  std::size_t fabric() const { return fabric_; }

 private:
  void add(const tactile::TouchedFabric& touched);

  TactileInputStatus status_;
  // Of the step that goes on.
  int messages_ = 0;
  int touching_ = 0;            // of these
  tactile::TouchedFabric sum_;  // but the placement is the last one
  std::size_t fabric_ = 0;
};

}  // namespace haptex::nodes
