#include <geometry_msgs/TransformStamped.h>
#include <gtest/gtest.h>
#include <haptex/AttachParticles.h>
#include <haptex/ClothMesh.h>
#include <haptex/ClothState.h>
#include <haptex/ContactForces.h>
#include <haptex/ServoForces.h>
#include <haptex/SetProperties.h>
#include <haptex/Tactile.h>
#include <tf2_msgs/TFMessage.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "haptex/nodes/wire/claimed_length.h"

namespace haptex::nodes::test_claimed_length {
namespace {

using Bytes = std::vector<std::uint8_t>;

template <typename Message>
Bytes bytesOf(const Message& message) {
  Bytes bytes(ros::serialization::serializationLength(message));
  ros::serialization::OStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::serialize(stream, message);
  return bytes;
}

template <typename Message>
bool fits(const Bytes& bytes) {
  try {
    requireClaimsFit<Message>(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  } catch (const std::invalid_argument&) {
    return false;
  }
  return true;
}

/// A whole message fits, and without its last byte it does not.
template <typename Message>
void expectFitsWholeOnly(const Message& message) {
  Bytes bytes = bytesOf(message);
  EXPECT_TRUE(fits<Message>(bytes));
  bytes.pop_back();
  EXPECT_FALSE(fits<Message>(bytes));
}

TEST(ClaimedLength, WholeMessagesOfEveryKindOfFieldFit) {
  haptex::ClothMesh mesh;
  mesh.header.frame_id = "world";
  mesh.triangles = {0, 1, 2};
  mesh.rest_weft_coordinates = {0.0, 0.1, 0.2};
  mesh.fabrics = {"wool", "denim"};
  mesh.fabric_files = {"name: wool", ""};
  expectFitsWholeOnly(mesh);
  haptex::ClothState state;
  state.positions.resize(3);
  state.velocities.resize(3);
  expectFitsWholeOnly(state);
  expectFitsWholeOnly(haptex::ServoForces());
  expectFitsWholeOnly(haptex::Tactile());
  tf2_msgs::TFMessage transforms;
  transforms.transforms.resize(2);
  transforms.transforms[0].child_frame_id = "hand_base";
  expectFitsWholeOnly(transforms);
  haptex::SetPropertiesRequest properties;
  properties.names = {"warp", "weft"};
  properties.values = {2.0, 1.0};
  expectFitsWholeOnly(properties);
}

TEST(ClaimedLength, ArraysThatClaimMoreThanTheBytesHaveDoNotFit) {
  haptex::AttachParticlesRequest request;
  request.particles = {1, 2, 3};
  const Bytes good = bytesOf(request);
  const std::size_t length = 16;  // after seq, stamp and the length of the empty frame_id
  ASSERT_EQ(good[length], 3);
  for (const std::uint32_t claimed : {4u, 0x40000000u, 0x40000003u, 0x80000000u, 0xffffffffu}) {
    Bytes bytes = good;
    std::memcpy(&bytes[length], &claimed, sizeof(claimed));
    EXPECT_FALSE(fits<haptex::AttachParticlesRequest>(bytes)) << claimed;
  }
}

TEST(ClaimedLength, ArraysOfTextsAndOfMessagesThatClaimTooMuchDoNotFit) {
  const Bytes claim = {0xff, 0xff, 0xff, 0xff};
  EXPECT_FALSE(fits<haptex::SetPropertiesRequest>(claim));
  EXPECT_FALSE(fits<tf2_msgs::TFMessage>(claim));
  // One text that claims more than there is within an array that does not.
  EXPECT_FALSE(fits<haptex::SetPropertiesRequest>({1, 0, 0, 0, 0xff, 0xff, 0xff, 0xff}));
}

TEST(ClaimedLength, SaysWhatIsClaimedAndWhatIsThere) {
  const Bytes claim = {0xff, 0xff, 0xff, 0xff};
  try {
    requireClaimsFit<tf2_msgs::TFMessage>(claim.data(), 4);
    ADD_FAILURE() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(),
                 "an array or a text of at least 17179869180 bytes is claimed: there are 0");
  }
}

}  // namespace
}  // namespace haptex::nodes::test_claimed_length
