#include <gtest/gtest.h>

#include "haptex/contact/patch_selection.h"

namespace haptex::contact::test_patch_selection {
namespace {

using Elements = std::vector<int>;

class PatchSelectionTest : public testing::Test {
 protected:
  /// One round in which the elements 0, 1, ... have these distances.
  bool round(const std::vector<double>& distances, int first_rank = 0) {
    selection_.begin();
    for (std::size_t i = 0; i < distances.size(); ++i) {
      selection_.add(static_cast<int>(i), distances[i], first_rank + static_cast<int>(i),
                     settings_);
    }
    return selection_.finish();
  }

  HapticSettings settings_;
  PatchSelection selection_{100};
};

TEST_F(PatchSelectionTest, TakesWhatIsWithinTheMargin) {
  EXPECT_TRUE(round({0.0, 0.0079, 0.0081}));
  EXPECT_EQ(selection_.elements(), Elements({0, 1}));
  EXPECT_FALSE(round({0.0, 0.0079, 0.0081})) << "nothing has changed";
}

TEST_F(PatchSelectionTest, KeepsWhatIsLittleFartherThanTheMargin) {
  round({0.001, 0.007});
  const double just_kept = settings_.margin + PatchSelection::kHysteresis - 1e-6;
  EXPECT_FALSE(round({0.001, just_kept}));
  EXPECT_EQ(selection_.elements(), Elements({0, 1}));
  EXPECT_TRUE(round({0.001, just_kept + 2e-6}));
  EXPECT_EQ(selection_.elements(), Elements({0}));
  EXPECT_FALSE(round({0.001, just_kept})) << "it comes back before it is within the margin";
}

TEST_F(PatchSelectionTest, TakesNoMoreThanTheNearest) {
  settings_.most_elements = 2;
  round({0.001, 0.002, 0.003});
  EXPECT_EQ(selection_.elements(), Elements({0, 1}));
  // Another element is nearer now, and those that are in stay.
  EXPECT_FALSE(round({0.001, 0.002}, 1));
}

TEST_F(PatchSelectionTest, KeepsAQuarterMoreThanTheNearestAndAllThatTouches) {
  settings_.most_elements = 4;
  const double near = PatchSelection::kTouching + 1e-6;
  round({near, near, near, near});
  EXPECT_FALSE(round({near, near, near, near}, 1));
  EXPECT_TRUE(round({near, near, near, near}, 2));
  EXPECT_EQ(selection_.elements(), Elements({0, 1, 2}));
  const double touching = PatchSelection::kTouching - 1e-6;
  EXPECT_TRUE(round({near, touching, touching}, 6));
  EXPECT_EQ(selection_.elements(), Elements({1, 2}));
}

TEST_F(PatchSelectionTest, KeepsForSomeRoundsWhatHasTouched) {
  settings_.most_elements = 4;
  const double near = PatchSelection::kTouching + 1e-6;
  round({PatchSelection::kTouching});
  for (int i = 1; i < PatchSelection::kRests; ++i) EXPECT_FALSE(round({near}, 6)) << i;
  EXPECT_FALSE(round({PatchSelection::kTouching}, 6)) << "it touches again";
  for (int i = 1; i < PatchSelection::kRests; ++i) EXPECT_FALSE(round({near}, 6)) << i;
  EXPECT_TRUE(round({near}, 6));
  EXPECT_TRUE(selection_.elements().empty());
}

TEST_F(PatchSelectionTest, UnitesWhatBothFingertipsAreNearTo) {
  selection_.begin();
  selection_.add(7, 0.001, 0, settings_);
  selection_.add(3, 0.001, 0, settings_);
  selection_.add(7, 0.002, 1, settings_);
  EXPECT_TRUE(selection_.finish());
  EXPECT_EQ(selection_.elements(), Elements({3, 7}));
}

TEST_F(PatchSelectionTest, IsEmptyWhenNothingIsNear) {
  round({0.001});
  EXPECT_TRUE(round({}));
  EXPECT_TRUE(selection_.elements().empty());
}

TEST(SearchVolume, ReachesFromTheFingertipToWhereItWillBe) {
  Fingertip fingertip;
  fingertip.position = {0.1, 0.0, 0.0};
  fingertip.velocity = {0.0, 2.0, 0.0};
  fingertip.radius = 0.008;
  HapticSettings settings;
  const SearchVolume volume = searchVolume(fingertip, 0.01, settings);
  EXPECT_EQ(volume.begin, fingertip.position);
  EXPECT_TRUE(volume.end.isApprox(Eigen::Vector3d(0.1, 0.02, 0.0), 1e-14));
  EXPECT_EQ(volume.radius, 0.008);
  EXPECT_GE(volume.distance, settings.margin + PatchSelection::kHysteresis);
  EXPECT_GE(volume.count, 30u);  // a quarter more than most_elements
  settings.predict = false;
  EXPECT_EQ(searchVolume(fingertip, 0.01, settings).end, fingertip.position);
}

}  // namespace
}  // namespace haptex::contact::test_patch_selection
