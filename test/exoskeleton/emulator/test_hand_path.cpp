#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <ostream>
#include <stdexcept>
#include <string>

#include "../../refusal.h"
#include "haptex/exoskeleton/emulator/hand_path.h"

namespace haptex::exoskeleton::test_hand_path {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;

class PathFile : public testing::Test {
 protected:
  PathFile()
      : path_(fs::path(testing::TempDir()) /
              ("haptex_path_" + std::to_string(getpid()) + ".yaml")) {}
  ~PathFile() override { fs::remove(path_); }

  HandPath load(const std::string& text) const {
    std::ofstream(path_) << text;
    return loadHandPath(path_.string());
  }

  std::string refusalOf(const std::string& text) const {
    return test::refusalOf([&] { load(text); });
  }

  fs::path path_;
};

const std::string kValid = R"(repeat: true
key_frames:
  - {time: 0, index: [0.1, 0, 0], thumb: [0, 0.1, 0], position: [1, 2, 3]}
  - {time: 2, index: [0.2, 0, 0], thumb: [0, 0.3, 0], position: [1, 2, 5], rpy: [0, 0, 1]}
  - {time: 3, index: [0.1, 0, 0], thumb: [0, 0.1, 0], position: [1, 2, 3]}
)";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << "the test replaces what is not there: " << from;
  return text.replace(at, from.size(), to);
}

TEST_F(PathFile, TellsThePhaseThatBeganLast) {
  EXPECT_EQ(load(kValid).phases(), std::vector<std::string>{""});
  const std::string named = replaced(replaced(kValid, "{time: 2,", "{time: 2, phase: turn,"),
                                     "{time: 3,", "{time: 3, phase: back,");
  const HandPath path = load(named);
  EXPECT_EQ(path.phases(), (std::vector<std::string>{"", "turn", "back"}));
  EXPECT_EQ(path.at(0.0).phase, 0);
  EXPECT_EQ(path.at(1.999).phase, 0);
  EXPECT_EQ(path.at(2.0).phase, 1);
  EXPECT_EQ(path.at(2.999).phase, 1);
  EXPECT_EQ(path.at(3.0).phase, 0);  // it repeats: this is the start again
  const HandPath once = load(replaced(named, "repeat: true", "repeat: false"));
  EXPECT_EQ(once.at(3.0).phase, 2);
  EXPECT_EQ(once.at(4.0).phase, 2);
  EXPECT_NE(refusalOf(replaced(kValid, "{time: 2,", "{time: 2, phase: \"\",")).find("phase"),
            std::string::npos);
}

TEST_F(PathFile, MeetsItsKeyFrames) {
  const HandPath path = load(kValid);
  EXPECT_EQ(path.duration(), 3.0);
  EXPECT_TRUE(path.repeats());
  const HandPlace start = path.at(0.0), turn = path.at(2.0);
  EXPECT_EQ(start.fingertips[Finger::kIndex], Vector3d(0.1, 0, 0));
  EXPECT_EQ(start.fingertips[Finger::kThumb], Vector3d(0, 0.1, 0));
  EXPECT_EQ(start.hand_base.translation(), Vector3d(1, 2, 3));
  EXPECT_TRUE(start.hand_base.linear().isIdentity(1e-15));
  EXPECT_EQ(turn.fingertips[Finger::kIndex], Vector3d(0.2, 0, 0));
  EXPECT_EQ(turn.fingertips[Finger::kThumb], Vector3d(0, 0.3, 0));
  EXPECT_EQ(turn.hand_base.translation(), Vector3d(1, 2, 5));
  EXPECT_TRUE(turn.hand_base.linear().isApprox(
      Eigen::AngleAxisd(1.0, Vector3d::UnitZ()).toRotationMatrix(), 1e-14));
}

TEST_F(PathFile, TurnsAboutTheFixedAxesAsUrdfDoes) {
  const HandPath path = load(
      "key_frames: [{time: 0, index: [0, 0, 0], thumb: [0, 0, 0], position: [0, 0, 0], "
      "rpy: [0.1, 0.2, 0.3]}]\n");
  const Eigen::Matrix3d expected =
      (Eigen::AngleAxisd(0.3, Vector3d::UnitZ()) * Eigen::AngleAxisd(0.2, Vector3d::UnitY()) *
       Eigen::AngleAxisd(0.1, Vector3d::UnitX()))
          .toRotationMatrix();
  EXPECT_TRUE(path.at(0.0).hand_base.linear().isApprox(expected, 1e-14));
}

TEST_F(PathFile, MovesSmoothlyBetweenKeyFrames) {
  const HandPath path = load(kValid);
  const HandPlace half = path.at(1.0);
  EXPECT_TRUE(half.fingertips[Finger::kIndex].isApprox(Vector3d(0.15, 0, 0), 1e-14));
  EXPECT_TRUE(half.hand_base.translation().isApprox(Vector3d(1, 2, 4), 1e-14));
  EXPECT_NEAR(Eigen::AngleAxisd(half.hand_base.linear()).angle(), 0.5, 1e-14);
  // Minimum jerk: at rest in the key frames, 1.875 times the mean speed in the middle, and the
  // acceleration nowhere above 10 / sqrt(3) times distance over squared time.
  const auto x = [&](double t) { return path.at(t).fingertips[Finger::kIndex].x(); };
  const double h = 1e-4;
  double fastest = 0.0, hardest = 0.0;
  for (double t = 2 * h; t < 2.0 - 2 * h; t += h) {
    fastest = std::max(fastest, (x(t + h) - x(t - h)) / (2 * h));
    hardest = std::max(hardest, std::abs(x(t + h) - 2 * x(t) + x(t - h)) / (h * h));
  }
  EXPECT_NEAR(fastest, 1.875 * 0.05, 1e-6);
  EXPECT_NEAR(hardest, 10.0 / std::sqrt(3.0) * 0.1 / 4.0, 1e-4);
  EXPECT_NEAR((x(h) - x(0.0)) / h, 0.0, 1e-8);
}

TEST_F(PathFile, RepeatsOnlyIfAsked) {
  const HandPath path = load(kValid);
  EXPECT_TRUE(path.at(3.0 * 7 + 1.0).hand_base.isApprox(path.at(1.0).hand_base, 1e-12));
  EXPECT_EQ(path.at(-1.0).fingertips[Finger::kIndex], Vector3d(0.1, 0, 0));
  for (const char* repeat : {"", "repeat: false\n"}) {
    const HandPath once = load(replaced(replaced(kValid, "repeat: true\n", repeat),
                                        "time: 3, index: [0.1", "time: 3, index: [0.4"));
    EXPECT_FALSE(once.repeats());
    EXPECT_EQ(once.at(100.0).fingertips[Finger::kIndex], Vector3d(0.4, 0, 0));
  }
}

TEST_F(PathFile, NamesTheFileThatIsNotYaml) {
  try {
    load("repeat: true\nkey_frames: [\n");
    ADD_FAILURE() << "not refused";
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(std::string(error.what()).rfind(path_.string() + ": line ", 0), 0u) << error.what();
  }
  EXPECT_THROW(loadHandPath(path_.string() + ".none"), std::runtime_error);
}

struct Refusal {
  std::string name;
  std::string from, to;   // the change that makes the valid path invalid
  std::string complaint;  // after the path of the file
};

void PrintTo(const Refusal& refusal, std::ostream* stream) { *stream << refusal.name; }

class PathFileRefuses : public PathFile, public testing::WithParamInterface<Refusal> {};

TEST_P(PathFileRefuses, NamingFileKeyValueAndWhatIsAllowed) {
  EXPECT_EQ(refusalOf(replaced(kValid, GetParam().from, GetParam().to)),
            path_.string() + ": " + GetParam().complaint);
}

INSTANTIATE_TEST_SUITE_P(
    Values, PathFileRefuses,
    testing::Values(
        Refusal{"UnknownKey", "repeat: true", "loop: true",
                "loop: unknown key, allowed here: key_frames, repeat"},
        Refusal{"MissingKeyFrames", kValid.substr(kValid.find("key_frames")), "",
                "the key 'key_frames' is missing, required here: key_frames"},
        Refusal{"UnknownKeyOfAFrame", "time: 2, ", "time: 2, speed: 1, ",
                "key_frames[1].speed: unknown key, allowed here: time, index, thumb, position, "
                "rpy, phase"},
        Refusal{"MissingThumb", "thumb: [0, 0.3, 0], ", "",
                "key_frames[1]: the key 'thumb' is missing, required here: time, index, thumb, "
                "position"},
        Refusal{"RepeatNotABoolean", "repeat: true", "repeat: 1",
                "repeat: '1' must be one of true, false"},
        Refusal{"FramesNotAList", kValid.substr(kValid.find("key_frames")), "key_frames: 3\n",
                "key_frames: '3' must be a list"},
        Refusal{"NoFrames", kValid.substr(kValid.find("key_frames")), "key_frames: []\n",
                "key_frames: a hand path needs a key frame"},
        Refusal{"NotFinite", "[0.2, 0, 0]", "[.nan, 0, 0]",
                "key_frames[1].index[0]: '.nan' must be a finite number"},
        Refusal{"InfiniteTime", "time: 2", "time: .inf",
                "key_frames[1].time: '.inf' must be a finite number"},
        Refusal{"NotAVector", "[1, 2, 5]", "[1, 2]",
                "key_frames[1].position: a list of 2 must be a list of 3"},
        Refusal{"FingertipTooFar", "[0.2, 0, 0]", "[0, 0, -1.1]",
                "key_frames[1].index[2]: '-1.1' must be from -1 to 1 m"},
        Refusal{"HandTooFar", "[1, 2, 5]", "[1, 101, 5]",
                "key_frames[1].position[1]: '101' must be from -100 to 100 m"},
        Refusal{"FirstTimeNotZero", "time: 0", "time: 0.5",
                "key_frames[0].time: '0.5' the first time must be 0"},
        Refusal{"NegativeTime", "time: 0", "time: -1",
                "key_frames[0].time: '-1' must be from 0 to 3600 s"},
        Refusal{"TimeTooLong", "time: 3", "time: 3601",
                "key_frames[2].time: '3601' must be from 0 to 3600 s"},
        Refusal{"TimesNotIncreasing", "time: 3", "time: 2",
                "key_frames[2].time: '2' must be later than the key frame before"},
        Refusal{"EndsElsewhere", "time: 3, index: [0.1", "time: 3, index: [0.101",
                "key_frames: a hand path that repeats must end where it starts"},
        Refusal{"RepeatsNothing", kValid.substr(kValid.find("  - {time: 2")), "",
                "key_frames: a hand path that repeats needs two key frames"}),
    [](const auto& info) { return info.param.name; });

TEST(HandPath, RefusesKeyFramesThatAreNoSequence) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(HandPath({}, false), std::invalid_argument);
  EXPECT_THROW(HandPath({{nan, {}}}, false), std::invalid_argument);
  EXPECT_THROW(HandPath({{1.0, {}}}, false), std::invalid_argument);
  EXPECT_THROW(HandPath({{0.0, {}}, {nan, {}}}, false), std::invalid_argument);
  EXPECT_THROW(HandPath({{0.0, {}}, {0.0, {}}}, false), std::invalid_argument);
  EXPECT_THROW(HandPath({{0.0, {}}}, true), std::invalid_argument);
  HandPlace elsewhere;
  elsewhere.hand_base.translation().z() = 0.1;
  EXPECT_THROW(HandPath({{0.0, {}}, {1.0, elsewhere}}, true), std::invalid_argument);
  EXPECT_NO_THROW(HandPath({{0.0, {}}, {1.0, elsewhere}}, false));
}

}  // namespace
}  // namespace haptex::exoskeleton::test_hand_path
