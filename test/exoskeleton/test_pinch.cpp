#include <gtest/gtest.h>

#include <cmath>

#include "haptex/oracles/experiments/pinch.h"
#include "shipped_urdf.h"

namespace haptex::exoskeleton::test_pinch {
namespace {

using oracles::findPinch;
using oracles::Meeting;

constexpr double kDegrees = M_PI / 180.0;

class EachMeeting : public testing::TestWithParam<Meeting> {};
INSTANTIATE_TEST_SUITE_P(Pinch, EachMeeting, testing::Values(Meeting::kTips, Meeting::kPads),
                         [](const auto& tested) {
                           return tested.param == Meeting::kTips ? "Tips" : "Pads";
                         });

TEST_P(EachMeeting, ThumbAndIndexMeetPadAgainstPadWithinTheirLimits) {
  const auto pinch = findPinch(shippedUrdf(), GetParam());
  ASSERT_TRUE(pinch);
  EXPECT_LE(pinch->distance, 1e-6);  // the promise is 2 mm; what Newton's method ends with is less
  EXPECT_LE(pinch->angle, 40.0 * kDegrees);
  FingerKinematics index(shippedUrdf(), Finger::kIndex), thumb(shippedUrdf(), Finger::kThumb);
  for (const auto& [finger, angles] :
       {std::pair(&index, &pinch->index), std::pair(&thumb, &pinch->thumb)}) {
    EXPECT_TRUE(finger->configuration(*angles).within_limits);
    EXPECT_GE(finger->configuration(*angles).smallest_singular_value, 2.0 * kSingular);
  }
  EXPECT_EQ(index.fingertip(pinch->index).translation(), pinch->index_tip);
  EXPECT_EQ(thumb.fingertip(pinch->thumb).translation(), pinch->thumb_tip);
}

TEST(Pinch, TipsAreApartByBothRadiiWherePadsThatFaceEachOtherTouch) {
  const auto pinch = findPinch(shippedUrdf(), Meeting::kPads);
  ASSERT_TRUE(pinch);
  // Two normals of 7.5 and 9 mm at the angle of the pads.
  const double apart = std::hypot(7.5 + 9.0 * std::cos(pinch->angle), 9.0 * std::sin(pinch->angle));
  EXPECT_NEAR((pinch->index_tip - pinch->thumb_tip).norm(), 1e-3 * apart, 2e-4);
}

TEST(Pinch, ThereIsNoneWhereTheThumbIsTurnedAway) {
  const std::string away = replaced(shippedUrdf(), "rpy=\"3.1 1 -0.22\"", "rpy=\"3.1 1 2.9\"");
  EXPECT_FALSE(findPinch(away, Meeting::kTips));
}

TEST(Pinch, RefusesAUrdfWithoutATactileFrameAtTheTip) {
  const std::string lost =
      replaced(shippedUrdf(), "<parent link=\"thumb_tip\"/><child link=\"thumb_tactile\"/>",
               "<parent link=\"thumb_distal\"/><child link=\"thumb_tactile\"/>");
  try {
    findPinch(lost, Meeting::kPads);
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "exoskeleton, thumb: no link thumb_tactile is fixed to thumb_tip");
  }
}

}  // namespace
}  // namespace haptex::exoskeleton::test_pinch
