// Fabric on a plate under one finger.
#include <cmath>
#include <string>

#include "haptex/base/workload.h"
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
    table.refinement = base::unlessSanitized(2, 1);
    const double height = kIndexRadius + law.halfThickness() - depth;
    HapticLoop loop(sheetOnPlate(table));
    press(loop, height, 0.2);
    const double exact = supportedPressForce(fabric, law, kIndexRadius, height);
    const std::string name =
        "table/press/" + fabric.name + "/" + std::to_string(std::lround(depth * 1e6)) + "um";
    sink(base::relativeTo(exact, name, exact, feltByIndex(loop).z(), pressTolerance()));
  }
}

void validateDrag(const material::Fabric& fabric, const Sink& sink) {
  for (const double speed : {0.01, 0.02, 0.03}) {
    if (base::kSanitized && speed < 0.03) continue;
    TableSettings table;
    table.fabric = fabric;
    table.refinement = base::unlessSanitized(2, 1);
    const double measured = frictionOfDrag(table, 1.5e-3, speed * Eigen::Vector3d::UnitX());
    const std::string name = "table/drag/" + std::to_string(std::lround(speed * 1e3)) + "mm_s";
    sink(base::relativeTo(table.plate_friction, name, table.plate_friction, measured,
                          dragTolerance(speed)));
  }
}

}  // namespace

double pressTolerance() { return base::unlessSanitized(0.01, 0.1); }

double dragTolerance(double speed) { return 0.005 + 1.5 * speed; }

void validateTable(const std::string& config_directory, const Sink& sink) {
  const std::string fabrics = config_directory + "/fabrics/";
  for (const char* name : {"wool", "denim", "cotton_canvas", "silk_habutae"}) {
    validatePress(material::loadFabric(fabrics + name + ".yaml"), sink);
    if (base::kSanitized) break;
  }
  validateDrag(material::loadFabric(fabrics + "wool.yaml"), sink);
}

}  // namespace haptex::oracles
