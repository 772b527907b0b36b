#include <gtest/gtest.h>

#include "haptex/simulation/newest_loads.h"

namespace haptex::simulation::test_newest_loads {
namespace {

using std::chrono::milliseconds;

std::vector<cloth::PointLoad> loadsOn(std::initializer_list<int> triangles) {
  std::vector<cloth::PointLoad> loads;
  for (int triangle : triangles) {
    loads.push_back({triangle, Eigen::Vector3d::UnitX(), Eigen::Vector3d::Zero(),
                     Eigen::Vector3d::Zero(), Eigen::Matrix3d::Zero()});
  }
  return loads;
}

TEST(NewestLoads, AreTakenOnceAndTheNewestWins) {
  NewestLoads newest;
  std::vector<cloth::PointLoad> loads;
  EXPECT_FALSE(newest.take(loads, milliseconds(1000)));
  newest.set(loadsOn({1}), milliseconds(1000));
  newest.set(loadsOn({2, 3}), milliseconds(1001));
  ASSERT_TRUE(newest.take(loads, milliseconds(1002)));
  ASSERT_EQ(loads.size(), 2u);
  EXPECT_EQ(loads[0].triangle, 2);
  EXPECT_FALSE(newest.take(loads, milliseconds(1003)));
  EXPECT_EQ(loads.size(), 2u);
}

TEST(NewestLoads, EndAfterTheirLifetimeOnceAndForNewOnesAgain) {
  NewestLoads newest;
  std::vector<cloth::PointLoad> loads;
  newest.set(loadsOn({1}), milliseconds(1000));
  ASSERT_TRUE(newest.take(loads, milliseconds(1010)));
  EXPECT_FALSE(newest.take(loads, milliseconds(1099)));
  ASSERT_TRUE(newest.take(loads, milliseconds(1100)));
  EXPECT_TRUE(loads.empty());
  EXPECT_FALSE(newest.take(loads, milliseconds(5000)));
  newest.set(loadsOn({4}), milliseconds(5000));
  ASSERT_TRUE(newest.take(loads, milliseconds(5001)));
  EXPECT_EQ(loads.size(), 1u);
  newest.set(loadsOn({5}), milliseconds(5090));  // each message begins a lifetime
  ASSERT_TRUE(newest.take(loads, milliseconds(5150)));
  EXPECT_EQ(loads[0].triangle, 5);
}

TEST(NewestLoads, ThatWereNeverTakenInTimeDoNotAct) {
  NewestLoads newest;
  std::vector<cloth::PointLoad> loads = loadsOn({9});
  newest.set(loadsOn({1}), milliseconds(1000));  // while the simulation was paused
  ASSERT_TRUE(newest.take(loads, milliseconds(2000)));
  EXPECT_TRUE(loads.empty());
}

TEST(NewestLoads, EndWhenCleared) {
  NewestLoads newest;
  std::vector<cloth::PointLoad> loads;
  newest.set(loadsOn({1}), milliseconds(1000));
  newest.clear();
  ASSERT_TRUE(newest.take(loads, milliseconds(1001)));
  EXPECT_TRUE(loads.empty());
  EXPECT_FALSE(newest.take(loads, milliseconds(1200)));
}

}  // namespace
}  // namespace haptex::simulation::test_newest_loads
