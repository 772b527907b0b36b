// Oracles at parameters that are drawn at random, so that nothing can be fitted to them.
#pragma once

#include <cstdint>
#include <functional>
#include <iosfwd>
#include <string>
#include <vector>

#include "haptex/base/repeatable_random.h"
#include "haptex/oracles/checks/validation.h"

namespace haptex::oracles {

/// A kind of case. It draws all that its exact result holds for, in ranges that its source states,
/// and hands on quantities whose names say what was drawn.
struct RandomCheck {
  std::string room;
  std::string kind;  ///< quantities are called room/random/kind/...
  std::function<void(const std::string& config_directory, base::RepeatableRandom& random,
                     const Sink& sink)>
      run;
};

/// All kinds, room by room in the order of validations().
const std::vector<RandomCheck>& randomChecks();

/// Runs the kinds of a room, each with numbers of its own: what one draws changes no other.
/// @param room of validations() @param kind only this one; empty: all
/// @throws what the kinds throw
void validateAtRandom(const std::string& room, std::uint64_t seed,
                      const std::string& config_directory, const Sink& sink,
                      const std::string& kind = "");

/// The same, printed. What fails or throws is told with the command that repeats it,
/// "scripts/validate --seed S ROOM".
/// @returns whether all pass
bool printAtRandom(const std::string& room, std::uint64_t seed, const std::string& config_directory,
                   std::ostream& out, std::ostream& errors);

/// Parts of a quantity's name: room/random/kind and then "/name=value" with four digits.
class CaseName {
 public:
  CaseName(const std::string& room, const std::string& kind) : text_(room + "/random/" + kind) {}
  CaseName& with(const std::string& name, double value);
  CaseName& with(const std::string& word);
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

// The kinds: draw from `random`, hand what came out to `sink`.
using Random = base::RepeatableRandom;
void randomElastica(const std::string&, Random& random, const Sink& sink);
void randomPlate(const std::string&, Random& random, const Sink& sink);
void randomDrape(const std::string&, Random& random, const Sink& sink);
void randomTensile(const std::string&, Random& random, const Sink& sink);
void randomContraction(const std::string&, Random& random, const Sink& sink);
void randomHangingStrip(const std::string&, Random& random, const Sink& sink);
void randomOscillator(const std::string&, Random& random, const Sink& sink);
void randomSwing(const std::string&, Random& random, const Sink& sink);
void randomAir(const std::string&, Random& random, const Sink& sink);
void randomCurve(const std::string&, Random& random, const Sink& sink);
void randomQueries(const std::string&, Random& random, const Sink& sink);
void randomStack(const std::string&, Random& random, const Sink& sink);
void randomPress(const std::string&, Random& random, const Sink& sink);
void randomStick(const std::string&, Random& random, const Sink& sink);
void randomIncline(const std::string&, Random& random, const Sink& sink);
void randomCapstan(const std::string& config_directory, Random& random, const Sink& sink);
void randomTablePress(const std::string& config_directory, Random& random, const Sink& sink);
void randomTableDrag(const std::string& config_directory, Random& random, const Sink& sink);
void randomFastFinger(const std::string& config_directory, Random& random, const Sink& sink);
void randomRegions(const std::string&, Random& random, const Sink& sink);
void randomRoll(const std::string&, Random& random, const Sink& sink);
void randomCone(const std::string&, Random& random, const Sink& sink);
void randomPatch(const std::string&, Random& random, const Sink& sink);
void randomLinkage(const std::string& config_directory, Random& random, const Sink& sink);
void randomFastener(const std::string& config_directory, Random& random, const Sink& sink);
void randomGrating(const std::string&, Random& random, const Sink& sink);
void randomContactors(const std::string&, Random& random, const Sink& sink);
void randomPose(const std::string& config_directory, Random& random, const Sink& sink);
void randomStaticForce(const std::string& config_directory, Random& random, const Sink& sink);
void randomRelief(const std::string&, Random& random, const Sink& sink);

}  // namespace haptex::oracles
