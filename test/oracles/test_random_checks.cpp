#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <set>
#include <sstream>
#include <string>

#include "haptex/base/workload.h"
#include "haptex/oracles/checks/random_checks.h"
#include "haptex/oracles/exact/amplification.h"
#include "haptex/oracles/experiments/free_strip.h"

namespace haptex::oracles::test_random_checks {
namespace {

std::string linesOf(const std::string& room, std::uint64_t seed, const std::string& kind = "") {
  std::ostringstream lines;
  validateAtRandom(
      room, seed, HAPTEX_CONFIG_DIRECTORY,
      [&](const base::Quantity& quantity) { print(lines, quantity); }, kind);
  return lines.str();
}

TEST(RandomChecks, PassForEverySeed) {
  // Seeds that nothing was looked at with.
  constexpr std::uint64_t kFirst = 20001, kSeeds = base::unlessSanitized(10, 1);
  for (const RandomCheck& check : randomChecks()) {
    for (std::uint64_t seed = kFirst; seed < kFirst + kSeeds; ++seed) {
      int quantities = 0;
      validateAtRandom(
          check.room, seed, HAPTEX_CONFIG_DIRECTORY,
          [&](const base::Quantity& quantity) {
            ++quantities;
            EXPECT_TRUE(quantity.pass()) << seed << ' ' << quantity.name << ": error "
                                         << quantity.error << " above " << quantity.tolerance;
            EXPECT_EQ(quantity.name.rfind(check.room + "/random/", 0), 0u) << quantity.name;
            EXPECT_EQ(quantity.name.find('\t'), std::string::npos);
          },
          check.kind);
      EXPECT_GT(quantities, 0) << check.kind;
    }
  }
}

TEST(RandomChecks, RepeatByTheirSeedAndDifferByAnother) {
  for (const char* room : {"material", "proximity", "tactile"}) {
    EXPECT_EQ(linesOf(room, 3), linesOf(room, 3)) << room;
  }
  EXPECT_NE(linesOf("tactile", 3), linesOf("tactile", 4));
}

TEST(RandomChecks, DrawTheSameAloneAsBesideOthers) {
  const std::string all = linesOf("contact", 5);
  for (const char* kind : {"press", "stick", "incline"}) {
    EXPECT_NE(all.find(linesOf("contact", 5, kind)), std::string::npos) << kind;
  }
}

TEST(RandomChecks, TellTheCommandThatRepeatsWhatFails) {
  std::ostringstream out, errors;
  EXPECT_FALSE(printAtRandom("exoskeleton", 77, "/nowhere", out, errors));
  EXPECT_EQ(out.str(), "");
  EXPECT_EQ(errors.str().substr(0, errors.str().find('\n')),
            "validate: exoskeleton/random/pose: /nowhere/../urdf/hand_exoskeleton.urdf: cannot be "
            "read; again: scripts/validate --seed 77 exoskeleton");
  std::ostringstream sound, none;
  EXPECT_TRUE(printAtRandom("tactile", 77, HAPTEX_CONFIG_DIRECTORY, sound, none));
  EXPECT_EQ(sound.str(), linesOf("tactile", 77));
  EXPECT_EQ(none.str(), "");
}

TEST(RandomChecks, AreThereForEveryRoom) {
  std::set<std::string> rooms, kinds;
  for (const RandomCheck& check : randomChecks()) {
    rooms.insert(check.room);
    EXPECT_TRUE(kinds.insert(check.room + "/" + check.kind).second) << check.kind;
  }
  for (const Validation& validation : validations()) EXPECT_EQ(rooms.count(validation.room), 1u);
  EXPECT_EQ(rooms.size(), validations().size());
}

TEST(CaseName, NamesWhatWasDrawnWithFourDigits) {
  EXPECT_EQ(CaseName("cloth", "elastica").with("linear").with("gamma", 12.345678).text(),
            "cloth/random/elastica/linear/gamma=12.35");
}

/// Of the oracles that the random cases brought along.
TEST(RandomOracles, AnObliqueStripIsTheUniaxialOneAlongTheThreads) {
  material::Fabric fabric;
  fabric.weft.elastic = material::StrainStressCurve::linear(100.0);
  fabric.warp.elastic = material::StrainStressCurve::linear(300.0);
  fabric.shear.elastic = material::StrainStressCurve::linear(40.0);
  fabric.contraction = 0.2;
  for (const kes::Direction along : {kes::Direction::kWeft, kes::Direction::kWarp}) {
    const Uniaxial exact = exactUniaxial(fabric, along, 0.1);
    const Uniaxial found = exactObliqueUniaxial(fabric, along, 0.0, exact.force / 1.1);
    EXPECT_NEAR(found.strain, 0.1, 1e-13);
    EXPECT_NEAR(found.transverse_strain, exact.transverse_strain, 1e-13);
    // A quarter of a turn makes warp of weft.
    const kes::Direction other =
        along == kes::Direction::kWeft ? kes::Direction::kWarp : kes::Direction::kWeft;
    EXPECT_NEAR(exactObliqueUniaxial(fabric, other, 0.5 * M_PI, exact.force / 1.1).strain, 0.1,
                1e-13);
  }
}

TEST(RandomOracles, AnIsotropicSheetIsAlikeAtAllAngles) {
  material::Fabric fabric;  // Poisson ratio 0: shear modulus half of the others
  fabric.weft.elastic = fabric.warp.elastic = material::StrainStressCurve::linear(100.0);
  fabric.shear.elastic = material::StrainStressCurve::linear(50.0);
  for (const double grain : {-1.5, -0.4, 0.3, 0.785, 3.0}) {
    const Uniaxial found = exactObliqueUniaxial(fabric, kes::Direction::kWeft, grain, 20.0);
    EXPECT_NEAR(found.strain, std::sqrt(1.4) - 1.0, 1e-14) << grain;
    EXPECT_NEAR(found.transverse_strain, 0.0, 1e-14) << grain;
  }
}

TEST(RandomOracles, AnObliqueStripRefusesWhatCollapses) {
  material::Fabric fabric;
  EXPECT_THROW(exactObliqueUniaxial(fabric, kes::Direction::kWeft, 0.1, 1.0),
               std::invalid_argument);
  fabric.weft.elastic = fabric.warp.elastic = material::StrainStressCurve::linear(100.0);
  fabric.shear.elastic = material::StrainStressCurve::linear(50.0);
  EXPECT_THROW(exactObliqueUniaxial(fabric, kes::Direction::kWeft, 0.1, -60.0),
               std::invalid_argument);
}

TEST(RandomOracles, TheEnergyOfAnOscillatorIsThatOfItsGrowth) {
  for (const cloth::NamedIntegrationMethod& named : cloth::kIntegrationMethods) {
    EXPECT_EQ(oscillatorEnergy(named.method, 0.1, 0), 1.0) << named.name;
    const double growth = growthPerStep(named.method, 0.1);
    // In the mean over many steps, which two-step Euler and the start of BDF-2 differ from.
    EXPECT_NEAR(std::log(oscillatorEnergy(named.method, 0.1, 4000)) / 8000.0, std::log(growth),
                2e-5)
        << named.name;
    EXPECT_THROW(oscillatorEnergy(named.method, 0.1, -1), std::invalid_argument);
    EXPECT_THROW(oscillatorEnergy(named.method, -0.1, 1), std::invalid_argument);
  }
}

struct Output {
  std::string text;
  int status = -1;
};

/// Of the program validate, both of its streams.
Output validate(const std::string& arguments) {
  const std::string command = std::string(VALIDATE) + ' ' + arguments + " 2>&1";
  std::FILE* pipe = popen(command.c_str(), "r");
  Output output;
  char buffer[4096];
  while (pipe != nullptr && std::fgets(buffer, sizeof(buffer), pipe) != nullptr) {
    output.text += buffer;
  }
  if (pipe != nullptr) output.status = pclose(pipe);
  return output;
}

const std::string kConfig = HAPTEX_CONFIG_DIRECTORY " ";

TEST(ValidateProgram, PrintsItsSeedFirstAndRepeatsByIt) {
  const Output first = validate(kConfig + "--seed 42 material");
  EXPECT_EQ(first.status, 0);
  EXPECT_EQ(first.text.rfind("seed\t42\nmaterial/", 0), 0u) << first.text.substr(0, 200);
  EXPECT_NE(first.text.find("\nmaterial/random/"), std::string::npos);
  EXPECT_EQ(validate(kConfig + "material --seed 42").text, first.text);
}

TEST(ValidateProgram, DrawsAnotherSeedEveryTimeThatItIsNotTold) {
  const auto seed_of = [](const Output& output) {
    return output.text.substr(0, output.text.find('\n'));
  };
  const Output a = validate(kConfig + "material"), b = validate(kConfig + "material");
  EXPECT_EQ(seed_of(a).rfind("seed\t", 0), 0u);
  EXPECT_NE(seed_of(a), seed_of(b));
}

TEST(ValidateProgram, RefusesOtherArguments) {
  EXPECT_NE(validate(kConfig + "--seed -1 material").status, 0);
  const Output seed = validate(kConfig + "--seed 1x material");
  EXPECT_NE(seed.status, 0);
  EXPECT_EQ(seed.text, "validate: --seed is '1x'; it must be a whole number of up to 19 digits\n");
  for (const char* arguments : {"--seed", "--speed 1", "material more", ""}) {
    const Output output = validate(kConfig + arguments + (*arguments == '\0' ? "a b" : ""));
    EXPECT_NE(output.status, 0) << arguments;
    EXPECT_NE(output.text.find("usage: validate CONFIG_DIRECTORY [--seed S] [ROOM]"),
              std::string::npos)
        << output.text;
  }
  const Output room = validate(kConfig + "attic");
  EXPECT_NE(room.status, 0);
  EXPECT_EQ(room.text.rfind("validate: no room 'attic'; rooms with oracles: material", 0), 0u);
}

}  // namespace
}  // namespace haptex::oracles::test_random_checks
