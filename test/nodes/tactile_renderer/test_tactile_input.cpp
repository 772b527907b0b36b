#include <gtest/gtest.h>

#include <cmath>

#include "haptex/nodes/tactile_renderer/tactile_input.h"
#include "tactile_fixtures.h"

namespace haptex::nodes::test_tactile_input {
namespace {

using namespace std::chrono_literals;
using tactile::kContactors;

TEST(TactileInput, GivesNothingWithoutMessagesOrWithoutContact) {
  TactileInput input;
  EXPECT_FALSE(input.endStep());
  input.receive(noContact(), 1ms);
  EXPECT_FALSE(input.endStep());
}

TEST(TactileInput, MeansTheVelocitiesAndForcesOfAStep) {
  TactileInput input;
  for (const double speed : {0.01, 0.02, 0.06}) input.receive(slidingContact(speed), 1ms);
  const auto step = input.endStep();
  ASSERT_TRUE(step);
  EXPECT_NEAR(step->stroke.velocity.x(), 0.03, 1e-15);
  EXPECT_NEAR(step->stroke.normal_force, kContactors * kPressOfOne, 1e-15);
  for (const double force : step->forces) EXPECT_NEAR(force, kPressOfOne, 1e-15);
}

TEST(TactileInput, AContactOfHalfAStepPressesHalfButIsNoSlower) {
  TactileInput input;
  for (int i = 0; i < 10; ++i) {
    input.receive(noContact(), 1ms);
    input.receive(slidingContact(), 1ms);
  }
  const auto step = input.endStep();
  ASSERT_TRUE(step);
  EXPECT_NEAR(step->stroke.velocity.x(), kWaveSpeed, 1e-15);
  EXPECT_NEAR(step->stroke.normal_force, 0.5 * kContactors * kPressOfOne, 1e-15);
  for (const double force : step->forces) EXPECT_NEAR(force, 0.5 * kPressOfOne, 1e-15);
}

TEST(TactileInput, KnowsTheLastPlacementAlsoIfTheFingertipHasLeft) {
  TactileInput input;
  input.receive(slidingContact(), 1ms);
  haptex::Contact later = slidingContact();
  later.array_origin = {0.3, 0.4};
  input.receive(later, 2ms);
  input.receive(noContact(), 3ms);
  EXPECT_EQ(input.endStep()->placement.origin, Eigen::Vector2d(0.3, 0.4));
}

TEST(TactileInput, ForgetsAStepThatHasEnded) {
  TactileInput input;
  input.receive(slidingContact(0.5), 1ms);
  EXPECT_TRUE(input.endStep());
  EXPECT_FALSE(input.endStep());
  input.receive(slidingContact(), 30ms);
  EXPECT_EQ(input.endStep()->stroke.velocity.x(), kWaveSpeed);
}

TEST(TactileInput, DropsAndCountsWhatIsNotBelievedWithoutLosingTheRest) {
  TactileInput input;
  input.receive(slidingContact(), 1ms);
  haptex::Contact bad = slidingContact();
  bad.contactor_forces[3] = std::nan("");
  input.receive(bad, 2ms);
  const auto step = input.endStep();
  ASSERT_TRUE(step);
  EXPECT_EQ(step->forces[3], kPressOfOne);
  EXPECT_EQ(input.status().taken, 1u);
  EXPECT_EQ(input.status().dropped, 1u);
  EXPECT_EQ(*input.status().last_arrival, 1ms);
  EXPECT_NE(input.status().dropped_why.find("contactor_forces[3]"), std::string::npos);
  input.receive(bad, 30ms);
  EXPECT_FALSE(input.endStep()) << "as if no message had come";
}

}  // namespace
}  // namespace haptex::nodes::test_tactile_input
