// An executable of its own, because it counts every call of malloc in the process.
#include <gtest/gtest.h>

#include <memory>

#include "../malloc_counter.h"
#include "haptex/exoskeleton/protocol/device_link.h"
#include "haptex/exoskeleton/protocol/firmware_model.h"
#include "haptex/serial/pseudo_terminal.h"
#include "haptex/serial/serial_port.h"
#include "serial_fixtures.h"

namespace haptex::exoskeleton::test_serial_allocation {
namespace {

TEST(SerialAllocation, NeitherEndOfTheLineAllocatesWhateverArrives) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the address sanitizer brings its own malloc";
#endif
  std::mt19937 generator(1);
  ByteVector garbage(500);
  for (std::uint8_t& byte : garbage) byte = static_cast<std::uint8_t>(generator());
  const ByteVector foreign = frameOf(Identity{9, 1, 1, 1});
  ByteVector corrupt = frameOf(DeviceState{});
  corrupt[20] ^= 1;
  const long at_start = allocations;
  EXPECT_GT(at_start, 0) << "the count does not work";

  DeviceLink link;
  FirmwareModel device(Identity{});
  std::uint64_t states = 0;
  for (int i = 0; i < 1000; ++i) {
    const Time now = milliseconds(i < 500 ? i : i + 1000);  // a time-out in between
    const Bytes hello = link.poll(now);
    device.receive(hello.data, hello.size, now);
    device.receive(garbage.data(), garbage.size(), now);
    const Bytes command = link.send(commandOf(DriveMode::kForce, i));
    device.receive(command.data, command.size, now);
    (void)device.command(now);
    if (i == 700) link.receive(foreign.data(), foreign.size(), now);
    const Bytes identity = device.answer();
    link.receive(identity.data, identity.size, now);
    link.receive(corrupt.data(), corrupt.size(), now);
    link.receive(garbage.data(), garbage.size(), now);
    const Bytes report = device.report({}, now);
    link.receive(report.data, report.size, now);
    states += link.takeState() != nullptr;
    if (i == 900) link.reset();
  }
  EXPECT_EQ(allocations - at_start, 0);
  EXPECT_GT(states, 800u);
  EXPECT_EQ(link.statistics().timeouts, 1u);
  EXPECT_EQ(link.statistics().version_mismatches, 1u);
}

TEST(SerialAllocation, NeitherReadingNorWritingALineAllocates) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the address sanitizer brings its own malloc";
#endif
  auto device = std::make_unique<serial::PseudoTerminal>();
  serial::SerialPort driver(device->path());
  const ByteVector frame = frameOf(DeviceCommand{});
  FrameBuffer buffer;
  const long before = allocations;
  std::size_t refused = 0, received = 0;
  for (int i = 0; i < 2000; ++i) {
    refused += !driver.write(view(frame));  // the line gets full
    device->write(view(frame));
  }
  for (int i = 0; i < 2000; ++i) {
    received += device->read(buffer.data(), buffer.size());
    received += driver.read(buffer.data(), buffer.size());
  }
  EXPECT_EQ(allocations - before, 0);
  EXPECT_GT(refused, 0u);
  EXPECT_GT(received, 0u);
  device.reset();
  const long at_end = allocations;
  while (!driver.closed()) driver.read(buffer.data(), buffer.size());
  EXPECT_FALSE(driver.write(view(frame)));
  EXPECT_EQ(allocations - at_end, 0);
}

}  // namespace
}  // namespace haptex::exoskeleton::test_serial_allocation
