#include <gtest/gtest.h>
#include <haptex/Tactile.h>
#include <rosbag/bag.h>
#include <sndfile.h>
#include <std_msgs/Header.h>

#include <cmath>
#include <complex>
#include <filesystem>
#include <fstream>
#include <limits>

#include "../../refusal.h"
#include "../../temporary_directory.h"
#include "haptex/nodes/tactile_renderer/sound_request.h"
#include "haptex/nodes/tactile_renderer/tactile_recording.h"

namespace haptex::nodes::test_tactile_sound {
namespace {

namespace fs = std::filesystem;

struct Directory : test::TemporaryDirectory {
  std::string file(const char* name) const { return path() + "/" + name; }
};

/// Samples as displacements, m.
std::vector<double> readSound(const std::string& path) {
  SF_INFO info{};
  SNDFILE* const file = sf_open(path.c_str(), SFM_READ, &info);
  EXPECT_NE(file, nullptr) << path;
  if (file == nullptr) return {};
  EXPECT_EQ(info.samplerate, 44100);
  EXPECT_EQ(info.channels, 1);
  EXPECT_EQ(info.format, SF_FORMAT_WAV | SF_FORMAT_PCM_16);
  std::vector<short> samples(info.frames);
  EXPECT_EQ(sf_read_short(file, samples.data(), info.frames), info.frames);
  sf_close(file);
  std::vector<double> displacements;
  for (const short sample : samples)
    displacements.push_back(tactile::kFullScale * sample / 32767.0);
  return displacements;
}

/// Amplitude of a frequency in samples [begin, end), whole periods of it.
double amplitudeAt(double frequency, const std::vector<double>& samples, std::size_t begin,
                   std::size_t end) {
  std::complex<double> sum = 0.0;
  for (std::size_t n = begin; n < end; ++n) {
    sum += samples.at(n) * std::polar(1.0, -2.0 * M_PI * frequency * n / 44100.0);
  }
  return 2.0 * std::abs(sum) / static_cast<double>(end - begin);
}

/// Rounding to whole numbers is half of this at most, and so is any line of its spectrum.
constexpr double kBit = tactile::kFullScale / 32767.0;  // m

TEST(WriteSound, HoldsBothVibrationsInMetresOfFullScale) {
  const Directory directory;
  const std::string path = directory.file("a.wav");
  const tactile::WrittenSound written =
      tactile::writeSound(path, tactile::ContactorSteps(41, {2e-5, 5e-6}));
  const std::vector<double> samples = readSound(path);
  // 41 steps, and one to come to rest.
  EXPECT_EQ(samples.size(), 46305u);
  EXPECT_EQ(written.samples, samples.size());
  EXPECT_EQ(written.clipped, 0u);
  EXPECT_GT(written.largest, 2e-5);
  // From the second step on: 40 steps are 44100 samples, whole periods of all four.
  const std::size_t begin = 1103, end = begin + 44100;
  EXPECT_NEAR(amplitudeAt(40.0, samples, begin, end), 2e-5, 0.5 * kBit);
  EXPECT_NEAR(amplitudeAt(320.0, samples, begin, end), 5e-6, 0.5 * kBit);
  EXPECT_LT(amplitudeAt(80.0, samples, begin, end), 0.5 * kBit);
  EXPECT_LT(amplitudeAt(640.0, samples, begin, end), 0.5 * kBit);
  EXPECT_LT(std::abs(samples.front()), kBit);
  EXPECT_LT(std::abs(samples.back()), 1e-3 * 2e-5 + kBit);  // a sample before the end of the fade
}

TEST(WriteSound, CountsWhatItClips) {
  const Directory directory;
  const tactile::WrittenSound written = tactile::writeSound(
      directory.file("a.wav"), tactile::ContactorSteps(20, {2.0 * tactile::kFullScale, 0.0}));
  // A sine is beyond half of its amplitude for two thirds of the time.
  const double settled = 19.0 / 21.0;
  EXPECT_GT(written.clipped, 0.66 * settled * written.samples);
  EXPECT_LT(written.clipped, 0.67 * written.samples);
  EXPECT_NEAR(written.largest, 2.0 * tactile::kFullScale, 1e-3 * tactile::kFullScale);
  double largest = 0.0;
  for (const double sample : readSound(directory.file("a.wav"))) {
    largest = std::max(largest, std::abs(sample));
  }
  EXPECT_DOUBLE_EQ(largest, tactile::kFullScale);
}

TEST(WriteSound, RefusesBadStepsAndPaths) {
  const Directory directory;
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity(), -1e-6}) {
    EXPECT_THROW(tactile::writeSound(directory.file("a.wav"), {{1e-6, 1e-6}, {0.0, bad}}),
                 std::invalid_argument);
  }
  EXPECT_FALSE(fs::exists(directory.file("a.wav")));
  EXPECT_THROW(tactile::writeSound(directory.file("a.wav"), tactile::ContactorSteps(144001)),
               std::invalid_argument);
  try {
    tactile::writeSound(directory.file("no/a.wav"), {{1e-6, 1e-6}});
    FAIL() << "written";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("no/a.wav: cannot be written"), std::string::npos);
  }
}

TEST(RubbedSteps, FollowTheStrokeAndRestAtItsEnds) {
  tactile::Surface surface;
  surface.small_scale.waves = {{2.0 * M_PI / 5e-4}, {0.0}, {0.5e-10}};  // 10 um, every 0.5 mm
  tactile::Rubbing rubbing;
  rubbing.speed = 0.02;  // 40 Hz
  rubbing.seconds = 2.0;
  const tactile::ContactorSteps steps = tactile::rubbedSteps(surface, rubbing);
  ASSERT_EQ(steps.size(), 80u);
  const double force = 0.5 / tactile::kContactors;
  const double exact = 1e-5 * force / (force + tactile::kHalfForce);
  for (const int middle : {20, 60}) {
    EXPECT_NEAR(steps[middle][tactile::k40], exact, 1e-12 * exact);
    EXPECT_NEAR(steps[middle][tactile::k320], exact * tactile::gain(tactile::k320, 40.0),
                1e-12 * exact);
  }
  for (const int end : {0, 39, 40, 79}) EXPECT_LT(steps[end][tactile::k40], 0.2 * exact);
  rubbing.angle = 0.5 * M_PI;  // along the grooves
  for (const auto& step : tactile::rubbedSteps(surface, rubbing))
    EXPECT_LT(step[tactile::k40], 1e-15);
}

TEST(RubbedSteps, RefuseWhatNoFingerDoes) {
  const auto refuse = [](double tactile::Rubbing::*member, double value) {
    tactile::Rubbing rubbing;
    rubbing.*member = value;
    EXPECT_THROW(tactile::rubbedSteps(tactile::Surface(), rubbing), std::invalid_argument) << value;
  };
  for (const double bad : {0.0, -1.0, 1e6, std::nan("")}) {
    refuse(&tactile::Rubbing::speed, bad);
    refuse(&tactile::Rubbing::force, bad);
    refuse(&tactile::Rubbing::seconds, bad);
  }
  refuse(&tactile::Rubbing::angle, std::numeric_limits<double>::infinity());
}

/// Writes a bag of messages whose amplitudes are 1 um plus their number, at the given times.
void record(const std::string& path, const std::string& topic, const std::vector<double>& stamps,
            rosbag::bagmode::BagMode mode = rosbag::bagmode::Write) {
  rosbag::Bag bag(path, mode);
  for (std::size_t i = 0; i < stamps.size(); ++i) {
    Tactile message;
    message.header.stamp = ros::Time(100.0 + stamps[i]);
    message.amplitudes_40.fill(0.0);
    message.amplitudes_320.fill(0.0);
    message.amplitudes_40[5] = 1.0 + static_cast<double>(i);
    message.amplitudes_320[5] = 0.5;
    bag.write(topic, message.header.stamp, message);
  }
}

TEST(RecordedSteps, AreTheMessagesInMetres) {
  const Directory directory;
  const std::string bag = directory.file("a.bag");
  record(bag, "/haptex/index/tactile", {0.0, 0.026, 0.049, 0.075});
  const tactile::ContactorSteps steps = recordedSteps(bag, "index", 5);
  ASSERT_EQ(steps.size(), 4u);
  for (int i = 0; i < 4; ++i) {
    EXPECT_DOUBLE_EQ(steps[i][tactile::k40], 1e-6 * (1 + i));
    EXPECT_DOUBLE_EQ(steps[i][tactile::k320], 0.5e-6);
  }
  EXPECT_EQ(recordedSteps(bag, "index", 6), tactile::ContactorSteps(4));
}

TEST(RecordedSteps, AreSilentWhereMessagesWereMissing) {
  const Directory directory;
  const std::string bag = directory.file("a.bag");
  record(bag, "index/tactile", {0.0, 0.025, 0.2, 0.225});
  const tactile::ContactorSteps steps = recordedSteps(bag, "index", 5);
  ASSERT_EQ(steps.size(), 10u);
  for (int i = 0; i < 10; ++i) {
    // A message holds for the step that follows it, as long as it is not older than that.
    EXPECT_EQ(steps[i][tactile::k40] > 0.0, i < 3 || i >= 8) << i;
  }
}

TEST(RecordedSteps, SayWhatIsInTheBagIfTheTopicIsNotClear) {
  const Directory directory;
  const std::string bag = directory.file("a.bag");
  record(bag, "/haptex/index/tactile", {0.0, 0.025});
  const auto refusal = [&](const std::string& finger) -> std::string {
    return test::refusalOf([&] { recordedSteps(bag, finger, 5); });
  };
  EXPECT_EQ(refusal("thumb"), bag +
                                  ": 0 topics end in thumb/tactile, one is needed; of "
                                  "haptex/Tactile there is /haptex/index/tactile");
  EXPECT_NE(refusal("dex"), test::kNotRefused);  // a finger is a whole name
  EXPECT_EQ(refusal("index"), test::kNotRefused);
  record(bag, "/other/index/tactile", {0.0}, rosbag::bagmode::Append);
  EXPECT_EQ(refusal("index"), bag +
                                  ": 2 topics end in index/tactile, one is needed; of "
                                  "haptex/Tactile there is /haptex/index/tactile "
                                  "/other/index/tactile");
}

TEST(RecordedSteps, RefuseFilesThatAreNoBagsAndContactorsThatAreNot) {
  const Directory directory;
  std::ofstream(directory.file("no.bag")) << "nothing";
  EXPECT_THROW(recordedSteps(directory.file("no.bag"), "index", 0), std::runtime_error);
  EXPECT_THROW(recordedSteps(directory.file("none.bag"), "index", 0), std::runtime_error);
  EXPECT_THROW(recordedSteps(directory.file("none.bag"), "index", 24), std::invalid_argument);
  const std::string bag = directory.file("long.bag");
  record(bag, "/index/tactile", {0.0, 4000.0});
  EXPECT_THROW(recordedSteps(bag, "index", 5), std::invalid_argument);
}

TEST(SoundRequest, ReadsAFabricWithItsStroke) {
  const SoundRequest request = parseSoundRequest(
      {"denim", "out.wav", "--speed", "30", "--angle", "90", "--force", "0.25", "--seconds", "2"});
  EXPECT_EQ(request.output, "out.wav");
  const auto& sound = std::get<FabricSound>(request.source);
  EXPECT_EQ(sound.fabric, "denim");
  EXPECT_DOUBLE_EQ(sound.rubbing.speed, 0.03);
  EXPECT_DOUBLE_EQ(sound.rubbing.angle, 0.5 * M_PI);
  EXPECT_DOUBLE_EQ(sound.rubbing.force, 0.25);
  EXPECT_DOUBLE_EQ(sound.rubbing.seconds, 2.0);
}

TEST(SoundRequest, ReadsARecording) {
  const SoundRequest request =
      parseSoundRequest({"--bag", "a.bag", "--finger", "thumb", "--contactor", "23", "out.wav"});
  const auto& sound = std::get<RecordedSound>(request.source);
  EXPECT_EQ(sound.bag, "a.bag");
  EXPECT_EQ(sound.finger, "thumb");
  EXPECT_EQ(sound.contactor, 23);
  EXPECT_EQ(request.output, "out.wav");
}

TEST(SoundRequest, NamesWhatIsWrong) {
  const auto refusal = [](const std::vector<std::string>& arguments) -> std::string {
    return test::refusalOf([&] { parseSoundRequest(arguments); });
  };
  EXPECT_EQ(refusal({}), "0 file names: it takes a fabric and a sound");
  EXPECT_EQ(refusal({"wool", "a.wav", "--speed"}), "--speed needs a value");
  EXPECT_EQ(refusal({"wool", "a.wav", "--speed", "fast"}), "--speed fast: allowed are numbers");
  EXPECT_EQ(refusal({"wool", "a.wav", "--speed", "3x"}), "--speed 3x: allowed are numbers");
  EXPECT_EQ(refusal({"wool", "a.wav", "--speed", "3", "--speed", "4"}), "--speed is there twice");
  EXPECT_EQ(refusal({"wool", "a.wav", "--volume", "3"}),
            "--volume is unknown or does not go with the rest");
  EXPECT_EQ(refusal({"--bag", "a.bag", "--contactor", "3", "a.wav"}), "--finger is missing");
  EXPECT_EQ(refusal({"--bag", "a", "--finger", "i", "--contactor", "24", "a.wav"}),
            "--contactor 24: allowed are whole numbers from 0 to 23");
  EXPECT_EQ(refusal({"--bag", "a", "--finger", "i", "--contactor", "1.5", "a.wav"}),
            "--contactor 1.5: allowed are whole numbers from 0 to 23");
  EXPECT_EQ(refusal({"--bag", "a", "--finger", "i", "--contactor", "3"}),
            "0 file names: with --bag it takes one, that of the sound");
  EXPECT_EQ(refusal({"--bag", "a", "--finger", "i", "--contactor", "3", "a.wav", "--speed", "3"}),
            "--speed is unknown or does not go with the rest");
}

}  // namespace
}  // namespace haptex::nodes::test_tactile_sound
