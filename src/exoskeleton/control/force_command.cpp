#include "haptex/exoskeleton/control/force_command.h"

namespace haptex::exoskeleton {

using Eigen::Vector3d;

Vector3d evaluate(const ForceCommand& command, const Vector3d& p, const Vector3d& v) {
  return command.force - command.stiffness * (p - command.position) -
         command.damping * (v - command.velocity);
}

bool isFinite(const ForceCommand& command) {
  return command.force.allFinite() && command.position.allFinite() &&
         command.velocity.allFinite() && command.stiffness.allFinite() &&
         command.damping.allFinite();
}

}  // namespace haptex::exoskeleton
