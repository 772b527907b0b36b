#include <gtest/gtest.h>

#include <limits>
#include <numeric>

#include "../../refusal.h"
#include "fixtures.h"
#include "haptex/cloth/dynamics/cloth.h"

namespace haptex::cloth::test_cloth {
namespace {

using test::refusalOf;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

AttachmentPath pathAt(const Eigen::Vector3d& place) {
  AttachmentPath path;
  path.start = place;
  return path;
}

TEST(Cloth, MassesSumToDensityTimesArea) {
  const Cloth cloth(mesh::makeRectangle(0.3, 0.2, 7, 5, mesh::Triangulation::kOneWay),
                    linearFabric(), {});
  const double mass = std::accumulate(cloth.masses().begin(), cloth.masses().end(), 0.0);
  EXPECT_NEAR(mass, 0.1 * 0.3 * 0.2, 1e-15);
}

TEST(Cloth, RefusesWhatCannotBeSimulated) {
  mesh::ClothMesh bad = square(2);
  bad.triangles.push_back({0, 0, 1});
  EXPECT_EQ(refusalOf([&] { Cloth(bad, linearFabric(), {}); }), "degenerate triangles: 8");
  material::Fabric weightless = linearFabric();
  weightless.areal_density = 0.0;
  EXPECT_NE(refusalOf([&] { Cloth(square(2), weightless, {}); }).find("areal density"),
            std::string::npos);
  ModelledEffects effects;
  effects.gravity.z() = kNaN;
  EXPECT_NE(refusalOf([&] { Cloth(square(2), linearFabric(), effects); }).find("gravity"),
            std::string::npos);
}

TEST(Cloth, ARefusedFabricLeavesTheOldOne) {
  Cloth cloth(square(2), linearFabric(), {});
  material::Fabric bad = stiffeningFabric();
  bad.name = "bad";
  bad.areal_density = kNaN;
  const std::vector<double> masses = cloth.masses();
  const ClothState state = randomState(cloth, 0.003, 0.0);
  std::vector<Eigen::Vector3d> before, after;
  cloth.computeForces(state, before);
  EXPECT_THROW(cloth.setFabric(bad), std::invalid_argument);
  cloth.computeForces(state, after);
  EXPECT_EQ(cloth.fabric().name, "linear");
  EXPECT_EQ(cloth.masses(), masses);
  EXPECT_EQ(after, before);
}

TEST(Cloth, SetFabricChangesMassesAndCurvesOnly) {
  Cloth cloth(square(2), linearFabric(), {});
  material::Fabric heavy = linearFabric();
  heavy.areal_density = 0.3;
  heavy.weft.elastic = material::StrainStressCurve::linear(500.0);
  const double before = cloth.masses()[4];
  cloth.setFabric(heavy);
  EXPECT_NEAR(cloth.masses()[4], 3.0 * before, 1e-15);
  ClothState state = cloth.initialState();
  for (auto& position : state.positions) position.y() *= 1.1;
  // 500 N/m against 100 N/m, everything else being equal.
  EXPECT_NEAR(cloth.potentialEnergy(state), 0.5 * 500.0 * 0.105 * 0.105 * 0.01, 1e-12);
}

TEST(Cloth, ExternalForcesAndGravityEnterForcesAndEnergy) {
  ModelledEffects effects;
  effects.gravity = {0.0, 0.0, -10.0};
  Cloth cloth(square(2), linearFabric(), effects);
  cloth.setExternalForce(4, {1.0, 2.0, 3.0});
  const ClothState state = cloth.initialState();
  std::vector<Eigen::Vector3d> forces;
  cloth.computeForces(state, forces);
  const Eigen::Vector3d exact(1.0, 2.0, 3.0 - 10.0 * cloth.masses()[4]);
  EXPECT_LT((forces[4] - exact).norm(), 1e-12);
  ClothState moved = state;
  for (auto& position : moved.positions) position += Eigen::Vector3d(0.0, 0.0, 0.5);
  EXPECT_NEAR(cloth.potentialEnergy(moved) - cloth.potentialEnergy(state),
              0.5 * (0.1 * 0.01 * 10.0 - 3.0), 1e-12);
}

TEST(Cloth, RefusesLoadsAndAttachmentsByName) {
  Cloth cloth(square(2), linearFabric(), {});
  EXPECT_NE(refusalOf([&] {
              cloth.setExternalForce(9, {0, 0, 0});
            }).find("particles 0 to 8"),
            std::string::npos);
  EXPECT_NE(refusalOf([&] {
              cloth.setExternalForce(1, {0, kNaN, 0});
            }).find("not finite"),
            std::string::npos);
  EXPECT_NE(refusalOf([&] { cloth.attach(-1, {}); }).find("particle -1"), std::string::npos);
  EXPECT_NE(refusalOf([&] {
              cloth.attach(0, pathAt({kNaN, 0, 0}));
            }).find("finite"),
            std::string::npos);
  AttachmentPath backward;
  backward.duration = -1.0;
  EXPECT_NE(refusalOf([&] { cloth.attach(0, backward); }).find("at least 0"), std::string::npos);
  for (int what = 0; what < 3; ++what) {
    AttachmentPath path;
    (what == 0 ? path.displacement.y() : what == 1 ? path.start_time : path.duration) = kNaN;
    EXPECT_NE(refusalOf([&] { cloth.attach(0, path); }).find("finite"), std::string::npos) << what;
  }
  EXPECT_EQ(refusalOf([&] { cloth.release(3); }), "particle 3 is not attached");
  EXPECT_FALSE(cloth.isAttached(0));
}

TEST(AttachmentPath, StartsAndEndsAtRestAndIsThereInTime) {
  AttachmentPath path;
  path.start = {1.0, 0.0, 0.0};
  path.displacement = {0.0, 2.0, 0.0};
  path.start_time = 3.0;
  path.duration = 4.0;
  EXPECT_EQ(path.position(0.0), path.start);
  EXPECT_TRUE(path.position(5.0).isApprox(Eigen::Vector3d(1.0, 1.0, 0.0)));  // half way
  EXPECT_EQ(path.position(7.0), Eigen::Vector3d(1.0, 2.0, 0.0));
  const double h = 1e-4;  // the path leaves its ends with the third power of time
  EXPECT_LT((path.position(3.0 + h) - path.start).norm(), 1e-12);
  EXPECT_LT((path.position(7.0 - h) - path.position(7.0)).norm(), 1e-12);
  for (double time : {2.5, 3.1, 4.0, 5.0, 6.9, 7.5}) {  // a central difference of the position
    const Eigen::Vector3d difference =
        (path.position(time + h) - path.position(time - h)) / (2 * h);
    EXPECT_LT((path.velocity(time) - difference).norm(), 1e-7) << time;  // of h^2 times jerk
  }
  path.duration = 0.0;
  EXPECT_EQ(path.velocity(3.0), Eigen::Vector3d::Zero());
  EXPECT_EQ(path.position(2.9), path.start);
  EXPECT_EQ(path.position(3.0), Eigen::Vector3d(1.0, 2.0, 0.0));
}

TEST(Cloth, RefusesAStateOfAnotherSize) {
  const Cloth cloth(square(2), linearFabric(), {});
  ClothState state = cloth.initialState();
  state.velocities.pop_back();
  std::vector<Eigen::Vector3d> forces;
  const std::string message = refusalOf([&] { cloth.computeForces(state, forces); });
  EXPECT_NE(message.find("8 velocities; the cloth has 9 particles"), std::string::npos) << message;
  EXPECT_THROW(cloth.jacobian(state, {0}), std::invalid_argument);
  EXPECT_THROW(cloth.potentialEnergy(state), std::invalid_argument);
  EXPECT_THROW(cloth.kineticEnergy(state), std::invalid_argument);
  EXPECT_THROW(cloth.momentum(state), std::invalid_argument);
}

TEST(Cloth, MomentumIsThatOfAllParticles) {
  Cloth cloth(square(2, 0.1), linearFabric(), {});
  ClothState state = cloth.initialState();
  cloth.attach(0, {state.positions[0]});
  const Eigen::Vector3d velocity(1.0, -2.0, 3.0);
  for (Eigen::Vector3d& of_particle : state.velocities) of_particle = velocity;
  EXPECT_LT((cloth.momentum(state) - 0.1 * 0.1 * 0.1 * velocity).norm(), 1e-15);  // 0.1 kg/m2
}

TEST(Cloth, JacobianRowsAreSortedAndHoldEveryNeighbour) {
  const Cloth cloth(square(2), linearFabric(), {});
  const std::vector<JacobianBlock> blocks = cloth.jacobian(cloth.initialState(), {4, 0});
  // Diagonals of the four cells: 0-4, 2-4, 4-6 and 4-8, so the middle touches all others.
  std::vector<std::pair<int, int>> places;
  for (const JacobianBlock& block : blocks) places.emplace_back(block.row, block.column);
  const std::vector<std::pair<int, int>> exact = {{4, 0}, {4, 1}, {4, 2}, {4, 3}, {4, 4},
                                                  {4, 5}, {4, 6}, {4, 7}, {4, 8}, {0, 0},
                                                  {0, 1}, {0, 3}, {0, 4}};
  EXPECT_EQ(places, exact);
  EXPECT_THROW(cloth.jacobian(cloth.initialState(), {99}), std::invalid_argument);
}

}  // namespace
}  // namespace haptex::cloth::test_cloth
