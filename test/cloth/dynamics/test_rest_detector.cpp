#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "fixtures.h"
#include "haptex/cloth/dynamics/rest_detector.h"

namespace haptex::cloth::test_rest_detector {
namespace {

using Eigen::Vector3d;

constexpr double kTimeStep = 0.0125;  // s

/// Two particles, one of which follows a motion along x (m, of the time in s).
class Watched {
 public:
  explicit Watched(std::function<double(double)> motion, double time_step = kTimeStep)
      : motion_(std::move(motion)), time_step_(time_step) {
    state_.positions = {Vector3d::Zero(), Vector3d(1.0, 2.0, 3.0)};
  }

  void step() {
    state_.time += time_step_;
    state_.positions[0].x() = motion_(state_.time);
    detector_.observe(state_);
  }

  /// @returns the time (s) at which it rested, or infinity if it did not by the end
  double restsAt(double end) {
    while (state_.time < end && !detector_.resting()) step();
    return detector_.resting() ? state_.time : HUGE_VAL;
  }

  RestDetector& detector() { return detector_; }

 private:
  std::function<double(double)> motion_;
  double time_step_;
  ClothState state_;
  RestDetector detector_{2};
};

TEST(RestDetector, LeavesLessThanItsToleranceToWhatDiesAway) {
  for (const double decay : {0.05, 0.5, 5.0, 60.0}) {  // s
    const auto creep = [decay](double time) { return 0.01 * std::exp(-time / decay); };
    const double time = Watched(creep).restsAt(1e4);
    ASSERT_LT(time, 1e4) << decay;
    EXPECT_LT(creep(time), RestDetector::kTolerance) << decay;
    // It is not far beyond either: some windows are needed to see it.
    EXPECT_GT(creep(time - 4.0 * RestDetector::kWindow - 0.5 * decay),
              0.5 * RestDetector::kTolerance)
        << decay;
  }
}

TEST(RestDetector, SeesADampedSwingOnlyWhereItHasDiedAway) {
  for (const double period : {0.1, 0.9, 1.0, 3.0}) {  // s
    const auto envelope = [](double time) { return 0.01 * std::exp(-time / 4.0); };
    const auto swing = [=](double time) {
      return envelope(time) * std::cos(2.0 * M_PI * time / period);
    };
    const double time = Watched(swing).restsAt(1e4);
    ASSERT_LT(time, 1e4) << period;
    EXPECT_LT(envelope(time), 3.0 * RestDetector::kTolerance) << period;
  }
}

TEST(RestDetector, NeverRestsWhereSomethingGoesOnMoving) {
  const auto rests_at = [](const std::function<double(double)>& motion) {
    return Watched(motion).restsAt(300.0);
  };
  EXPECT_EQ(rests_at([](double time) { return 1e-8 * time; }), HUGE_VAL) << "a steady creep";
  EXPECT_EQ(rests_at([](double time) { return 1e-5 * std::sin(6.0 * time); }), HUGE_VAL);
  EXPECT_EQ(rests_at([](double time) { return 1e-5 * std::sin(time); }), HUGE_VAL);
  EXPECT_EQ(rests_at([](double time) { return 1e-6 * std::exp(0.01 * time); }), HUGE_VAL);
}

TEST(RestDetector, RestsAfterItsWindowsWhereNothingMovesButRounding) {
  const auto rounding = [](double time) { return 1e-15 * std::sin(1e5 * time); };
  EXPECT_NEAR(Watched(rounding).restsAt(10.0), RestDetector::kWindows * RestDetector::kWindow,
              3.0 * kTimeStep);
  Watched slow(rounding, 10.0);  // s
  EXPECT_EQ(slow.restsAt(1e4), 10.0 * (RestDetector::kWindows * RestDetector::kStepsPerWindow + 1));
}

TEST(RestDetector, BeginsAnewWhenItIsWoken) {
  Watched watched([](double) { return 0.0; });
  const double first = watched.restsAt(10.0);
  watched.detector().wake();
  EXPECT_FALSE(watched.detector().resting());
  EXPECT_NEAR(watched.restsAt(20.0), 2.0 * first, 2.0 * kTimeStep);
}

TEST(RestDetector, PathsAndGustsDisturbUntilTheyEnd) {
  ModelledEffects effects;
  Cloth cloth(square(2), linearFabric(), effects);
  EXPECT_TRUE(isUndisturbed(cloth, 0.0));
  cloth.attach(0, {Vector3d::Zero(), Vector3d::UnitX(), 3.0, 100.0});
  EXPECT_FALSE(isUndisturbed(cloth, 0.0)) << "it has not begun yet";
  EXPECT_FALSE(isUndisturbed(cloth, 102.9));
  EXPECT_TRUE(isUndisturbed(cloth, 103.0));
  effects.air = Air();
  effects.air->wind.mean = {2.0, 0.0, 0.0};
  EXPECT_TRUE(isUndisturbed(Cloth(square(2), linearFabric(), effects), 0.0));
  effects.air->wind.gusts = {{Vector3d::UnitX(), 0.0, 1.0}, {Vector3d::Zero(), 1.0, 0.0}};
  EXPECT_TRUE(isUndisturbed(Cloth(square(2), linearFabric(), effects), 0.0)) << "both are steady";
  effects.air->wind.gusts.push_back({{0.0, 0.0, 1e-3}, 0.1, 0.0});
  EXPECT_FALSE(isUndisturbed(Cloth(square(2), linearFabric(), effects), 0.0));
}

}  // namespace
}  // namespace haptex::cloth::test_rest_detector
