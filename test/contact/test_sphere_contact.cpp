#include <gtest/gtest.h>

#include <cmath>

#include "fixtures.h"
#include "haptex/contact/sphere_contact.h"

namespace haptex::contact::test_sphere_contact {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kArea = 1e-6;   // m^2
constexpr double kDepth = 2e-4;  // m

/// One particle in the origin, and a fingertip that presses it along -x.
class SphereContactTest : public testing::Test {
 protected:
  Particles particles() const { return {positions_, velocities_, areas_, 1}; }
  const TouchedParticle& evaluate() {
    const auto& touched = contact_.evaluate(particles(), fingertip_);
    EXPECT_EQ(touched.size(), 1u);
    return touched.front();
  }
  const TouchedParticle& commit() {
    const auto& touched = contact_.commit(particles(), fingertip_);
    EXPECT_EQ(touched.size(), 1u);
    return touched.front();
  }
  double elasticForce() const { return kArea * law_.pressure(kDepth).stress; }
  double sticking() const { return kArea * law_.tangentialStiffness(); }
  /// The displacement (m) at which the particle begins to slip.
  double slipDisplacement() const { return law_.friction() * elasticForce() / sticking(); }

  const ContactLaw law_{wool()};
  std::vector<Vector3d> positions_{Vector3d::Zero()};
  std::vector<Vector3d> velocities_{Vector3d::Zero()};
  std::vector<double> areas_{kArea};
  Fingertip fingertip_ = pressing(law_, Vector3d::Zero(), kDepth);
  SphereContact contact_{law_, 1};
};

TEST_F(SphereContactTest, PushesWithThePressureTimesTheAreaAlongTheLineFromTheCentre) {
  const TouchedParticle& touched = evaluate();
  EXPECT_EQ(touched.normal, Vector3d(-1.0, 0.0, 0.0));
  EXPECT_NEAR(touched.depth, kDepth, 1e-15);
  EXPECT_NEAR(touched.normal_force, elasticForce(), 1e-9 * elasticForce());
  EXPECT_EQ(touched.friction, Vector3d::Zero());
  EXPECT_FALSE(touched.slips);
}

TEST_F(SphereContactTest, DoesNotTouchWhatIsOutOfReachOrInTheVeryCentre) {
  fingertip_.position.x() += kDepth + 1e-12;
  EXPECT_TRUE(contact_.evaluate(particles(), fingertip_).empty());
  fingertip_.position.setZero();
  EXPECT_TRUE(contact_.evaluate(particles(), fingertip_).empty());
  positions_[0].x() = std::nan("");
  EXPECT_TRUE(contact_.evaluate(particles(), fingertip_).empty());
}

TEST_F(SphereContactTest, ApproachRaisesTheForceInProportionAndRetreatNeverPulls) {
  velocities_[0].x() = 0.1;  // against the normal
  EXPECT_NEAR(evaluate().normal_force, (1.0 + 0.1 * law_.damping()) * elasticForce(),
              1e-9 * elasticForce());
  velocities_[0].x() = -0.9 / law_.damping();
  EXPECT_NEAR(evaluate().normal_force, 0.1 * elasticForce(), 1e-9 * elasticForce());
  velocities_[0].x() = -2.0 / law_.damping();
  EXPECT_EQ(evaluate().normal_force, 0.0);
  EXPECT_EQ(evaluate().damping, Matrix3d::Zero());
  EXPECT_EQ(evaluate().stiffness(0, 0), 0.0);
}

TEST_F(SphereContactTest, HoldsAParticleByASpringToWhereItTouchedFirst) {
  commit();
  positions_[0].y() = 0.5 * slipDisplacement();
  const TouchedParticle& touched = evaluate();
  EXPECT_FALSE(touched.slips);
  // The normal has turned by 1e-3 at most.
  EXPECT_NEAR(touched.friction.y(), -0.5 * sticking() * slipDisplacement(),
              1e-3 * sticking() * slipDisplacement());
  EXPECT_NEAR(touched.friction.dot(touched.normal), 0.0, 1e-15);
  commit();
  EXPECT_NEAR(commit().friction.norm(), touched.friction.norm(), 1e-15) << "creeps";
}

TEST_F(SphereContactTest, SlipsAtTheCoefficientOfFrictionWhateverTheDistance) {
  commit();
  for (double part : {1.1, 3.0, 0.5}) {  // on, on, and back
    positions_[0].y() = part * slipDisplacement();
    const TouchedParticle& touched = commit();
    EXPECT_NEAR(touched.friction.norm(), law_.friction() * touched.normal_force,
                1e-12 * touched.normal_force);
    EXPECT_TRUE(touched.slips);
    EXPECT_EQ(touched.friction.y() < 0.0, part != 0.5) << "friction acts with the motion";
  }
}

TEST_F(SphereContactTest, SticksAgainAfterAReversal) {
  commit();
  positions_[0].y() = 3.0 * slipDisplacement();
  const double slipping = commit().friction.y();
  positions_[0].y() = 2.5 * slipDisplacement();
  const TouchedParticle& touched = evaluate();
  EXPECT_FALSE(touched.slips);
  // The depth, and with it the limit, changes by 1 % on the way.
  EXPECT_NEAR(touched.friction.y(), 0.5 * slipping, 1e-2 * std::abs(slipping));
}

TEST_F(SphereContactTest, ASlidingParticleFeelsOneFrictionInBothKindsOfEvaluation) {
  commit();
  positions_[0].y() = 1.5 * slipDisplacement();
  const Vector3d before = evaluate().friction;
  EXPECT_EQ(commit().friction, before);
  EXPECT_NEAR((evaluate().friction - before).norm(), 0.0, 1e-12 * before.norm());
}

TEST_F(SphereContactTest, TheAnchorTurnsWithTheFingertip) {
  commit();
  const double angle = 0.5 * slipDisplacement() / fingertip_.radius;
  fingertip_.orientation = Eigen::AngleAxisd(angle, Vector3d::UnitZ());
  // The anchor was at (-1, 0, 0) times the distance from the centre and turns towards -y.
  const double distance = fingertip_.radius + law_.halfThickness() - kDepth;
  EXPECT_NEAR(evaluate().friction.y(), -sticking() * distance * std::sin(angle),
              1e-9 * sticking() * distance);
}

TEST_F(SphereContactTest, ForgetsTheAnchorOfAContactThatEnded) {
  commit();
  const Vector3d place = fingertip_.position;
  fingertip_.position.x() += 0.01;
  contact_.commit(particles(), fingertip_);
  fingertip_.position = place;
  positions_[0].y() = 0.5 * slipDisplacement();
  EXPECT_EQ(commit().friction, Vector3d::Zero());
}

TEST_F(SphereContactTest, ClearForgetsAllAnchors) {
  commit();
  contact_.clear();
  EXPECT_TRUE(contact_.touched().empty());
  positions_[0].y() = 0.5 * slipDisplacement();
  EXPECT_EQ(evaluate().friction, Vector3d::Zero());
}

TEST_F(SphereContactTest, AnAdoptedAnchorPullsAsItDidBefore) {
  commit();
  positions_[0].y() = 0.5 * slipDisplacement();
  SphereContact next(law_, 1);
  next.adoptAnchor(0, contact_, 0);
  EXPECT_EQ(next.evaluate(particles(), fingertip_).front().friction, evaluate().friction);
}

TEST_F(SphereContactTest, NeverPullsWithMoreThanFrictionOnAPathInAllDirections) {
  for (int i = 0; i < 200; ++i) {
    const double angle = 0.1 * i;
    positions_[0] =
        5.0 * slipDisplacement() * Vector3d(0.1, std::sin(angle), std::cos(0.7 * angle));
    const TouchedParticle& touched = commit();
    EXPECT_LE(touched.friction.norm(), law_.friction() * touched.normal_force * (1.0 + 1e-12));
  }
}

/// -d force / d position of a particle that sticks, by central differences.
TEST_F(SphereContactTest, StiffnessOfAStickingParticleIsTheDerivativeOfItsForce) {
  commit();
  positions_[0] = {0.0, 0.3 * slipDisplacement(), -0.2 * slipDisplacement()};
  const Matrix3d stiffness = evaluate().stiffness;
  Matrix3d differences;
  const double step = 1e-9;
  for (int axis = 0; axis < 3; ++axis) {
    const Vector3d middle = positions_[0];
    positions_[0][axis] += step;
    const Vector3d above = evaluate().force();
    positions_[0] = middle;
    positions_[0][axis] -= step;
    differences.col(axis) = (evaluate().force() - above) / (2.0 * step);
    positions_[0] = middle;
  }
  // What is left out is how the normal turns: the force over the distance from the centre.
  const double left_out = 2.0 * elasticForce() / fingertip_.radius;
  EXPECT_LT((stiffness - differences).norm(), left_out + 1e-3 * stiffness.norm());
  EXPECT_LT(left_out, 0.1 * stiffness.norm()) << "a tolerance that means nothing";
}

TEST_F(SphereContactTest, FrictionOfASlippingParticleIsConstantAlongTheSlipInTheTangent) {
  commit();
  positions_[0].y() = 2.0 * slipDisplacement();
  const TouchedParticle& touched = evaluate();
  ASSERT_TRUE(touched.slips);
  const Vector3d along = touched.friction.normalized();
  EXPECT_NEAR(along.dot(touched.tangent * along), 0.0, 1e-9 * touched.stiffness.norm());
  // The secant to the anchor; the depth is a little less than in the middle.
  EXPECT_NEAR(along.dot(touched.stiffness * along), 0.5 * sticking(), 1e-2 * sticking());
}

}  // namespace
}  // namespace haptex::contact::test_sphere_contact
