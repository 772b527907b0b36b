#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "../refusal.h"
#include "haptex/contact/fingertip.h"

namespace haptex::contact::test_fingertip {
namespace {

Fingertip sound() {
  Fingertip fingertip;
  fingertip.position = {0.1, 0.2, 0.3};
  fingertip.orientation = Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitX());
  fingertip.velocity = {1.0, -2.0, 0.5};
  fingertip.angular_velocity = {0.0, 0.0, 2.0};
  fingertip.radius = 0.008;
  return fingertip;
}

TEST(Fingertip, MovesOnStraightWithItsVelocity) {
  const Fingertip predicted = predict(sound(), 0.04);
  EXPECT_TRUE(predicted.position.isApprox(Eigen::Vector3d(0.14, 0.12, 0.32), 1e-14));
  EXPECT_EQ(predicted.velocity, sound().velocity);
  EXPECT_EQ(predicted.angular_velocity, sound().angular_velocity);
  EXPECT_EQ(predicted.radius, 0.008);
}

TEST(Fingertip, TurnsOnAboutItsAngularVelocityInTheWorldFrame) {
  // 2 rad/s for 0.1 s about the world's z axis, after the turn about x that it had.
  const Eigen::Matrix3d expected = (Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitZ()) *
                                    Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitX()))
                                       .toRotationMatrix();
  const Fingertip predicted = predict(sound(), 0.1);
  EXPECT_TRUE(predicted.orientation.toRotationMatrix().isApprox(expected, 1e-14));
  EXPECT_NEAR(predicted.orientation.norm(), 1.0, 1e-15);
}

TEST(Fingertip, StaysWhereItIsWithoutVelocitiesOrTime) {
  Fingertip still = sound();
  still.velocity.setZero();
  still.angular_velocity.setZero();
  EXPECT_EQ(predict(still, 1.0).position, still.position);
  EXPECT_EQ(predict(still, 1.0).orientation.coeffs(), still.orientation.coeffs());
  EXPECT_EQ(predict(sound(), 0.0).position, sound().position);
}

std::string refusalOf(const Fingertip& fingertip) {
  try {
    requireSound(fingertip);
    EXPECT_TRUE(isSound(fingertip));
  } catch (const std::invalid_argument& error) {
    EXPECT_FALSE(isSound(fingertip));
    return error.what();
  }
  return test::kNotRefused;
}

TEST(Fingertip, IsSoundWithFiniteNumbersAndAUnitQuaternion) {
  EXPECT_EQ(refusalOf(sound()), test::kNotRefused);
  Fingertip fingertip = sound();
  fingertip.orientation.coeffs() *= 1.0009;
  EXPECT_EQ(refusalOf(fingertip), test::kNotRefused);
  fingertip.radius = 0.1;
  EXPECT_EQ(refusalOf(fingertip), test::kNotRefused);
}

TEST(Fingertip, RefusesWhatIsNotFiniteByName) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  Fingertip fingertip = sound();
  fingertip.position.y() = nan;
  EXPECT_EQ(refusalOf(fingertip), "fingertip: position (0.1 nan 0.3) must be finite");
  fingertip = sound();
  fingertip.velocity.z() = infinity;
  EXPECT_EQ(refusalOf(fingertip), "fingertip: velocity (  1  -2 inf) must be finite");
  fingertip = sound();
  fingertip.angular_velocity.x() = nan;
  EXPECT_EQ(refusalOf(fingertip), "fingertip: angular velocity (nan   0   2) must be finite");
  fingertip = sound();
  fingertip.orientation.w() = nan;
  EXPECT_EQ(refusalOf(fingertip), "fingertip: orientation has the norm nan, it must be 1 to 0.001");
}

TEST(Fingertip, RefusesOrientationsThatAreNone) {
  Fingertip fingertip = sound();
  fingertip.orientation.coeffs() *= 1.01;
  EXPECT_EQ(refusalOf(fingertip),
            "fingertip: orientation has the norm 1.01, it must be 1 to 0.001");
  fingertip.orientation.coeffs().setZero();
  EXPECT_EQ(refusalOf(fingertip), "fingertip: orientation has the norm 0, it must be 1 to 0.001");
}

TEST(Fingertip, RefusesRadiiOutOfRange) {
  for (const auto& [radius, text] :
       {std::pair(0.0, "0"), std::pair(-0.008, "-0.008"), std::pair(0.11, "0.11"),
        std::pair(std::numeric_limits<double>::infinity(), "inf"),
        std::pair(std::numeric_limits<double>::quiet_NaN(), "nan")}) {
    Fingertip fingertip = sound();
    fingertip.radius = radius;
    EXPECT_EQ(refusalOf(fingertip),
              std::string("fingertip: radius ") + text + " must be > 0 and <= 0.1 m");
  }
}

}  // namespace
}  // namespace haptex::contact::test_fingertip
