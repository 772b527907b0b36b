#include "haptex/scene/stuffing_values.h"

namespace haptex::scene {
namespace {

double readPositive(const base::YamlValue& value) {
  const double number = value.number();
  if (!(number > 0.0)) value.refuse("must be greater than 0");
  return number;
}

}  // namespace

void requireStuffing(const base::YamlValue& scene, bool fingers) {
  const base::YamlValue model = scene.at("model");
  if (!scene.has("stuffing")) {
    model.refuseBecause("lists stuffing, so the key stuffing is required");
  }
  if (fingers) {
    model.refuseBecause(
        "lists stuffing and fingers, whose patches do not know its pressure: allowed is one of "
        "both");
  }
}

cloth::StuffingMass readStuffing(const base::YamlValue& value) {
  value.requireKeys({"volume", "modulus"});
  return {readPositive(value.at("volume")), readPositive(value.at("modulus"))};
}

}  // namespace haptex::scene
