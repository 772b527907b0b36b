#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "tactile_fixtures.h"

namespace haptex::nodes::test_tactile_messages {
namespace {

using base::Finger;
using tactile::kContactors;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::string refusal(const haptex::Contact& message) {
  try {
    touchedFabric(message);
    return "";
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
}

TEST(TactileMessages, TakeFromAContactHowTheFingertipLiesAndMovesOnTheFabric) {
  const auto touched = touchedFabric(slidingContact());
  ASSERT_TRUE(touched);
  EXPECT_EQ(touched->stroke.velocity, Eigen::Vector2d(kWaveSpeed, 0.0));
  EXPECT_EQ(touched->stroke.normal_force, kContactors * kPressOfOne);
  EXPECT_EQ(touched->forces[23], kPressOfOne);
  // x along warp, y against weft: the first contactor is at (-5 mm, -3 mm) of the array.
  EXPECT_TRUE(touched->placement.placeOf(0).isApprox(Eigen::Vector2d(0.103, 0.195), 1e-15));
}

TEST(TactileMessages, AnArrayWhosePlaceIsNotKnownLiesAlongWeftAndWarpAtTheCentreOfPressure) {
  haptex::Contact message = slidingContact();
  message.array_origin = {0.0, 0.0};
  message.array_x = message.array_y = {0.0, 0.0};
  const auto touched = touchedFabric(message);
  ASSERT_TRUE(touched);
  EXPECT_EQ(touched->placement.origin, Eigen::Vector2d(0.11, 0.22));
  EXPECT_EQ(touched->placement.axes, Eigen::Matrix2d::Identity());
}

TEST(TactileMessages, AFingertipThatDoesNotTouchHasNoFabric) {
  EXPECT_FALSE(touchedFabric(noContact()));
  haptex::Contact lifted = slidingContact();
  lifted.touching = false;
  EXPECT_FALSE(touchedFabric(lifted));
}

TEST(TactileMessages, NameTheFieldOfAContactThatIsNotBelieved) {
  struct Case {
    std::function<void(haptex::Contact&)> spoil;
    std::string says;
  };
  const std::vector<Case> cases = {
      {[](auto& m) { m.header.frame_id = "moon"; }, "frame_id = 'moon'"},
      {[](auto& m) { m.fabric_velocity[1] = kNaN; }, "fabric_velocity[1] = nan"},
      {[](auto& m) { m.fabric_velocity[0] = -101.0; }, "fabric_velocity[0] = -101"},
      {[](auto& m) { m.fabric_position[0] = kInfinity; }, "fabric_position[0] = inf"},
      {[](auto& m) { m.array_origin[1] = 1e6; }, "array_origin[1] = 1e+06"},
      {[](auto& m) { m.array_x[0] = kNaN; }, "array_x[0] = nan"},
      {[](auto& m) { m.array_y[1] = -kInfinity; }, "array_y[1] = -inf"},
      {[](auto& m) { m.normal_force = -0.1; }, "normal_force = -0.1"},
      {[](auto& m) { m.normal_force = kNaN; }, "normal_force = nan"},
      {[](auto& m) { m.contactor_forces[7] = -1e-3; }, "contactor_forces[7] = -0.001"},
      {[](auto& m) { m.contactor_forces[23] = 1e4; }, "contactor_forces[23] = 10000"}};
  EXPECT_EQ(refusal(slidingContact()), "");
  for (const Case& bad : cases) {
    haptex::Contact message = slidingContact();
    bad.spoil(message);
    const std::string why = refusal(message);
    EXPECT_NE(why.find(bad.says), std::string::npos) << bad.says << ": " << why;
    EXPECT_NE(why.find("allowed"), std::string::npos) << why;
    message.touching = false;
    EXPECT_FALSE(refusal(message).empty()) << bad.says << " without contact";
  }
}

TEST(TactileMessages, HaveTheContactorsTwoMillimetresApartInTheFrameOfTheArray) {
  const haptex::Tactile message = tactileMessage(Finger::kThumb);
  EXPECT_EQ(message.header.frame_id, "thumb_tactile");
  EXPECT_DOUBLE_EQ(message.places[0].x, -0.005);
  EXPECT_DOUBLE_EQ(message.places[0].y, -0.003);
  EXPECT_DOUBLE_EQ(message.places[23].x, 0.005);
  EXPECT_DOUBLE_EQ(message.places[23].y, 0.003);
  EXPECT_DOUBLE_EQ(message.places[1].x - message.places[0].x, 0.002);
}

TEST(TactileMessages, TellAStepInMicrometresAndBecomeZeroAgain) {
  const auto touched = touchedFabric(slidingContact());
  tactile::ArrayAmplitudes amplitudes{};
  amplitudes[5] = {3e-6, 4e-7};
  haptex::Tactile message = tactileMessage(Finger::kIndex);
  fillTactile(&*touched, amplitudes, 0.026, ros::Time(7, 8), message);
  EXPECT_EQ(message.header.stamp, ros::Time(7, 8));
  EXPECT_EQ(message.header.frame_id, "index_tactile");
  EXPECT_EQ(message.step_time, 0.026);
  EXPECT_DOUBLE_EQ(message.amplitudes_40[5], 3.0);
  EXPECT_DOUBLE_EQ(message.amplitudes_320[5], 0.4);
  EXPECT_EQ(message.amplitudes_40[4], 0.0);
  EXPECT_EQ(message.velocity[0], kWaveSpeed);
  EXPECT_EQ(message.normal_force, kContactors * kPressOfOne);
  EXPECT_NEAR(message.weft[0], 0.103, 1e-15);
  EXPECT_NEAR(message.warp[0], 0.195, 1e-15);

  fillTactile(nullptr, tactile::ArrayAmplitudes{}, 0.025, ros::Time(7, 9), message);
  haptex::Tactile silent = tactileMessage(Finger::kIndex);
  silent.header.stamp = ros::Time(7, 9);
  silent.step_time = 0.025;
  EXPECT_EQ(message, silent);
}

}  // namespace
}  // namespace haptex::nodes::test_tactile_messages
