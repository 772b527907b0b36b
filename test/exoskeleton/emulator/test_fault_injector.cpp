#include <gtest/gtest.h>

#include <limits>
#include <set>
#include <stdexcept>
#include <string>

#include "haptex/serial/fault_injector.h"
#include "serial_fixtures.h"

namespace haptex::exoskeleton::test_fault_injector {
namespace {

constexpr Time kForever = Time::max();

ByteVector numbered(int number) {
  return frameOf(commandOf(DriveMode::kForce, number), static_cast<std::uint8_t>(number));
}

// What arrives of one frame a millisecond, piece by piece.
std::vector<ByteVector> through(FaultInjector& line, int count, int first = 0) {
  std::vector<ByteVector> pieces;
  for (int i = first; i < first + count; ++i) {
    const ByteVector frame = numbered(i);
    line.send(view(frame), milliseconds(i));
    pieces.push_back(copy(line.arrived(milliseconds(i))));
  }
  return pieces;
}

FaultInjector with(LineFault fault, double probability = 1.0) {
  FaultInjector line(7, kFrameLayout);
  line.set(fault, probability, kForever);
  return line;
}

bool endsWith(const ByteVector& bytes, const ByteVector& end) {
  return bytes.size() >= end.size() && std::equal(end.rbegin(), end.rend(), bytes.rbegin());
}

TEST(FaultInjector, WithoutFaultsEveryByteArrivesAtOnce) {
  FaultInjector line(1, kFrameLayout);
  const auto pieces = through(line, 100);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(pieces[i], numbered(i));
  EXPECT_TRUE(line.arrived(milliseconds(1000)).empty());
}

TEST(FaultInjector, HasANameForEveryFault) {
  std::set<std::string> names;
  for (const LineFault fault : lineFaults()) names.insert(name(fault));
  EXPECT_EQ(names,
            (std::set<std::string>{"drop", "drop_bytes", "duplicate", "flip", "truncate", "delay",
                                   "reorder", "garbage", "oversize", "wrong_version", "stall"}));
  EXPECT_EQ(lineFaults().size(), kLineFaults);
}

TEST(FaultInjector, RefusesWhatIsNoProbability) {
  for (const double bad : {-0.01, 1.01, std::numeric_limits<double>::quiet_NaN()}) {
    FaultInjector line(1, kFrameLayout);
    try {
      line.set(LineFault::kFlip, bad, kForever);
      ADD_FAILURE() << bad;
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find("probability of flip"), std::string::npos);
      EXPECT_NE(std::string(error.what()).find("allowed is 0 to 1"), std::string::npos);
    }
    EXPECT_EQ(through(line, 1)[0], numbered(0));
  }
}

TEST(FaultInjector, AFaultEndsWhenItIsSaidToAndWhenItIsSwitchedOff) {
  for (const LineFault fault : lineFaults()) {
    FaultInjector line(2, kFrameLayout);
    line.set(fault, 1.0, milliseconds(50));
    through(line, 50);
    const auto after = through(line, 100, 70);  // what was delayed has come by then
    for (int i = 1; i < 100; ++i) EXPECT_EQ(after[i], numbered(70 + i)) << name(fault) << i;
    line.set(fault, 1.0, kForever);
    line.set(fault, 0.0, kForever);
    EXPECT_EQ(through(line, 1, 200)[0], numbered(200)) << name(fault);
  }
}

TEST(FaultInjector, IsReproducibleAndMeetsFramesWithTheProbability) {
  for (const LineFault fault : lineFaults()) {
    if (fault == LineFault::kStall) continue;
    FaultInjector first = with(fault, 0.3), second = with(fault, 0.3);
    const auto pieces = through(first, 2000);
    EXPECT_EQ(pieces, through(second, 2000)) << name(fault);
    if (fault == LineFault::kDelay || fault == LineFault::kReorder) continue;  // touch their heirs
    int met = 0;
    for (int i = 0; i < 2000; ++i) met += pieces[i] != numbered(i);
    EXPECT_NEAR(met, 600, 100) << name(fault);  // five standard deviations
  }
}

TEST(FaultInjector, Drops) {
  FaultInjector line = with(LineFault::kDrop);
  for (const ByteVector& piece : through(line, 50)) EXPECT_TRUE(piece.empty());
}

TEST(FaultInjector, DropsSomeBytes) {
  FaultInjector line = with(LineFault::kDropBytes);
  std::set<std::size_t> lost;
  const std::size_t whole = numbered(0).size();
  for (const ByteVector& piece : through(line, 200)) lost.insert(whole - piece.size());
  EXPECT_EQ(lost, (std::set<std::size_t>{1, 2, 3, 4}));
}

TEST(FaultInjector, Duplicates) {
  FaultInjector line = with(LineFault::kDuplicate);
  const auto pieces = through(line, 50);
  for (int i = 0; i < 50; ++i) {
    ByteVector twice = numbered(i);
    append(twice, numbered(i));
    EXPECT_EQ(pieces[i], twice);
  }
}

TEST(FaultInjector, FlipsOneToEightBits) {
  FaultInjector line = with(LineFault::kFlip);
  const auto pieces = through(line, 500);
  std::set<int> flipped;
  for (int i = 0; i < 500; ++i) {
    const ByteVector frame = numbered(i);
    ASSERT_EQ(pieces[i].size(), frame.size());
    int bits = 0;
    for (std::size_t k = 0; k < frame.size(); ++k) {
      bits += __builtin_popcount(static_cast<unsigned>(frame[k] ^ pieces[i][k]));
    }
    flipped.insert(bits);
  }
  EXPECT_EQ(flipped, (std::set<int>{1, 2, 3, 4, 5, 6, 7, 8}));
}

TEST(FaultInjector, Truncates) {
  FaultInjector line = with(LineFault::kTruncate);
  const auto pieces = through(line, 500);
  std::set<std::size_t> kept;
  for (int i = 0; i < 500; ++i) {
    const ByteVector frame = numbered(i);
    ASSERT_LT(pieces[i].size(), frame.size());
    EXPECT_TRUE(std::equal(pieces[i].begin(), pieces[i].end(), frame.begin()));
    kept.insert(pieces[i].size());
  }
  EXPECT_EQ(kept.size(), numbered(0).size());
}

TEST(FaultInjector, DelaysUpToTwentyMillisecondsAndKeepsTheOrder) {
  FaultInjector line = with(LineFault::kDelay, 0.1);
  ByteVector arrived, sent;
  std::size_t most_waiting = 0;
  for (int i = 0; i < 2000; ++i) {
    append(sent, numbered(i));
    append(arrived, through(line, 1, i)[0]);
    ASSERT_TRUE(std::equal(arrived.begin(), arrived.end(), sent.begin()));
    most_waiting = std::max(most_waiting, (sent.size() - arrived.size()) / numbered(0).size());
  }
  append(arrived, copy(line.arrived(milliseconds(2019))));
  EXPECT_EQ(arrived, sent);
  EXPECT_EQ(most_waiting, 20u);
}

TEST(FaultInjector, ReordersNeighbours) {
  FaultInjector line = with(LineFault::kReorder);
  const auto pieces = through(line, 50);
  for (int i = 0; i < 50; i += 2) {
    EXPECT_TRUE(pieces[i].empty());
    ByteVector swapped = numbered(i + 1);
    append(swapped, numbered(i));
    EXPECT_EQ(pieces[i + 1], swapped);
  }
}

TEST(FaultInjector, AFrameThatWaitsForItsSuccessorTooLongIsLost) {
  FaultInjector line(1, kFrameLayout);
  line.set(LineFault::kReorder, 1.0, milliseconds(1));
  through(line, 1);
  EXPECT_EQ(through(line, 1, 21)[0], numbered(21));
  line.set(LineFault::kReorder, 1.0, milliseconds(101));
  through(line, 1, 100);
  ByteVector swapped = numbered(120);
  append(swapped, numbered(100));
  EXPECT_EQ(through(line, 1, 120)[0], swapped);
}

TEST(FaultInjector, PutsGarbageBeforeFrames) {
  FaultInjector line = with(LineFault::kGarbage);
  const auto pieces = through(line, 2000);
  std::set<std::size_t> lengths;
  for (int i = 0; i < 2000; ++i) {
    ASSERT_TRUE(endsWith(pieces[i], numbered(i)));
    lengths.insert(pieces[i].size() - numbered(i).size());
  }
  EXPECT_EQ(lengths.size(), 64u);
  EXPECT_EQ(*lengths.begin(), 1u);
}

TEST(FaultInjector, PutsTheStartOfAnOversizeFrameBeforeFrames) {
  FaultInjector line = with(LineFault::kOversize);
  FrameParser parser(LineEnd::kDevice, kFrameLayout);
  const auto pieces = through(line, 200);
  for (int i = 0; i < 200; ++i) {
    ASSERT_TRUE(endsWith(pieces[i], numbered(i)));
    EXPECT_EQ(framesFoundBy(parser, pieces[i]), std::vector<ByteVector>{numbered(i)});
  }
  EXPECT_EQ(parser.statistics().impossible_lengths, 200u);
}

TEST(FaultInjector, SpeaksAnotherVersion) {
  FaultInjector line = with(LineFault::kWrongVersion);
  FrameParser parser(LineEnd::kDevice, kFrameLayout);
  for (const ByteVector& piece : through(line, 50)) {
    EXPECT_EQ(piece.size(), numbered(0).size());
    EXPECT_TRUE(framesFoundBy(parser, piece).empty());
  }
  EXPECT_EQ(parser.statistics().corrupt_frames, 50u);
  const ByteVector hello = frameOf(Hello{kProtocolVersion});
  line.send(view(hello), milliseconds(50));
  const ByteVector other = copy(line.arrived(milliseconds(50)));
  EXPECT_EQ(decodeHello(frameIn(other, LineEnd::kDevice))->version, kProtocolVersion + 1);
}

TEST(FaultInjector, WhileItStallsNothingArrivesAndWhatIsSentIsLost) {
  FaultInjector line(1, kFrameLayout);
  line.set(LineFault::kDelay, 1.0, milliseconds(1));
  through(line, 1);  // comes within 20 ms
  line.set(LineFault::kDelay, 0.0, kForever);
  line.set(LineFault::kStall, 1.0, milliseconds(100));
  for (const ByteVector& piece : through(line, 99, 1)) EXPECT_TRUE(piece.empty());
  ByteVector late = numbered(0);
  append(late, numbered(100));
  EXPECT_EQ(through(line, 1, 100)[0], late) << "was on its way before";
}

TEST(FaultInjector, AStallIsThereForAllFramesOrForNone) {
  FaultInjector line(1, kFrameLayout);
  int stalls = 0;
  for (int i = 0; i < 400; ++i) {
    line.set(LineFault::kStall, 0.5, kForever);
    const auto pieces = through(line, 10, 10 * i);
    for (const ByteVector& piece : pieces) EXPECT_EQ(piece.empty(), pieces[0].empty());
    stalls += pieces[0].empty();
  }
  EXPECT_NEAR(stalls, 200, 50);
}

}  // namespace
}  // namespace haptex::exoskeleton::test_fault_injector
