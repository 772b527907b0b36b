#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>

#include "haptex/exoskeleton/control/fingertip_reach.h"
#include "haptex/exoskeleton/emulator/emulated_finger.h"
#include "haptex/exoskeleton/emulator/hand_path.h"
#include "shipped_urdf.h"

namespace haptex::exoskeleton::test_shipped_paths {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;

constexpr double kStep = 0.01;          // s
constexpr double kThumbRadius = 0.009;  // m, and of the index: hand_exoskeleton.urdf
constexpr double kIndexRadius = 0.0075;

const std::string kDemo = HAPTEX_SOURCE_DIRECTORY "/config/paths/demo.yaml";
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

/// How far (m) from the sample's plane a target lies that holds a fingertip at it with a force (N).
double targetOf(double force, double radius) {
  const FingerMechanics person;
  const double yields = 1.0 / person.fingertip_stiffness + 1.0 / person.pulp_stiffness;
  constexpr double kPulp = 8e6;  // Pa/m, PulpSettings::stiffness: F = pi R kPulp depth^2
  return radius - std::sqrt(force / (M_PI * radius * kPulp)) - force * yields;
}

TEST(ShippedPaths, PinchTakesTheSampleNearItsLowerEdgeLiftsItAndLetsGo) {
  const HandPath path = loadHandPath(kPinch);
  EXPECT_TRUE(path.repeats());
  EXPECT_NEAR(path.duration(), 10.0, 1.0);
  // Open by 40 mm around the sample, which hangs in the plane x = 0; then it is held with 1 N.
  const HandPlace open = path.at(1.5);
  EXPECT_GT((inWorld(open, Finger::kIndex) - inWorld(open, Finger::kThumb)).norm(), 0.04);
  EXPECT_GT(inWorld(open, Finger::kIndex).x(), kIndexRadius);
  EXPECT_LT(inWorld(open, Finger::kThumb).x(), -kThumbRadius);
  for (const double time : {3.0, 4.0, 5.5, 7.0}) {
    const HandPlace place = path.at(time);
    EXPECT_NEAR(inWorld(place, Finger::kIndex).x(), targetOf(1.0, kIndexRadius), 2e-4) << time;
    EXPECT_NEAR(inWorld(place, Finger::kThumb).x(), -targetOf(1.0, kThumbRadius), 2e-4) << time;
  }

  const auto middle = [&](double time) -> Vector3d {
    const HandPlace place = path.at(time);
    return 0.5 * (inWorld(place, Finger::kIndex) + inWorld(place, Finger::kThumb));
  };
  EXPECT_NEAR(middle(3.5).z(), -0.19, 0.001);
  EXPECT_NEAR(middle(3.5).y(), 0.0, 0.001);
  EXPECT_NEAR(middle(5.5).z() - middle(3.5).z(), 0.04, 0.001);
  EXPECT_NEAR(middle(7.0).y() - middle(5.5).y(), 0.05, 0.001);
  // The pads face each other across the sample.
  EXPECT_GT((inWorld(open, Finger::kIndex) - inWorld(open, Finger::kThumb)).normalized().x(), 0.99);
  // Away from the sample, which ends at z = -0.2.
  for (const Finger finger : kFingers) EXPECT_LT(inWorld(path.at(0.0), finger).z(), -0.23);
}

/// When a phase of a path begins (s).
double beginOf(const HandPath& path, const std::string& phase) {
  for (double time = 0.0; time <= path.duration(); time += kStep) {
    if (path.phases()[path.at(time).phase] == phase) return time;
  }
  ADD_FAILURE() << "no phase " << phase;
  return 0.0;
}

TEST(ShippedPaths, DemoPinchesLiftsStretchesSlidesAndRubsWithTheForcesThatItSays) {
  const HandPath path = loadHandPath(kDemo);
  EXPECT_EQ(path.phases(), (std::vector<std::string>{"", "approach", "pinch", "lift", "stretch",
                                                     "slide", "release", "rub", "retreat", "end"}));
  EXPECT_GT(path.duration(), 30.0);
  EXPECT_LT(path.duration(), 40.0);
  const struct {
    const char* before_phase;
    double force, y, z;  // N, m
  } holds[] = {{"lift", 1.0, 0.0, -0.19},    {"stretch", 2.2, 0.0, -0.16},
               {"slide", 2.2, 0.0, -0.1912}, {"release", 0.3, 0.025, -0.19},
               {"rub", 0.5, 0.0, -0.1},      {"retreat", 0.5, 0.0, -0.16}};
  for (const auto& hold : holds) {
    const HandPlace place = path.at(beginOf(path, hold.before_phase) - 1e-3);
    const Vector3d index = inWorld(place, Finger::kIndex), thumb = inWorld(place, Finger::kThumb);
    // The file's coordinates are rounded to 0.1 mm, of which three add up.
    const Vector3d expected_index(targetOf(hold.force, kIndexRadius), hold.y, hold.z);
    const Vector3d expected_thumb(-targetOf(hold.force, kThumbRadius), hold.y, hold.z);
    EXPECT_LT((index - expected_index).norm(), 2e-4) << hold.before_phase << index.transpose();
    EXPECT_LT((thumb - expected_thumb).norm(), 2e-4) << hold.before_phase << thumb.transpose();
  }
  // Away from the sample at both ends.
  for (const double time : {0.0, path.duration()}) {
    for (const Finger finger : kFingers) EXPECT_LT(inWorld(path.at(time), finger).z(), -0.26);
  }
}

}  // namespace
}  // namespace haptex::exoskeleton::test_shipped_paths
