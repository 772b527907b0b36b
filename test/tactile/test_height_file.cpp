#include <gtest/gtest.h>
#include <png.h>

#include <cmath>
#include <csetjmp>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "haptex/tactile/height_file.h"
#include "temporary_file.h"

namespace haptex::tactile::test_height_file {
namespace {

struct PngKind {
  int bits = 16;
  int colour = PNG_COLOR_TYPE_GRAY;
  int interlace = PNG_INTERLACE_NONE;
  bool with_gamma = false;
};

/// The bytes of a PNG of greyscale `values` from the uppermost row downwards. Other kinds have
/// black samples: they are there to be refused.
std::string pngBytes(int columns, int rows, const std::vector<int>& values, PngKind kind = {}) {
  std::string bytes;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  const std::size_t row_bytes = 8 * static_cast<std::size_t>(columns);  // enough for any kind
  std::vector<png_byte> samples(row_bytes * rows);
  std::vector<png_bytep> begins;
  for (int row = 0; row < rows; ++row) begins.push_back(samples.data() + row_bytes * row);
  for (std::size_t i = 0; i < values.size() && kind.bits == 16; ++i) {
    png_bytep sample = begins[i / columns] + 2 * (i % columns);
    sample[0] = static_cast<png_byte>(values[i] >> 8);
    sample[1] = static_cast<png_byte>(values[i] & 0xff);
  }
  if (setjmp(png_jmpbuf(png))) std::abort();  // an error of this helper
  png_set_write_fn(
      png, &bytes,
      [](png_structp p, png_bytep data, png_size_t count) {
        static_cast<std::string*>(png_get_io_ptr(p))
            ->append(reinterpret_cast<const char*>(data), count);
      },
      nullptr);
  png_set_IHDR(png, info, columns, rows, kind.bits, kind.colour, kind.interlace,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  const png_color black{0, 0, 0};
  if (kind.colour == PNG_COLOR_TYPE_PALETTE) png_set_PLTE(png, info, &black, 1);
  if (kind.with_gamma) png_set_gAMA(png, info, 0.45455);
  png_write_info(png, info);
  png_write_image(png, begins.data());
  png_write_end(png, nullptr);
  png_destroy_write_struct(&png, &info);
  return bytes;
}

/// Every sample there is, once.
std::vector<int> allSamples() {
  std::vector<int> values(65536);
  for (int i = 0; i < 65536; ++i)
    values[i] = (i * 12345 + 7) & 0xffff;  // odd factor: a permutation
  return values;
}

HeightField load(const std::string& ending, const std::string& bytes) {
  const TemporaryFile file(ending);
  file.write(bytes);
  return loadHeights({file.path(), 1e-4, 2e-3, true});
}

void expectAllSamples(const HeightField& field) {
  ASSERT_EQ(field.columns, 256);
  ASSERT_EQ(field.rows, 256);
  EXPECT_EQ(field.weft_spacing, 1e-4);
  EXPECT_EQ(field.warp_spacing, 1e-4);
  const std::vector<int> values = allSamples();
  for (int row = 0; row < 256; ++row) {
    for (int column = 0; column < 256; ++column) {
      // The uppermost row is the last.
      const double expected = 2e-3 * (values[256 * (255 - row) + column] / 65535.0);
      ASSERT_EQ(field.at(column, row), expected) << column << ", " << row;
    }
  }
}

TEST(HeightFile, ReadsEverySampleOfAPngExactly) {
  expectAllSamples(load(".png", pngBytes(256, 256, allSamples())));
}

TEST(HeightFile, ReadsInterlacedPngs) {
  PngKind kind;
  kind.interlace = PNG_INTERLACE_ADAM7;
  expectAllSamples(load(".png", pngBytes(256, 256, allSamples(), kind)));
}

TEST(HeightFile, TakesSamplesAsTheyAreWhateverTheirGamma) {
  PngKind kind;
  kind.with_gamma = true;
  expectAllSamples(load(".png", pngBytes(256, 256, allSamples(), kind)));
}

TEST(HeightFile, ReadsEverySampleOfARawFileExactly) {
  expectAllSamples(load(".raw", rawBytes(256, 256, allSamples())));
}

TEST(HeightFile, ReadsOblongFields) {
  const std::vector<int> values{0, 1, 2, 3, 4, 65535};
  for (const HeightField& field :
       {load(".png", pngBytes(3, 2, values)), load(".raw", rawBytes(3, 2, values))}) {
    ASSERT_EQ(field.columns, 3);
    ASSERT_EQ(field.rows, 2);
    EXPECT_EQ(field.at(2, 0), 2e-3);
    EXPECT_EQ(field.at(0, 1), 0.0);
    EXPECT_EQ(field.at(1, 1), 2e-3 / 65535.0);
  }
}

template <typename Error>
void expectRefusal(const std::function<void()>& action, const std::string& complaint) {
  try {
    action();
    ADD_FAILURE() << "not refused: " << complaint;
  } catch (const Error& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("haptex_test_"), std::string::npos) << message;
    EXPECT_NE(message.find(complaint), std::string::npos) << message;
  }
}

TEST(HeightFile, RefusesWhatIsNoPngOfSixteenBitsGreyscale) {
  const auto refuse = [](const std::string& bytes, const std::string& complaint) {
    expectRefusal<std::runtime_error>([&] { load(".png", bytes); }, complaint);
  };
  refuse("", "is not a PNG file");
  refuse("P5 2 2 65535 and so on", "is not a PNG file");
  refuse(pngBytes(4, 4, {}, {8, PNG_COLOR_TYPE_GRAY}), "8 bits, greyscale: it must be 16 bits");
  refuse(pngBytes(4, 4, {}, {16, PNG_COLOR_TYPE_RGB}), "16 bits, colour: it must be");
  refuse(pngBytes(4, 4, {}, {16, PNG_COLOR_TYPE_GRAY_ALPHA}), "16 bits, greyscale and alpha");
  refuse(pngBytes(4, 4, {}, {8, PNG_COLOR_TYPE_PALETTE}), "8 bits, palette");
}

TEST(HeightFile, RefusesDamagedPngs) {
  const std::string whole = pngBytes(256, 256, allSamples());
  // At the signature's end, in the header, in the samples, before the end.
  for (const std::size_t size :
       {std::size_t{8}, std::size_t{20}, whole.size() / 2, whole.size() - 8}) {
    expectRefusal<std::runtime_error>([&] { load(".png", whole.substr(0, size)); },
                                      "damaged PNG: ");
  }
  std::string changed = whole;
  changed[whole.size() / 2] ^= 0x10;
  expectRefusal<std::runtime_error>([&] { load(".png", changed); }, "damaged PNG: ");
}

TEST(HeightFile, RefusesSizesOutOfRange) {
  const std::vector<int> samples(4097 * 2);
  const auto refuse = [](const std::string& ending, const std::string& bytes,
                         const std::string& complaint) {
    expectRefusal<std::invalid_argument>([&] { load(ending, bytes); }, complaint);
  };
  refuse(".png", pngBytes(1, 5, {0, 0, 0, 0, 0}), "1 columns and 5 rows: allowed are 2 to 4096");
  refuse(".png", pngBytes(4097, 2, samples), "4097 columns and 2 rows");
  refuse(".raw", rawBytes(2, 4097, samples), "2 columns and 4097 rows");
  refuse(".raw", rawBytes(0, 3, {}), "0 columns and 3 rows");
}

TEST(HeightFile, RefusesRawFilesOfAnotherLength) {
  const std::string whole = rawBytes(3, 2, {1, 2, 3, 4, 5, 6});
  const auto refuse = [](const std::string& bytes, const std::string& complaint) {
    expectRefusal<std::runtime_error>([&] { load(".raw", bytes); }, complaint);
  };
  refuse(whole.substr(0, 3), "too short");
  refuse(whole.substr(0, 15), "has 15 bytes: 3 columns and 2 rows need 16");
  refuse(whole + "x", "has 17 bytes");
}

TEST(HeightFile, RefusesMissingFilesDirectoriesAndOtherEndings) {
  for (const char* const ending : {".png", ".raw"}) {
    const TemporaryFile file(ending);
    const auto load_it = [&] { loadHeights({file.path(), 1e-4, 1e-3, true}); };
    expectRefusal<std::runtime_error>(load_it, "cannot be read");
    std::filesystem::create_directory(file.path());
    EXPECT_THROW(load_it(), std::runtime_error) << ending;
  }
  expectRefusal<std::runtime_error>([] { load(".tiff", "II*"); }, "ends in '.tiff': allowed are");
}

TEST(HeightFile, RefusesSpacingsAndHeightsThatAreNotPositive) {
  const TemporaryFile file(".raw");
  file.write(rawBytes(2, 2, {1, 2, 3, 4}));
  for (const double bad : {0.0, -1e-4, std::nan("")}) {
    expectRefusal<std::invalid_argument>(
        [&] {
          loadHeights({file.path(), bad, 1e-3, true});
        },
        "the spacing is ");
    expectRefusal<std::invalid_argument>(
        [&] {
          loadHeights({file.path(), 1e-4, bad, true});
        },
        "the height is ");
  }
}

}  // namespace
}  // namespace haptex::tactile::test_height_file
