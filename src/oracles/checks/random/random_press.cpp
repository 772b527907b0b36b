// Fingertips that press flat sheets: equilibrium of the pressure under them.
#include <cmath>

#include "haptex/base/workload.h"
#include "haptex/material/compression.h"
#include "haptex/oracles/checks/random_checks.h"
#include "haptex/oracles/exact/flat_contact.h"
#include "haptex/oracles/exact/pinched_sheet.h"

namespace haptex::oracles {

void randomPress(const std::string&, Random& random, const Sink& sink) {
  for (int i = 0; i < 10; ++i) {
    material::Fabric fabric;
    const double thickest = random.logarithmic(0.2e-3, 3e-3);
    const double thinnest = thickest * random.uniform(0.4, 0.8);
    // J/m^2, WC: a linearity of 1 would be a straight line.
    const double work = 0.5 * random.uniform(0.2, 0.4) * 4903.325 * (thickest - thinnest);
    fabric.compression = material::compressionFromKes({thickest, thinnest, work});
    fabric.friction = random.uniform(0.1, 0.6);
    const contact::ContactLaw law(fabric, {random.logarithmic(2e6, 2e7), 2.0});
    const double radius = random.uniform(5e-3, 12e-3);
    const double reach = radius + law.halfThickness();
    const double depth = random.logarithmic(1e-4, 2e-3);
    const double rim = std::sqrt(depth * (2.0 * reach - depth));
    const int cells = base::unlessSanitized(100 + random.below(100), 60);  // over 2.2 rims
    const FlatSheet sheet(1.1 * rim, cells);
    contact::SphereContact contact(law, sheet.positions.size());
    contact::Fingertip fingertip;
    fingertip.radius = radius;
    const double cell = 2.2 * rim / cells;
    fingertip.position = {reach - depth, cell * random.uniform(-0.5, 0.5),
                          cell * random.uniform(-0.5, 0.5)};
    double force = 0.0;
    for (const auto& touched : contact.evaluate(sheet.particles(), fingertip)) {
      force -= touched.force().x();
    }
    const double exact = pinchForce(law, radius, 2.0 * (reach - depth)).force;
    CaseName text("contact", "press");
    text.with("radius", radius).with("depth", depth).with("thickness", thickest);
    text.with("cells", cells);
    // Of second order in the cell over the rim of contact, which is 0.02 here.
    sink(base::relativeTo(exact, text.text(), exact, force, 0.001));
  }
}

}  // namespace haptex::oracles
