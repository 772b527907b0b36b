// Which meshes and states the proximity service takes, and what it answers from.
#include "cloth_proximity_fixtures.h"

namespace haptex::nodes::test_cloth_proximity_messages {
namespace {

TEST_F(ClothProximityTest, RefusesWhileThereIsNoCloth) {
  expectRefused(sphere(), "no good message on cloth/mesh");
  proximity_.setMesh(testMeshMessage(mesh_));
  expectRefused(sphere(), "no good message on cloth/state");
  proximity_.setState(testState(1, positions_), kArrival);
  EXPECT_TRUE(ask(sphere()).success);
}

TEST_F(ClothProximityTest, SaysWhyTheMeshWasRefused) {
  haptex::ClothMesh message = testMeshMessage(mesh_);
  message.triangles[4] = 81;
  proximity_.setMesh(message);
  expectRefused(sphere(), "cloth/mesh: triangles[4] = 81: there are 81 particles");
}

TEST_F(ClothProximityTest, TakesAStateThatCameBeforeItsMesh) {
  proximity_.setState(testState(3, positions_), kArrival);
  proximity_.setMesh(testMeshMessage(mesh_));
  EXPECT_EQ(ask(sphere()).step, 3u);
}

TEST_F(ClothProximityTest, RefusesStaleClothByItsArrivalAndNotByItsStamp) {
  setCloth();  // stamped seconds after 1970
  using std::chrono::milliseconds;
  EXPECT_TRUE(proximity_.answer(sphere(), worldFrame, kArrival + milliseconds(499)).success);
  const Response response = proximity_.answer(sphere(), worldFrame, kArrival + milliseconds(2500));
  EXPECT_FALSE(response.success);
  EXPECT_NE(response.message.find("arrived 2.5 s ago, allowed are 0.5 s: is cloth_simulation "
                                  "running?"),
            std::string::npos)
      << response.message;
  proximity_.setState(testState(8, positions_), kArrival + milliseconds(2500));
  EXPECT_TRUE(proximity_.answer(sphere(), worldFrame, kArrival + milliseconds(2600)).success);
}

TEST_F(ClothProximityTest, DropsStatesThatCannotBe) {
  setCloth();
  for (const double number : {kNaN, kInfinity, 1e10}) {
    expectDropped(
        [&] {
          auto state = testState(8, positions_);
          state->positions[5].y = number;
          proximity_.setState(state, kArrival);
        },
        "cloth/state: positions[5] = (");
  }
  expectDropped(
      [&] {
        auto state = testState(8, positions_);
        state->positions.pop_back();
        proximity_.setState(state, kArrival);
      },
      "cloth/state: positions has 80 elements: cloth/mesh has 81 particles");
  expectDropped([&] { proximity_.setState(testState(8, {}), kArrival); },
                "positions has 0 elements");
  for (const char* frame : {"", "map"}) {
    expectDropped(
        [&] {
          auto state = testState(8, positions_);
          state->header.frame_id = frame;
          proximity_.setState(state, kArrival);
        },
        "cloth/state: header.frame_id = '");
  }
}

TEST_F(ClothProximityTest, DropsMeshesThatCannotBe) {
  setCloth();
  const auto expect_mesh_dropped = [&](const std::function<void(haptex::ClothMesh&)>& spoil,
                                       const std::string& says) {
    haptex::ClothMesh message = testMeshMessage(mesh_);
    spoil(message);
    expectDropped([&] { proximity_.setMesh(message); }, "cloth/mesh: " + says);
  };
  using Mesh = haptex::ClothMesh;
  expect_mesh_dropped([](Mesh& m) { m.triangles.clear(); }, "triangles has 0 elements");
  expect_mesh_dropped([](Mesh& m) { m.triangles.pop_back(); }, "triangles has 383 elements");
  expect_mesh_dropped([](Mesh& m) { m.triangles[7] = 81; }, "triangles[7] = 81: there are 81");
  expect_mesh_dropped([](Mesh& m) { m.triangles[7] = 4294967295u; }, "triangles[7] = 4294967295");
  expect_mesh_dropped([](Mesh& m) { m.rest_weft_coordinates.pop_back(); },
                      "rest_weft_coordinates has 80 elements and rest_warp_coordinates 81");
  expect_mesh_dropped([](Mesh& m) { m.rest_weft_coordinates[3] = kNaN; },
                      "rest coordinates of particle 3 = (nan");
  expect_mesh_dropped([](Mesh& m) { m.rest_warp_coordinates[4] = -1e10; },
                      "rest coordinates of particle 4 = (");
}

TEST_F(ClothProximityTest, BuildsOnceForAMeshThatComesAgain) {
  setCloth();
  haptex::ClothMesh other_fabric = testMeshMessage(mesh_);
  other_fabric.fabrics = {"another"};
  other_fabric.masses.assign(other_fabric.masses.size(), 2e-3);
  proximity_.setMesh(other_fabric);
  EXPECT_EQ(proximity_.status(kNow).meshes, 2u);
  EXPECT_EQ(proximity_.status(kNow).builds, 1u);
  EXPECT_EQ(ask(sphere()).step, 7u);  // and keeps the state
}

TEST_F(ClothProximityTest, TakesNoStateWithTheNumberOfAnotherMesh) {
  setCloth();
  haptex::ClothMesh other = testMeshMessage(mesh_);
  other.mesh = 1;  // of the same shape
  proximity_.setMesh(other);
  expectRefused(sphere(), "no good message on cloth/state");
  proximity_.setState(testState(7, positions_), kArrival);  // of mesh 0
  expectRefused(sphere(), "no good message on cloth/state");
  EXPECT_EQ(proximity_.status(kNow).dropped_why, "cloth/state: mesh = 0: cloth/mesh is 1");
}

TEST_F(ClothProximityTest, ForgetsTheStateOfAnotherMesh) {
  setCloth();
  EXPECT_TRUE(ask(sphere()).success);
  std::swap(mesh_.triangles[3], mesh_.triangles[30]);  // as many particles
  proximity_.setMesh(testMeshMessage(mesh_));
  EXPECT_EQ(proximity_.status(kNow).builds, 2u);
  expectRefused(sphere(), "no good message on cloth/state");

  mesh_ = testMesh(5);
  positions_ = wavy(mesh_.initial_positions);
  setCloth();
  expectElements(
      ask(sphere()),
      proximity::nearElementsByBruteForce(
          mesh_.triangles, positions_,
          proximity::Cursor::spheres({{Eigen::Vector3d(0.02, 0.0, -0.1), 0.005}}), {0.03}));
}

TEST_F(ClothProximityTest, RefitsOnlyWhenSomebodyAsksAboutANewState) {
  setCloth();
  for (std::uint32_t step = 8; step < 20; ++step) {
    proximity_.setState(testState(step, positions_), kArrival);
  }
  EXPECT_EQ(proximity_.status(kNow).refits, 0u);
  EXPECT_TRUE(std::isnan(proximity_.status(kNow).refit_seconds));
  EXPECT_EQ(ask(sphere()).step, 19u);
  ask(sphere());
  EXPECT_EQ(proximity_.status(kNow).refits, 1u);
  EXPECT_EQ(proximity_.status(kNow).answered, 2u);
  EXPECT_GT(proximity_.status(kNow).refit_seconds, 0.0);
}

}  // namespace
}  // namespace haptex::nodes::test_cloth_proximity_messages
