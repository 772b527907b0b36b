#include "haptex/oracles/checks/garment_oracles.h"

namespace haptex::oracles {

void validateGarment(const std::string&, const Sink& sink) {
  validateSeams(sink);
  validateCones(sink);
  validateSewnStrips(sink);
}

}  // namespace haptex::oracles
