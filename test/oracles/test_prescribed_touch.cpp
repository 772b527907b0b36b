#include <gtest/gtest.h>

#include <limits>

#include "haptex/material/fabric_file.h"
#include "haptex/oracles/experiments/prescribed_touch.h"

namespace haptex::oracles::test_prescribed_touch {
namespace {

using base::Finger;
using base::kFingers;
using Eigen::Vector3d;

const std::vector<PrescribedTouch>& woolTouches() {
  static const std::vector<PrescribedTouch> touches =
      prescribedTouches(material::loadFabric(HAPTEX_CONFIG_DIRECTORY "/fabrics/wool.yaml"));
  return touches;
}

TEST(PrescribedTouch, FingertipsMoveWithTheVelocitiesThatTheyState) {
  constexpr double kStep = 1e-6;  // s
  for (const PrescribedTouch& touch : woolTouches()) {
    for (double time = 0.013; time < touch.duration; time += 0.029) {
      const Fingertips before = touch.fingertips(time - kStep);
      const Fingertips now = touch.fingertips(time);
      const Fingertips after = touch.fingertips(time + kStep);
      for (const Finger finger : kFingers) {
        if (!now[finger]) continue;
        const Vector3d expected =
            (after[finger]->position - before[finger]->position) / (2.0 * kStep);
        EXPECT_LT((now[finger]->velocity - expected).norm(), 1e-6) << touch.name << ' ' << time;
      }
    }
  }
}

TEST(PrescribedTouch, FingertipsStartOutsideAndRestAtTheEnd) {
  for (const PrescribedTouch& touch : woolTouches()) {
    const double outside = contact::ContactLaw(touch.sample.fabric).halfThickness();
    const Fingertips start = touch.fingertips(0.0);
    const Fingertips rest = touch.fingertips(touch.rest_from);
    const Fingertips end = touch.fingertips(touch.duration);
    EXPECT_LT(touch.rest_from, touch.duration);
    for (const Finger finger : kFingers) {
      ASSERT_EQ(start[finger].has_value(), end[finger].has_value());
      if (!start[finger]) continue;
      for (const Vector3d& particle : touch.sample.mesh.initial_positions) {
        ASSERT_GT((particle - start[finger]->position).norm(),
                  start[finger]->radius + outside - 1e-12);
      }
      EXPECT_EQ(rest[finger]->position, end[finger]->position);
      EXPECT_EQ(end[finger]->velocity.norm(), 0.0);
    }
  }
}

TEST(PrescribedTouch, NothingMovesBeforeTheTouch) {
  for (const PrescribedTouch& touch : woolTouches()) {
    HapticLoopSettings sample = touch.sample;
    HapticLoop loop(sample);
    loop.rest({}, 2.0 * sample.large_scale_step);
    for (std::size_t i = 0; i < loop.state().positions.size(); ++i) {
      ASSERT_LT((loop.state().positions[i] - sample.mesh.initial_positions[i]).norm(), 1e-7)
          << touch.name;
    }
  }
}

TEST(GradedLines, CoverTheLengthAndGrowByNoMoreThanAsked) {
  const std::vector<double> lines = gradedLines(0.2, 0.05, 0.08, 1e-3, 1.25);
  EXPECT_EQ(lines.front(), 0.0);
  EXPECT_EQ(lines.back(), 0.2);
  for (std::size_t i = 0; i + 2 < lines.size(); ++i) {
    const double here = lines[i + 1] - lines[i];
    const double next = lines[i + 2] - lines[i + 1];
    EXPECT_GT(here, 0.0);
    EXPECT_LE(std::max(here, next) / std::min(here, next), 1.25 + 1e-9) << lines[i];
    if (lines[i] > 0.05 - 1e-9 && lines[i + 1] < 0.08 + 1e-9) {
      EXPECT_LE(here, 1e-3 + 1e-12);
    }
  }
}

TEST(GradedLines, RefuseWhatWouldNotEnd) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(gradedLines(nan, 0.05, 0.08, 1e-3, 1.25), std::invalid_argument);
  EXPECT_THROW(gradedLines(0.2, 0.0, 0.08, 1e-3, 1.25), std::invalid_argument);
  EXPECT_THROW(gradedLines(0.2, 0.08, 0.05, 1e-3, 1.25), std::invalid_argument);
  EXPECT_THROW(gradedLines(0.2, 0.05, 0.2, 1e-3, 1.25), std::invalid_argument);
  EXPECT_THROW(gradedLines(0.2, 0.05, nan, 1e-3, 1.25), std::invalid_argument);
  EXPECT_THROW(gradedLines(0.2, 0.05, 0.08, 0.0, 1.25), std::invalid_argument);
  EXPECT_THROW(gradedLines(0.2, 0.05, 0.08, nan, 1.25), std::invalid_argument);
  EXPECT_THROW(gradedLines(0.2, 0.05, 0.08, 1e-3, 1.0), std::invalid_argument);
  EXPECT_THROW(computeInOneLayer(woolTouches().at(0), 1e-2, 2.0, 0), std::invalid_argument);
}

TEST(OnLines, KeepsPlacesAndAttachments) {
  const PrescribedTouch& press = woolTouches().at(0);
  const std::vector<double> weft = gradedLines(kSampleSide, 0.09, 0.11, 4e-3, 1.5);
  const std::vector<double> warp = gradedLines(kSampleSide, 0.04, 0.06, 4e-3, 1.5);
  const HapticLoopSettings other = onLines(press.sample, weft, warp);
  ASSERT_EQ(other.mesh.rest_coordinates.size(), weft.size() * warp.size());
  // All four sides are held, each corner once.
  EXPECT_EQ(other.attached_particles.size(), 2 * (weft.size() + warp.size()) - 4);
  // The taut sample is evenly stretched: places follow from rest coordinates alone.
  const double stretch = (press.sample.mesh.initial_positions.back().y() -
                          press.sample.mesh.initial_positions.front().y()) /
                         kSampleSide;
  for (std::size_t i = 0; i < other.mesh.rest_coordinates.size(); ++i) {
    const Eigen::Vector2d& rest = other.mesh.rest_coordinates[i];
    EXPECT_EQ(rest, Eigen::Vector2d(weft[i % weft.size()], warp[i / weft.size()]));
    const Vector3d expected(0.0, stretch * (rest.x() - 0.5 * kSampleSide),
                            -0.5 * kSampleSide + stretch * (rest.y() - 0.5 * kSampleSide));
    EXPECT_LT((other.mesh.initial_positions[i] - expected).norm(), 1e-12);
  }
}

}  // namespace
}  // namespace haptex::oracles::test_prescribed_touch
