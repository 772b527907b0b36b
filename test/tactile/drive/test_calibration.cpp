// Calibration files, and the drive that they make of amplitudes.
#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "../fixtures.h"
#include "../temporary_file.h"
#include "haptex/tactile/drive/calibration.h"

namespace haptex::tactile::test_calibration {
namespace {

using base::Finger;

std::string list(const std::string& value, int count) {
  std::string text = "[";
  for (int i = 0; i < count; ++i) text += (i > 0 ? ", " : "") + value;
  return text + "]";
}

std::string fileWith(const std::string& slow, const std::string& largest = "100") {
  const std::string array = "\n  full_displacement_40: " + slow +
                            "\n  full_displacement_320: 90\n  largest_displacement: " + largest;
  return "source: a test\nindex:" + array + "\nthumb:" + array + "\n";
}

Calibration load(const std::string& text) {
  const TemporaryFile file(".calibration.yaml");
  file.write(text);
  return loadCalibration(file.path());
}

std::string refusalOf(const std::string& text) {
  return test::refusalOf([&] { load(text); });
}

TEST(Calibration, TheShippedFileIsRead) {
  const Calibration calibration =
      loadCalibration(std::string(HAPTEX_CONFIG_DIRECTORY) + "/tactile/representative.yaml");
  EXPECT_DOUBLE_EQ(calibration[Finger::kThumb][23].full_displacement[k320], 90e-6);
  EXPECT_DOUBLE_EQ(calibration[Finger::kIndex][0].largest_displacement, 100e-6);
}

TEST(Calibration, ANumberIsForAllContactorsAndAListForEach) {
  EXPECT_DOUBLE_EQ(load(fileWith("80"))[Finger::kIndex][7].full_displacement[k40], 80e-6);
  std::string each = list("80", kContactors - 1);
  each.back() = ',';
  const Calibration calibration = load(fileWith(each + " 81]"));
  EXPECT_DOUBLE_EQ(calibration[Finger::kThumb][22].full_displacement[k40], 80e-6);
  EXPECT_DOUBLE_EQ(calibration[Finger::kThumb][23].full_displacement[k40], 81e-6);
}

TEST(Calibration, RefusalsNameKeyValueAndWhatIsAllowed) {
  const std::string too_short = list("80", 1);
  for (const std::string& value :
       std::vector<std::string>{"0", "-1", ".nan", ".inf", "1001", "many", too_short}) {
    const std::string refused = refusalOf(fileWith(value));
    EXPECT_NE(refused.find("index.full_displacement_40"), std::string::npos) << value << refused;
  }
  EXPECT_NE(refusalOf(fileWith("1001")).find("from 0.01 to 1000"), std::string::npos);
  EXPECT_NE(refusalOf(fileWith(list("80", 23))), test::kNotRefused);
  EXPECT_NE(refusalOf(fileWith("80", "-1")).find("index.largest_displacement"), std::string::npos);
  EXPECT_NE(refusalOf("index: 3\n"), test::kNotRefused);
  EXPECT_NE(refusalOf("source: a test\nindex: 3\nthumb: 4\n"), test::kNotRefused);
}

TEST(Calibration, DriveIsTheInverseOfWhatContactorsDo) {
  const Calibration calibration = load(fileWith("80"));
  ArrayAmplitudes asked{};
  asked[5] = {30e-6, 12e-6};
  const ArrayDrive drive = driveFor(asked, calibration[Finger::kIndex]);
  EXPECT_DOUBLE_EQ(drive[5][k40], 30.0 / 80.0);
  EXPECT_DOUBLE_EQ(drive[5][k320], 12.0 / 90.0);
  EXPECT_EQ(drive[4], (PerChannel<double>{0.0, 0.0}));
  EXPECT_NEAR(amplitudesOf(drive, calibration[Finger::kIndex])[5][k40], 30e-6, 1e-18);
}

TEST(Calibration, LimitsReduceBothChannelsByTheSameFactor) {
  const Calibration calibration = load(fileWith("80", "40"));
  ArrayAmplitudes asked{};
  asked[0] = {60e-6, 20e-6};  // twice what it may
  asked[1] = {30e-6, 10e-6};  // just what it may
  const ArrayAmplitudes done =
      amplitudesOf(driveFor(asked, calibration[Finger::kIndex]), calibration[Finger::kIndex]);
  for (const int i : {0, 1}) {
    EXPECT_NEAR(done[i][k40], 30e-6, 1e-15);
    EXPECT_NEAR(done[i][k320], 10e-6, 1e-15);
  }
  // Full drive is a limit of its own.
  const Calibration weak = load(fileWith("10"));
  ArrayAmplitudes strong{};
  strong[0] = {20e-6, 45e-6};
  const ArrayDrive drive = driveFor(strong, weak[Finger::kIndex]);
  EXPECT_DOUBLE_EQ(drive[0][k40] + drive[0][k320], 1.0);
  EXPECT_DOUBLE_EQ(drive[0][k40], 4.0 * drive[0][k320]);
}

TEST(Calibration, ALimitOfZeroSwitchesAContactorOff) {
  const Calibration calibration = load(fileWith("80", "0"));
  ArrayAmplitudes asked{};
  asked[3] = {1e-6, 0.0};
  EXPECT_EQ(driveFor(asked, calibration[Finger::kIndex])[3], (PerChannel<double>{0.0, 0.0}));
  EXPECT_EQ(driveFor({}, calibration[Finger::kIndex])[3], (PerChannel<double>{0.0, 0.0}));
}

}  // namespace
}  // namespace haptex::tactile::test_calibration
