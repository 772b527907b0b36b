// Fabric on a plate under one finger: the press against the contact law with the plate behind the
// fabric, and the drag at which fabric slips on the plate.
#include <cmath>

#include "haptex/base/workload.h"
#include "haptex/material/compression.h"
#include "haptex/material/fabric_file.h"
#include "haptex/oracles/checks/random_checks.h"
#include "haptex/oracles/checks/validation.h"
#include "haptex/oracles/exact/supported_press.h"
#include "haptex/oracles/experiments/contact_scenes.h"

namespace haptex::oracles {
namespace {

using Eigen::Vector3d;

/// A woven fabric with another compression curve and friction: the sheet of the exact result does
/// not stretch, and a knit errs by up to 1.3 %.
material::Fabric drawFabric(const std::string& config_directory, Random& random) {
  static const char* const kNames[] = {"wool", "denim", "cotton_canvas", "silk_habutae"};
  material::Fabric fabric =
      material::loadFabric(config_directory + "/fabrics/" + kNames[random.below(4)] + ".yaml");
  const double thickest = random.logarithmic(0.3e-3, 1.5e-3);
  const double thinnest = thickest * random.uniform(0.5, 0.8);
  const double work = 0.5 * random.uniform(0.2, 0.4) * 4903.325 * (thickest - thinnest);
  fabric.compression = material::compressionFromKes({thickest, thinnest, work});
  fabric.friction = random.uniform(0.3, 0.6);
  return fabric;
}

}  // namespace

void randomTablePress(const std::string& config_directory, Random& random, const Sink& sink) {
  TableSettings table;
  table.fabric = drawFabric(config_directory, random);
  table.side = 0.08;
  table.cells = 24 + random.below(10);
  table.refinement = base::unlessSanitized(3, 1);
  table.plate_friction = random.uniform(0.2, 0.6);
  const contact::ContactLaw law(table.fabric);
  // At a few newtons, and without the bending that the law knows nothing of.
  table.fabric.bending = material::BendingRigidity{0.0, 0.0};
  const double depth = 0.6 * table.fabric.compression->thickness + random.uniform(1e-3, 1.8e-3);
  const double speed = random.logarithmic(2e-3, 2e-2);
  const double height = kIndexRadius + law.halfThickness() - depth;
  HapticLoop loop(sheetOnPlate(table));
  press(loop, height, depth / speed);
  const double exact = supportedPressForce(table.fabric, law, kIndexRadius, height);
  CaseName name("table", "press");
  name.with(table.fabric.name).with("thickness", table.fabric.compression->thickness);
  name.with("depth", depth).with("speed", speed).with("cells", table.cells);
  sink(base::relativeTo(exact, name.text(), exact, feltByIndex(loop).z(), pressTolerance()));
}

/// The whole sheet follows the finger at last. What resists is the plate's friction with the force
/// of the finger and with the sheet's weight.
void randomTableDrag(const std::string& config_directory, Random& random, const Sink& sink) {
  TableSettings table;
  table.fabric = drawFabric(config_directory, random);
  table.cells = 16 + random.below(8);
  table.plate_friction = *table.fabric.friction * random.uniform(0.2, 0.7);
  const double depth = 0.4 * table.fabric.compression->thickness + random.uniform(0.8e-3, 1.5e-3);
  const double speed = random.logarithmic(2e-3, 3e-2);
  const double angle = random.uniform(0.0, 2.0 * M_PI);
  CaseName name("table", "drag");
  name.with(table.fabric.name).with("friction", table.plate_friction).with("depth", depth);
  name.with("speed", speed).with("cells", table.cells);
  const double measured =
      frictionOfDrag(table, depth, speed * Vector3d(std::cos(angle), std::sin(angle), 0.0));
  sink(base::relativeTo(table.plate_friction, name.text(), table.plate_friction, measured,
                        dragTolerance(speed)));
}

}  // namespace haptex::oracles
