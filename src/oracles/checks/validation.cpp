#include "haptex/oracles/checks/validation.h"

#include "haptex/base/yaml_reader.h"
#include "haptex/material/fabric_file.h"
#include "haptex/material/strain_measures.h"

namespace haptex::oracles {

const std::vector<Validation>& validations() {
  static const std::vector<Validation> all = {
      {"material", validateMaterial},    {"cloth", validateCloth},
      {"proximity", validateProximity},  {"self_collision", validateSelfCollision},
      {"contact", validateContact},      {"table", validateTable},
      {"regions", validateRegions},      {"body", validateBody},
      {"garment", validateGarment},      {"exoskeleton", validateExoskeleton},
      {"tactile", validateTactile},      {"tactile_driver", validateTactileDriver},
      {"appearance", validateAppearance}};
  return all;
}

std::vector<material::CurvePoint> fabricSamples(const std::string& path, const std::string& curve) {
  material::loadFabric(path);  // names what is wrong with the file
  const std::size_t dot = curve.find('.');
  const base::YamlValue value =
      base::YamlValue::load(path).at(curve.substr(0, dot)).at(curve.substr(dot + 1));
  if (!value.has("points")) value.refuseBecause("has no points");
  std::vector<material::CurvePoint> samples;
  for (const base::YamlValue& item : value.at("points").items()) {
    const std::vector<base::YamlValue> pair = item.items(2);
    samples.push_back({pair[0].number(), pair[1].number()});
  }
  const bool from_tester = value.at("quantity").text() == "force_per_width_over_engineering_strain";
  return from_tester ? material::curvePointsFromTester(samples) : samples;
}

}  // namespace haptex::oracles
