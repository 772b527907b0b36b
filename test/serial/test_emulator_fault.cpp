#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>
#include <string>

#include "../refusal.h"
#include "haptex/serial/emulator_fault.h"

namespace haptex::serial::test_emulator_fault {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// What parse() says to a request that it refuses.
std::string refusal(const std::string& fault, const std::string& direction, double probability,
                    double duration) {
  return test::refusalOf(
      [&] { EmulatorFault::parse(fault, direction, probability, duration, {"saturated_sensor"}); });
}

TEST(EmulatorFault, KnowsEveryFaultOfTheLineByItsName) {
  for (const LineFault fault : lineFaults()) {
    const EmulatorFault parsed = EmulatorFault::parse(serial::name(fault), "both", 0.25, 1.5);
    EXPECT_EQ(parsed.kind, EmulatorFault::Kind::kLine);
    EXPECT_EQ(parsed.line_fault, fault);
    EXPECT_EQ(parsed.probability, 0.25);
    EXPECT_EQ(parsed.duration, std::chrono::milliseconds(1500));
  }
}

TEST(EmulatorFault, KnowsTheFaultsOfTheDevice) {
  EXPECT_EQ(EmulatorFault::parse("closed_port", "both", 1.0, 1.0).kind,
            EmulatorFault::Kind::kClosedPort);
  const EmulatorFault own =
      EmulatorFault::parse("saturated_sensor", "both", 1.0, 1.0, {"saturated_sensor"});
  EXPECT_EQ(own.kind, EmulatorFault::Kind::kDevice);
  EXPECT_STREQ(own.device_fault, "saturated_sensor");
  EXPECT_THROW(EmulatorFault::parse("saturated_sensor", "both", 1.0, 1.0), std::invalid_argument);
}

TEST(EmulatorFault, TakesTheDirectionsByName) {
  const EmulatorFault to = EmulatorFault::parse("drop", "to_device", 1.0, 1.0);
  EXPECT_TRUE(to.to_device && !to.from_device);
  const EmulatorFault from = EmulatorFault::parse("drop", "from_device", 1.0, 1.0);
  EXPECT_TRUE(!from.to_device && from.from_device);
  const EmulatorFault both = EmulatorFault::parse("drop", "both", 1.0, 1.0);
  EXPECT_TRUE(both.to_device && both.from_device);
}

TEST(EmulatorFault, RefusesAnUnknownNameWithAllThatAreAllowed) {
  const std::string refused = refusal("explode", "both", 1.0, 1.0);
  EXPECT_NE(refused.find("'explode'"), std::string::npos) << refused;
  for (const LineFault fault : lineFaults()) {
    EXPECT_NE(refused.find(serial::name(fault)), std::string::npos) << refused;
  }
  EXPECT_NE(refused.find("closed_port, saturated_sensor"), std::string::npos) << refused;
  EXPECT_NE(refusal("", "both", 1.0, 1.0), test::kNotRefused);
}

TEST(EmulatorFault, RefusesAnUnknownDirection) {
  for (const char* direction : {"", "up", "To_device"}) {
    EXPECT_NE(refusal("drop", direction, 1.0, 1.0).find("to_device, from_device and both"),
              std::string::npos);
  }
}

TEST(EmulatorFault, RefusesWhatIsNoProbability) {
  for (const double probability : {-0.1, 1.1, kNaN, kInfinity, -kInfinity}) {
    EXPECT_NE(refusal("drop", "both", probability, 1.0).find("probability = "), std::string::npos);
  }
  EXPECT_EQ(refusal("drop", "both", 0.0, 1.0), test::kNotRefused);
  EXPECT_EQ(refusal("drop", "both", 1.0, 1.0), test::kNotRefused);
}

TEST(EmulatorFault, RefusesDurationsThatAreNoneOrTooLong) {
  for (const double duration : {-1.0, 0.0, 3601.0, 1e300, kNaN, kInfinity}) {
    EXPECT_NE(refusal("drop", "both", 1.0, duration).find("duration = "), std::string::npos);
  }
  EXPECT_EQ(refusal("drop", "both", 1.0, EmulatorFault::kLongest), test::kNotRefused);
}

TEST(EmulatorFault, IsDescribedByNameAndDirection) {
  EXPECT_EQ(describe(EmulatorFault::parse("flip", "to_device", 1.0, 1.0)), "flip to_device");
  EXPECT_EQ(describe(EmulatorFault::parse("stall", "both", 1.0, 1.0)), "stall both");
  EXPECT_EQ(describe(EmulatorFault::parse("closed_port", "both", 1.0, 1.0)), "closed_port");
}

TEST(EmulatorFault, IsAnsweredByHowLongItLastsOrThatItIsOver) {
  EXPECT_EQ(answerTo(EmulatorFault::parse("flip", "both", 0.5, 1.5)), "flip both for 1.5 s");
  EXPECT_EQ(answerTo(EmulatorFault::parse("flip", "both", 0.0, 1.5)), "flip both is over");
}

}  // namespace
}  // namespace haptex::serial::test_emulator_fault
