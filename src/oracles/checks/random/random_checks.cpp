#include "haptex/oracles/checks/random_checks.h"

#include <exception>
#include <iomanip>
#include <ostream>
#include <sstream>

#include "haptex/base/checksum.h"

namespace haptex::oracles {

const std::vector<RandomCheck>& randomChecks() {
  static const std::vector<RandomCheck> all = {
      {"material", "curve", randomCurve},
      {"cloth", "elastica", randomElastica},
      {"cloth", "plate", randomPlate},
      {"cloth", "drape", randomDrape},
      {"cloth", "tensile", randomTensile},
      {"cloth", "contraction", randomContraction},
      {"cloth", "hanging_strip", randomHangingStrip},
      {"cloth", "oscillator", randomOscillator},
      {"cloth", "swing", randomSwing},
      {"cloth", "air", randomAir},
      {"proximity", "queries", randomQueries},
      {"self_collision", "stack", randomStack},
      {"contact", "press", randomPress},
      {"contact", "stick", randomStick},
      {"contact", "incline", randomIncline},
      {"contact", "capstan", randomCapstan},
      {"table", "press", randomTablePress},
      {"table", "drag", randomTableDrag},
      {"table", "fast", randomFastFinger},
      {"regions", "strip", randomRegions},
      {"body", "roll", randomRoll},
      {"garment", "patch", randomPatch},
      {"garment", "cone", randomCone},
      {"garment", "linkage", randomLinkage},
      {"garment", "fastener", randomFastener},
      {"exoskeleton", "pose", randomPose},
      {"exoskeleton", "static_force", randomStaticForce},
      {"tactile", "grating", randomGrating},
      {"tactile_driver", "contactors", randomContactors},
      {"appearance", "relief", randomRelief},
  };
  return all;
}

void validateAtRandom(const std::string& room, std::uint64_t seed,
                      const std::string& config_directory, const Sink& sink,
                      const std::string& kind) {
  for (const RandomCheck& check : randomChecks()) {
    if (check.room != room || (!kind.empty() && check.kind != kind)) continue;
    base::RepeatableRandom random(seed ^ base::checksum(check.room + "/" + check.kind));
    check.run(config_directory, random, sink);
  }
}

bool printAtRandom(const std::string& room, std::uint64_t seed, const std::string& config_directory,
                   std::ostream& out, std::ostream& errors) {
  bool all_pass = true;
  const auto tell = [&](const std::string& what) {
    all_pass = false;
    errors << "validate: " << what << "; again: scripts/validate --seed " << seed << ' ' << room
           << std::endl;
  };
  for (const RandomCheck& check : randomChecks()) {
    if (check.room != room) continue;
    try {
      validateAtRandom(
          room, seed, config_directory,
          [&](const base::Quantity& quantity) {
            print(out, quantity);
            if (!quantity.pass()) tell(quantity.name + " fails");
          },
          check.kind);
    } catch (const std::exception& error) {
      tell(room + "/random/" + check.kind + ": " + error.what());
    }
  }
  return all_pass;
}

CaseName& CaseName::with(const std::string& name, double value) {
  std::ostringstream text;
  text << '/' << name << '=' << std::setprecision(4) << value;
  text_ += text.str();
  return *this;
}

CaseName& CaseName::with(const std::string& word) {
  text_ += '/' + word;
  return *this;
}

}  // namespace haptex::oracles
