#include "haptex/nodes/tactile_driver/array_messages.h"

#include <sstream>
#include <stdexcept>
#include <string>

#include "haptex/base/quoted.h"
#include "haptex/nodes/wire/frame_names.h"

namespace haptex::nodes {
namespace {

/// NaN compares false. @returns m
double displacementIn(const char* field, int contactor, double micrometres) {
  if (micrometres >= 0.0 && micrometres <= kLargestAmplitude) return 1e-6 * micrometres;
  std::ostringstream text;
  text << field << "[" << contactor << "] = " << micrometres << ": allowed are numbers from 0 to "
       << kLargestAmplitude << " um";
  throw std::invalid_argument(text.str());
}

}  // namespace

tactile::ArrayAmplitudes amplitudesIn(base::Finger finger, const haptex::Tactile& message) {
  const std::string frame = arrayFrame(finger);
  if (message.header.frame_id != frame) {
    throw std::invalid_argument("frame_id = " + base::quoted(message.header.frame_id) +
                                ": allowed is " + frame);
  }
  tactile::ArrayAmplitudes amplitudes;
  for (int i = 0; i < tactile::kContactors; ++i) {
    amplitudes[i][tactile::k40] = displacementIn("amplitudes_40", i, message.amplitudes_40[i]);
    amplitudes[i][tactile::k320] = displacementIn("amplitudes_320", i, message.amplitudes_320[i]);
  }
  return amplitudes;
}

}  // namespace haptex::nodes
