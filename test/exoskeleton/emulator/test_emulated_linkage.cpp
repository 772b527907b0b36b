#include <gtest/gtest.h>
#include <urdf_parser/urdf_parser.h>

#include <kdl/chaindynparam.hpp>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainjnttojacsolver.hpp>
#include <stdexcept>
#include <vector>

#include "../../refusal.h"
#include "emulator_fixtures.h"
#include "haptex/exoskeleton/emulator/emulated_linkage.h"

namespace haptex::exoskeleton::test_emulated_linkage {
namespace {

using Eigen::Vector3d;

const Vector3d kGravity(1.0, -2.0, -9.0);  // m/s^2, so that no axis is spared

KDL::Frame toKdl(const urdf::Pose& pose) {
  const urdf::Rotation& r = pose.rotation;
  return {KDL::Rotation::Quaternion(r.x, r.y, r.z, r.w),
          KDL::Vector(pose.position.x, pose.position.y, pose.position.z)};
}

KDL::RigidBodyInertia toKdl(const urdf::Inertial& body) {
  const KDL::RotationalInertia about_centre(body.ixx, body.iyy, body.izz, body.ixy, body.ixz,
                                            body.iyz);
  return toKdl(body.origin) * KDL::RigidBodyInertia(body.mass, KDL::Vector::Zero(), about_centre);
}

// Of a link and what is fixed to it, in the link's frame. The next link of the chain moves.
KDL::RigidBodyInertia rigidPart(const urdf::Link& link) {
  KDL::RigidBodyInertia sum = link.inertial ? toKdl(*link.inertial) : KDL::RigidBodyInertia::Zero();
  for (const auto& child : link.child_links) {
    const urdf::Joint& joint = *child->parent_joint;
    if (joint.type != urdf::Joint::FIXED) continue;
    sum = sum + toKdl(joint.parent_to_joint_origin_transform) * rigidPart(*child);
  }
  return sum;
}

// The chain as KDL has it, built here on its own: segment by segment from hand_base to the tip, the
// masses of fixed links on the moving one before them.
KDL::Chain kdlChain(const std::string& text, Finger finger) {
  const auto model = urdf::parseURDF(text);
  std::vector<urdf::LinkConstSharedPtr> links;
  for (urdf::LinkConstSharedPtr link = model->getLink(std::string(name(finger)) + "_tip");
       link->name != "hand_base"; link = link->getParent()) {
    links.insert(links.begin(), link);
  }
  KDL::Chain chain;
  for (const auto& link : links) {
    const urdf::Joint& joint = *link->parent_joint;
    const KDL::Frame origin = toKdl(joint.parent_to_joint_origin_transform);
    if (joint.type == urdf::Joint::FIXED) {
      chain.addSegment(KDL::Segment(KDL::Joint(KDL::Joint::None), origin));
    } else {
      const KDL::Vector axis(joint.axis.x, joint.axis.y, joint.axis.z);
      chain.addSegment(KDL::Segment(KDL::Joint(origin.p, origin.M * axis, KDL::Joint::RotAxis),
                                    origin, rigidPart(*link)));
    }
  }
  return chain;
}

class EmulatedLinkageOf : public testing::TestWithParam<Finger> {
 protected:
  JointVector randomJoints(double largest) {
    std::uniform_real_distribution<double> uniform(-largest, largest);
    JointVector joints;
    for (int i = 0; i < kJoints; ++i) joints[i] = uniform(generator_);
    return joints;
  }

  std::mt19937 generator_{1};
};

// Both add up some fifty products per entry, each rounded to 1.1e-16 of its size, and four turns of
// the frames before: 1e-14 of the norm. Terms that cancel in the sums take one to two digits more.
constexpr double kRounding = 1e-13;

TEST_P(EmulatedLinkageOf, HasTheMassMatrixBiasAndJacobianOfKdl) {
  EmulatedLinkage linkage(shippedUrdf(), GetParam());
  const KDL::Chain chain = kdlChain(shippedUrdf(), GetParam());
  ASSERT_EQ(chain.getNrOfJoints(), unsigned{kJoints});
  KDL::ChainDynParam dynamics(chain, KDL::Vector(kGravity.x(), kGravity.y(), kGravity.z()));
  KDL::ChainFkSolverPos_recursive position(chain);
  KDL::ChainJntToJacSolver differential(chain);
  for (int trial = 0; trial < 100; ++trial) {
    const JointVector angles = randomJoints(1.5), velocities = randomJoints(20.0);
    KDL::JntArray q(kJoints), v(kJoints), coriolis(kJoints), gravity(kJoints);
    q.data = angles;
    v.data = velocities;
    KDL::JntSpaceInertiaMatrix mass(kJoints);
    KDL::Jacobian jacobian(kJoints);
    KDL::Frame tip;
    dynamics.JntToMass(q, mass);
    dynamics.JntToCoriolis(q, v, coriolis);
    dynamics.JntToGravity(q, gravity);
    differential.JntToJac(q, jacobian);
    position.JntToCart(q, tip);

    linkage.setAngles(angles);
    EXPECT_TRUE(linkage.massMatrix().isApprox(JointMatrix(mass.data), kRounding));
    const JointVector bias = coriolis.data + gravity.data;
    EXPECT_TRUE(linkage.biasTorques(velocities, kGravity).isApprox(bias, 10.0 * kRounding));
    EXPECT_TRUE(linkage.tipJacobian().isApprox(TipJacobian(jacobian.data.topRows<3>()), kRounding));
    EXPECT_LT((linkage.tip().translation() - Vector3d(tip.p.x(), tip.p.y(), tip.p.z())).norm(),
              kRounding);  // m
  }
}

TEST_P(EmulatedLinkageOf, TorquesAgainstGravityAreTheGradientOfItsEnergy) {
  EmulatedLinkage linkage(shippedUrdf(), GetParam());
  const JointVector angles = randomJoints(1.0);
  const double h = 1e-5;
  linkage.setAngles(angles);
  const JointVector torques = linkage.biasTorques(JointVector::Zero(), kGravity);
  for (int i = 0; i < kJoints; ++i) {
    linkage.setAngles(angles + h * JointVector::Unit(i));
    const double above = linkage.potentialEnergy(kGravity);
    linkage.setAngles(angles - h * JointVector::Unit(i));
    EXPECT_NEAR(torques[i], (above - linkage.potentialEnergy(kGravity)) / (2.0 * h), 1e-9);
  }
}

INSTANTIATE_TEST_SUITE_P(Both, EmulatedLinkageOf, testing::ValuesIn(kFingers),
                         [](const auto& info) { return std::string(name(info.param)); });

std::string refusalOf(const std::string& urdf) {
  return test::refusalOf([&] { EmulatedLinkage linkage(urdf, Finger::kIndex); });
}

std::string chainOf(int joints, const std::string& type, const std::string& mass) {
  std::string urdf = R"(<robot name="r"><link name="hand_base"/>)";
  std::string parent = "hand_base";
  for (int i = 0; i < joints; ++i) {
    const std::string link = i + 1 == joints ? "index_tip" : "link" + std::to_string(i);
    urdf += "<link name=\"" + link + "\"><inertial><mass value=\"" + mass +
            R"("/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>)" +
            "<joint name=\"joint" + std::to_string(i) + "\" type=\"" + type + "\"><parent link=\"" +
            parent + "\"/><child link=\"" + link +
            R"("/><limit lower="0" upper="1" effort="1" velocity="1"/></joint>)";
    parent = link;
  }
  return urdf + "</robot>";
}

TEST(EmulatedLinkage, RefusesAChainThatIsNotAFinger) {
  EXPECT_EQ(refusalOf(chainOf(4, "revolute", "0.01")), test::kNotRefused);
  EXPECT_EQ(refusalOf("nonsense"), "index: the URDF is not valid");
  EXPECT_EQ(refusalOf(R"(<robot name="r"><link name="hand_base"/></robot>)"),
            "index: the URDF has no link index_tip");
  EXPECT_EQ(refusalOf(R"(<robot name="r"><link name="index_tip"/></robot>)"),
            "index: hand_base is no ancestor of index_tip");
  EXPECT_EQ(refusalOf(chainOf(3, "revolute", "0.01")),
            "index: the chain must have four revolute joints");
  EXPECT_EQ(refusalOf(chainOf(5, "revolute", "0.01")),
            "index: joint joint4: the chain must have four revolute joints");
  EXPECT_EQ(refusalOf(chainOf(4, "prismatic", "0.01")),
            "index: joint joint0: the chain must have four revolute joints");
  EXPECT_EQ(refusalOf(chainOf(4, "revolute", "0")), "index: link link0: needs a mass > 0");
}

}  // namespace
}  // namespace haptex::exoskeleton::test_emulated_linkage
