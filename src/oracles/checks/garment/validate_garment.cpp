#include "haptex/oracles/checks/garment_oracles.h"

namespace haptex::oracles {

void validateGarment(const std::string& config_directory, const Sink& sink) {
  validateSeams(sink);
  validateCones(sink);
  validateSewnStrips(sink);
  validateBodies(config_directory, sink);
  validatePreposition(config_directory, sink);
  validateLinkage(config_directory, sink);
  validateFasteners(config_directory, sink);
  validateStuffing(sink);
}

}  // namespace haptex::oracles
