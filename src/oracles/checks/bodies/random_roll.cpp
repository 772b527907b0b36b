// Balls on inclines: they roll, or slip where friction is too little for that.
#include <algorithm>
#include <cmath>

#include "haptex/base/constants.h"
#include "haptex/oracles/checks/random_checks.h"
#include "haptex/oracles/scenes/body_scenes.h"

namespace haptex::oracles {

void randomRoll(const std::string&, Random& random, const Sink& sink) {
  for (int i = 0; i < 4; ++i) {
    const double angle = random.uniform(0.05, 0.8);    // rad
    const double radius = random.uniform(0.005, 0.1);  // m
    const double mass = random.uniform(1e-3, 5.0);     // kg
    const double friction = random.uniform(0.0, 2.0) * 2.0 / 7.0 * std::tan(angle);
    const double slips = std::sin(angle) - friction * std::cos(angle);
    const double exact = base::kStandardGravity * std::max(slips, 5.0 / 7.0 * std::sin(angle));
    CaseName name("body", "roll");
    name.with("angle", angle).with("radius", radius).with("mass", mass).with("friction", friction);
    const mesh::Obstacle ball =
        ballOf(mass, radius, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), friction);
    sink(base::relativeTo(exact, name.text(), exact, accelerationDown(ball, radius, angle), 1e-9));
  }
}

}  // namespace haptex::oracles
