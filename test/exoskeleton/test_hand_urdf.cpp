// What the shipped URDF promises: a mechanism that can be built and worn.
#include <gtest/gtest.h>
#include <urdf_parser/urdf_parser.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <vector>

#include "haptex/base/workload.h"
#include "haptex/exoskeleton/finger.h"
#include "shipped_urdf.h"
#include "urdf_poses.h"

namespace haptex::exoskeleton::test_hand_urdf {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

const urdf::ModelInterface& model() {
  static const auto parsed = urdf::parseURDF(shippedUrdf());
  return *parsed;
}

TEST(HandUrdf, PassesCheckUrdf) {
  EXPECT_EQ(
      std::system("check_urdf " HAPTEX_SOURCE_DIRECTORY "/urdf/hand_exoskeleton.urdf > /dev/null"),
      0);
}

TEST(HandUrdf, LinksThatMoveHaveAMassAndAnInertiaThatABodyCanHave) {
  int moving = 0;
  for (const auto& [name, joint] : model().joints_) {
    if (joint->type != urdf::Joint::REVOLUTE) continue;
    const auto inertial = model().getLink(joint->child_link_name)->inertial;
    ASSERT_TRUE(inertial) << name;
    ++moving;
    EXPECT_GT(inertial->mass, 0.0);
    EXPECT_EQ(std::abs(inertial->ixy) + std::abs(inertial->ixz) + std::abs(inertial->iyz), 0.0);
    const double x = inertial->ixx, y = inertial->iyy, z = inertial->izz;
    EXPECT_GT(std::min({x, y, z}), 0.0) << name;
    EXPECT_LE(std::max({x, y, z}), 0.5 * (x + y + z)) << name;  // triangle inequality
  }
  EXPECT_EQ(moving, 8);
}

TEST(HandUrdf, RootHasNoInertiaBecauseKdlWantsNone) {
  EXPECT_EQ(model().getRoot()->name, "hand_base");
  EXPECT_FALSE(model().getRoot()->inertial);
}

TEST(HandUrdf, MotorsOnThePalmOutweighWhatTheyMove) {
  for (const Finger finger : kFingers) {
    double moving = 0.0;
    for (const auto& [name, link] : model().links_) {
      if (name.rfind(exoskeleton::name(finger), 0) == 0 && link->inertial) {
        moving += link->inertial->mass;
      }
    }
    EXPECT_LT(moving, 0.025);
    EXPECT_GT(model().getLink("motor_box")->inertial->mass, 10.0 * moving);
  }
}

TEST(HandUrdf, TactileArrayLiesOnThePadAndLooksOutOfIt) {
  for (const Finger finger : kFingers) {
    const std::string prefix = name(finger);
    const Isometry3d array = toEigen(
        model().getLink(prefix + "_tactile")->parent_joint->parent_to_joint_origin_transform);
    const auto& skin = model().getLink(prefix + "_distal")->visual_array.back()->geometry;
    const double radius = dynamic_cast<const urdf::Sphere&>(*skin).radius;
    EXPECT_NEAR(array.translation().norm(), radius, 1e-4);
    EXPECT_NEAR(array.linear().col(2).dot(array.translation().normalized()), 1.0, 1e-3);
    EXPECT_LT(array.linear()(2, 2), -0.9);  // palmar
    EXPECT_GT(array.linear()(0, 0), 0.9);   // x distal
  }
}

/// The round of a finger or the box of the palm.
struct Skin {
  std::string link;
  Isometry3d in_link;
  double half_length, radius;  // m, along z of a capsule
  Vector3d half_box;           // m; zero for a capsule
};

/// Negative inside (m).
double distance(const Skin& skin, const Vector3d& point) {
  if (!skin.half_box.isZero()) {
    const Vector3d beyond = point.cwiseAbs() - skin.half_box;
    return beyond.cwiseMax(0.0).norm() + std::min(beyond.maxCoeff(), 0.0);
  }
  const double along = std::max(std::abs(point.z()) - skin.half_length, 0.0);
  return std::sqrt(point.head<2>().squaredNorm() + along * along) - skin.radius;
}

bool isSkin(const urdf::Visual& visual) { return visual.name.rfind("skin", 0) == 0; }

std::vector<Skin> allSkin() {
  std::vector<Skin> found;
  for (const auto& [name, link] : model().links_) {
    for (const auto& visual : link->visual_array) {
      if (!isSkin(*visual)) continue;
      Skin skin{name, toEigen(visual->origin), 0.0, 0.0, Vector3d::Zero()};
      const urdf::Geometry& shape = *visual->geometry;
      if (shape.type == urdf::Geometry::BOX) {
        const urdf::Vector3& size = dynamic_cast<const urdf::Box&>(shape).dim;
        skin.half_box = 0.5 * Vector3d(size.x, size.y, size.z);
      } else if (shape.type == urdf::Geometry::SPHERE) {
        skin.radius = dynamic_cast<const urdf::Sphere&>(shape).radius;
      } else {
        const auto& cylinder = dynamic_cast<const urdf::Cylinder&>(shape);
        skin.half_length = 0.5 * cylinder.length;
        skin.radius = cylinder.radius;
      }
      found.push_back(skin);
    }
  }
  return found;
}

/// A visual of the device as points of its surface, at most a millimetre apart.
struct Part {
  std::string link, name;
  std::vector<Vector3d> points;  // m, in the link
  Vector3d centre;               // m, in the link
  double radius;                 // m, around the centre; holds all points
};

std::vector<Vector3d> pointsOf(const urdf::Geometry& shape) {
  std::vector<Vector3d> points;
  Vector3d half;
  double radius = std::numeric_limits<double>::infinity();
  if (shape.type == urdf::Geometry::BOX) {
    const urdf::Vector3& size = dynamic_cast<const urdf::Box&>(shape).dim;
    half = 0.5 * Vector3d(size.x, size.y, size.z);
  } else if (shape.type == urdf::Geometry::CYLINDER) {
    const auto& cylinder = dynamic_cast<const urdf::Cylinder&>(shape);
    radius = cylinder.radius;
    half = Vector3d(radius, radius, 0.5 * cylinder.length);
  } else {
    radius = dynamic_cast<const urdf::Sphere&>(shape).radius;
    half = Vector3d::Constant(radius);
  }
  const Eigen::Vector3i count = (half / 0.0005).array().ceil().cast<int>().max(2);
  for (int i = 0; i <= count.x(); ++i) {
    for (int j = 0; j <= count.y(); ++j) {
      for (int k = 0; k <= count.z(); ++k) {
        const Eigen::Vector3i at(i, j, k);
        if ((at.array() > 0).all() && (at.array() < count.array()).all()) continue;  // inside
        const Vector3d share = at.cast<double>().cwiseQuotient(count.cast<double>());
        Vector3d point = half.cwiseProduct(2.0 * share - Vector3d::Ones());
        const bool ball = shape.type == urdf::Geometry::SPHERE;
        const double out = ball ? point.norm() : point.head<2>().norm();
        if (out > radius) point.head(ball ? 3 : 2) *= radius / out;
        points.push_back(point);
      }
    }
  }
  return points;
}

std::vector<Part> allParts() {
  std::vector<Part> found;
  for (const auto& [name, link] : model().links_) {
    for (const auto& visual : link->visual_array) {
      if (isSkin(*visual)) continue;
      Part part{name, visual->name, pointsOf(*visual->geometry), Vector3d::Zero(), 0.0};
      for (const Vector3d& point : part.points) part.radius = std::max(part.radius, point.norm());
      const Isometry3d in_link = toEigen(visual->origin);
      for (Vector3d& point : part.points) point = in_link * point;
      part.centre = in_link.translation();
      found.push_back(part);
    }
  }
  return found;
}

struct Clearance {
  double smallest = std::numeric_limits<double>::infinity();  // m
  std::string where;
};

/// The smallest distance between the device and the hand in it.
Clearance clearance(const JointAngles& angles) {
  static const std::vector<Skin> skins = allSkin();
  static const std::vector<Part> parts = allParts();
  Clearance found;
  for (const Part& part : parts) {
    const Isometry3d at = pose(model(), part.link, angles);
    for (const Skin& skin : skins) {
      const Isometry3d to_skin = (pose(model(), skin.link, angles) * skin.in_link).inverse() * at;
      if (distance(skin, to_skin * part.centre) - part.radius >= found.smallest) continue;
      for (const Vector3d& point : part.points) {
        const double away = distance(skin, to_skin * point);
        if (away < found.smallest) {
          found = {away, part.link + "/" + part.name + " and " + skin.link};
        }
      }
    }
  }
  return found;
}

/// Driven joints of index and thumb, in degrees.
using Posture = std::array<double, 6>;

// The postures of scripts/exoskeleton_pictures. In a pinch the arrays touch each other, not yet
// the skin of the other finger.
constexpr Posture kOpen = {0, 0, 12, -25, 0, 15};
constexpr Posture kPinch = {-8, 40, 18, 3, 13, 19};
constexpr Posture kClosed = {0, 75, 80, -28, 30, 45};

JointAngles between(const Posture& from, const Posture& to, double share) {
  const char* const names[] = {"index_abduction", "index_mcp", "index_pip",
                               "thumb_abduction", "thumb_cmc", "thumb_mcp"};
  JointAngles made;
  for (int i = 0; i < 6; ++i) made[names[i]] = M_PI / 180.0 * (from[i] + share * (to[i] - from[i]));
  return made;
}

TEST(HandUrdf, NoPartOfTheDeviceEntersTheHandWhileItCloses) {
  for (const Posture& to : {kPinch, kClosed}) {
    constexpr int kSteps = base::unlessSanitized(20, 4);
    for (int i = 0; i <= kSteps; ++i) {
      const double share = static_cast<double>(i) / kSteps;
      const Clearance found = clearance(between(kOpen, to, share));
      EXPECT_GT(found.smallest, 0.0) << found.where << " at " << share;
      EXPECT_LT(found.smallest, 0.002) << "the thimbles fit closely: the check does not see them";
    }
  }
}

TEST(HandUrdf, AFingerKeepsClearOfItsOwnLinksUpToItsLimits) {
  for (const Finger finger : kFingers) {
    const std::string prefix = std::string(name(finger)) + "_";
    for (const auto& [name, joint] : model().joints_) {
      if (name.rfind(prefix, 0) != 0 || joint->type != urdf::Joint::REVOLUTE || joint->mimic)
        continue;
      constexpr int kSteps = base::unlessSanitized(6, 2);
      for (int i = 0; i <= kSteps; ++i) {
        JointAngles angles = between(kOpen, kOpen, 0.0);
        const double lower = joint->limits->lower, upper = joint->limits->upper;
        angles[name] = lower + static_cast<double>(i) / kSteps * (upper - lower);
        const Clearance found = clearance(angles);
        EXPECT_GT(found.smallest, 0.0) << found.where << ", " << name << " " << angles[name];
      }
    }
  }
}

TEST(HandUrdf, AFingerBentBackwardsWouldTouchTheDevice) {
  JointAngles angles = between(kOpen, kOpen, 0.0);
  angles["index_mcp"] = -1.0;
  EXPECT_LT(clearance(angles).smallest, 0.0);
}

}  // namespace
}  // namespace haptex::exoskeleton::test_hand_urdf
