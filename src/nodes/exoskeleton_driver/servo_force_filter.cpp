#include "haptex/nodes/exoskeleton_driver/servo_force_filter.h"

#include <sstream>

#include "haptex/base/quoted.h"
#include "haptex/exoskeleton/control/command_check.h"
#include "haptex/nodes/common/driver_messages.h"
#include "haptex/nodes/common/ros_time.h"
#include "haptex/nodes/common/vector_messages.h"
#include "haptex/nodes/wire/frame_names.h"

namespace haptex::nodes {
namespace {

using base::Time;
using exoskeleton::CommandFlaw;
using exoskeleton::ForceCommand;

ForceCommand commandOf(const haptex::ServoForce& message) {
  using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  ForceCommand command;
  command.force = fromMessage(message.force);
  command.position = fromMessage(message.position);
  command.velocity = fromMessage(message.velocity);
  command.stiffness = Eigen::Map<const RowMajor>(message.stiffness.data());
  command.damping = Eigen::Map<const RowMajor>(message.damping.data());
  return command;
}

}  // namespace

const char* name(ServoForceFlaw flaw) {
  switch (flaw) {
    case ServoForceFlaw::kFrame:
      return "another frame";
    case ServoForceFlaw::kNotFinite:
      return "not finite";
    case ServoForceFlaw::kTooLarge:
      return "too large";
    case ServoForceFlaw::kActive:
      return "stiffness or damping not positive semidefinite";
    case ServoForceFlaw::kTooOld:
      return "too old";
    case ServoForceFlaw::kTooNew:
      return "from the future";
    case ServoForceFlaw::kOrder:
      return "out of order";
  }
  return "unknown";
}

std::optional<ForceCommand> ServoForceFilter::receive(const haptex::ServoForce& message,
                                                      const ros::Time& now, Time steady_now) {
  const std::optional<ServoForceFlaw> flaw = findFlaw(message, now, steady_now);
  if (flaw) {
    last_flaw_ = *flaw;
    dropped_[static_cast<std::size_t>(*flaw)].fetch_add(1, std::memory_order_relaxed);
    return std::nullopt;
  }
  last_stamp_ = message.header.stamp;
  last_time_ = steady_now;
  accepted_.fetch_add(1, std::memory_order_relaxed);
  return commandOf(message);
}

std::optional<ServoForceFlaw> ServoForceFilter::findFlaw(const haptex::ServoForce& message,
                                                         const ros::Time& now,
                                                         Time steady_now) const {
  if (message.header.frame_id != handFrame()) return ServoForceFlaw::kFrame;
  switch (exoskeleton::findFlaw(commandOf(message))) {
    case CommandFlaw::kNotFinite:
      return ServoForceFlaw::kNotFinite;
    case CommandFlaw::kTooLarge:
      return ServoForceFlaw::kTooLarge;
    case CommandFlaw::kActive:
      return ServoForceFlaw::kActive;
    case CommandFlaw::kNone:
      break;
  }
  const Time age = between(message.header.stamp, now);
  if (age > kStampTolerance) return ServoForceFlaw::kTooOld;
  if (age < -kStampTolerance) return ServoForceFlaw::kTooNew;
  const bool remembered = last_time_ && steady_now - *last_time_ <= kForgetAfter;
  if (remembered && between(last_stamp_, message.header.stamp).count() <= 0) {
    return ServoForceFlaw::kOrder;
  }
  return std::nullopt;
}

std::string ServoForceFilter::explain(const haptex::ServoForce& message,
                                      const ros::Time& now) const {
  std::ostringstream text;
  const double age = base::milliseconds(between(message.header.stamp, now));
  switch (last_flaw_) {
    case ServoForceFlaw::kFrame:
      text << "header.frame_id = " << base::quoted(message.header.frame_id) << ": allowed is '"
           << handFrame() << "'";
      break;
    case ServoForceFlaw::kNotFinite:
    case ServoForceFlaw::kTooLarge:
    case ServoForceFlaw::kActive:
      text << exoskeleton::explainFlaw(commandOf(message));
      break;
    case ServoForceFlaw::kTooOld:
    case ServoForceFlaw::kTooNew:
      text << "header.stamp is " << (age > 0.0 ? age : -age) << " ms "
           << (age > 0.0 ? "before" : "after") << " the driver's clock: allowed are "
           << base::milliseconds(kStampTolerance) << " ms";
      break;
    case ServoForceFlaw::kOrder:
      text << "header.stamp is not later than that of the command before, but by "
           << base::milliseconds(between(message.header.stamp, last_stamp_))
           << " ms earlier: allowed are later ones";
      break;
  }
  return text.str();
}

std::uint64_t ServoForceFilter::dropped(ServoForceFlaw flaw) const {
  return dropped_[static_cast<std::size_t>(flaw)].load(std::memory_order_relaxed);
}

}  // namespace haptex::nodes
