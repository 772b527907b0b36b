#include <gtest/gtest.h>

#include <utility>

#include "haptex/base/workload.h"
#include "haptex/material/fabric_file.h"
#include "haptex/material/linear_fabric.h"
#include "haptex/oracles/experiments/capstan.h"

namespace haptex::oracles::test_capstan {
namespace {

CapstanCase stiffStrip(double friction, double wrap) {
  CapstanCase capstan;
  capstan.fabric = material::linearFabric(3000.0, 3.0);
  capstan.friction = friction;
  capstan.wrap = wrap;
  capstan.steps = 60;
  return capstan;
}

// What is not converged shows as slip, not as force: also in the steps before the strip slips
// everywhere, and with one solve per step.
TEST(Capstan, FrictionNeverExceedsItsConeWhateverTheNumberOfSolves) {
  for (const cloth::NamedIntegrationMethod& method : cloth::kIntegrationMethods) {
    if (!isImplicit(method.method)) continue;
    for (const int solves : {1, 2, 20}) {
      CapstanCase capstan = stiffStrip(0.5, 3.0);
      capstan.steps = 20;
      capstan.solves = solves;
      capstan.method = method.method;
      const CapstanOutcome outcome = pullOverCapstan(capstan);
      EXPECT_LE(outcome.total, 1.0 + 1e-9) << method.name << ' ' << solves;
      EXPECT_LE(outcome.particle, 1.0 + 1e-9) << method.name << ' ' << solves;
      EXPECT_EQ(outcome.pull, 0.0) << method.name << ' ' << solves;
      EXPECT_GT(outcome.contacts, 30.0);
    }
  }
}

TEST(Capstan, TensionGrowsAsTheEquationSays) {
  for (const double friction : {0.1, 0.7}) {
    if (base::kSanitized && friction > 0.1) break;
    for (const double wrap : {1.6, 6.2}) {
      for (const int solves : {1, 2, 20}) {
        CapstanCase capstan = stiffStrip(friction, wrap);
        capstan.solves = solves;
        const CapstanOutcome outcome = pullOverCapstan(capstan);
        // One solve, the linearised stage alone, stretches what turns.
        EXPECT_NEAR(outcome.ratio / outcome.exact, 1.0, solves == 1 ? 0.03 : 0.01)
            << friction << ' ' << wrap << ' ' << solves;
      }
    }
  }
}

// Slips of micrometres a step once were taken for creep: the strip lost its tension.
TEST(Capstan, SlowSlipOfAStiffFabricKeepsItsFriction) {
  CapstanCase capstan;
  capstan.fabric = material::loadFabric(HAPTEX_CONFIG_DIRECTORY "/fabrics/wool.yaml");
  std::swap(capstan.fabric.weft, capstan.fabric.warp);
  capstan.speed = 1e-3;
  capstan.steps = 200;
  struct {
    double friction, wrap, step, cell;
  } const cases[] = {{0.68, 4.85, 3.55e-3, 4.8e-3}, {0.28, 3.09, 1.33e-3, 1.17e-3}};
  for (const auto& [friction, wrap, step, cell] : cases) {
    if (base::kSanitized && friction > 0.5) continue;
    capstan.friction = friction;
    capstan.wrap = wrap;
    capstan.time_step = step;
    capstan.cell = cell;
    capstan.radius = capstanRadius(cell);
    const CapstanOutcome outcome = pullOverCapstan(capstan);
    EXPECT_NEAR(outcome.ratio / outcome.exact, 1.0, 0.01) << friction;
    EXPECT_LT(outcome.rounds, 10.0) << friction;
  }
}

}  // namespace
}  // namespace haptex::oracles::test_capstan
