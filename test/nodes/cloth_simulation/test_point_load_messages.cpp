#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <string>

#include "../simulation/small_scene.h"
#include "haptex/nodes/cloth_simulation/point_load_messages.h"
#include "haptex/nodes/common/cloth_messages.h"

namespace haptex::nodes::test_point_load_messages {
namespace {

constexpr std::size_t kTriangles = 32;  // of simulation::smallSimulation()

haptex::ContactForces twoForces() {
  haptex::ContactForces message;
  message.header.frame_id = "world";
  message.triangles = {3, 31};
  message.barycentric = {0.2, 0.3, 0.5, 1.0, 0.0, 0.0};
  message.positions.resize(2);
  message.positions[1].y = 0.25;
  message.forces.resize(2);
  message.forces[0].x = 0.01;
  message.forces[1].z = -0.02;
  message.stiffness = {1, 2, 0, 2, 5, 0, 0, 0, 3,  //
                       0, 0, 0, 0, 0, 0, 0, 0, 0};
  return message;
}

TEST(PointLoadMessages, KeepEveryNumberInItsPlace) {
  const std::vector<cloth::PointLoad> loads = pointLoads(twoForces(), kTriangles);
  ASSERT_EQ(loads.size(), 2u);
  EXPECT_EQ(loads[0].triangle, 3);
  EXPECT_EQ(loads[0].weights, Eigen::Vector3d(0.2, 0.3, 0.5));
  EXPECT_EQ(loads[0].force, Eigen::Vector3d(0.01, 0.0, 0.0));
  Eigen::Matrix3d stiffness;
  stiffness << 1, 2, 0, 2, 5, 0, 0, 0, 3;
  EXPECT_EQ(loads[0].stiffness, stiffness);
  EXPECT_EQ(loads[1].triangle, 31);
  EXPECT_EQ(loads[1].position, Eigen::Vector3d(0.0, 0.25, 0.0));
  EXPECT_EQ(loads[1].force, Eigen::Vector3d(0.0, 0.0, -0.02));
  haptex::ContactForces nothing;
  nothing.header.frame_id = "world";
  EXPECT_TRUE(pointLoads(nothing, kTriangles).empty());
}

TEST(PointLoadMessages, AreRefusedForWhatIsWrongWithThem) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  using Message = haptex::ContactForces;
  const auto expect_refused = [](const std::function<void(Message&)>& spoil,
                                 const std::string& expected) {
    Message message = twoForces();
    spoil(message);
    try {
      pointLoads(message, kTriangles);
      FAIL() << "accepted, instead of: " << expected;
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find(expected), std::string::npos) << error.what();
    }
  };
  expect_refused([](Message& m) { m.header.frame_id = "map"; }, "header.frame_id = 'map'");
  expect_refused([](Message& m) { m.barycentric.pop_back(); }, "barycentric has 5 elements");
  expect_refused([](Message& m) { m.positions.clear(); }, "positions has 0 elements");
  expect_refused([](Message& m) { m.forces.resize(3); }, "forces has 3 elements");
  expect_refused([](Message& m) { m.stiffness.resize(9); }, "stiffness has 9 elements");
  expect_refused([](Message& m) { m.triangles.pop_back(); }, "barycentric has 6 elements");
  expect_refused([](Message& m) { m.triangles.resize(4097); }, "4097 elements: allowed are 4096");
  expect_refused([](Message& m) { m.triangles[1] = 32; }, "triangles[1] = 32 does not exist");
  expect_refused([](Message& m) { m.triangles[1] = 4294967295u; }, "4294967295 does not exist");
  expect_refused([=](Message& m) { m.forces[1].y = nan; }, "point load 1");
  expect_refused([=](Message& m) { m.positions[0].y = nan; }, "point load 0");
  expect_refused([=](Message& m) { m.stiffness[17] = nan; }, "not finite");
  expect_refused([=](Message& m) { m.barycentric[0] = nan; }, "not finite");
  expect_refused([](Message& m) { m.barycentric[0] = 0.3; }, "the weights sum to 1.1");
  expect_refused([](Message& m) { m.stiffness[1] = 2.5; }, "differs from its transpose");
  expect_refused([](Message& m) { m.stiffness[0] = -1.0; }, "positive semidefinite");
  expect_refused(
      [](Message& m) { m.forces[1].y = -1e308; },
      "force of point 1 = (      0 -1e+308   -0.02): allowed are numbers of a norm up to 1000");
  expect_refused([](Message& m) { m.forces[0].y = 1001.0; }, "up to 1000 N");
  expect_refused([](Message& m) { m.stiffness[0] = 1e308; }, "stiffness of point 0");
  expect_refused([](Message& m) { m.stiffness[0] = -1e6; }, "up to 100000 N/m");
  expect_refused([](Message& m) { m.positions[1].x = 1e300; }, "position of point 1");
  expect_refused([](Message& m) { m.barycentric = {1e9, -1e9, 1.0, 1.0, 0.0, 0.0}; },
                 "weights of point 0");
}

TEST(PointLoadMessages, WhatIsAcceptedTheClothAccepts) {
  simulation::SimulatedCloth simulation = simulation::smallSimulation();
  simulation::SimulatedCloth untouched = simulation::smallSimulation();
  simulation.setPointLoads(pointLoads(twoForces(), simulation.cloth().mesh().triangles.size()));
  ASSERT_TRUE(simulation.step());
  ASSERT_TRUE(untouched.step());
  EXPECT_NE(simulation.state().positions, untouched.state().positions);
  simulation.reset();
  EXPECT_TRUE(simulation.cloth().forces().find<cloth::PointLoads>()->loads().empty());
}

TEST(StateMessage, NamesTheAttachedParticles) {
  simulation::SimulatedCloth simulation = simulation::smallSimulation();
  simulation.release({simulation::kSmallTop + 1});
  simulation.attach({2});
  std::vector<Eigen::Vector3d> forces;
  simulation.cloth().computeForces(simulation.state(), forces);
  haptex::ClothState message;
  for (int i = 0; i < 2; ++i) fillStateMessage(simulation, ros::Time(1.0), forces, message);
  EXPECT_EQ(message.attached, (std::vector<std::uint32_t>{2, 20, 22, 23, 24}));
}

}  // namespace
}  // namespace haptex::nodes::test_point_load_messages
