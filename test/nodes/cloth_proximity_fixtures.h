// A service with obstacles, and a cloth to give to it.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "haptex/nodes/proximity/cloth_proximity.h"
#include "proximity_fixtures.h"

namespace haptex::nodes {

using Clock = ClothProximity::Clock;
using Request = haptex::QueryProximity::Request;
using Response = haptex::QueryProximity::Response;

constexpr double kStaleAfter = 0.5;  // s
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline const Clock::time_point kArrival = Clock::time_point() + std::chrono::hours(1);
inline const Clock::time_point kNow = kArrival + std::chrono::milliseconds(10);

inline ClothProximity::Obstacles ballAndTable() {
  ClothProximity::Obstacles obstacles;
  auto ball = proximity::RigidObstacle::sphere(0.02);
  ball.setPose(Eigen::Isometry3d(Eigen::Translation3d(0.06, 0.01, -0.1)));
  obstacles.emplace("ball", ball);
  obstacles.emplace("table", proximity::RigidObstacle::box({0.1, 0.1, 0.1}));
  return obstacles;
}

class ClothProximityTest : public testing::Test {
 protected:
  ClothProximityTest() : mesh_(testMesh()), positions_(wavy(mesh_.initial_positions)) {}

  void setCloth() {
    proximity_.setMesh(testMeshMessage(mesh_));
    proximity_.setState(testState(7, positions_), kArrival);
  }

  Response ask(const Request& request) { return proximity_.answer(request, worldFrame, kNow); }

  void expectRefused(const Request& request, const std::string& says) {
    const std::uint64_t before = proximity_.status(kNow).refused;
    const Response response = ask(request);
    EXPECT_FALSE(response.success) << "accepted instead of refused: " << says;
    EXPECT_NE(response.message.find(says), std::string::npos) << response.message;
    EXPECT_EQ(response.distance, kInfinity);
    EXPECT_TRUE(response.elements.empty());
    EXPECT_EQ(proximity_.status(kNow).refused, before + 1);
    EXPECT_EQ(proximity_.status(kNow).refused_why, response.message);
  }

  void expectDropped(const std::function<void()>& send, const std::string& says) {
    const ProximityStatus before = proximity_.status(kNow);
    send();
    const ProximityStatus after = proximity_.status(kNow);
    EXPECT_EQ(after.dropped, before.dropped + 1) << "taken instead of dropped: " << says;
    EXPECT_NE(after.dropped_why.find(says), std::string::npos) << after.dropped_why;
    EXPECT_EQ(after.states, before.states);
    EXPECT_EQ(after.meshes, before.meshes);
    const Response response = ask(sphere());
    EXPECT_TRUE(response.success) << response.message;
    EXPECT_EQ(response.step, 7u);  // the last good state stays
  }

  static Request sphere() {
    return testRequest(Request::SPHERES, {{0.02, 0.0, -0.1}}, {0.005}, 0.03);
  }

  /// Not one bit of the answer may differ from the other way.
  void expectElements(const Response& response,
                      const std::vector<proximity::NearElement>& elements) {
    ASSERT_TRUE(response.success) << response.message;
    ASSERT_EQ(response.elements.size(), elements.size());
    for (std::size_t i = 0; i < elements.size(); ++i) {
      const haptex::NearElement& message = response.elements[i];
      const proximity::NearElement& element = elements[i];
      EXPECT_EQ(message.triangle, static_cast<std::uint32_t>(element.triangle));
      EXPECT_EQ(message.part, static_cast<std::uint32_t>(element.part));
      EXPECT_EQ(message.distance, element.distance);
      EXPECT_EQ(message.point, pointMessage(element.point));
      for (int j = 0; j < 3; ++j) EXPECT_EQ(message.barycentric[j], element.barycentric[j]);
      EXPECT_EQ(message.normal.x, element.normal.x());
      EXPECT_EQ(message.normal.y, element.normal.y());
      EXPECT_EQ(message.normal.z, element.normal.z());
    }
    EXPECT_EQ(response.distance, elements.empty() ? kInfinity : elements.front().distance);
  }

  mesh::ClothMesh mesh_;
  std::vector<Eigen::Vector3d> positions_;
  ClothProximity proximity_{kStaleAfter, ballAndTable()};
};

}  // namespace haptex::nodes
