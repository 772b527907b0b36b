// The oracles of the contact room. Each part is in a file named after it.
#include "haptex/material/fabric_file.h"
#include "haptex/oracles/checks/contact_oracles.h"

namespace haptex::oracles {

void validateContact(const std::string& config_directory, const Sink& sink) {
  const material::Fabric wool = material::loadFabric(config_directory + "/fabrics/wool.yaml");
  validateContactObstacles(sink);
  validateContactTouch(wool, sink);
  validateContactFriction(wool, sink);
  validateContactEquilibrium(wool, sink);
  validateContactFeel(wool, sink);
  validateMovedPinch(wool, sink);
}

}  // namespace haptex::oracles
