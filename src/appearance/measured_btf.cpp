#include "haptex/appearance/measured_btf.h"

#include <turbojpeg.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <optional>
#include <stdexcept>
#include <utility>

#include "haptex/appearance/srgb.h"
#include "haptex/base/file_size.h"
#include "haptex/base/require.h"

namespace haptex::appearance {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLargestPicture = std::size_t{1} << 20;  // bytes

struct Angles {
  int light_polar, light_azimuth, view_polar, view_azimuth;  // degrees
};

/// Of a file whose name ends as it should.
std::optional<Angles> anglesOf(const std::string& name) {
  const std::size_t begin = name.rfind("tl");
  if (begin == std::string::npos) return std::nullopt;
  Angles angles{};
  int end = 0;
  const int found =
      std::sscanf(name.c_str() + begin, "tl%3d pl%3d tv%3d pv%3d.jpg%n", &angles.light_polar,
                  &angles.light_azimuth, &angles.view_polar, &angles.view_azimuth, &end);
  if (found != 4 || end == 0 || begin + end != name.size()) return std::nullopt;
  return angles;
}

int directionOf(const std::string& path, const char* what, int polar, int azimuth) {
  const double theta = polar * M_PI / 180.0, phi = azimuth * M_PI / 180.0;
  const Eigen::Vector3d direction(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                                  std::cos(theta));
  const auto& sampled = sampledDirections();
  for (int i = 0; i < kDirections; ++i) {
    if ((sampled[i] - direction).norm() < 1e-6) return i;
  }
  base::refuse(
      path, ": the ", what, " is at ", polar, " degrees from the normal and ", azimuth,
      " around it: allowed are 0, 15, 30, 45, 60 and 75, and 1, 6, 12, 18, 20 and 24 evenly "
      "around");
}

std::string nameOf(int view, int light) {
  const auto degrees = [](double radians) {
    const int whole = static_cast<int>(std::lround(radians * 180.0 / M_PI));
    return whole < 0 ? whole + 360 : whole;
  };
  const auto angles = [&](int direction) {
    const Eigen::Vector3d& of = sampledDirections()[direction];
    return std::pair(degrees(std::acos(std::min(1.0, of.z()))),
                     degrees(std::atan2(of.y(), of.x())));
  };
  const auto [light_polar, light_azimuth] = angles(light);
  const auto [view_polar, view_azimuth] = angles(view);
  std::array<char, 64> name{};
  std::snprintf(name.data(), name.size(), "tl%03d pl%03d tv%03d pv%03d.jpg", light_polar,
                light_azimuth, view_polar, view_azimuth);
  return name.data();
}

/// From the bytes of sRGB.
std::array<float, 256> linearOfBytes() {
  std::array<float, 256> table{};
  for (int i = 0; i < 256; ++i) table[i] = static_cast<float>(linearOfSrgb(i / 255.0));
  return table;
}

/// Irradiance times 1/sr of the white of a picture, by the light.
std::array<float, kDirections> whites() {
  std::array<float, kDirections> table{};
  for (int light = 0; light < kDirections; ++light) {
    table[light] = static_cast<float>(M_PI * sampledDirections()[light].z());
  }
  return table;
}

struct DestroyDecoder {
  void operator()(void* decoder) const { tjDestroy(decoder); }
};

struct Picture {
  int columns = 0, rows = 0;
  std::vector<std::uint8_t> values;  // red, green and blue, row by row
};

Picture readJpeg(const std::string& path) {
  base::requireFileSize(path, kLargestPicture);
  std::ifstream file(path, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  if (!file) throw std::runtime_error(path + " cannot be read");
  const std::unique_ptr<void, DestroyDecoder> decoder(tjInitDecompress());
  if (!decoder) throw std::runtime_error("no decoder of JPEG files");
  const auto* data = reinterpret_cast<const unsigned char*>(bytes.data());
  Picture picture;
  int subsampling = 0, colours = 0;
  const auto require = [&](int status) {
    if (status != 0) {
      throw std::runtime_error(path + ": " + tjGetErrorStr2(decoder.get()));
    }
  };
  require(tjDecompressHeader3(decoder.get(), data, bytes.size(), &picture.columns, &picture.rows,
                              &subsampling, &colours));
  const auto allowed = [](int side) {
    return side >= MeasuredImages::kMinSide && side <= MeasuredImages::kMaxSide;
  };
  if (!allowed(picture.columns) || !allowed(picture.rows)) {
    base::refuse(path, ": the picture has ", picture.columns, " x ", picture.rows,
                 " texels: allowed are ", MeasuredImages::kMinSide, " to ",
                 MeasuredImages::kMaxSide, " along each side");
  }
  picture.values.resize(std::size_t{3} * picture.columns * picture.rows);
  require(tjDecompress2(decoder.get(), data, bytes.size(), picture.values.data(), picture.columns,
                        0, picture.rows, TJPF_RGB, TJFLAG_ACCURATEDCT));
  return picture;
}

}  // namespace

MeasuredImages::MeasuredImages(const std::string& folder) {
  std::vector<std::string> paths(Btf::kColumns / 3);  // by pair
  std::error_code error;
  fs::recursive_directory_iterator entry(folder, error);
  if (error) throw std::runtime_error(folder + ": " + error.message());
  for (; entry != fs::recursive_directory_iterator(); entry.increment(error)) {
    if (error) throw std::runtime_error(folder + ": " + error.message());
    const std::string path = entry->path().string();
    const std::optional<Angles> angles = anglesOf(entry->path().filename().string());
    if (!angles) continue;
    const int view = directionOf(path, "view", angles->view_polar, angles->view_azimuth);
    const int light = directionOf(path, "light", angles->light_polar, angles->light_azimuth);
    std::string& of_pair = paths[Btf::columnOf(view, light) / 3];
    if (!of_pair.empty()) base::refuse(path, ": ", of_pair, " is of the same pair of directions");
    of_pair = path;
  }
  const auto missing = std::count(paths.begin(), paths.end(), "");
  if (missing > 0) {
    const auto first = static_cast<int>(std::find(paths.begin(), paths.end(), "") - paths.begin());
    base::refuse(folder, ": of ", paths.size(), " pairs of directions ", missing,
                 " have no picture, first that of ",
                 nameOf(first / kDirections, first % kDirections));
  }
  for (std::size_t pair = 0; pair < paths.size(); ++pair) {
    take(paths[pair], 3 * static_cast<int>(pair));
  }
}

void MeasuredImages::take(const std::string& path, int column) {
  const Picture picture = readJpeg(path);
  if (values_.empty()) {
    columns_ = picture.columns;
    rows_ = picture.rows;
    values_.resize(static_cast<std::size_t>(columns_) * rows_ * Btf::kColumns);
  }
  if (picture.columns != columns_ || picture.rows != rows_) {
    base::refuse(path, ": the picture has ", picture.columns, " x ", picture.rows,
                 " texels, the others ", columns_, " x ", rows_);
  }
  for (int row = 0; row < rows_; ++row) {
    for (int x = 0; x < columns_; ++x) {
      const auto texel = static_cast<std::size_t>(columns_) * (rows_ - 1 - row) + x;
      std::copy_n(&picture.values[std::size_t{3} * (columns_ * row + x)], 3,
                  &values_[texel * Btf::kColumns + column]);
    }
  }
}

void MeasuredImages::operator()(int texel, float* values) const {
  const std::uint8_t* stored = &values_[static_cast<std::size_t>(texel) * Btf::kColumns];
  static const std::array<float, 256> linear = linearOfBytes();
  static const std::array<float, kDirections> white = whites();
  for (int column = 0; column < Btf::kColumns;) {
    const float of_light = white[column / 3 % kDirections];
    for (int c = 0; c < 3; ++c, ++column) values[column] = linear[stored[column]] / of_light;
  }
}

Btf makeBtf(const MeasuredImages& images, double width, const Compression& compression) {
  if (!(width > 0.0) || !std::isfinite(width)) {
    base::refuse("the width of the sample is ", width, " m: allowed are finite ones > 0");
  }
  const int texels = images.columns() * images.rows();
  const double height = width * images.rows() / images.columns();
  ReliefSurface flat(images.columns(), images.rows(), {width, height},
                     std::vector<float>(texels, 0.0f), std::vector<bool>(texels, true));
  const material::Look black{{0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}, 0.0, 1.0};  // all light is stored
  return Btf(std::move(flat), black, compressRows(texels, Btf::kColumns, images, compression));
}

double compressionError(const Btf& btf, const MeasuredImages& images) {
  constexpr int kMostTexels = 1000;
  const CompressedRows& stored = btf.indirect();
  const int step = std::max(1, stored.rows() / kMostTexels);
  Eigen::VectorXf exact(Btf::kColumns);
  double squares = 0.0, sum = 0.0;
  long count = 0;
  for (int texel = 0; texel < stored.rows(); texel += step) {
    images(texel, exact.data());
    const Eigen::VectorXf found =
        stored.mean + stored.basis.transpose() * stored.coordinates(texel);
    squares += (found - exact).cast<double>().squaredNorm();
    sum += exact.cast<double>().sum();
    count += Btf::kColumns;
  }
  return sum > 0.0 ? std::sqrt(squares / count) / (sum / count) : 0.0;
}

}  // namespace haptex::appearance
