#include <gtest/gtest.h>

#include <algorithm>

#include "haptex/base/workload.h"
#include "haptex/oracles/exact/moving_elements.h"
#include "haptex/proximity/continuous.h"

namespace haptex::proximity::test_continuous {
namespace {

using Eigen::Vector3d;
using Places = std::array<Vector3d, 4>;

constexpr auto kFace = ElementPairKind::kVertexTriangle;
constexpr auto kEdges = ElementPairKind::kEdgeEdge;

/// Smallest distance at so many times.
double sampledDistance(const oracles::MovingElements& e, int samples) {
  double least = 1e9;
  for (int i = 0; i <= samples; ++i) {
    const double time = static_cast<double>(i) / samples;
    Places places;
    for (int k = 0; k < 4; ++k) places[k] = (1.0 - time) * e.begin[k] + time * e.end[k];
    least = std::min(least, distanceOf(e.kind, places).distance);
  }
  return least;
}

// A million of them are run by scripts/bench self_collision.
TEST(ContinuousDetection, MissesNoContactThatIsKnownExactly) {
  oracles::MovingElementCases cases;
  constexpr int kCases = base::unlessSanitized(100000, 20000);
  int contacts = 0, late = 0, missed = 0;
  for (int i = 0; i < kCases; ++i) {
    const oracles::MovingElements e = cases.next();
    if (!e.contact) continue;
    ++contacts;
    const auto found = earliestContact(e.kind, e.begin, e.end);
    missed += !found;
    late += found && *found > *e.contact;
  }
  EXPECT_GT(contacts, kCases / 2);
  EXPECT_EQ(missed, 0);
  EXPECT_EQ(late, 0);
}

TEST(ContinuousDetection, ReportsNoContactWhereThereIsADistance) {
  oracles::MovingElementCases cases;
  constexpr int kCases = base::unlessSanitized(3000, 750);
  int apart = 0, found = 0;
  for (int i = 0; i < kCases; ++i) {
    const oracles::MovingElements e = cases.next();
    if (e.contact) continue;
    // Between two samples the distance changes by less than 24 sqrt(3) / 2 / 10000.
    if (sampledDistance(e, 10000) < 0.003) continue;
    ++apart;
    found += earliestContact(e.kind, e.begin, e.end).has_value();
  }
  EXPECT_GT(apart, 2 * kCases / 15);
  EXPECT_EQ(found, 0);
}

TEST(ContinuousDetection, TellsTheTimeOfTheFirstContact) {
  // A vertex that falls through a triangle at 0.75, and two edges that cross there.
  const Places begin = {Vector3d(0.1, 0.1, 3), Vector3d(0, 0, 0), Vector3d(1, 0, 0),
                        Vector3d(0, 1, 0)};
  Places end = begin;
  end[0].z() = -1.0;
  const auto face = earliestContact(kFace, begin, end);
  ASSERT_TRUE(face);
  EXPECT_LE(*face, 0.75);
  EXPECT_NEAR(*face, 0.75, 2.0 * kShortestInterval);
  const auto with_gap = earliestContact(kFace, begin, end, 0.5);
  ASSERT_TRUE(with_gap);
  EXPECT_LE(*with_gap, 0.625);
  EXPECT_NEAR(*with_gap, 0.625, 2.0 * kShortestInterval);

  const Places edges_begin = {Vector3d(-1, 0, 3), Vector3d(1, 0, 3), Vector3d(0, -1, 0),
                              Vector3d(0, 1, 0)};
  Places edges_end = edges_begin;
  edges_end[0].z() = edges_end[1].z() = -1.0;
  const auto edges = earliestContact(kEdges, edges_begin, edges_end);
  ASSERT_TRUE(edges);
  EXPECT_LE(*edges, 0.75);
  EXPECT_NEAR(*edges, 0.75, 2.0 * kShortestInterval);
  edges_end[0].z() = edges_end[1].z() = 1e-6;
  EXPECT_FALSE(earliestContact(kEdges, edges_begin, edges_end));
  EXPECT_TRUE(earliestContact(kEdges, edges_begin, edges_end, 1e-6));
}

TEST(ContinuousDetection, SeesContactsThatBeginAtOnce) {
  const Places touching = {Vector3d(0.2, 0.2, 0), Vector3d(0, 0, 0), Vector3d(1, 0, 0),
                           Vector3d(0, 1, 0)};
  Places away = touching;
  away[0].z() = 1.0;
  EXPECT_EQ(earliestContact(kFace, touching, away), std::optional<double>(0.0));
  EXPECT_EQ(earliestContact(kFace, touching, touching), std::optional<double>(0.0));
  const auto at_the_end = earliestContact(kFace, away, touching);
  ASSERT_TRUE(at_the_end);
  EXPECT_NEAR(*at_the_end, 1.0, 2.0 * kShortestInterval);
}

TEST(ContinuousDetection, FollowsElementsThatTurnAroundEachOther) {
  // A needle that turns by 90 degrees above an edge, 1 um away, is no contact; 1 um lower it is.
  for (double gap : {1e-6, 0.0}) {
    const Places begin = {Vector3d(-1, 0, gap), Vector3d(1, 0, gap), Vector3d(-1, 0.3, 0),
                          Vector3d(1, 0.3, 0)};
    const Places end = {Vector3d(0, -1, gap), Vector3d(0, 1, gap), Vector3d(-1, 0.3, 0),
                        Vector3d(1, 0.3, 0)};
    EXPECT_EQ(earliestContact(kEdges, begin, end).has_value(), gap == 0.0);
  }
}

}  // namespace
}  // namespace haptex::proximity::test_continuous
