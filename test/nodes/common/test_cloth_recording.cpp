#include <gtest/gtest.h>
#include <haptex/ClothMesh.h>
#include <rosbag/bag.h>

#include <filesystem>
#include <fstream>

#include "../../temporary_directory.h"
#include "haptex/nodes/common/cloth_recording.h"

namespace haptex::nodes::test_cloth_recording {
namespace {

namespace fs = std::filesystem;

/// A bag that goes with the test.
class TestBag {
 public:
  std::string path() const { return directory_.path() + "/cloth.bag"; }
  template <typename Message>
  void write(const std::string& topic, const Message& message) {
    const auto mode = fs::exists(path()) ? rosbag::bagmode::Append : rosbag::bagmode::Write;
    rosbag::Bag bag(path(), mode);
    bag.write(topic, ros::Time(++messages_), message);
  }

 private:
  test::TemporaryDirectory directory_;
  int messages_ = 0;
};

ClothMesh meshOf(const std::vector<uint32_t>& triangles) {
  ClothMesh mesh;
  mesh.triangles = triangles;
  mesh.rest_weft_coordinates = mesh.rest_warp_coordinates = {0.0, 0.0, 0.0, 0.0};
  return mesh;
}

ClothState stateOf(int step) {
  ClothState state;
  state.step = step;
  return state;
}

void ignore(const ClothState&, const Triangles&) {}

void expectRefused(const TestBag& bag, const std::string& part) {
  try {
    readClothRecording(bag.path(), ignore);
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
  }
}

TEST(ClothRecording, HandsOnEveryStateWithTheTriangles) {
  TestBag bag;
  bag.write("/left/cloth/mesh", meshOf({0, 1, 2, 2, 1, 3}));
  for (int step = 0; step < 3; ++step) bag.write("/left/cloth/state", stateOf(step));
  std::vector<int> steps;
  readClothRecording(bag.path(), [&](const ClothState& state, const Triangles& triangles) {
    steps.push_back(static_cast<int>(state.step));
    EXPECT_EQ(triangles, (Triangles{{0, 1, 2}, {2, 1, 3}}));
  });
  EXPECT_EQ(steps, (std::vector<int>{0, 1, 2}));
}

TEST(ClothRecording, RefusesWhatIsNoRecordingOfOneCloth) {
  const TestBag none;
  EXPECT_THROW(readClothRecording(none.path(), ignore), std::runtime_error);
  std::ofstream(none.path()) << "no bag";
  EXPECT_THROW(readClothRecording(none.path(), ignore), std::runtime_error);
  {
    TestBag bag;
    bag.write("/cloth/state", stateOf(0));
    expectRefused(bag, "0 topics end in cloth/mesh");
    bag.write("/cloth/mesh", meshOf({0, 1, 2}));
    bag.write("/other/cloth/state", stateOf(0));
    expectRefused(bag, "2 topics end in cloth/state");
    bag.write("/cloth/mesh", meshOf({0, 2, 1}));
    expectRefused(bag, "the triangles change");
  }
  {
    TestBag bag;
    bag.write("/cloth/mesh", meshOf({0, 1, 2, 3}));
    expectRefused(bag, "three per triangle");
  }
  TestBag bag;
  bag.write("/cloth/mesh", meshOf({0, 1, 4}));
  expectRefused(bag, "triangles[2] = 4: there are 4 particles");
}

}  // namespace
}  // namespace haptex::nodes::test_cloth_recording
