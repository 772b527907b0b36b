// Fingertips on flat sheets that are drawn sideways: they stick, slip from the rim inwards, slip.
#include <cmath>

#include "haptex/base/workload.h"
#include "haptex/material/compression.h"
#include "haptex/oracles/checks/random_checks.h"
#include "haptex/oracles/exact/flat_contact.h"

namespace haptex::oracles {

void randomStick(const std::string&, Random& random, const Sink& sink) {
  for (int i = 0; i < 5; ++i) {
    material::Fabric fabric;
    fabric.compression = {random.logarithmic(0.2e-3, 3e-3),
                          material::StrainStressCurve::linear(random.logarithmic(1e4, 1e6))};
    fabric.friction = random.uniform(0.1, 0.6);
    const contact::ContactLaw law(fabric, {random.logarithmic(2e6, 2e7), 2.0});
    const double radius = random.uniform(5e-3, 12e-3);
    const double reach = radius + law.halfThickness();
    // So shallow that normals stay within 7 degrees.
    const double depth = reach * (1.0 - std::cos(random.uniform(3.0, 7.0) * M_PI / 180.0));
    const double rim = std::sqrt(depth * (2.0 * reach - depth));
    const int cells = base::unlessSanitized(80 + random.below(60), 60);
    const FlatSheet sheet(1.4 * rim, cells);
    contact::SphereContact contact(law, sheet.positions.size());
    contact::Fingertip fingertip;
    fingertip.radius = radius;
    fingertip.position = {reach - depth, 0.0, 0.0};
    contact.commit(sheet.particles(), fingertip);
    // Up to where even the middle slips.
    const double slip = law.friction() * law.pressure(depth).stress / law.tangentialStiffness();
    const double displacement = random.uniform(0.05, 1.3) * slip;
    const double angle = random.uniform(-M_PI, M_PI);
    const Eigen::Vector3d way(0.0, std::cos(angle), std::sin(angle));
    fingertip.position += displacement * way;
    double force = 0.0;
    for (const auto& touched : contact.commit(sheet.particles(), fingertip)) {
      force += touched.friction.dot(way);
    }
    CaseName text("contact", "friction");
    text.with("friction", law.friction()).with("depth", depth).with("radius", radius);
    text.with("share_of_slip", displacement / slip).with("angle", angle);
    sink(base::relativeTo(exactDrag(law, radius, depth, 1.0), text.text(),
                          exactDrag(law, radius, depth, displacement), force, 0.02));
  }
}

}  // namespace haptex::oracles
