// Also built with the thread sanitizer, see scripts/test.
#include <gtest/gtest.h>

#include <atomic>
#include <thread>
#include <vector>

#include "haptex/nodes/proximity/cloth_proximity.h"
#include "proximity_fixtures.h"

namespace haptex::nodes::test_proximity_threads {
namespace {

using Clock = ClothProximity::Clock;
using Request = haptex::QueryProximity::Request;

constexpr double kPerStep = 1e-3;  // m, along x
constexpr std::uint32_t kSteps = 300;
constexpr int kAskers = 3;

/// Every particle at the same x, which tells the step.
haptex::ClothStatePtr stateOf(const mesh::ClothMesh& mesh, std::uint32_t step) {
  return testState(step, translated(mesh.initial_positions, {step * kPerStep, 0.0, 0.0}));
}

/// Whether all of an answer to a point at (10 m, 0, -0.1 m) is of the state that it names.
bool isOfOneState(const haptex::QueryProximity::Response& response, std::size_t triangles) {
  const double x = static_cast<double>(response.step) * kPerStep;
  if (response.header.stamp != ros::Time(1000 + response.step)) return false;
  if (response.elements.size() != triangles) return false;
  for (const haptex::NearElement& element : response.elements) {
    // A sum of three corners with weights whose sum is 1 rounds.
    if (std::abs(element.point.x - x) > 1e-14) return false;
  }
  // The middle of the cloth is right opposite.
  return std::abs(response.distance - (10.0 - x)) < 1e-14 * 10.0;
}

ClothProximity::Obstacles ball() {
  ClothProximity::Obstacles obstacles;
  obstacles.emplace("ball", proximity::RigidObstacle::sphere(0.02));
  return obstacles;
}

/// Asks until told to stop, at least once. @returns whether every answer was good
bool keepAsking(ClothProximity& proximity, std::size_t triangles, const std::atomic<bool>& stop) {
  const Request point = testRequest(Request::POINT, {{10.0, 0.0, -0.1}}, {}, 20.0);
  Request obstacle = testRequest(Request::OBSTACLE, {}, {}, 20.0);
  obstacle.obstacle = "ball";
  std::uint64_t last_step = 0;
  bool good = true;
  do {
    const auto response = proximity.answer(point, worldFrame, Clock::now());
    good = good && response.success && isOfOneState(response, triangles) &&
           response.step >= last_step;  // never back in time
    last_step = response.step;
    const auto near = proximity.answer(obstacle, worldFrame, Clock::now());
    good = good && near.success && near.elements.size() == triangles;
  } while (!stop);
  return good;
}

TEST(ProximityThreads, EveryAnswerIsOfOneStateWhileStatesArrive) {
  const mesh::ClothMesh mesh = testMesh();
  const haptex::ClothMesh message = testMeshMessage(mesh);
  ClothProximity proximity(1e6, ball());
  proximity.setMesh(message);
  proximity.setState(stateOf(mesh, 0), Clock::now());
  std::atomic<bool> stop{false};
  std::atomic<int> good{0};
  std::vector<std::thread> threads;
  for (int i = 0; i < kAskers; ++i) {
    threads.emplace_back(
        [&] { good += keepAsking(proximity, mesh.triangles.size(), stop) ? 1 : 0; });
  }
  threads.emplace_back([&] {
    while (!stop) {
      proximity.setMesh(message);  // as after a change of the fabric
      proximity.scene({{0, 1, 2}, 3, {}});
      proximity.status(Clock::now());
    }
  });
  for (std::uint32_t step = 1; step <= kSteps; ++step) {
    proximity.setState(stateOf(mesh, step), Clock::now());
    const std::uint64_t answered = proximity.status(Clock::now()).answered;
    while (proximity.status(Clock::now()).answered == answered) std::this_thread::yield();
  }
  stop = true;
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(good, kAskers);
  EXPECT_EQ(proximity.status(Clock::now()).refused, 0u);
  EXPECT_EQ(proximity.status(Clock::now()).builds, 1u);
  EXPECT_EQ(
      proximity.answer(testRequest(Request::POINT, {{0, 0, 0}}, {}, 20.0), worldFrame, Clock::now())
          .step,
      kSteps);
}

TEST(ProximityThreads, SurvivesMeshesThatChangeDuringQueries) {
  const std::array<mesh::ClothMesh, 2> meshes = {testMesh(4), testMesh(6)};
  ClothProximity proximity(1e6, {});
  std::atomic<bool> stop{false};
  std::atomic<int> wrong{0};
  std::atomic<int> answered{0};
  std::vector<std::thread> threads;
  for (int i = 0; i < kAskers; ++i) {
    threads.emplace_back([&] {
      const Request point = testRequest(Request::POINT, {{10.0, 0.0, -0.1}}, {}, 20.0);
      while (!stop) {
        const auto response = proximity.answer(point, worldFrame, Clock::now());
        if (!response.success) continue;  // between two meshes there is no cloth
        ++answered;
        // States of even steps belong to the first mesh.
        if (!isOfOneState(response, meshes[response.step % 2].triangles.size())) ++wrong;
      }
    });
  }
  for (std::uint32_t step = 0; step < 100; ++step) {
    const mesh::ClothMesh& mesh = meshes[step % 2];
    proximity.setMesh(testMeshMessage(mesh));
    proximity.setState(stateOf(mesh, step), Clock::now());
    const int before = answered;
    while (answered == before) std::this_thread::yield();
  }
  stop = true;
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(wrong, 0);
}

}  // namespace
}  // namespace haptex::nodes::test_proximity_threads
