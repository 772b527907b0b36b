#include <gtest/gtest.h>

#include "haptex/serial/frame_parser.h"
#include "serial_fixtures.h"

namespace haptex::exoskeleton::test_frame_parser {
namespace {

std::vector<ByteVector> someStates(std::size_t count) {
  std::mt19937 generator(3);
  std::vector<ByteVector> frames;
  for (std::size_t i = 0; i < count; ++i) {
    frames.push_back(frameOf(randomState(generator), static_cast<std::uint8_t>(i)));
  }
  return frames;
}

ByteVector joined(const std::vector<ByteVector>& frames) {
  ByteVector bytes;
  for (const ByteVector& frame : frames) append(bytes, frame);
  return bytes;
}

TEST(FrameParser, FindsTheSameFramesHoweverTheBytesAreSplit) {
  const auto frames = someStates(50);
  const ByteVector bytes = joined(frames);
  for (std::size_t piece = 1; piece <= 2 * kLongestFrame + 1; ++piece) {
    FrameParser parser(LineEnd::kDriver, kFrameLayout);
    EXPECT_EQ(framesFoundBy(parser, bytes, piece), frames) << piece;
    EXPECT_EQ(parser.statistics().good_frames, frames.size());
    EXPECT_EQ(parser.statistics().garbage_bytes, 0u);
    EXPECT_EQ(parser.pending(), 0u);
  }
}

TEST(FrameParser, ReadsTypeNumberAndPayload) {
  const ByteVector bytes = frameOf(commandOf(DriveMode::kForce, 77), 12);
  FrameParser parser(LineEnd::kDevice, kFrameLayout);
  Bytes rest = view(bytes);
  const Frame* frame = parser.next(rest);
  ASSERT_NE(frame, nullptr);
  EXPECT_TRUE(rest.empty());
  EXPECT_EQ(frame->type, FrameType::kCommand);
  EXPECT_EQ(frame->sequence, 12);
  EXPECT_TRUE(equal(decodeCommand(*frame).value(), commandOf(DriveMode::kForce, 77)));
  EXPECT_EQ(parser.next(rest), nullptr);
}

TEST(FrameParser, FindsTheFrameBehindATruncatedOneWhereverItEnds) {
  const auto frames = someStates(2);
  for (std::size_t kept = 0; kept < frames[0].size(); ++kept) {
    ByteVector bytes(frames[0].begin(), frames[0].begin() + static_cast<long>(kept));
    append(bytes, frames[1]);
    FrameParser parser(LineEnd::kDriver, kFrameLayout);
    const auto found = framesFoundBy(parser, bytes);
    ASSERT_EQ(found.size(), 1u) << kept;
    EXPECT_EQ(found[0], frames[1]);
    EXPECT_EQ(parser.statistics().garbage_bytes, kept);
  }
}

TEST(FrameParser, FindsAFrameInsideOfWhatLookedLikeOne) {
  const ByteVector command = frameOf(commandOf(DriveMode::kForce, 5), 1);
  // Starts of commands that never come, one inside of the other, and a lone sync byte.
  ByteVector bytes = {0xA5, 0x5A, 13, 4, 0, 0xA5, 0x5A, 13, 4, 1, 2, 0xA5};
  append(bytes, command);
  FrameParser parser(LineEnd::kDevice, kFrameLayout);
  EXPECT_EQ(framesFoundBy(parser, bytes), std::vector<ByteVector>{command});
  EXPECT_EQ(parser.statistics().corrupt_frames, 2u);
  EXPECT_EQ(parser.statistics().garbage_bytes, 12u);
}

TEST(FrameParser, CountsWhatWentWrong) {
  ByteVector corrupt = frameOf(DeviceState{});
  corrupt[20] ^= 1;
  FrameBuffer buffer;
  const ByteVector oversize = copy(serial::oversizeStart(200, 0, buffer));
  ByteVector short_state = frameOf(DeviceState{});
  short_state[2] = 42;
  ByteVector unknown = frameOf(DeviceState{});
  unknown[3] = 77;
  const ByteVector echo = frameOf(DeviceCommand{});

  FrameParser parser(LineEnd::kDriver, kFrameLayout);
  framesFoundBy(parser, corrupt);
  EXPECT_EQ(parser.statistics().corrupt_frames, 1u);
  framesFoundBy(parser, oversize);
  EXPECT_EQ(parser.statistics().impossible_lengths, 1u);
  framesFoundBy(parser, short_state);
  EXPECT_EQ(parser.statistics().impossible_lengths, 2u);
  framesFoundBy(parser, unknown);
  EXPECT_EQ(parser.statistics().unknown_types, 1u);
  framesFoundBy(parser, echo);  // a line that is looped back
  EXPECT_EQ(parser.statistics().unknown_types, 2u);
  framesFoundBy(parser, frameOf(DeviceState{}));
  EXPECT_EQ(parser.statistics().good_frames, 1u);
  EXPECT_EQ(parser.statistics().corrupt_frames, 1u);
  EXPECT_EQ(parser.statistics().garbage_bytes, 3 * kLongestFrame + oversize.size() + echo.size());
}

TEST(FrameParser, ForgetsAnUnfinishedFrameIfAsked) {
  const auto frames = someStates(2);
  ByteVector start = frames[0];
  start.pop_back();
  FrameParser parser(LineEnd::kDriver, kFrameLayout);
  EXPECT_TRUE(framesFoundBy(parser, start).empty());
  EXPECT_EQ(parser.pending(), start.size());
  parser.discard();
  EXPECT_EQ(parser.pending(), 0u);
  EXPECT_EQ(parser.statistics().garbage_bytes, start.size());
  EXPECT_TRUE(framesFoundBy(parser, {frames[0].back()}).empty());
  EXPECT_EQ(framesFoundBy(parser, frames[1]), std::vector<ByteVector>{frames[1]});
  parser.discard();  // does not count a frame that was handed out
  EXPECT_EQ(parser.statistics().garbage_bytes, start.size() + 1);
}

}  // namespace
}  // namespace haptex::exoskeleton::test_frame_parser
