#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <string>

#include "cloth_proximity_fixtures.h"
#include "haptex/nodes/common/transforms.h"

namespace haptex::nodes::test_cloth_proximity {
namespace {

TEST_F(ClothProximityTest, AnswersWhatBruteForceFindsForEveryShape) {
  setCloth();
  const Eigen::Vector3d a(0.02, -0.03, -0.05), b(-0.01, 0.04, -0.12);
  const std::vector<std::pair<Request, proximity::Cursor>> queries = {
      {testRequest(Request::POINT, {a}, {}, 0.03), proximity::Cursor::point(a)},
      {testRequest(Request::SPHERES, {a, b}, {0.01, 0.004}, 0.02),
       proximity::Cursor::spheres({{a, 0.01}, {b, 0.004}})},
      {testRequest(Request::CAPSULE, {a, b}, {0.006}, 0.01),
       proximity::Cursor::capsule(a, b, 0.006)},
      {testRequest(Request::TAPERED_CAPSULE, {a, b}, {0.012, 0.002}, 0.01),
       proximity::Cursor::taperedCapsule({a, 0.012}, {b, 0.002})}};
  for (auto [request, cursor] : queries) {
    for (const std::uint32_t nearest : {0u, 1u, 3u}) {
      request.nearest = nearest;
      proximity::Range range{request.distance};
      if (nearest > 0) range.count = nearest;
      const auto elements =
          proximity::nearElementsByBruteForce(mesh_.triangles, positions_, cursor, range);
      EXPECT_FALSE(elements.empty());
      expectElements(ask(request), elements);
    }
  }
}

TEST_F(ClothProximityTest, AnswersInTheWorldFrameOnTheStampOfTheState) {
  setCloth();
  const Eigen::Isometry3d world_from_frame =
      Eigen::Translation3d(0.1, -0.2, 0.3) *
      Eigen::AngleAxisd(0.7, Eigen::Vector3d(1.0, 2.0, -1.0).normalized());
  const Eigen::Vector3d place(0.02, 0.0, -0.1);
  Request request = sphere();
  request.header.frame_id = "finger";
  request.points = {pointMessage(world_from_frame.inverse() * place)};
  const Response response = proximity_.answer(
      request, [&] { return world_from_frame; }, kNow);
  EXPECT_EQ(response.header.frame_id, "world");
  EXPECT_EQ(response.header.stamp, ros::Time(1007));
  EXPECT_EQ(response.step, 7u);
  const Response in_world = ask(sphere());
  ASSERT_EQ(response.elements.size(), in_world.elements.size());
  for (std::size_t i = 0; i < response.elements.size(); ++i) {
    EXPECT_EQ(response.elements[i].triangle, in_world.elements[i].triangle);
    // There and back through the transform: some roundings of coordinates below 1 m.
    EXPECT_NEAR(response.elements[i].distance, in_world.elements[i].distance, 1e-15);
  }
}

TEST_F(ClothProximityTest, NothingInRangeIsAnAnswerWithInfiniteDistance) {
  setCloth();
  const Response response = ask(testRequest(Request::SPHERES, {{1.0, 0.0, 0.0}}, {0.005}, 0.012));
  EXPECT_TRUE(response.success);
  EXPECT_EQ(response.message, "no element within 0.012 m");
  EXPECT_EQ(response.distance, kInfinity);
  EXPECT_TRUE(response.elements.empty());
  EXPECT_EQ(response.header.stamp, ros::Time(1007));
}

TEST_F(ClothProximityTest, TellsWhatIsNearAnObstacle) {
  setCloth();
  Request request = testRequest(Request::OBSTACLE, {}, {}, 0.05);
  request.obstacle = "ball";
  request.header.frame_id = "";
  const Response response = ask(request);
  ASSERT_TRUE(response.success) << response.message;
  const auto solid = proximity::nearElementsByBruteForce(
      mesh_.triangles, positions_,
      proximity::Cursor::spheres({{Eigen::Vector3d(0.06, 0.01, -0.1), 0.02}}), {0.05});
  ASSERT_FALSE(solid.empty());
  ASSERT_EQ(response.elements.size(), solid.size());
  for (const proximity::NearElement& element : solid) {
    const auto found =
        std::find_if(response.elements.begin(), response.elements.end(), [&](const auto& message) {
          return message.triangle == static_cast<std::uint32_t>(element.triangle);
        });
    ASSERT_NE(found, response.elements.end());
    // 1e-9 m is what RigidObstacle promises; what enters an obstacle is 0 away from it.
    EXPECT_NEAR(found->distance, std::max(0.0, element.distance), 1e-9);
  }
}

TEST_F(ClothProximityTest, AnswersBesideTrianglesWithoutArea) {
  mesh_.triangles.push_back({0, 0, 0});
  mesh_.triangles.push_back({10, 11, 11});
  mesh_.triangles.push_back({20, 21, 22});  // in one line
  setCloth();
  const proximity::Cursor everything = proximity::Cursor::point({0.02, 0.0, -0.1});
  expectElements(
      ask(testRequest(Request::POINT, {{0.02, 0.0, -0.1}}, {}, 1.0)),
      proximity::nearElementsByBruteForce(mesh_.triangles, positions_, everything, {1.0}));
}

TEST_F(ClothProximityTest, RefusesShapesThatThereAreNot) {
  setCloth();
  Request request = sphere();
  request.shape = 5;
  expectRefused(request, "shape = 5: allowed are POINT = 0");
}

TEST_F(ClothProximityTest, RefusesPointsAndRadiiThatDoNotGoWithTheShape) {
  setCloth();
  const Eigen::Vector3d a(0.0, 0.0, 0.0);
  const auto refuse = [&](std::uint8_t shape, std::size_t points, std::size_t radii,
                          const std::string& says) {
    expectRefused(testRequest(shape, std::vector<Eigen::Vector3d>(points, a),
                              std::vector<double>(radii, 0.01), 0.01),
                  says);
  };
  refuse(Request::POINT, 0, 0, "points has 0 elements: shape POINT takes 1");
  refuse(Request::POINT, 2, 0, "points has 2 elements: shape POINT takes 1");
  refuse(Request::POINT, 1, 1, "radii has 1 elements: shape POINT takes 0");
  refuse(Request::SPHERES, 0, 0, "points is empty: shape SPHERES takes one or more");
  refuse(Request::SPHERES, 2, 1, "radii has 1 elements: shape SPHERES takes one for each of the 2");
  refuse(Request::CAPSULE, 1, 1, "points has 1 elements: shape CAPSULE takes 2");
  refuse(Request::CAPSULE, 2, 2, "radii has 2 elements: shape CAPSULE takes 1");
  refuse(Request::TAPERED_CAPSULE, 3, 2, "points has 3 elements: shape TAPERED_CAPSULE takes 2");
  refuse(Request::TAPERED_CAPSULE, 2, 1, "radii has 1 elements: shape TAPERED_CAPSULE takes 2");
  refuse(Request::OBSTACLE, 1, 0, "points has 1 elements: shape OBSTACLE takes 0");
  refuse(Request::OBSTACLE, 0, 1, "radii has 1 elements: shape OBSTACLE takes 0");
}

TEST_F(ClothProximityTest, RefusesNumbersThatAreNotFiniteOrTooLarge) {
  setCloth();
  for (const double number : {kNaN, kInfinity, -kInfinity, 1e10}) {
    for (int axis = 0; axis < 3; ++axis) {
      Eigen::Vector3d place = Eigen::Vector3d::Zero();
      place[axis] = number;
      expectRefused(testRequest(Request::SPHERES, {{0, 0, 0}, place}, {0.01, 0.01}, 0.01),
                    "points[1] = (");
    }
    expectRefused(testRequest(Request::SPHERES, {{0, 0, 0}}, {number}, 0.01), "radii[0] = ");
    expectRefused(testRequest(Request::SPHERES, {{0, 0, 0}}, {0.01}, number), "distance = ");
  }
}

TEST_F(ClothProximityTest, RefusesNegativeRadiiAndDistances) {
  setCloth();
  const Eigen::Vector3d a(0.0, 0.0, 0.0);
  expectRefused(testRequest(Request::TAPERED_CAPSULE, {a, a}, {0.01, -0.01}, 0.01),
                "radii[1] = -0.01: allowed are finite numbers from 0");
  expectRefused(testRequest(Request::POINT, {a}, {}, -1e-9), "distance = -1e-09");
}

TEST_F(ClothProximityTest, RefusesPlacesThatItsFrameTakesTooFar) {
  setCloth();
  const Response response = proximity_.answer(
      sphere(), [] { return Eigen::Isometry3d(Eigen::Translation3d(2e9, 0.0, 0.0)); }, kNow);
  EXPECT_FALSE(response.success);
  EXPECT_NE(response.message.find("e+09"), std::string::npos) << response.message;
}

TEST_F(ClothProximityTest, FindsAnObstacleWithMassWhereTheStateHasIt) {
  mesh::Obstacle table{"table", mesh::ObstacleBox{{0.1, 0.1, 0.1}}, Eigen::Isometry3d::Identity()};
  mesh::Obstacle ball{"ball", mesh::ObstacleSphere{0.02}, Eigen::Isometry3d::Identity()};
  ball.body = mesh::ObstacleBody{0.1};
  ClothProximity proximity(kStaleAfter, ballAndTable(), {table, ball});
  Request request = testRequest(Request::OBSTACLE, {}, {}, 0.05);
  request.obstacle = "ball";
  request.header.frame_id = "";
  proximity.setMesh(testMeshMessage(mesh_));
  const auto state = boost::make_shared<haptex::ClothState>(*testState(7, positions_));
  proximity.setState(state, kArrival);
  EXPECT_NE(proximity.answer(request, worldFrame, kNow)
                .message.find("cloth/state has 0 of the 1 bodies of the scene"),
            std::string::npos);
  const auto with_body = boost::make_shared<haptex::ClothState>(*state);
  const Eigen::Vector3d place(0.03, 0.02, -0.05);
  with_body->bodies = {poseMessage(Eigen::Isometry3d(Eigen::Translation3d(place)))};
  proximity.setState(with_body, kArrival);
  const auto near = proximity::nearElementsByBruteForce(
      mesh_.triangles, positions_, proximity::Cursor::spheres({{place, 0.02}}), {0.05});
  const Response response = proximity.answer(request, worldFrame, kNow);
  ASSERT_TRUE(response.success) << response.message;
  EXPECT_EQ(response.elements.size(), near.size());
  EXPECT_FALSE(near.empty());
  with_body->bodies[0].orientation.w = 3.0;
  EXPECT_FALSE(proximity.answer(request, worldFrame, kNow).success);
}

TEST_F(ClothProximityTest, RefusesUnknownObstaclesAndNamesThoseThatThereAre) {
  setCloth();
  Request request = testRequest(Request::OBSTACLE, {}, {}, 0.01);
  request.obstacle = "chair";
  expectRefused(request, "obstacle = 'chair': those of the scene are ball table");
  request.obstacle = "";
  expectRefused(request, "obstacle = ''");
  Request contradiction = sphere();
  contradiction.obstacle = "ball";
  expectRefused(contradiction, "obstacle = 'ball' with shape SPHERES");

  ClothProximity none(kStaleAfter, {});
  request.obstacle = "ball";
  EXPECT_NE(none.answer(request, worldFrame, kNow).message.find("~scene"), std::string::npos);
}

TEST_F(ClothProximityTest, RefusesWhatTheFrameLookupThrows) {
  setCloth();
  const auto unknown = []() -> Eigen::Isometry3d { throw std::invalid_argument("no such frame"); };
  EXPECT_EQ(proximity_.answer(sphere(), unknown, kNow).message, "no such frame");
  Request obstacle = testRequest(Request::OBSTACLE, {}, {}, 0.01);
  obstacle.obstacle = "ball";
  EXPECT_EQ(proximity_.answer(obstacle, unknown, kNow).message, "no such frame");
  obstacle.header.frame_id = "";  // then it is not looked up
  EXPECT_TRUE(proximity_.answer(obstacle, unknown, kNow).success);
}

TEST_F(ClothProximityTest, SceneHasTheTrianglesAndTheVolumesAskedFor) {
  EXPECT_FALSE(proximity_.scene({{}, 0, {}}));
  setCloth();
  const auto scene = proximity_.scene({{0, 5, 100000}, 2, {}});
  ASSERT_TRUE(scene);
  EXPECT_EQ(scene->stamp, ros::Time(1007));
  ASSERT_EQ(scene->triangles.size(), 2u);  // without the one that does not exist
  EXPECT_EQ(scene->triangles[1][0], positions_[mesh_.triangles[5][0]]);
  ASSERT_EQ(scene->volumes.size(), 1u);
  EXPECT_EQ(scene->volumes[0].name, "volumes");
  EXPECT_EQ(scene->volumes[0].volumes.size(), 4u);
  EXPECT_TRUE(proximity_.scene({{}, SceneRequest::kNoLevel, {}})->volumes.empty());
  // 128 triangles, 8 to a leaf.
  EXPECT_EQ(proximity_.scene({{}, 16, {}})->volumes[0].volumes.size(), 16u);
  const auto all = proximity_.scene({{}, SceneRequest::kAllLevels, {}})->volumes;
  ASSERT_EQ(all.size(), 5u);
  for (std::size_t level = 0; level < all.size(); ++level) {
    EXPECT_EQ(all[level].name, "volumes/" + std::to_string(level));
    EXPECT_EQ(all[level].volumes.size(), std::size_t{1} << level);
    EXPECT_EQ(all[level].colours.size(), all[level].volumes.size());
  }
}

TEST_F(ClothProximityTest, SceneHasTheVolumesThatAQueryTests) {
  setCloth();
  const auto tested = [&](const Request& request) {
    const auto groups =
        proximity_.scene({{}, SceneRequest::kNoLevel, AnsweredQuery{request}})->volumes;
    EXPECT_EQ(groups.size(), 1u);
    EXPECT_EQ(groups[0].name, "tested_volumes");
    return groups[0];
  };
  const VolumeGroup near = tested(sphere());
  EXPECT_GT(near.volumes.size(), 3u);
  EXPECT_LT(near.volumes.size(), 31u);
  EXPECT_EQ(near.colours.front(), 0) << "the level of the volume around all";
  EXPECT_EQ(*std::max_element(near.colours.begin(), near.colours.end()), 4);
  EXPECT_EQ(tested(testRequest(Request::POINT, {Eigen::Vector3d(9.0, 0.0, 0.0)}, {}, 0.01))
                .volumes.size(),
            1u);
  Request obstacle = testRequest(Request::OBSTACLE, {}, {}, 10.0);
  obstacle.obstacle = "ball";
  EXPECT_EQ(tested(obstacle).volumes.size(), 31u);
}

}  // namespace
}  // namespace haptex::nodes::test_cloth_proximity
