#include "haptex/tactile/height_file.h"

#include <png.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <csetjmp>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <new>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "haptex/base/quoted.h"

namespace haptex::tactile {
namespace {

constexpr std::size_t kSignatureBytes = 8;
constexpr std::size_t kRawHeaderBytes = 4;

[[noreturn]] void throwUnreadable(const std::string& path, const std::string& what) {
  throw std::runtime_error(path + ": " + what);
}

void requireSize(const std::string& path, std::size_t columns, std::size_t rows) {
  const auto allowed = [](std::size_t count) { return count >= 2 && count <= kMaxSamples; };
  if (allowed(columns) && allowed(rows)) return;
  std::ostringstream message;
  message << path << ": the height field has " << columns << " columns and " << rows
          << " rows: allowed are 2 to " << kMaxSamples << " of each";
  throw std::invalid_argument(message.str());
}

/// Samples as they are stored: the first row is the uppermost.
struct Samples {
  int columns;
  int rows;
  std::vector<std::uint16_t> values;
};

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

/// libpng reports errors by a long jump, over which no destructor runs. Every function with a
/// setjmp() here has therefore no object of its own that needs one.
class PngReader {
 public:
  explicit PngReader(std::FILE* file) {
    png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, this, &PngReader::fail,
                                  [](png_structp, png_const_charp) {});
    if (png_) info_ = png_create_info_struct(png_);
    if (!info_) {
      png_destroy_read_struct(&png_, nullptr, nullptr);
      throw std::bad_alloc();
    }
    png_init_io(png_, file);
  }
  ~PngReader() { png_destroy_read_struct(&png_, &info_, nullptr); }
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;

  bool readHeader() {
    if (setjmp(png_jmpbuf(png_))) return false;
    png_set_sig_bytes(png_, kSignatureBytes);
    png_read_info(png_, info_);
    png_set_interlace_handling(png_);
    return true;
  }
  bool readRows(png_bytepp rows) {
    if (setjmp(png_jmpbuf(png_))) return false;
    png_read_image(png_, rows);
    png_read_end(png_, nullptr);
    return true;
  }

  unsigned columns() const { return png_get_image_width(png_, info_); }
  unsigned rows() const { return png_get_image_height(png_, info_); }
  int bits() const { return png_get_bit_depth(png_, info_); }
  int colourType() const { return png_get_color_type(png_, info_); }
  const char* error() const { return error_; }

 private:
  [[noreturn]] static void fail(png_structp png, png_const_charp message) {
    auto* const reader = static_cast<PngReader*>(png_get_error_ptr(png));
    std::snprintf(reader->error_, sizeof reader->error_, "%s", message);
    png_longjmp(png, 1);
  }

  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
  char error_[256] = "";
};

const char* colourName(int type) {
  switch (type) {
    case PNG_COLOR_TYPE_GRAY:
      return "greyscale";
    case PNG_COLOR_TYPE_GRAY_ALPHA:
      return "greyscale and alpha";
    case PNG_COLOR_TYPE_PALETTE:
      return "palette";
    default:
      return "colour";
  }
}

Samples readPng(const std::string& path) {
  const std::unique_ptr<std::FILE, CloseFile> file(std::fopen(path.c_str(), "rb"));
  if (!file) throwUnreadable(path, std::string("cannot be read: ") + std::strerror(errno));
  png_byte signature[kSignatureBytes] = {};
  const std::size_t got = std::fread(signature, 1, kSignatureBytes, file.get());
  if (got != kSignatureBytes || png_sig_cmp(signature, 0, kSignatureBytes) != 0) {
    throwUnreadable(path, "is not a PNG file");
  }
  PngReader reader(file.get());
  if (!reader.readHeader()) throwUnreadable(path, std::string("damaged PNG: ") + reader.error());
  if (reader.bits() != 16 || reader.colourType() != PNG_COLOR_TYPE_GRAY) {
    throwUnreadable(path, "is a PNG of " + std::to_string(reader.bits()) + " bits, " +
                              colourName(reader.colourType()) + ": it must be 16 bits, greyscale");
  }
  requireSize(path, reader.columns(), reader.rows());
  Samples samples{static_cast<int>(reader.columns()), static_cast<int>(reader.rows()), {}};
  const std::size_t row_bytes = 2 * static_cast<std::size_t>(samples.columns);
  std::vector<png_byte> bytes(row_bytes * samples.rows);
  std::vector<png_bytep> rows;
  for (int row = 0; row < samples.rows; ++row) rows.push_back(bytes.data() + row_bytes * row);
  if (!reader.readRows(rows.data())) {
    throwUnreadable(path, std::string("damaged PNG: ") + reader.error());
  }
  samples.values.reserve(bytes.size() / 2);
  for (std::size_t i = 0; i < bytes.size(); i += 2) {
    samples.values.push_back(static_cast<std::uint16_t>(bytes[i] << 8 | bytes[i + 1]));
  }
  return samples;
}

Samples readRaw(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  std::error_code error;
  if (!stream.is_open() || std::filesystem::is_directory(path, error)) {
    throwUnreadable(path, "cannot be read");
  }
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (error) throwUnreadable(path, "cannot be read: " + error.message());
  const auto read = [&](std::size_t count) {
    std::vector<unsigned char> bytes(2 * count);
    if (!stream.read(reinterpret_cast<char*>(bytes.data()), bytes.size())) {
      throwUnreadable(path, "cannot be read to its end");
    }
    std::vector<std::uint16_t> values;
    values.reserve(count);
    for (std::size_t i = 0; i < bytes.size(); i += 2) {
      values.push_back(static_cast<std::uint16_t>(bytes[i] | bytes[i + 1] << 8));
    }
    return values;
  };
  if (size < kRawHeaderBytes) throwUnreadable(path, "is too short for numbers of columns and rows");
  const std::vector<std::uint16_t> header = read(2);
  requireSize(path, header[0], header[1]);
  const std::size_t count = static_cast<std::size_t>(header[0]) * header[1];
  if (size != kRawHeaderBytes + 2 * count) {
    std::ostringstream message;
    message << "has " << size << " bytes: " << header[0] << " columns and " << header[1]
            << " rows need " << kRawHeaderBytes + 2 * count;
    throwUnreadable(path, message.str());
  }
  return {header[0], header[1], read(count)};
}

Samples readSamples(const std::string& path) {
  const std::string ending = std::filesystem::path(path).extension().string();
  if (ending == ".png") return readPng(path);
  if (ending == ".raw") return readRaw(path);
  throwUnreadable(path, "ends in " + base::quoted(ending) + ": allowed are .png and .raw");
}

void requirePositive(const material::HeightFile& file, const char* name, double value) {
  if (std::isfinite(value) && value > 0.0) return;
  std::ostringstream message;
  message << file.path << ": the " << name << " is " << value << " m: it must be finite and > 0";
  throw std::invalid_argument(message.str());
}

}  // namespace

HeightField loadHeights(const material::HeightFile& file) {
  requirePositive(file, "spacing", file.spacing);
  requirePositive(file, "height", file.height);
  const Samples samples = readSamples(file.path);
  HeightField field;
  field.columns = samples.columns;
  field.rows = samples.rows;
  field.weft_spacing = field.warp_spacing = file.spacing;
  field.heights.reserve(samples.values.size());
  for (int row = samples.rows - 1; row >= 0; --row) {
    const auto begin = samples.values.begin() + static_cast<std::ptrdiff_t>(row) * samples.columns;
    std::transform(begin, begin + samples.columns, std::back_inserter(field.heights),
                   [&](std::uint16_t value) { return file.height * (value / 65535.0); });
  }
  return field;
}

}  // namespace haptex::tactile
