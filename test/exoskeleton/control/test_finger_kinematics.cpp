#include <gtest/gtest.h>
#include <urdf_parser/urdf_parser.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <functional>
#include <limits>

#include "../../refusal.h"
#include "haptex/exoskeleton/control/finger_kinematics.h"
#include "haptex/exoskeleton/emulator/emulated_linkage.h"
#include "shipped_urdf.h"
#include "urdf_poses.h"

namespace haptex::exoskeleton::test_finger_kinematics {
namespace {

using Eigen::Vector3d;

JointVector angles(double a, double b, double c, double d) { return JointVector(a, b, c, d); }

/// Configurations that the motors can reach, on a grid from limit to limit of each driven joint.
void forEachConfiguration(const FingerKinematics& finger, int steps,
                          const std::function<void(const JointVector&)>& visit) {
  const MotorVector lower = finger.motorAngles(finger.lowerLimits());
  const MotorVector upper = finger.motorAngles(finger.upperLimits());
  for (int i = 0; i < steps; ++i) {
    for (int j = 0; j < steps; ++j) {
      for (int k = 0; k < steps; ++k) {
        const MotorVector share = MotorVector(i, j, k) / (steps - 1);
        visit(finger.jointAngles(lower + share.cwiseProduct(upper - lower)));
      }
    }
  }
}

/// The tip's pose without KDL.
Eigen::Isometry3d composedFingertip(const FingerKinematics& finger, const std::string& tip,
                                    const JointVector& joint_angles) {
  static const auto model = urdf::parseURDF(shippedUrdf());
  JointAngles named;
  for (int i = 0; i < kJoints; ++i) named[finger.jointNames()[i]] = joint_angles[i];
  return pose(*model, tip, named);
}

class EachFinger : public testing::TestWithParam<Finger> {
 protected:
  FingerKinematics finger{shippedUrdf(), GetParam()};
  std::string prefix = name(GetParam());
};
INSTANTIATE_TEST_SUITE_P(FingerKinematics, EachFinger, testing::ValuesIn(kFingers),
                         [](const auto& tested) { return name(tested.param); });

TEST_P(EachFinger, NamesItsJointsFromThePalmToTheTip) {
  const bool index = GetParam() == Finger::kIndex;
  const std::array<std::string, kJoints> expected =
      index ? std::array<std::string, kJoints>{"index_abduction", "index_mcp", "index_pip",
                                               "index_dip"}
            : std::array<std::string, kJoints>{"thumb_abduction", "thumb_cmc", "thumb_mcp",
                                               "thumb_ip"};
  EXPECT_EQ(finger.jointNames(), expected);
}

TEST_P(EachFinger, FingertipIsTheProductOfTheTransformsOfTheUrdf) {
  forEachConfiguration(finger, 4, [&](const JointVector& at) {
    EXPECT_TRUE(finger.fingertip(at).matrix().isApprox(
        composedFingertip(finger, prefix + "_tip", at).matrix(), 1e-14))
        << at.transpose();
  });
}

TEST_P(EachFinger, FingertipTakesAnUncoupledLastJointAsItIs) {
  JointVector at = finger.jointAngles(MotorVector(1.0, 4.0, 8.0));
  const Vector3d coupled = finger.fingertip(at).translation();
  at[3] += 0.3;
  const Vector3d bent = finger.fingertip(at).translation();
  EXPECT_GT((bent - coupled).norm(), 0.003);
  EXPECT_TRUE(bent.isApprox(composedFingertip(finger, prefix + "_tip", at).translation(), 1e-14));
}

TEST_P(EachFinger, MotorJacobianIsTheDerivativeOfTheFingertipInTheWholeJointSpace) {
  constexpr double kStep = 1e-3;  // rad of the motor: truncation and rounding both below 1e-9
  int configurations = 0;
  forEachConfiguration(finger, 9, [&](const JointVector& at) {
    const Eigen::Matrix3d jacobian = finger.motorJacobian(at);
    const MotorVector motors = finger.motorAngles(at);
    Eigen::Matrix3d difference;
    for (int i = 0; i < kMotors; ++i) {
      const MotorVector step = kStep * MotorVector::Unit(i);
      difference.col(i) = (finger.fingertip(finger.jointAngles(motors + step)).translation() -
                           finger.fingertip(finger.jointAngles(motors - step)).translation()) /
                          (2.0 * kStep);
    }
    EXPECT_LT((jacobian - difference).norm(), 1e-7 * jacobian.norm()) << at.transpose();
    ++configurations;
  });
  EXPECT_EQ(configurations, 729);
}

TEST_P(EachFinger, MotorsTurnFourteenTimesAsFarAsTheirJoints) {
  const MotorVector motors(-1.0, 5.0, 9.0);
  const JointVector joints = finger.jointAngles(motors);
  for (int i = 0; i < kMotors; ++i) EXPECT_DOUBLE_EQ(motors[i], 14.0 * joints[i]);
  EXPECT_TRUE(finger.motorAngles(joints).isApprox(motors, 1e-15));
}

TEST_P(EachFinger, LastJointIsWithinItsLimitsWhereTheOneBeforeItIs) {
  for (const JointVector& limits : {finger.lowerLimits(), finger.upperLimits()}) {
    const Configuration found =
        finger.configuration(finger.jointAngles(finger.motorAngles(limits)));
    EXPECT_TRUE(found.within_limits) << "joint " << found.outside;
  }
}

TEST_P(EachFinger, ReportsTheFirstJointOutsideOfItsLimits) {
  const JointVector middle = 0.5 * (finger.lowerLimits() + finger.upperLimits());
  EXPECT_TRUE(finger.configuration(middle).within_limits);
  EXPECT_EQ(finger.configuration(middle).outside, -1);
  for (int i = 0; i < kJoints; ++i) {
    for (const double beyond : {finger.lowerLimits()[i] - 1e-6, finger.upperLimits()[i] + 1e-6,
                                std::numeric_limits<double>::quiet_NaN()}) {
      JointVector at = middle;
      at[i] = beyond;
      at[kJoints - 1] = i == 0 ? 10.0 : at[kJoints - 1];  // a second one: the first is reported
      const Configuration found = finger.configuration(at);
      EXPECT_FALSE(found.within_limits);
      EXPECT_EQ(found.outside, i);
    }
  }
}

TEST_P(EachFinger, AnglesThatAreNotNumbersCountAsSingular) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(finger.configuration(JointVector::Constant(nan)).singular);
}

TEST_P(EachFinger, SmallestSingularValueIsThatOfTheMotorJacobianTimesTheReduction) {
  forEachConfiguration(finger, 4, [&](const JointVector& at) {
    const Eigen::Matrix3d driven = kReduction * finger.motorJacobian(at);
    // The square root of the smallest eigenvalue of J^T J: another way than the class goes.
    const double squared = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(
                               driven.transpose() * driven, Eigen::EigenvaluesOnly)
                               .eigenvalues()[0];
    const Configuration found = finger.configuration(at);
    EXPECT_NEAR(found.smallest_singular_value, std::sqrt(std::max(squared, 0.0)), 1e-9);
    EXPECT_EQ(found.singular, found.smallest_singular_value < kSingular);
  });
}

TEST(FingerKinematics, StraightFingerIsSingularAndOutsideOfTheLimits) {
  FingerKinematics index(shippedUrdf(), Finger::kIndex);
  const Configuration straight = index.configuration(angles(0.0, 0.5, 0.0, 0.0));
  EXPECT_TRUE(straight.singular);
  EXPECT_EQ(straight.outside, 2);
  // Straight at the thumb means mcp and ip that cancel in the reach along the finger.
  FingerKinematics thumb(shippedUrdf(), Finger::kThumb);
  const Configuration stretched = thumb.configuration(thumb.jointAngles({0.0, 2.0, 14.0 * 0.14}));
  EXPECT_TRUE(stretched.singular);
  EXPECT_EQ(stretched.outside, 2);
}

TEST(FingerKinematics, StretchedFingersAreNotSingularAtTheirLimits) {
  for (const Finger which : kFingers) {
    FingerKinematics finger(shippedUrdf(), which);
    JointVector stretched = finger.jointAngles(finger.motorAngles(finger.lowerLimits()));
    EXPECT_FALSE(finger.configuration(stretched).singular) << name(which);
  }
}

TEST(FingerKinematics, FingertipOnTheAxisOfAbductionIsSingularWithinTheLimits) {
  FingerKinematics index(shippedUrdf(), Finger::kIndex);
  // Bends the finger until the tip is below the knuckle.
  double low = 0.0, high = 1.2;
  const double knuckle = 0.034;  // m, x of the axis of abduction
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    const JointVector at = index.jointAngles({0.0, 14.0 * 1.2, 14.0 * middle});
    (index.fingertip(at).translation().x() > knuckle ? low : high) = middle;
  }
  const Configuration found = index.configuration(index.jointAngles({0.0, 14.0 * 1.2, 14.0 * low}));
  EXPECT_TRUE(found.within_limits);
  EXPECT_TRUE(found.singular);
  EXPECT_LT(found.smallest_singular_value, 1e-9);
}

TEST(FingerKinematics, CouplingComesFromTheMimicOfTheUrdf) {
  const FingerKinematics index(shippedUrdf(), Finger::kIndex);
  EXPECT_NEAR(index.jointAngles({0.0, 0.0, 14.0})[3], 2.0 / 3.0, 1e-6);
  const FingerKinematics thumb(shippedUrdf(), Finger::kThumb);
  EXPECT_NEAR(thumb.jointAngles({0.0, 0.0, 14.0})[3], 1.0 - 0.349066, 1e-15);
  FingerKinematics other(replaced(shippedUrdf(), "multiplier=\"0.666667\" offset=\"0\"",
                                  "multiplier=\"-0.5\" offset=\"0.25\""),
                         Finger::kIndex);
  EXPECT_DOUBLE_EQ(other.jointAngles({0.0, 0.0, 28.0})[3], -0.75);
}

/// What the constructor says about a URDF.
std::string refusal(const std::string& urdf, Finger finger = Finger::kIndex) {
  return test::refusalOf([&] { FingerKinematics(urdf, finger); });
}

std::string refusalWith(const std::string& old_part, const std::string& new_part) {
  return refusal(replaced(shippedUrdf(), old_part, new_part));
}

TEST(FingerKinematics, RefusesWhatUrdfdomCannotRead) {
  const std::string expected =
      "exoskeleton, index: urdfdom cannot read the URDF; its reason is on standard error";
  EXPECT_EQ(refusal("not a URDF"), expected);
  EXPECT_EQ(refusal(""), expected);
  EXPECT_EQ(
      refusalWith("<limit lower=\"0.0000\" upper=\"1.3963\" effort=\"0.5\" velocity=\"12\"/>", ""),
      expected);
  EXPECT_EQ(refusalWith("multiplier=\"0.666667\"", "multiplier=\"nan\""), expected);
  EXPECT_EQ(refusalWith("upper=\"1.3963\"", "upper=\"inf\""), expected);
  EXPECT_EQ(refusalWith("xyz=\"0.034 0.022 -0.014\"", "xyz=\"nan 0.022 -0.014\""), expected);
}

TEST(FingerKinematics, RefusesAUrdfWithoutTheEndsOfTheChain) {
  const std::string empty = "<robot name=\"r\"><link name=\"hand_base\"/></robot>";
  EXPECT_EQ(refusal(empty, Finger::kThumb), "exoskeleton, thumb: the URDF has no link thumb_tip");
  EXPECT_EQ(refusal("<robot name=\"r\"><link name=\"index_tip\"/></robot>"),
            "exoskeleton, index: the URDF has no link hand_base");
  EXPECT_EQ(refusal("<robot name=\"r\"><link name=\"index_tip\"/><link name=\"hand_base\"/>"
                    "<joint name=\"j\" type=\"fixed\"><parent link=\"index_tip\"/>"
                    "<child link=\"hand_base\"/></joint></robot>"),
            "exoskeleton, index: index_tip does not descend from hand_base");
}

TEST(FingerKinematics, RefusesAnotherNumberOfRevoluteJointsThanFour) {
  EXPECT_EQ(
      refusalWith("name=\"index_mcp\" type=\"revolute\"", "name=\"index_mcp\" type=\"fixed\""),
      "exoskeleton, index: the chain has 3 revolute joints, must be 4");
  const std::string five = replaced(
      replaced(shippedUrdf(), "<link name=\"index_tip\"/>",
               "<link name=\"index_tip\"/><link name=\"index_nail\"/>"
               "<joint name=\"index_nail\" type=\"revolute\"><parent link=\"index_distal\"/>"
               "<child link=\"index_nail\"/><axis xyz=\"0 1 0\"/>"
               "<limit lower=\"0\" upper=\"1\" effort=\"1\" velocity=\"1\"/></joint>"),
      "<parent link=\"index_distal\"/><child link=\"index_tip\"/>",
      "<parent link=\"index_nail\"/><child link=\"index_tip\"/>");
  EXPECT_EQ(refusal(five), "exoskeleton, index: the chain has 5 revolute joints, must be 4");
}

TEST(FingerKinematics, RefusesAJointThatIsNeitherRevoluteNorFixed) {
  for (const std::string type : {"prismatic", "continuous", "floating"}) {
    EXPECT_EQ(refusalWith("name=\"index_pip\" type=\"revolute\"",
                          "name=\"index_pip\" type=\"" + type + "\""),
              "exoskeleton, index: index_pip must be revolute or fixed");
  }
}

TEST(FingerKinematics, RefusesLimitsThatDoNotIncrease) {
  EXPECT_EQ(refusalWith("lower=\"0.0000\" upper=\"1.3963\"", "lower=\"1.5\" upper=\"1.5\""),
            "exoskeleton, index: limits of index_mcp are 1.500000 to 1.500000 rad, must increase");
}

TEST(FingerKinematics, RefusesAnAxisWithoutDirection) {
  EXPECT_EQ(refusalWith("<axis xyz=\"0 0 1\"/>", "<axis xyz=\"0 0 0\"/>"),
            "exoskeleton, index: the axis of index_abduction has no direction");
}

TEST(FingerKinematics, RefusesALastJointThatDoesNotMimicTheOneBeforeIt) {
  const std::string mimic = "<mimic joint=\"index_pip\" multiplier=\"0.666667\" offset=\"0\"/>";
  EXPECT_EQ(refusalWith(mimic, ""), "exoskeleton, index: index_dip does not mimic index_pip");
  EXPECT_EQ(refusalWith(mimic, "<mimic joint=\"index_mcp\"/>"),
            "exoskeleton, index: index_dip does not mimic index_pip");
}

TEST_P(EachFinger, WeightOfTheLinksIsTheDerivativeOfTheirPotentialEnergy) {
  FingerKinematics kinematics(shippedUrdf(), GetParam());
  EmulatedLinkage linkage(shippedUrdf(), GetParam());
  const Vector3d gravity(3.0, -5.0, 7.0);
  const MotorVector at = kinematics.motorAngles({0.1, 0.6, 0.9, 0.0});
  const auto energy = [&](const MotorVector& angles) {
    linkage.setAngles(kinematics.jointAngles(angles));
    return linkage.potentialEnergy(gravity);
  };
  const MotorVector torques = kinematics.motorWeight(kinematics.jointAngles(at)) * gravity;
  constexpr double kStep = 1e-3;  // rad: rounding and truncation are 1e-12 N m
  for (int i = 0; i < kMotors; ++i) {
    const MotorVector step = kStep * MotorVector::Unit(i);
    EXPECT_NEAR(torques[i], (energy(at + step) - energy(at - step)) / (2.0 * kStep), 1e-10);
  }
  EXPECT_GT(torques.norm(), 1e-5);
}

TEST(FingerKinematics, LinksWithoutInertialsWeighNothing) {
  std::string urdf = shippedUrdf();
  for (std::size_t at; (at = urdf.find("<inertial>")) != std::string::npos;) {
    const std::string end = "</inertial>";
    urdf.erase(at, urdf.find(end, at) + end.size() - at);
  }
  FingerKinematics kinematics(urdf, Finger::kIndex);
  EXPECT_TRUE(kinematics.motorWeight(kinematics.jointAngles({0.0, 3.0, 6.0})).isZero(0.0));
}

TEST(FingerKinematics, RefusesAMassBelowZero) {
  EXPECT_EQ(refusalWith("<mass value=\"0.006\"/>", "<mass value=\"-0.006\"/>"),
            "exoskeleton, index: the mass of index_knuckle is -0.006000 kg, must be at least 0");
}

TEST(FingerKinematics, KeepsItsChainWhenMoved) {
  FingerKinematics first(shippedUrdf(), Finger::kThumb);
  const JointVector at = first.jointAngles({0.0, 3.0, 6.0});
  const Eigen::Isometry3d before = first.fingertip(at);
  FingerKinematics second(std::move(first));
  EXPECT_EQ(second.fingertip(at).matrix(), before.matrix());
  first = std::move(second);
  EXPECT_EQ(first.fingertip(at).matrix(), before.matrix());
}

}  // namespace
}  // namespace haptex::exoskeleton::test_finger_kinematics
