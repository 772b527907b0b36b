// A cloth that collides with itself among obstacles: forces, and that nothing passes through.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "fixtures.h"
#include "haptex/base/workload.h"
#include "haptex/cloth/dynamics/integrator.h"
#include "haptex/proximity/intersections.h"
#include "haptex/proximity/rigid_obstacle.h"
#include "self_contact_fixtures.h"

namespace haptex::cloth::test_cloth_among_obstacles {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using mesh::Obstacle;

/// Around the origin of their frames, with tops at z = 0.
std::vector<Obstacle> shapes() {
  const double diagonal = 0.04 / std::sqrt(2.0);
  const Isometry3d on_edge =
      placedAt({0.0, 0.0, -diagonal}) * Eigen::AngleAxisd(M_PI / 4.0, Vector3d::UnitY());
  const Isometry3d along_y =
      placedAt({0.0, 0.0, -0.01}) * Eigen::AngleAxisd(M_PI / 2.0, Vector3d::UnitX());
  const mesh::ObstacleMesh tip{
      {{0.02, 0.0, -0.03}, {-0.01, 0.02, -0.03}, {-0.01, -0.02, -0.03}, {0.0, 0.0, 0.0}},
      {{0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
  return {{"floor", mesh::ObstacleBox{{0.5, 0.5, 0.02}}, placedAt({0.0, 0.0, -0.01})},
          {"edge", mesh::ObstacleBox{{0.04, 0.5, 0.04}}, on_edge},
          {"sphere", mesh::ObstacleSphere{0.03}, placedAt({0.0, 0.0, -0.03})},
          {"pole", mesh::ObstacleCapsule{0.01, 0.3}, along_y},
          {"needle", mesh::ObstacleCapsule{5e-4, 0.05}, placedAt({0.002, 0.001, -0.0255})},
          {"tip", tip, Isometry3d::Identity()}};
}

/// A sheet of 40 mm in the plane z = 0, around the origin.
mesh::ClothMesh sheet(int cells, double height = 0.0) {
  mesh::ClothMesh mesh = layers(1, 0.04, cells);
  for (Vector3d& place : mesh.initial_positions) place += Vector3d(-0.02, -0.02, height);
  return mesh;
}

ModelledEffects effects(double gravity = 0.0) {
  ModelledEffects all = selfCollision();
  all.gravity = {0.0, 0.0, -gravity};
  all.viscosity = true;
  return all;
}

/// Triangles of the cloth that an obstacle touches.
int touched(const Cloth& cloth, const ClothState& state, const Obstacle& obstacle) {
  const auto solid = [&]() -> proximity::RigidObstacle {
    if (const auto* ball = std::get_if<mesh::ObstacleSphere>(&obstacle.shape)) {
      return proximity::RigidObstacle::sphere(ball->radius);
    }
    if (const auto* box = std::get_if<mesh::ObstacleBox>(&obstacle.shape)) {
      return proximity::RigidObstacle::box(box->sides);
    }
    if (const auto* rod = std::get_if<mesh::ObstacleCapsule>(&obstacle.shape)) {
      return proximity::RigidObstacle::capsule(rod->radius, rod->length);
    }
    const auto& surface = std::get<mesh::ObstacleMesh>(obstacle.shape);
    return proximity::RigidObstacle::mesh(surface.vertices, surface.triangles);
  };
  proximity::RigidObstacle body = solid();
  body.setPose(obstacle.poseAt(state.time));
  int count = 0;
  for (const auto& [a, b, c] : cloth.mesh().triangles) {
    const auto& places = state.positions;
    count += body.closestPoint({places[a], places[b], places[c]}).distance <= 0.0;
  }
  return count;
}

StepReport step(Cloth& cloth, Integrator& integrator, ClothState& state, double h) {
  cloth.moveObstacles(state.time, state.time + h);
  return integrator.step(cloth, state, h);
}

TEST(AmongObstacles, TheFloorHasThePressureOfALayerThatMirrorsTheCloth) {
  Cloth cloth(sheet(4), fabricNamed("wool"), effects());
  cloth.setObstacles({shapes()[0]});
  const LayerLaw& law = cloth.selfContact()->layers().law(0);
  ClothState state = cloth.initialState();
  for (const double share : {0.4, 0.7, 0.9}) {
    const double gap = 0.5 * share * law.thickness();
    for (Vector3d& place : state.positions) place.z() = gap;
    const std::vector<Vector3d> forces = contactForces(cloth, state);
    Vector3d sum = Vector3d::Zero();
    for (const Vector3d& force : forces) sum += force;
    const double expected = law.at(2.0 * gap).pressure * 0.04 * 0.04;
    // Below the least distance the guard acts where the cloth's edges lie over that between the two
    // triangles of the floor.
    const double tolerance = 2.0 * gap < law.leastDistance() ? 0.3 : 1e-9;
    EXPECT_NEAR(sum.z(), expected, tolerance * expected) << share;
    EXPECT_LT((sum + cloth.selfContact()->forceOn(0, state.ofForces())).norm(), 1e-12 * expected);
  }
}

TEST(AmongObstacles, ForcesAreTheGradientOfTheEnergyOnEveryShape) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  for (const Obstacle& obstacle : shapes()) {
    Cloth cloth(sheet(5), fabricNamed("wool"), effects());
    cloth.setObstacles({obstacle});
    ClothState state = cloth.initialState();
    const double thickness = cloth.selfContact()->layers().law(0).thickness();
    for (Vector3d& place : state.positions) {
      place +=
          Vector3d(1e-3 * any(random), 1e-3 * any(random), thickness * (0.17 + 0.05 * any(random)));
    }
    SCOPED_TRACE(obstacle.name);
    expectContactGradient(cloth, state, 2e-4);
  }
}

TEST(AmongObstacles, FrictionIsThatOfTheSurfacesVelocityAndOfItsOwnCoefficient) {
  Obstacle ball = shapes()[2];
  ball.friction = 0.5;
  ball.motion = mesh::ObstacleOrbit{{0.0, 0.0, -0.03}, Vector3d::UnitX(), 0.5};
  Cloth cloth(sheet(1), fabricNamed("wool"), effects());
  cloth.setObstacles({ball});
  ClothState state = cloth.initialState();
  for (Vector3d& place : state.positions) place += Vector3d(0.02, 0.02, 5.0);
  state.positions[0] = Vector3d(0.0, 0.0, 0.35 * cloth.selfContact()->layers().law(0).thickness());
  cloth.moveObstacles(0.0, 1e-3);
  state.time = 1e-3;
  const Vector3d force = -cloth.selfContact()->forceOn(0, state.ofForces());
  EXPECT_GT(force.z(), 0.0);
  EXPECT_NEAR(force.y(), -0.5 * force.z(), 1e-2 * force.z());  // its top goes to -y
  const double way = -2.0 * M_PI / 0.5 * 0.03 * 1e-3;
  EXPECT_NEAR(cloth.selfContact()->obstacleWork(state.ofForces()), force.y() * way,
              2e-2 * force.y() * way);
}

TEST(AmongObstacles, WhatIsThrownOnAnyShapeStaysOutsideAndGainsNoEnergy) {
  for (const Obstacle& obstacle : shapes()) {
    for (const int iterations : {1, 6}) {
      Cloth cloth(sheet(4, 0.004), fabricNamed("wool"), effects(9.81));
      cloth.setObstacles({obstacle});
      StepSettings settings;
      settings.newton_iterations = iterations;
      Integrator integrator(cloth, settings);
      ClothState state = cloth.initialState();
      for (Vector3d& velocity : state.velocities) velocity = Vector3d(0.2, 0.1, -2.0);
      double energy = cloth.potentialEnergy(state) + cloth.kineticEnergy(state);
      const double first = energy;
      bool has_touched = false;
      for (int i = 0; i < 24; ++i) {
        ASSERT_TRUE(step(cloth, integrator, state, 0.0125).accepted);
        ASSERT_EQ(touched(cloth, state, obstacle), 0) << obstacle.name << ' ' << i;
        ASSERT_EQ(proximity::countIntersections(state.positions, cloth.mesh().triangles), 0u);
        energy = cloth.potentialEnergy(state) + cloth.kineticEnergy(state);
        EXPECT_LE(energy, first + 1e-9 * std::abs(first)) << obstacle.name << ' ' << i;
        has_touched = has_touched || !cloth.selfContact()->touching(state.positions).empty();
      }
      EXPECT_TRUE(has_touched) << obstacle.name;
    }
  }
}

TEST(AmongObstacles, WhatMovesPushesTheClothAheadHoweverFast) {
  for (Obstacle obstacle : shapes()) {
    const Vector3d start = obstacle.pose.translation();
    for (const double speed : {base::unlessSanitized(0.3, 2.0), 10.0}) {
      Cloth cloth(sheet(4, 0.01), fabricNamed("wool"), effects());
      obstacle.motion = mesh::ObstacleDrift{{0.0, 0.0, speed}};
      cloth.setObstacles({obstacle});
      StepSettings settings;
      settings.newton_iterations = 5;
      Integrator integrator(cloth, settings);
      ClothState state = cloth.initialState();
      const int steps = 2 + static_cast<int>(0.1 / speed / 0.0125);
      for (int i = 0; i < steps; ++i) {
        const StepReport report = step(cloth, integrator, state, 0.0125);
        ASSERT_TRUE(report.accepted);
        EXPECT_EQ(report.obstacle_cut.particles, 0) << obstacle.name;
        ASSERT_EQ(touched(cloth, state, obstacle), 0) << obstacle.name << ' ' << i;
        ASSERT_EQ(proximity::countIntersections(state.positions, cloth.mesh().triangles), 0u);
      }
      double highest = 0.0;
      for (const Vector3d& place : state.positions) highest = std::max(highest, place.z());
      const double top = state.time * speed;
      EXPECT_GT(highest, top) << obstacle.name << ' ' << speed << ' ' << start.transpose();
    }
  }
}

TEST(AmongObstacles, TwoThatCloseOnTheClothStopAndTheReportSaysBetweenWhat) {
  Obstacle lower = shapes()[0], upper = lower;
  upper.name = "ceiling";
  upper.pose.translation().z() = 0.03;
  upper.motion = mesh::ObstacleDrift{{0.0, 0.0, -0.5}};
  Cloth cloth(sheet(3, 0.01), fabricNamed("wool"), effects(9.81));
  cloth.setObstacles({lower, upper});
  StepSettings settings;
  settings.newton_iterations = 5;
  Integrator integrator(cloth, settings);
  ClothState state = cloth.initialState();
  StepReport report;
  for (int i = 0; i < 6; ++i) {
    report = step(cloth, integrator, state, 0.0125);
    ASSERT_TRUE(report.accepted);
    EXPECT_EQ(touched(cloth, state, lower), 0);
    for (const Vector3d& place : state.positions) EXPECT_GT(place.z(), 0.0);
  }
  EXPECT_GT(report.obstacle_cut.particles, 0);
  EXPECT_GT(report.obstacle_cut.longest, 0.001);
  EXPECT_GE(report.obstacle_cut.between[0], 0);
  EXPECT_GE(report.obstacle_cut.obstacle, 0);
}

TEST(AmongObstacles, TheSameForAnyNumberOfThreads) {
  ClothState states[2];
  for (int threads : {1, 3}) {
    Cloth cloth(sheet(6, 0.003), fabricNamed("wool"), effects(9.81));
    Obstacle ball = shapes()[2];
    ball.motion = mesh::ObstacleOrbit{{0.05, 0.0, -0.03}, Vector3d::UnitZ(), 2.0};
    cloth.setObstacles({ball, shapes()[1]});
    StepSettings settings;
    settings.newton_iterations = 4;
    settings.threads = threads;
    Integrator integrator(cloth, settings);
    ClothState& state = states[threads == 3];
    state = cloth.initialState();
    for (int i = 0; i < 12; ++i) step(cloth, integrator, state, 0.0125);
  }
  EXPECT_EQ(states[0].positions, states[1].positions);
}

TEST(AmongObstacles, ObstaclesStayWithTheClothThroughAChangeOfFabric) {
  Cloth cloth(sheet(3, 0.0005), fabricNamed("wool"), effects());
  cloth.setObstacles({shapes()[0]});
  cloth.setFabric(fabricNamed("cotton_knit"));
  ASSERT_NE(cloth.selfContact()->obstacles(), nullptr);
  EXPECT_EQ(cloth.selfContact()->obstacles()->surfaces().count(), 1);
}

TEST(AmongObstacles, OnlyAClothThatCollidesWithItselfTakesThem) {
  Cloth cloth(sheet(2), fabricNamed("wool"), {});
  EXPECT_THROW(cloth.setObstacles(shapes()), std::invalid_argument);
}

/// All pairs by asking all.
std::size_t pairsByBruteForce(const Cloth& cloth, const ClothState& state,
                              const ObstacleSurfaces& surfaces, double distance) {
  const proximity::MeshElements of_cloth(cloth.mesh().triangles);
  const proximity::MeshElements& others = surfaces.elements();
  const auto& p = state.positions;
  const auto& q = surfaces.atEnd();
  std::size_t count = 0;
  const auto radius = [&](int vertex) { return surfaces.radius(surfaces.obstacleOf(vertex)); };
  for (const auto& [a, b, c] : others.triangles) {
    for (int v : of_cloth.vertices) {
      count += proximity::vertexTriangleDistance({p[v], q[a], q[b], q[c]}).distance - radius(a) <=
               distance;
    }
  }
  for (const auto& [a, b, c] : of_cloth.triangles) {
    for (int v : others.vertices) {
      count += proximity::vertexTriangleDistance({q[v], p[a], p[b], p[c]}).distance - radius(v) <=
               distance;
    }
  }
  for (const auto& [a, b] : of_cloth.edges) {
    for (const auto& [c, d] : others.edges) {
      count +=
          proximity::edgeEdgeDistance({p[a], p[b], q[c], q[d]}).distance - radius(c) <= distance;
    }
  }
  return count;
}

TEST(NearObstacles, FindsThePairsOfAskingAll) {
  std::mt19937 random(8);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  Cloth cloth(sheet(6), fabricNamed("wool"), effects());
  cloth.setObstacles(shapes());
  ClothState state = cloth.initialState();
  NearObstacles& near = *cloth.selfContact()->obstacles();
  for (int round = 0; round < 20; ++round) {
    for (Vector3d& place : state.positions) {
      place += 5e-3 * Vector3d(any(random), any(random), any(random));
    }
    near.find(state.positions, near.surfaces().atEnd(), 0.9 * near.searched());
    EXPECT_EQ(near.pairs().size(),
              pairsByBruteForce(cloth, state, near.surfaces(), near.searched()));
  }
}

TEST(NearObstacles, FindsTheSamePairsInTheSameOrderOnSeveralThreads) {
  std::mt19937 random(8);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  Cloth one(sheet(20), fabricNamed("wool"), effects()),
      three(sheet(20), fabricNamed("wool"), effects());
  one.setObstacles(shapes());
  three.setObstacles(shapes());
  ClothState state = one.initialState();
  linear::ThreadPool pool(3);
  for (int round = 0; round < 20; ++round) {
    std::vector<Vector3d> ways = state.positions;
    for (Vector3d& way : ways) way = 2e-3 * Vector3d(any(random), any(random), any(random));
    const auto found = [&](Cloth& cloth, linear::ThreadPool* threads) {
      NearObstacles& near = *cloth.selfContact()->obstacles();
      const auto& places = near.surfaces().atEnd();
      near.find(state.positions, places, 0.9 * near.searched(), threads);
      std::vector<NearObstacles::Pair> pairs = near.pairs();
      const auto& on_ways = near.onWays(state.positions, Vector3d(0.0, 0.0, -2e-3), ways, places,
                                        nullptr, 1e-3, threads);
      pairs.insert(pairs.end(), on_ways.begin(), on_ways.end());
      return pairs;
    };
    const auto alone = found(one, nullptr), shared = found(three, &pool);
    ASSERT_EQ(alone.size(), shared.size());
    EXPECT_GT(alone.size(), 0u);
    for (std::size_t i = 0; i < alone.size(); ++i) {
      EXPECT_EQ(alone[i].vertices, shared[i].vertices);
      EXPECT_EQ(alone[i].distance, shared[i].distance);
    }
    for (std::size_t i = 0; i < ways.size(); ++i) state.positions[i] += ways[i];
  }
}

}  // namespace
}  // namespace haptex::cloth::test_cloth_among_obstacles
