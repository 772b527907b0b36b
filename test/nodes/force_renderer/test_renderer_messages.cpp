#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "haptex/nodes/force_renderer/renderer_messages.h"

namespace haptex::nodes::test_renderer_messages {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
const ros::Time kStamp(1234, 5678);

/// Two triangles.
haptex::ClothMesh someMesh() {
  haptex::ClothMesh message;
  message.header.frame_id = "world";
  message.fabrics = {"wool"};
  message.rest_weft_coordinates = {0.0, 0.1, 0.1, 0.0};
  message.rest_warp_coordinates = {0.0, 0.0, 0.1, 0.1};
  message.triangles = {0, 1, 2, 0, 2, 3};
  message.masses = {0.1, 0.1, 0.1, 0.1};
  return message;
}

haptex::ClothState someState() {
  haptex::ClothState message;
  message.header.frame_id = "world";
  message.simulated_time = 2.5;
  message.until_next = 0.011;
  message.positions.resize(4);
  message.velocities.resize(4);
  message.positions[2].y = 0.25;
  message.velocities[3].z = -0.5;
  message.attached = {1, 3};
  return message;
}

contact::FingertipContact someContact() {
  contact::FingertipContact contact;
  contact.touching = contact.slipping = true;
  contact.force = {1.0, 2.0, 3.0};
  contact.position = {0.1, 0.2, 0.3};
  contact.velocity = {0.01, 0.02, 0.03};
  contact.stiffness << 4.0, 1.0, 0.5, 1.0, 5.0, 0.25, 0.5, 0.25, 6.0;
  contact.damping = 0.01 * contact.stiffness;
  contact.area = 1e-4;
  contact.normal_force = 3.5;
  contact.penetration = 1e-3;
  contact.centre = {0.11, 0.21, 0.31};
  contact.normal = Eigen::Vector3d::UnitX();
  contact.sliding_velocity = {0.0, 0.05, 0.0};
  contact.fabric_position = {0.03, 0.04};
  contact.fabric_velocity = {0.05, 0.06};
  return contact;
}

tactile::ArrayPlacement someArray() {
  tactile::ArrayPlacement array;
  array.origin = {0.031, 0.041};
  array.axes << 0.9, -0.1, 0.2, 0.8;
  return array;
}

simulation::FrameMotion movingHand() {
  simulation::FrameMotion hand;
  hand.pose = Eigen::Translation3d(0.5, -0.4, 0.3) *
              Eigen::AngleAxisd(0.8, Eigen::Vector3d(1.0, 2.0, 2.0) / 3.0);
  hand.velocity = {0.1, 0.2, -0.1};
  hand.angular_velocity = {0.5, -0.3, 0.2};
  return hand;
}

Eigen::Vector3d vector(const geometry_msgs::Vector3& v) { return {v.x, v.y, v.z}; }
Eigen::Vector3d vector(const geometry_msgs::Point& v) { return {v.x, v.y, v.z}; }
template <typename Nine>
Eigen::Matrix3d matrix(const Nine& nine) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(&nine[0]);
}

TEST(RendererMessages, MeshOfAMessage) {
  const mesh::ClothMesh mesh = clothMesh(someMesh());
  EXPECT_EQ(mesh.triangles.size(), 2u);
  EXPECT_EQ(mesh.rest_coordinates[2], Eigen::Vector2d(0.1, 0.1));
  EXPECT_EQ(mesh.initial_positions.size(), 4u);
}

TEST(RendererMessages, RefusesAMeshWithDefects) {
  haptex::ClothMesh message = someMesh();
  message.triangles = {0, 1, 1};
  EXPECT_THROW(clothMesh(message), std::invalid_argument);
  message.triangles = {0, 1, 9};
  EXPECT_THROW(clothMesh(message), std::invalid_argument);
}

TEST(RendererMessages, StateOfAMessage) {
  simulation::LargeScaleState state;
  readState(someState(), state);
  EXPECT_EQ(state.simulated_time, 2.5);
  EXPECT_EQ(state.until_next, 0.011);
  ASSERT_EQ(state.positions.size(), 4u);
  EXPECT_EQ(state.positions[2], Eigen::Vector3d(0.0, 0.25, 0.0));
  EXPECT_EQ(state.velocities[3], Eigen::Vector3d(0.0, 0.0, -0.5));
  EXPECT_EQ(state.attached, (std::vector<char>{0, 1, 0, 1}));
}

TEST(RendererMessages, RefusesABadStateAndSaysWhy) {
  using Message = haptex::ClothState;
  const std::vector<std::pair<std::string, std::function<void(Message&)>>> flaws = {
      {"frame_id", [](Message& m) { m.header.frame_id = "map"; }},
      {"positions[1]", [](Message& m) { m.positions[1].x = kNaN; }},
      {"positions[0]", [](Message& m) { m.positions[0].x = 1e300; }},
      {"velocities[2]", [](Message& m) { m.velocities[2].y = kNaN; }},
      {"velocities[2]", [](Message& m) { m.velocities[2].y = 1e300; }},
      {"velocities has 3", [](Message& m) { m.velocities.resize(3); }},
      {"velocities has 4", [](Message& m) { m.positions.resize(5); }},
      {"attached has 4", [](Message& m) { m.attached.push_back(4); }},
      {"simulated_time", [](Message& m) { m.simulated_time = kNaN; }},
      {"until_next", [](Message& m) { m.until_next = kNaN; }},
      {"until_next", [](Message& m) { m.until_next = -0.01; }},
      {"until_next", [](Message& m) { m.until_next = 1e300; }},
  };
  simulation::LargeScaleState state;
  for (const auto& [why, spoil] : flaws) {
    Message message = someState();
    spoil(message);
    try {
      readState(message, state);
      ADD_FAILURE() << "not refused: " << why;
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find(why), std::string::npos) << error.what();
    }
  }
}

// The promise of a command: evaluated in the hand's frame for a fingertip that is elsewhere and
// moves differently, it gives the force of the contact there in the world frame.
TEST(RendererMessages, CommandIsTheSameForceInTheFrameOfAMovingHand) {
  const contact::FingertipContact contact = someContact();
  const simulation::FrameMotion hand = movingHand();
  haptex::ServoForce message;
  fillServoForce(contact, 1.0, hand, kStamp, message);
  EXPECT_EQ(message.header.frame_id, "hand_base");
  EXPECT_EQ(message.header.stamp, kStamp);

  const Eigen::Vector3d moved(1e-3, -2e-3, 3e-3);   // in the world frame
  const Eigen::Vector3d faster(0.02, 0.01, -0.03);  // likewise
  const Eigen::Vector3d in_world =
      contact.force - contact.stiffness * moved - contact.damping * faster;
  const Eigen::Matrix3d to_hand = hand.pose.linear().transpose();
  const Eigen::Vector3d place = hand.pose.inverse() * (contact.position + moved);
  // The velocity that a finger's joints have; the hand's, at the place of linearisation, is not
  // among them.
  const Eigen::Vector3d velocity =
      to_hand * (contact.velocity + faster - hand.velocity -
                 hand.angular_velocity.cross(contact.position - hand.pose.translation()));
  const Eigen::Vector3d in_hand = vector(message.force) -
                                  matrix(message.stiffness) * (place - vector(message.position)) -
                                  matrix(message.damping) * (velocity - vector(message.velocity));
  EXPECT_LT((hand.pose.linear() * in_hand - in_world).norm(), 1e-12);
}

TEST(RendererMessages, GainScalesForceStiffnessAndDampingTogether) {
  haptex::ServoForce whole, part;
  fillServoForce(someContact(), 1.0, movingHand(), kStamp, whole);
  fillServoForce(someContact(), 0.25, movingHand(), kStamp, part);
  EXPECT_LT((vector(part.force) - 0.25 * vector(whole.force)).norm(), 1e-15);
  EXPECT_LT((matrix(part.stiffness) - 0.25 * matrix(whole.stiffness)).norm(), 1e-14);
  EXPECT_LT((matrix(part.damping) - 0.25 * matrix(whole.damping)).norm(), 1e-15);
  EXPECT_EQ(vector(part.position), vector(whole.position));
}

TEST(RendererMessages, ContactForTheTactileRenderer) {
  const contact::FingertipContact contact = someContact();
  tactile::PerContactor<double> contactors{};
  contactors[7] = 0.5;
  haptex::Contact message;
  fillContact(contact, contactors, someArray(), 0.5, kStamp, message);
  EXPECT_EQ(message.header.frame_id, "world");
  EXPECT_EQ(message.header.stamp, kStamp);
  EXPECT_TRUE(message.touching);
  EXPECT_TRUE(message.slipping);
  EXPECT_EQ(vector(message.force), 0.5 * contact.force);
  EXPECT_EQ(vector(message.centre), contact.centre);
  EXPECT_EQ(vector(message.normal), contact.normal);
  EXPECT_EQ(message.normal_force, 0.5 * 3.5);
  EXPECT_EQ(message.area, 1e-4);
  EXPECT_EQ(message.penetration, 1e-3);
  EXPECT_EQ(vector(message.sliding_velocity), contact.sliding_velocity);
  EXPECT_EQ(message.fabric_position[1], 0.04);
  EXPECT_EQ(message.fabric_velocity[0], 0.05);
  EXPECT_EQ(message.array_origin[1], 0.041);
  EXPECT_EQ(message.array_x[0], 0.9);
  EXPECT_EQ(message.array_x[1], 0.2);
  EXPECT_EQ(message.array_y[1], 0.8);
  EXPECT_EQ(message.contactor_forces[7], 0.25);
}

TEST(RendererMessages, NoContactWithoutAGain) {
  tactile::PerContactor<double> contactors{};
  contactors[7] = 0.5;
  haptex::Contact message;
  fillContact(someContact(), contactors, someArray(), 0.5, kStamp, message);
  fillContact(someContact(), contactors, someArray(), 0.0, kStamp, message);
  haptex::Contact none;
  none.header = message.header;
  EXPECT_TRUE(message.touching == none.touching && message.slipping == none.slipping);
  EXPECT_EQ(vector(message.force).norm() + vector(message.centre).norm() +
                vector(message.sliding_velocity).norm() + message.area + message.penetration +
                message.normal_force,
            0.0);
  EXPECT_EQ(message.array_origin[1], 0.0);
  EXPECT_EQ(message.array_x[0], 0.0);
  EXPECT_EQ(message.contactor_forces[7], 0.0);
}

TEST(RendererMessages, ForcesOnTheCloth) {
  cloth::PointLoad load;
  load.triangle = 5;
  load.weights = {0.2, 0.3, 0.5};
  load.position = {1.0, 2.0, 3.0};
  load.force = {4.0, 5.0, 6.0};
  load.stiffness = someContact().stiffness;
  haptex::ContactForces message;
  fillContactForces({load, load}, kStamp, message);
  EXPECT_EQ(message.header.frame_id, "world");
  ASSERT_EQ(message.triangles.size(), 2u);
  ASSERT_EQ(message.barycentric.size(), 6u);
  ASSERT_EQ(message.stiffness.size(), 18u);
  EXPECT_EQ(message.triangles[1], 5u);
  EXPECT_EQ(message.barycentric[4], 0.3);
  EXPECT_EQ(vector(message.positions[1]), load.position);
  EXPECT_EQ(vector(message.forces[1]), load.force);
  EXPECT_EQ(message.stiffness[9 + 1], 1.0);
  EXPECT_EQ(message.stiffness[9 + 8], 6.0);
  fillContactForces({}, kStamp, message);
  EXPECT_TRUE(message.triangles.empty() && message.stiffness.empty());
}

TEST(RendererMessages, AsksForTheNearestInAVolume) {
  contact::SearchVolume volume;
  volume.begin = {0.1, 0.2, 0.3};
  volume.end = {0.4, 0.5, 0.6};
  volume.radius = 0.0075;
  volume.distance = 0.012;
  volume.count = 50;
  const haptex::QueryProximity::Request request = volumeQuery(volume);
  EXPECT_EQ(request.header.frame_id, "world");
  EXPECT_EQ(request.shape, haptex::QueryProximity::Request::CAPSULE);
  ASSERT_EQ(request.points.size(), 2u);
  EXPECT_EQ(vector(request.points[1]), volume.end);
  EXPECT_EQ(request.radii, (std::vector<double>{0.0075}));
  EXPECT_EQ(request.distance, 0.012);
  EXPECT_EQ(request.nearest, 50u);
}

TEST(RendererMessages, SelectsWhatAnAnswerFoundAndRefusesTrianglesThatDoNotExist) {
  haptex::QueryProximity::Response response;
  response.elements.resize(3);
  response.elements[0].triangle = 5;
  response.elements[1].triangle = 2;
  response.elements[2].triangle = 7;
  response.elements[2].distance = 1.0;
  contact::HapticSettings settings;
  contact::PatchSelection selection(8);
  selection.begin();
  addFound(response, 8, settings, selection);
  EXPECT_TRUE(selection.finish());
  EXPECT_EQ(selection.elements(), (std::vector<int>{2, 5}));

  selection.begin();
  EXPECT_THROW(addFound(response, 7, settings, selection), std::invalid_argument);
  settings.most_elements = 1;
  contact::PatchSelection nearest(8);
  nearest.begin();
  addFound(response, 8, settings, nearest);
  EXPECT_TRUE(nearest.finish());
  EXPECT_EQ(nearest.elements(), (std::vector<int>{5}));
}

TEST(SewnMeshMessage, HasItsPanelsAndSeamsAndRefusesArraysThatDoNotFit) {
  haptex::ClothMesh message;
  message.rest_weft_coordinates = {0.0, 0.1, 0.1, 0.0};
  message.rest_warp_coordinates = {0.0, 0.0, 0.1, 0.1};
  message.triangles = {0, 1, 2, 0, 2, 3};
  message.fabrics = {"wool"};
  message.triangle_panels = {0, 1};
  message.corner_weft_coordinates = {0.0, 0.1, 0.1, 5.0, 5.1, 5.0};
  message.corner_warp_coordinates = {0.0, 0.0, 0.1, 0.0, 0.1, 0.1};
  const mesh::ClothMesh mesh = clothMesh(message);
  EXPECT_EQ(mesh.panelCount(), 2);
  EXPECT_EQ(mesh.restCorners(1)[1], Eigen::Vector2d(5.1, 0.1));
  EXPECT_EQ(mesh.seam_hinges.size(), 1u);
  haptex::ClothMesh other = message;
  other.triangle_panels = {0};
  EXPECT_THROW(clothMesh(other), std::invalid_argument);
  other.triangle_panels = {0, 2};
  EXPECT_THROW(clothMesh(other), std::invalid_argument);
  other = message;
  other.corner_warp_coordinates.pop_back();
  EXPECT_THROW(clothMesh(other), std::invalid_argument);
}

}  // namespace
}  // namespace haptex::nodes::test_renderer_messages
