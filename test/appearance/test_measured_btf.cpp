#include <gtest/gtest.h>
#include <turbojpeg.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "../refusal.h"
#include "../temporary_directory.h"
#include "haptex/appearance/btf_file.h"
#include "haptex/appearance/measured_btf.h"
#include "haptex/appearance/srgb.h"

namespace haptex::appearance {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;

constexpr int kColumns = 8, kRows = 4;

std::uint8_t srgb(double linear) {
  return static_cast<std::uint8_t>(std::lround(255.0 * srgbOfLinear(linear)));
}

std::string jpeg(int columns, int rows, double upper, double lower) {
  std::vector<unsigned char> pixels;
  for (int row = 0; row < rows; ++row) {
    pixels.insert(pixels.end(), std::size_t{3} * columns, srgb(row < rows / 2 ? upper : lower));
  }
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  const tjhandle encoder = tjInitCompress();
  tjCompress2(encoder, pixels.data(), columns, 0, rows, TJPF_RGB, &bytes, &size, TJSAMP_444, 100,
              0);
  std::string text(reinterpret_cast<const char*>(bytes), size);
  tjFree(bytes);
  tjDestroy(encoder);
  return text;
}

void write(const fs::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

fs::path nameOf(const Vector3d& view, const Vector3d& light) {
  const auto degrees = [](double radians) {
    return (static_cast<int>(std::lround(radians * 180.0 / M_PI)) + 360) % 360;
  };
  const auto polar = [&](const Vector3d& of) {
    return degrees(std::atan2(of.head<2>().norm(), of.z()));
  };
  const auto azimuth = [&](const Vector3d& of) { return degrees(std::atan2(of.y(), of.x())); };
  std::array<char, 80> folder{}, file{};
  std::snprintf(folder.data(), folder.size(), "tv%03d_pv%03d", polar(view), azimuth(view));
  std::snprintf(file.data(), file.size(), "00042 tl%03d pl%03d tv%03d pv%03d.jpg", polar(light),
                azimuth(light), polar(view), azimuth(view));
  return fs::path(folder.data()) / file.data();
}

/// Pictures of a matt sample: half of it, where warp coordinates are large, of 0.8 and half of 0.2.
class MeasuredSample : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    sample_ = new test::TemporaryDirectory;
    for (const Vector3d& light : sampledDirections()) {
      const std::string picture = jpeg(kColumns, kRows, 0.8 * light.z(), 0.2 * light.z());
      for (const Vector3d& view : sampledDirections()) {
        const fs::path path = root() / nameOf(view, light);
        fs::create_directories(path.parent_path());
        write(path, picture);
      }
    }
  }
  static void TearDownTestSuite() { delete sample_; }
  static fs::path root() { return sample_->path(); }
  static fs::path normalPicture() { return root() / nameOf({0, 0, 1}, {0, 0, 1}); }

  /// What is said where another file stands in the place of one, after its name.
  static std::string refusalWith(const std::string& bytes) {
    const fs::path path = root() / nameOf(sampledDirections()[5], sampledDirections()[30]);
    fs::rename(path, root() / "aside");
    write(path, bytes);
    const std::string refusal =
        test::refusalOf<std::exception>([&] { MeasuredImages images(root()); });
    fs::rename(root() / "aside", path);
    EXPECT_EQ(refusal.find(path.string()), 0u) << refusal;
    return refusal.substr(std::min(refusal.size(), path.string().size()));
  }

 private:
  static inline test::TemporaryDirectory* sample_ = nullptr;
};

TEST_F(MeasuredSample, IsWhatWasPhotographed) {
  const MeasuredImages images(root());
  EXPECT_EQ(images.columns(), kColumns);
  EXPECT_EQ(images.rows(), kRows);
  const Btf btf = makeBtf(images, 0.016, {12, 1, 12});
  EXPECT_LT(compressionError(btf, images), 1e-3);
  for (const Vector3d& view : {Vector3d(0, 0, 1), Vector3d(0.3, 0.1, 1), Vector3d(-1, 0.5, 0.8)}) {
    for (const Vector3d& light : {Vector3d(0, 0, 1), Vector3d(0.5, -0.3, 1)}) {
      const Btf::Pair pair = btf.pair(view, light);
      const double cosine = light.normalized().z();
      for (const double warp : {0.001, 0.007}) {
        const double albedo = warp > 0.004 ? 0.8 : 0.2;
        EXPECT_NEAR(pair.at({0.003, warp})[1], albedo * cosine / M_PI, 0.03 * albedo)
            << view.transpose() << ", " << light.transpose() << ", warp " << warp;
      }
    }
  }
}

TEST_F(MeasuredSample, IsReadFromItsFile) {
  const Btf btf = makeBtf(MeasuredImages(root()), 0.016, {12, 1, 12});
  const std::string path = (root() / "sample.btf").string();
  writeBtf(btf, path);
  const Btf read = readBtf(path);
  EXPECT_EQ(read.surface().size(), Eigen::Vector2d(0.016, 0.008));
  const Vector3d direction(0.2, 0.3, 1.0);
  EXPECT_EQ(read.pair(direction, direction).at({0.001, 0.001}),
            btf.pair(direction, direction).at({0.001, 0.001}));
}

TEST_F(MeasuredSample, NamesThePairThatHasNoPicture) {
  fs::rename(normalPicture(), root() / "elsewhere");
  EXPECT_EQ(test::refusalOf([&] { MeasuredImages images(root()); }),
            root().string() +
                ": of 6561 pairs of directions 1 have no picture, first that of tl000 pl000 "
                "tv000 pv000.jpg");
  fs::rename(root() / "elsewhere", normalPicture());
}

TEST_F(MeasuredSample, RefusesOtherPictures) {
  EXPECT_EQ(refusalWith(jpeg(8, 8, 0.5, 0.5)), ": the picture has 8 x 8 texels, the others 8 x 4");
  EXPECT_EQ(refusalWith(jpeg(300, 8, 0.5, 0.5)),
            ": the picture has 300 x 8 texels: allowed are 4 to 256 along each side");
  EXPECT_NE(refusalWith("no picture").find("Not a JPEG file"), std::string::npos);
  EXPECT_EQ(refusalWith("").find(": "), 0u);
}

TEST_F(MeasuredSample, RefusesDirectionsThatAreNotSampled) {
  for (const char* name : {"1 tl022 pl000 tv000 pv000.jpg", "1 tl015 pl010 tv000 pv000.jpg"}) {
    write(root() / name, jpeg(kColumns, kRows, 0.5, 0.5));
    EXPECT_NE(test::refusalOf([&] { MeasuredImages images(root()); }).find("the light is at"),
              std::string::npos)
        << name;
    fs::remove(root() / name);
  }
  write(root() / "1 tl000 pl000 tv000 pv000.jpg", jpeg(kColumns, kRows, 0.5, 0.5));
  EXPECT_NE(test::refusalOf([&] { MeasuredImages images(root()); }).find("same pair"),
            std::string::npos);
  fs::remove(root() / "1 tl000 pl000 tv000 pv000.jpg");
}

TEST_F(MeasuredSample, RefusesAWidthThatIsNone) {
  const MeasuredImages images(root());
  for (const double width : {0.0, -1.0, std::nan("")}) {
    EXPECT_THROW(makeBtf(images, width, {12, 1, 12}), std::invalid_argument);
  }
  EXPECT_THROW(MeasuredImages("/no/such/folder"), std::runtime_error);
}

}  // namespace
}  // namespace haptex::appearance
