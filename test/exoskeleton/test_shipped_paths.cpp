#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>

#include "haptex/exoskeleton/emulated_finger.h"
#include "haptex/exoskeleton/fingertip_reach.h"
#include "haptex/exoskeleton/hand_path.h"
#include "shipped_urdf.h"

namespace haptex::exoskeleton {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;

constexpr double kStep = 0.01;          // s
constexpr double kThumbRadius = 0.009;  // m, and of the index: hand_exoskeleton.urdf
constexpr double kIndexRadius = 0.0075;

const std::string kPinch = HAPTEX_SOURCE_DIRECTORY "/config/paths/pinch.yaml";

Vector3d inWorld(const HandPlace& place, Finger finger) {
  return place.hand_base * place.fingertips[finger];
}

TEST(ShippedPaths, LeadFingertipsOnlyToPlacesWellWithinTheirLimits) {
  for (const auto& entry : fs::directory_iterator(fs::path(kPinch).parent_path())) {
    const HandPath path = loadHandPath(entry.path().string());
    for (const Finger finger : kFingers) {
      FingertipReach reach(shippedUrdf(), finger);
      FingerKinematics kinematics(shippedUrdf(), finger);
      const MotorVector margin = 0.02 * (reach.highest() - reach.lowest());
      MotorVector angles = 0.5 * (reach.lowest() + reach.highest());
      for (double time = 0.0; time <= path.duration(); time += kStep) {
        const Vector3d target = path.at(time).fingertips[finger];
        const FingertipReach::Place place = reach.nearest(target, angles);
        angles = place.motor_angles;
        const std::string where =
            entry.path().string() + ", " + name(finger) + ", " + std::to_string(time) + " s";
        ASSERT_LT((place.position - target).norm(), 2.0 * FingertipReach::kTolerance) << where;
        ASSERT_TRUE((angles.array() > (reach.lowest() + margin).array()).all()) << where;
        ASSERT_TRUE((angles.array() < (reach.highest() - margin).array()).all()) << where;
        ASSERT_FALSE(kinematics.configuration(kinematics.jointAngles(angles)).singular) << where;
      }
    }
  }
}

TEST(ShippedPaths, AreNoFasterThanAPersonsFinger) {
  for (const auto& entry : fs::directory_iterator(fs::path(kPinch).parent_path())) {
    const HandPath path = loadHandPath(entry.path().string());
    for (const Finger finger : kFingers) {
      for (double time = 0.0; time < path.duration(); time += kStep) {
        const Vector3d way =
            path.at(time + kStep).fingertips[finger] - path.at(time).fingertips[finger];
        EXPECT_LT(way.norm() / kStep, 0.2 * EmulatedFinger::kTargetSpeed) << entry.path();
      }
    }
  }
}

TEST(ShippedPaths, PinchTakesTheSampleNearItsLowerEdgeLiftsItAndLetsGo) {
  const HandPath path = loadHandPath(kPinch);
  EXPECT_TRUE(path.repeats());
  EXPECT_NEAR(path.duration(), 10.0, 1.0);
  double closest = 1.0, farthest = 0.0;
  for (double time = 0.0; time < path.duration(); time += kStep) {
    const HandPlace place = path.at(time);
    const double distance =
        (inWorld(place, Finger::kIndex) - inWorld(place, Finger::kThumb)).norm();
    closest = std::min(closest, distance);
    farthest = std::max(farthest, distance);
    // One on each side of the sample, which hangs in the plane x = 0.
    EXPECT_GT(inWorld(place, Finger::kIndex).x(), 0.9 * kIndexRadius) << time;
    EXPECT_LT(inWorld(place, Finger::kThumb).x(), -0.9 * kThumbRadius) << time;
  }
  EXPECT_GT(closest, kIndexRadius + kThumbRadius);
  EXPECT_LT(closest, kIndexRadius + kThumbRadius + 0.001);
  EXPECT_GT(farthest, 0.04);

  const auto middle = [&](double time) -> Vector3d {
    const HandPlace place = path.at(time);
    return 0.5 * (inWorld(place, Finger::kIndex) + inWorld(place, Finger::kThumb));
  };
  EXPECT_NEAR(middle(3.5).z(), -0.19, 0.001);
  EXPECT_NEAR(middle(3.5).y(), 0.0, 0.001);
  EXPECT_NEAR(middle(5.5).z() - middle(3.5).z(), 0.04, 0.001);
  EXPECT_NEAR(middle(7.0).y() - middle(5.5).y(), 0.05, 0.001);
  // The pads face each other across the sample.
  const HandPlace held = path.at(3.5);
  EXPECT_GT((inWorld(held, Finger::kIndex) - inWorld(held, Finger::kThumb)).normalized().x(), 0.99);
  // Away from the sample, which ends at z = -0.2.
  for (const Finger finger : kFingers) EXPECT_LT(inWorld(path.at(0.0), finger).z(), -0.23);
}

}  // namespace
}  // namespace haptex::exoskeleton
