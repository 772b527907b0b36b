// More than ten million bytes of everything that can happen to a line, through parsers, decoders
// and both ends. A 16-bit checksum takes one in 65536 damaged frames for good: the counts are held
// against that.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "haptex/exoskeleton/protocol/device_link.h"
#include "haptex/exoskeleton/protocol/firmware_model.h"
#include "haptex/serial/fault_injector.h"
#include "serial_fixtures.h"

namespace haptex::exoskeleton::test_serial_fuzz {
namespace {

// Six standard deviations above what the checksum lets through, and a few for small numbers.
double mostWronglyTaken(double candidates) {
  const double expected = candidates / 65536.0;
  return expected + 6.0 * std::sqrt(expected) + 6.0;
}

/// Hands bytes to a parser in pieces of any size, decodes what it finds, and keeps the books.
class Listener {
 public:
  explicit Listener(LineEnd end) : parser_(end, kFrameLayout) {}

  template <typename OnFrame>
  void hear(const ByteVector& bytes, std::mt19937& generator, OnFrame on_frame) {
    for (std::size_t at = 0; at < bytes.size();) {
      const std::size_t piece = std::min<std::size_t>(1 + generator() % 97, bytes.size() - at);
      Bytes rest{bytes.data() + at, piece};
      while (const Frame* frame = parser_.next(rest)) {
        good_bytes_ += frame->bytes.size;
        decoded_ += decodes(*frame);
        on_frame(*frame);
      }
      at += piece;
    }
    bytes_ += bytes.size();
    ASSERT_LE(parser_.pending(), kLongestFrame);
    // No byte is lost and none is counted twice.
    ASSERT_EQ(good_bytes_ + parser_.statistics().garbage_bytes + parser_.pending(), bytes_);
  }

  const ParserStatistics& statistics() const { return parser_.statistics(); }
  std::uint64_t bytes() const { return bytes_; }
  std::uint64_t decoded() const { return decoded_; }

 private:
  static bool decodes(const Frame& frame) {
    const auto state = decodeState(frame);
    if (state) {
      for (const Finger finger : kFingers) EXPECT_TRUE(state->fingers[finger].force.allFinite());
    }
    const auto command = decodeCommand(frame);
    if (command) {
      for (const Finger finger : kFingers) EXPECT_TRUE(command->torques[finger].allFinite());
    }
    return state || command || decodeHello(frame) || decodeIdentity(frame);
  }

  FrameParser parser_;
  std::uint64_t bytes_ = 0, good_bytes_ = 0, decoded_ = 0;
};

ByteVector randomBytes(std::size_t count, std::mt19937& generator) {
  ByteVector bytes(count);
  for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(generator());
  return bytes;
}

// A header has four bytes that must be right and the checksum two: 2^-48 per byte of noise, for
// Identity of 43 lengths 43 x 2^-48, so that 3 million bytes hold one with a chance of 5e-7.
TEST(SerialFuzz, NoiseHoldsNoFrame) {
  std::mt19937 generator(10);
  for (const LineEnd end : {LineEnd::kDriver, LineEnd::kDevice}) {
    Listener listener(end);
    for (int i = 0; i < 1500; ++i) {
      listener.hear(randomBytes(1000, generator), generator, [](const Frame&) {});
    }
    EXPECT_EQ(listener.statistics().good_frames, 0u);
    EXPECT_EQ(listener.bytes(), 1500000u);
  }
}

// Noise in which every header is right, so that the checksum alone has to tell.
TEST(SerialFuzz, NoiseWithHeadersIsTakenAsOftenAsTheChecksumLets) {
  std::mt19937 generator(11);
  for (const LineEnd end : {LineEnd::kDriver, LineEnd::kDevice}) {
    Listener listener(end);
    for (int i = 0; i < 150000; ++i) {
      ByteVector bytes =
          end == LineEnd::kDriver ? frameOf(DeviceState{}) : frameOf(DeviceCommand{});
      for (std::size_t k = 4; k < bytes.size(); ++k) {
        bytes[k] = static_cast<std::uint8_t>(generator());
      }
      listener.hear(bytes, generator, [](const Frame&) {});
    }
    const ParserStatistics& counts = listener.statistics();
    EXPECT_NEAR(static_cast<double>(counts.corrupt_frames), 150000.0, 100.0);
    EXPECT_LE(static_cast<double>(counts.good_frames), mostWronglyTaken(150000.0));
    std::printf("%.1f million bytes, %lu of 150000 taken (expected 2.3), %lu of them decoded\n",
                1e-6 * static_cast<double>(listener.bytes()),
                static_cast<unsigned long>(counts.good_frames),
                static_cast<unsigned long>(listener.decoded()));
  }
}

// What a checksum cannot tell the decoders have to.
TEST(SerialFuzz, WhateverIsDecodedIsFiniteAndMeansWhatItsBytesSay) {
  std::mt19937 generator(17);
  int states = 0, commands = 0;
  for (int i = 0; i < 20000; ++i) {
    ByteVector bytes = frameOf(DeviceState{});
    for (std::size_t k = 4; k < bytes.size(); ++k)
      bytes[k] = static_cast<std::uint8_t>(generator());
    bytes[10] %= 4;  // else hardly any mode and flags mean something
    bytes[11] %= 16;
    seal(bytes);
    const auto state = decodeState(frameIn(bytes, LineEnd::kDriver));
    EXPECT_EQ(state.has_value(), bytes[10] < 3 && bytes[11] < 8);
    if (state) {
      EXPECT_EQ(frameOf(*state, bytes[4]), bytes);
    }
    states += state.has_value();

    bytes = frameOf(DeviceCommand{});
    for (std::size_t k = 4; k < bytes.size(); ++k)
      bytes[k] = static_cast<std::uint8_t>(generator());
    bytes[5] %= 4;
    seal(bytes);
    const auto command = decodeCommand(frameIn(bytes, LineEnd::kDevice));
    EXPECT_EQ(command.has_value(), bytes[5] < 3);
    if (command) {
      EXPECT_EQ(frameOf(*command, bytes[4]), bytes);
    }
    commands += command.has_value();
  }
  EXPECT_GT(states, 5000);
  EXPECT_GT(commands, 10000);
}

struct Figures {
  std::uint64_t bytes = 0, sent = 0, unharmed = 0, taken = 0, wrong = 0, displaced = 0;
};

void print(const char* what, const Figures& figures) {
  std::printf(
      "%-13s %7lu bytes, %6lu sent, %5lu unharmed, %5lu taken, %lu wrong, %lu displaced\n", what,
      static_cast<unsigned long>(figures.bytes), static_cast<unsigned long>(figures.sent),
      static_cast<unsigned long>(figures.unharmed), static_cast<unsigned long>(figures.taken),
      static_cast<unsigned long>(figures.wrong), static_cast<unsigned long>(figures.displaced));
}

ByteVector randomFrame(LineEnd end, int number, std::mt19937& generator) {
  const auto sequence = static_cast<std::uint8_t>(number);
  return end == LineEnd::kDriver ? frameOf(randomState(generator), sequence)
                                 : frameOf(randomCommand(generator), sequence);
}

// Every third frame meets the faults, the others are unharmed and have to be taken at once. Only
// the first behind a harmed one may be displaced, where its first byte happens to be the one that
// the harmed frame lacks: then that is complete, and it is not.
void fuzz(LineEnd end, const std::vector<LineFault>& faults, int frames, Figures& figures) {
  std::mt19937 generator(12);
  FaultInjector line(13, kFrameLayout);
  Listener listener(end);
  std::map<ByteVector, int> sent;  // and not yet too old to arrive
  for (int i = 0; i < frames; ++i) {
    const Time now = milliseconds(50L * i);
    const bool harmed = i % 3 == 0;
    for (const LineFault fault : faults) {
      line.set(fault, harmed ? 0.7 : 0.0, now + milliseconds(1));
    }
    const ByteVector frame = randomFrame(end, i, generator);
    sent[frame] = i;
    line.send(view(frame), now);
    ByteVector bytes = copy(line.arrived(now));
    if (harmed) append(bytes, copy(line.arrived(now + milliseconds(40))));
    bool found = false, another = false;
    listener.hear(bytes, generator, [&](const Frame& taken) {
      const ByteVector whole = copy(taken.bytes);
      ++figures.taken;
      figures.wrong += sent.count(whole) == 0;
      found = found || whole == frame;
      another = another || whole != frame;
    });
    const bool displaced = i % 3 == 1 && another && !found;
    ASSERT_TRUE(harmed || found || displaced) << "frame " << i;
    figures.displaced += displaced;
    figures.unharmed += !harmed;
    if (sent.size() > 10) sent.clear();
  }
  figures.bytes += listener.bytes();
  figures.sent += static_cast<std::uint64_t>(frames);
  const auto candidates = static_cast<double>(listener.statistics().corrupt_frames);
  EXPECT_LE(static_cast<double>(figures.wrong), mostWronglyTaken(candidates));
  // One of 256 of those that lack their last byte, which are one of 20 at most.
  EXPECT_LE(static_cast<double>(figures.displaced), 6.0 + 2.0 * frames / (3 * 256 * 20));
}

TEST(SerialFuzz, EveryUnharmedFrameIsTakenAtOnceBehindAnySingleFault) {
  for (const LineFault fault : lineFaults()) {
    Figures figures;
    fuzz(LineEnd::kDriver, {fault}, 10000, figures);
    fuzz(LineEnd::kDevice, {fault}, 10000, figures);
    print(name(fault), figures);
  }
}

TEST(SerialFuzz, EveryUnharmedFrameIsTakenAtOnceBehindAllFaultsTogether) {
  std::vector<LineFault> faults = lineFaults();
  faults.pop_back();  // a stall and a drop leave nothing of the others
  faults.erase(faults.begin());
  Figures figures;
  fuzz(LineEnd::kDriver, faults, 50000, figures);
  fuzz(LineEnd::kDevice, faults, 50000, figures);
  print("all together", figures);
}

// Both ends behind bad lines in both directions, with a driver that comes and goes.
TEST(SerialFuzz, BothEndsSurviveAndTheTorqueNeverOutlivesTheDriver) {
  FaultInjector to_device(14, kFrameLayout), to_driver(15, kFrameLayout);
  FirmwareModel device(Identity{});
  DeviceLink link;
  std::mt19937 generator(16);
  std::uint64_t bytes = 0, states = 0, obeyed = 0;
  Time last_sent{};
  constexpr double kSteps = 1000.0;
  double before = 0.0;
  for (long ms = 0; ms < 60000; ++ms) {
    const Time now = milliseconds(ms);
    const bool alive = ms % 700 < 600;
    if (ms % 700 == 0) link.reset();
    if (ms % 50 == 0) {
      for (FaultInjector* line : {&to_device, &to_driver}) {
        const LineFault fault = lineFaults()[generator() % kLineFaults];
        line->set(fault, 0.5, now + milliseconds(static_cast<long>(generator() % 60)));
      }
    }
    if (alive) {
      to_device.send(link.poll(now), now);
      const Bytes command = link.send(commandOf(DriveMode::kForce, static_cast<int>(kSteps)));
      if (!command.empty()) last_sent = now;
      to_device.send(command, now);
    }
    const Bytes at_device = to_device.arrived(now);
    bytes += at_device.size;
    device.receive(at_device.data, at_device.size, now);
    to_driver.send(device.answer(), now);
    to_driver.send(device.report(stateAt(static_cast<std::uint32_t>(ms)), now), now);
    const Bytes at_driver = to_driver.arrived(now);
    bytes += at_driver.size;
    if (alive) link.receive(at_driver.data, at_driver.size, now);
    states += link.takeState() != nullptr;

    const double share = device.command(now).torques[Finger::kIndex][0] / (kSteps * kTorqueStep);
    obeyed += share > 0.0;
    // A line may be up to 20 ms late; then the watchdog takes 20 ms.
    const bool too_late = now - last_sent >= milliseconds(40);
    ASSERT_TRUE(share == 0.0 || !too_late) << ms;
    ASSERT_LE(std::abs(share - before), 0.2 + 1e-9) << ms;
    before = share;
  }
  EXPECT_GT(states, 20000u);
  EXPECT_GT(obeyed, 20000u);
  EXPECT_GT(link.statistics().timeouts, 20u);
  EXPECT_GT(link.statistics().handshakes, link.statistics().timeouts);
  std::printf("%lu bytes, %lu states, %lu ms with torque, %lu handshakes, %lu timeouts\n",
              static_cast<unsigned long>(bytes), static_cast<unsigned long>(states),
              static_cast<unsigned long>(obeyed),
              static_cast<unsigned long>(link.statistics().handshakes),
              static_cast<unsigned long>(link.statistics().timeouts));
}

}  // namespace
}  // namespace haptex::exoskeleton::test_serial_fuzz
