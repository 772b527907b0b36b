#include "haptex/tactile/relief_picture.h"

#include <png.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <variant>

#include "haptex/tactile/surface.h"
#include "haptex/tactile/weave_relief.h"

namespace haptex::tactile {
namespace {

constexpr double kLegHeight = 0.25;  // of a wale, which holds two legs: half of a leg's width

/// @param rows of the picture from the uppermost on @param format of libpng
void writePng(const HeightField& field, png_uint_32 format, const void* rows,
              const std::string& path) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(field.columns);
  image.height = static_cast<png_uint_32>(field.rows);
  image.format = format;
  if (png_image_write_to_file(&image, path.c_str(), 0, rows, 0, nullptr) != 0) return;
  throw std::runtime_error(path + ": cannot be written: " + image.message);
}

/// By sample of the field, in the order of a picture's rows.
template <typename Sample, typename SampleAt>
std::vector<Sample> picture(const HeightField& field, const SampleAt& sample_at) {
  std::vector<Sample> samples;
  samples.reserve(field.heights.size());
  for (int row = field.rows - 1; row >= 0; --row) {
    for (int column = 0; column < field.columns; ++column) {
      samples.push_back(sample_at(static_cast<std::size_t>(field.columns) * row + column));
    }
  }
  return samples;
}

}  // namespace

FaceRelief faceRelief(const material::Surface& surface) {
  FaceRelief relief{sampledRelief(surface), {}};
  if (const auto* weave = std::get_if<material::Weave>(&surface.relief)) {
    relief.warp_on_top = warpsOnTop(*weave);
    return relief;
  }
  relief.warp_on_top.assign(relief.heights.heights.size(), true);
  if (const auto* knit = std::get_if<material::Knit>(&surface.relief)) {
    for (double& height : relief.heights.heights) height *= kLegHeight * knit->wale;
  }
  return relief;
}

double writeHeights(const HeightField& heights, const std::string& path) {
  const auto [low, high] = std::minmax_element(heights.heights.begin(), heights.heights.end());
  const double lowest = *low, range = *high - *low;
  writePng(heights, PNG_FORMAT_LINEAR_Y,
           picture<std::uint16_t>(heights,
                                  [&](std::size_t i) {
                                    const double share =
                                        range > 0.0 ? (heights.heights[i] - lowest) / range : 0.0;
                                    return static_cast<std::uint16_t>(std::lround(65535.0 * share));
                                  })
               .data(),
           path);
  return range;
}

void writeYarns(const FaceRelief& relief, const std::string& path) {
  writePng(relief.heights, PNG_FORMAT_GRAY,
           picture<std::uint8_t>(
               relief.heights,
               [&](std::size_t i) -> std::uint8_t { return relief.warp_on_top[i] ? 255 : 0; })
               .data(),
           path);
}

}  // namespace haptex::tactile
