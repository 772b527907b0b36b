// Real bytes between a serial port and a pseudo-terminal of this system.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <string>

#include "../refusal.h"
#include "byte_fixtures.h"
#include "haptex/serial/pseudo_terminal.h"
#include "haptex/serial/serial_port.h"

namespace haptex::serial::test_serial_port {
namespace {

constexpr int kLongEnough = 10000;  // ms, for the system to bring bytes that were written

// Reads until that many bytes have come or none come any more.
template <typename Line>
ByteVector readFrom(Line& line, std::size_t count) {
  ByteVector bytes(count + 1);
  std::size_t size = 0;
  while (size < count) {
    pollfd state{line.descriptor(), POLLIN, 0};
    if (::poll(&state, 1, kLongEnough) <= 0) break;
    const std::size_t more = line.read(bytes.data() + size, bytes.size() - size);
    if (more == 0) break;
    size += more;
  }
  bytes.resize(size);
  return bytes;
}

ByteVector everyByte() {
  ByteVector bytes(256);
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::uint8_t>(i);
  return bytes;
}

std::string refusal(const std::string& path) {
  return test::refusalOf<std::runtime_error>([&] { SerialPort port(path); });
}

// Root may do everything, so that nothing is refused to it.
class AsNobody {
 public:
  AsNobody() : user_(::geteuid()) {
    if (user_ == 0 && ::seteuid(65534) != 0) throw std::runtime_error("cannot become nobody");
  }
  ~AsNobody() { EXPECT_EQ(::seteuid(user_), 0); }
  AsNobody(const AsNobody&) = delete;
  AsNobody& operator=(const AsNobody&) = delete;

 private:
  uid_t user_;
};

class TemporaryDirectory {
 public:
  TemporaryDirectory() {
    std::string name = std::filesystem::temp_directory_path() / "haptex_serial_XXXXXX";
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary directory");
    path_ = name;
  }
  ~TemporaryDirectory() { EXPECT_EQ(::rmdir(path_.c_str()), 0) << "not empty"; }
  TemporaryDirectory(const TemporaryDirectory&) = delete;
  TemporaryDirectory& operator=(const TemporaryDirectory&) = delete;
  std::string operator/(const std::string& name) const { return path_ + "/" + name; }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

bool exists(const std::string& path) {
  struct stat status {};
  return ::lstat(path.c_str(), &status) == 0;
}

TEST(SerialPort, EveryByteGoesThroughUnchangedBothWays) {
  PseudoTerminal device;
  SerialPort driver(device.path());
  const ByteVector bytes = everyByte();  // among them Ctrl-C, XON, XOFF, line ends
  ASSERT_TRUE(driver.write(view(bytes)));
  EXPECT_EQ(readFrom(device, bytes.size()), bytes);
  ASSERT_TRUE(device.write(view(bytes)));
  EXPECT_EQ(readFrom(driver, bytes.size()), bytes);
  // No echo.
  std::uint8_t byte = 0;
  EXPECT_EQ(driver.read(&byte, 1), 0u);
  EXPECT_EQ(device.read(&byte, 1), 0u);
  EXPECT_FALSE(driver.closed());
}

TEST(SerialPort, IsSetUpAsTheProtocolSays) {
  PseudoTerminal device;
  SerialPort driver(device.path());
  termios settings{};
  ASSERT_EQ(::tcgetattr(driver.descriptor(), &settings), 0);
  EXPECT_EQ(::cfgetospeed(&settings), static_cast<speed_t>(B921600));
  EXPECT_EQ(::cfgetispeed(&settings), static_cast<speed_t>(B921600));
  EXPECT_EQ(settings.c_cflag & (CSIZE | PARENB | CSTOPB | CRTSCTS | CLOCAL | CREAD),
            static_cast<tcflag_t>(CS8 | CLOCAL | CREAD));
  EXPECT_EQ(settings.c_iflag & (IXON | IXOFF | IXANY | ICRNL), 0u);
  EXPECT_EQ(settings.c_lflag & (ICANON | ECHO | ISIG), 0u);
  EXPECT_EQ(settings.c_oflag & OPOST, 0u);
}

TEST(SerialPort, ReadingAndWritingNothingIsNoError) {
  PseudoTerminal device;
  SerialPort driver(device.path());
  std::uint8_t byte = 0;
  EXPECT_EQ(driver.read(&byte, 1), 0u);
  EXPECT_EQ(driver.read(&byte, 0), 0u);
  EXPECT_TRUE(driver.write({}));
  EXPECT_FALSE(driver.closed());
}

TEST(SerialPort, SaysWhyAPortCannotBeOpened) {
  const TemporaryDirectory directory;
  const std::string missing = directory / "none", file = directory / "file";
  EXPECT_EQ(refusal(missing), missing + ": cannot be opened: No such file or directory");
  EXPECT_EQ(refusal(directory.path()), directory.path() + ": cannot be opened: Is a directory");
  std::ofstream(file) << "text";
  EXPECT_EQ(refusal(file), file + ": not a serial port");
  EXPECT_EQ(refusal("/dev/null"), "/dev/null: not a serial port");
  ASSERT_EQ(::unlink(file.c_str()), 0);
}

TEST(SerialPort, SaysThatThePermissionIsMissing) {
  const AsNobody nobody;
  PseudoTerminal device;
  ASSERT_EQ(::chmod(device.path().c_str(), 0), 0);
  EXPECT_EQ(refusal(device.path()), device.path() + ": cannot be opened: Permission denied");
}

TEST(SerialPort, RefusesASecondDriver) {
  PseudoTerminal device;
  {
    SerialPort driver(device.path());
    EXPECT_EQ(refusal(device.path()), device.path() + ": another program has it open");
  }
  EXPECT_EQ(refusal(device.path()), test::kNotRefused);
}

// TIOCEXCL would, for everybody but root.
TEST(SerialPort, AKilledDriverDoesNotKeepOutItsSuccessor) {
  const AsNobody nobody;
  PseudoTerminal device;
  const pid_t child = ::fork();
  if (child == 0) {
    const SerialPort driver(device.path());
    ::kill(::getpid(), SIGKILL);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL);
  EXPECT_EQ(refusal(device.path()), test::kNotRefused);
}

TEST(SerialPort, NoticesThatTheOtherEndIsGone) {
  auto device = std::make_unique<PseudoTerminal>();
  SerialPort reader(device->path());
  device.reset();
  std::uint8_t byte = 0;
  EXPECT_FALSE(reader.closed());
  errno = EAGAIN;  // of some call before
  EXPECT_EQ(reader.read(&byte, 1), 0u);
  EXPECT_TRUE(reader.closed());
  EXPECT_FALSE(reader.write({&byte, 1}));

  device = std::make_unique<PseudoTerminal>();
  SerialPort writer(device->path());
  device.reset();
  EXPECT_FALSE(writer.write({&byte, 1}));
  EXPECT_TRUE(writer.closed());
  EXPECT_EQ(writer.read(&byte, 1), 0u);
}

TEST(SerialPort, DropsWhatCameBeforeItWasOpened) {
  PseudoTerminal device;
  const ByteVector old = {1, 2, 3}, fresh = {4, 5};
  {
    SerialPort first(device.path());
    ASSERT_TRUE(device.write(view(old)));
    pollfd state{first.descriptor(), POLLIN, 0};
    ASSERT_EQ(::poll(&state, 1, kLongEnough), 1);
  }
  SerialPort second(device.path());
  ASSERT_TRUE(device.write(view(fresh)));
  EXPECT_EQ(readFrom(second, fresh.size()), fresh);
}

TEST(SerialPort, WritesAllOrNothingOnALineThatIsFull) {
  PseudoTerminal device;
  SerialPort driver(device.path());
  constexpr std::size_t kPiece = 20;  // bytes
  ByteVector accepted;
  int refused = 0;
  for (int i = 0; i < 20000 && refused < 3; ++i) {
    const ByteVector frame = ByteVector(kPiece, static_cast<std::uint8_t>(i));
    if (driver.write(view(frame))) {
      EXPECT_EQ(refused, 0) << "nobody has read since";
      append(accepted, frame);
    } else {
      ++refused;
    }
  }
  ASSERT_EQ(refused, 3);
  EXPECT_FALSE(driver.closed());
  // The end of the last one may still have to be written; it goes before the next.
  ByteVector arrived = readFrom(device, accepted.size() - kPiece);
  const ByteVector last = ByteVector(kPiece, 99);
  ASSERT_TRUE(driver.write(view(last)));
  append(accepted, last);
  append(arrived, readFrom(device, accepted.size() - arrived.size()));
  EXPECT_EQ(arrived, accepted);
}

TEST(SerialPort, RefusesMoreThanTheLongestWrite) {
  PseudoTerminal device;
  SerialPort driver(device.path());
  const ByteVector bytes(LineDescriptor::kLongestWrite + 1);
  EXPECT_FALSE(driver.write(view(bytes)));
  EXPECT_FALSE(driver.closed());
  EXPECT_TRUE(driver.write({bytes.data(), bytes.size() - 1}));
}

TEST(PseudoTerminal, IsSilentWhileNobodyHasTheOtherEndOpen) {
  PseudoTerminal device;
  const ByteVector lost = {1, 2, 3}, bytes = {4, 5, 6};
  std::uint8_t byte = 0;
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(device.read(&byte, 1), 0u);
    EXPECT_TRUE(device.write(view(lost)));  // into a wire that leads nowhere
    SerialPort driver(device.path());
    ASSERT_TRUE(device.write(view(bytes)));
    EXPECT_EQ(readFrom(driver, bytes.size()), bytes);
    ASSERT_TRUE(driver.write(view(bytes)));
    EXPECT_EQ(readFrom(device, bytes.size()), bytes);
  }
}

TEST(PseudoTerminal, NeverFillsUpWhileNobodyHasTheOtherEndOpen) {
  PseudoTerminal device;
  const ByteVector lost(1000, 1), bytes = {4, 5, 6};
  for (int i = 0; i < 2; ++i) {  // nobody yet, and nobody any more
    for (int k = 0; k < 100; ++k) EXPECT_TRUE(device.write(view(lost))) << i;
    SerialPort driver(device.path());
    ASSERT_TRUE(device.write(view(bytes)));
    EXPECT_EQ(readFrom(driver, bytes.size()), bytes);
  }
}

TEST(PseudoTerminal, ForgetsWhatADriverThatIsGoneHasNotRead) {
  PseudoTerminal device;
  const ByteVector lost(1000, 1), bytes = {4, 5, 6};
  {
    SerialPort driver(device.path());
    while (device.write(view(lost))) {
    }
  }
  EXPECT_TRUE(device.write(view(lost)));
  SerialPort driver(device.path());
  ASSERT_TRUE(device.write(view(bytes)));
  EXPECT_EQ(readFrom(driver, bytes.size()), bytes);
}

TEST(PseudoTerminal, IsRawAlsoForAProgramThatSetsNothing) {
  PseudoTerminal device;
  const LineDescriptor plain(::open(device.path().c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK));
  termios settings{};
  ASSERT_EQ(::tcgetattr(plain.get(), &settings), 0);
  EXPECT_EQ(settings.c_lflag & (ICANON | ECHO | ISIG), 0u);
}

TEST(PseudoTerminal, MakesALinkAndRemovesIt) {
  const TemporaryDirectory directory;
  const std::string link = directory / "exoskeleton";
  {
    PseudoTerminal device(link);
    SerialPort driver(link);
    const ByteVector bytes = everyByte();
    ASSERT_TRUE(driver.write(view(bytes)));
    EXPECT_EQ(readFrom(device, bytes.size()), bytes);
  }
  EXPECT_FALSE(exists(link));
}

TEST(PseudoTerminal, ReplacesALinkThatADeadEmulatorHasLeft) {
  const TemporaryDirectory directory;
  const std::string link = directory / "exoskeleton";
  ASSERT_EQ(::symlink("/nowhere", link.c_str()), 0);
  std::ofstream(link + ".lock").close();
  const PseudoTerminal device(link);
  EXPECT_EQ(refusal(link), test::kNotRefused);
}

TEST(PseudoTerminal, DoesNotTakeTheLinkOfAnother) {
  const TemporaryDirectory directory;
  const std::string link = directory / "exoskeleton";
  {
    const PseudoTerminal first(link);
    try {
      const PseudoTerminal second(link);
      ADD_FAILURE() << "the link was taken";
    } catch (const std::runtime_error& error) {
      EXPECT_EQ(error.what(), link +
                                  ": is the link of another emulator, which runs: give this one "
                                  "another, or start it in another namespace");
    }
    EXPECT_EQ(std::filesystem::read_symlink(link), first.path());
  }
  EXPECT_FALSE(exists(link + ".lock"));
  const PseudoTerminal third(link);
  EXPECT_EQ(std::filesystem::read_symlink(link), third.path());
}

TEST(PseudoTerminal, RemovesOnlyItsOwnLink) {
  const TemporaryDirectory directory;
  const std::string link = directory / "exoskeleton";
  const PseudoTerminal other;
  {
    const PseudoTerminal device(link);
    ASSERT_EQ(::unlink(link.c_str()), 0);
    ASSERT_EQ(::symlink(other.path().c_str(), link.c_str()), 0);
  }
  EXPECT_EQ(refusal(link), test::kNotRefused) << "leads to the other";
  ::unlink(link.c_str());
}

TEST(PseudoTerminal, DoesNotReplaceAFile) {
  const TemporaryDirectory directory;
  const std::string file = directory / "file";
  std::ofstream(file) << "text";
  try {
    PseudoTerminal device(file);
    ADD_FAILURE() << "replaced";
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(std::string(error.what()), file + ": exists and is not a symbolic link, so it stays");
  }
  EXPECT_TRUE(exists(file));
  ASSERT_EQ(::unlink(file.c_str()), 0);
}

TEST(PseudoTerminal, SaysWhyALinkCannotBeMade) {
  const TemporaryDirectory directory;
  const std::string link = directory / "none/exoskeleton";
  try {
    PseudoTerminal device(link);
    ADD_FAILURE() << "made";
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(std::string(error.what()),
              link + ": cannot be made a symbolic link: No such file or directory");
  }
}

}  // namespace
}  // namespace haptex::serial::test_serial_port
