#include "haptex/studies/extreme_fingertips.h"

#include <algorithm>
#include <cmath>

#include "haptex/base/quantity.h"
#include "haptex/oracles/experiments/contact_scenes.h"
#include "haptex/studies/extreme_cloth.h"

namespace haptex::studies {
namespace {

constexpr double kHold = 0.025;  // s, of each place of the fingertips

oracles::HapticLoopSettings loopSettings(const ExtremeCase& extreme, const mesh::ClothMesh& mesh,
                                         const cloth::Cloth& cloth) {
  oracles::HapticLoopSettings settings;
  settings.mesh = mesh;
  settings.fabric = cloth.fabric();
  settings.effects = cloth.effects();
  settings.attached_particles = attachedParticles(extreme, mesh);
  settings.large_scale_step = extreme.longest_step;
  settings.step.method = extreme.method;
  settings.step.newton_iterations = extreme.newton_iterations;
  settings.haptics.refinement = 1;
  return settings;
}

class TouchedRun {
 public:
  TouchedRun(const ExtremeCase& extreme, int most_solved_steps)
      : extreme_(extreme),
        most_solved_steps_(most_solved_steps),
        random_(extreme.seed + 2),
        mesh_(meshOf(extreme)),
        untouched_(clothOf(extreme, mesh_, std::nullopt)),
        rest_(restOf(apart(extreme, mesh_, std::nullopt))),
        loop_(loopSettings(extreme, restingMesh(), untouched_)),
        intersections_(untouched_) {}

  ExtremeOutcome run() {
    intersections_.failsAt(rest_);
    for (int i = 0; i < extreme_.disturbed_steps && !failed(); ++i) hold(drawFingertips(), kHold);
    // What the fingertips have done last acts in the step after the next state.
    hold({}, kHold + 2.0 * extreme_.longest_step);
    outcome_.rejected = loop_.rejectedSteps();
    for (int i = 0; i < extreme_.free_steps && !failed(); ++i) watch();
    if (failed()) return outcome_;
    cloth::ClothState state = loop_.state();
    settleAndJudge(extreme_, untouched_, rest_, most_solved_steps_, intersections_, state,
                   outcome_);
    return outcome_;
  }

 private:
  mesh::ClothMesh restingMesh() const {
    mesh::ClothMesh mesh = mesh_;
    mesh.initial_positions = rest_.positions;
    return mesh;
  }

  bool failed() const { return outcome_.failure != ExtremeFailure::kNone; }

  /// Near a particle of the cloth as it is: a leap away, right inside of it, or pinching it.
  oracles::Fingertips drawFingertips() {
    const auto& positions = loop_.state().positions;
    oracles::Hand hand;
    hand.middle = positions[random_.below(static_cast<int>(positions.size()))];
    hand.gap = random_.uniform(-0.015, 0.005);
    const int what = random_.below(3);
    if (what == 0) hand.middle += extreme_.magnitude * random_.direction();
    if (what == 1) hand.velocity = random_.logarithmic(0.01, 10.0) * random_.direction();
    oracles::Fingertips fingertips = hand.fingertips();
    if (random_.chance(0.3)) fingertips.values[random_.below(2)].reset();
    return fingertips;
  }

  void hold(const oracles::Fingertips& fingertips, double seconds) {
    const double end = loop_.time() + seconds;
    while (loop_.time() < end && !failed()) {
      loop_.step(fingertips);
      ++outcome_.steps;
      requireSoundContacts();
      requireSoundState();
    }
  }

  void requireSoundState() {
    if (!isFinite(loop_.state())) {
      outcome_.failure = ExtremeFailure::kNotFinite;
    } else if (loop_.state().time != judged_ && intersections_.failsAt(loop_.state())) {
      outcome_.failure = ExtremeFailure::kIntersects;
    }
    judged_ = loop_.state().time;
  }

  /// The pressure of the largest depth, that of the centre, on the whole sheet, with friction and
  /// the damping of an approach with the speed of sound.
  double mostForce() const {
    constexpr double kSpeed = 340.0;  // m/s
    const contact::ContactLaw& law = loop_.layer().law();
    double area = 0.0;
    for (const cloth::MembraneElement& element : cloth::restElements(untouched_.mesh())) {
      area += element.area;
    }
    return law.pressure(oracles::kThumbRadius + law.halfThickness()).stress *
           (1.0 + law.damping() * kSpeed) * (1.0 + law.friction()) * area;
  }

  void requireSoundContacts() {
    for (const contact::FingertipContact& contact : loop_.layer().contacts().values) {
      const bool sound = contact.force.norm() <= mostForce() && contact.stiffness.allFinite() &&
                         contact.damping.allFinite();
      if (!sound) outcome_.failure = ExtremeFailure::kNotFinite;
    }
  }

  /// A step of the large-scale cloth without fingertips: nothing does work.
  void watch() {
    const cloth::ClothState before = loop_.state();
    watch_.begin(untouched_, before);
    while (loop_.state().time == before.time) {
      loop_.step({});
      ++outcome_.steps;
      if (loop_.rejectedSteps() > outcome_.rejected) {
        outcome_.failure = ExtremeFailure::kStuck;
        return;
      }
    }
    requireSoundState();
    if (failed()) return;
    outcome_.growth =
        base::largerOrNaN(outcome_.growth, watch_.growth(untouched_, before, loop_.state()));
    if (!(outcome_.growth <= kRoundingGrowth)) outcome_.failure = ExtremeFailure::kEnergyGrew;
  }

  const ExtremeCase& extreme_;
  int most_solved_steps_;
  RepeatableRandom random_;
  mesh::ClothMesh mesh_;
  cloth::Cloth untouched_;
  cloth::ClothState rest_;
  oracles::HapticLoop loop_;
  IntersectionWatch intersections_;
  double judged_ = 0.0;  // s, simulated
  EnergyWatch watch_{cloth::EnergyBalance::kRemembered};
  ExtremeOutcome outcome_;
};

}  // namespace

ExtremeOutcome runTouchedCase(const ExtremeCase& extreme, int most_solved_steps) {
  return TouchedRun(extreme, most_solved_steps).run();
}

}  // namespace haptex::studies
