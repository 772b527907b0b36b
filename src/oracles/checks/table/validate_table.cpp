// Fabric on a plate under one finger.
#include <cmath>
#include <string>

#include "haptex/material/fabric_file.h"
#include "haptex/oracles/checks/validation.h"
#include "haptex/oracles/exact/supported_press.h"
#include "haptex/oracles/experiments/contact_scenes.h"

namespace haptex::oracles {
namespace {

/// The press as deep as a finger of 1 and of some newtons, by the patches that the scene has.
void validatePress(const material::Fabric& fabric, const Sink& sink) {
  const contact::ContactLaw law(fabric);
  for (const double depth : {1e-3, 2e-3}) {
    TableSettings table;
    table.fabric = fabric;
    table.cells = 40;
    const double height = kIndexRadius + law.halfThickness() - depth;
    HapticLoop loop(sheetOnPlate(table));
    press(loop, height, 0.2);
    const double exact = supportedPressForce(fabric, law, kIndexRadius, height);
    sink(base::relativeTo(exact, "table/press/" + std::to_string(std::lround(depth * 1e6)) + "um",
                          exact, feltByIndex(loop).z(), 0.01));
  }
}

}  // namespace

void validateTable(const std::string& config_directory, const Sink& sink) {
  validatePress(material::loadFabric(config_directory + "/fabrics/wool.yaml"), sink);
}

}  // namespace haptex::oracles
