#include "haptex/appearance/btf_file.h"

#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <utility>
#include <vector>

#include "haptex/base/checksum.h"
#include "haptex/base/file_size.h"
#include "haptex/base/quoted.h"
#include "haptex/base/require.h"
#include "haptex/base/whole_file.h"

namespace haptex::appearance {
namespace {

constexpr char kMagic[] = "HAPTBTF1";
constexpr std::size_t kMagicBytes = sizeof(kMagic) - 1;
// Whole numbers of 4 bytes, and numbers of 8 bytes, that every file begins with.
constexpr std::size_t kCounts = 5, kNumbers = 10;
constexpr std::size_t kHeaderBytes = kMagicBytes + 4 * kCounts + 8 * kNumbers;
constexpr std::size_t kChecksumBytes = 8;
constexpr std::uintmax_t kLargestFile = std::uintmax_t{1} << 30;

template <typename Number>
using Bits =
    std::conditional_t<sizeof(Number) == 8, std::uint64_t,
                       std::conditional_t<sizeof(Number) == 4, std::uint32_t, std::uint16_t>>;

/// Lowest byte first, whatever the machine.
class Writer {
 public:
  template <typename Number>
  void put(Number number) {
    Bits<Number> bits;
    std::memcpy(&bits, &number, sizeof bits);
    for (std::size_t i = 0; i < sizeof bits; ++i)
      text.push_back(static_cast<char>(bits >> (8 * i)));
  }
  /// All of a matrix, column by column.
  template <typename Matrix>
  void putAll(const Matrix& matrix) {
    for (Eigen::Index i = 0; i < matrix.size(); ++i) put(matrix.data()[i]);
  }

  std::string text;
};

/// Of bytes that are known to suffice.
class Reader {
 public:
  Reader(const std::string& text, std::size_t at) : text_(text), at_(at) {}

  template <typename Number>
  Number take() {
    Bits<Number> bits = 0;
    for (std::size_t i = 0; i < sizeof bits; ++i) {
      bits = static_cast<Bits<Number>>(
          bits | static_cast<Bits<Number>>(static_cast<unsigned char>(text_[at_++])) << (8 * i));
    }
    Number number;
    std::memcpy(&number, &bits, sizeof bits);
    return number;
  }
  std::uint8_t takeByte() { return static_cast<std::uint8_t>(text_[at_++]); }
  /// Column by column. @throws std::invalid_argument naming what is not finite
  template <typename Matrix>
  void takeAll(const char* name, Matrix& matrix) {
    for (Eigen::Index i = 0; i < matrix.size(); ++i) {
      const auto number = take<typename Matrix::Scalar>();
      if (!std::isfinite(static_cast<double>(number))) {
        base::refuse(name, " ", i, " is ", number, ": it must be finite");
      }
      matrix.data()[i] = number;
    }
  }

 private:
  const std::string& text_;
  std::size_t at_;
};

struct Header {
  std::uint32_t columns, rows;
  std::uint32_t components, clusters, local;
  Eigen::Vector2d size;
  material::Look look;
};

/// Bytes of a file with these numbers, which are sound.
std::size_t bytesOf(const Header& header) {
  const std::size_t texels = static_cast<std::size_t>(header.columns) * header.rows;
  const std::size_t axes = static_cast<std::size_t>(header.clusters) * header.local;
  const std::size_t floats =
      texels + (1 + static_cast<std::size_t>(header.components)) * Btf::kColumns +
      static_cast<std::size_t>(header.components) * (header.clusters + axes) + axes;
  return kHeaderBytes + 4 * floats + 2 * texels + 2 * texels * header.local + kChecksumBytes;
}

Header takeHeader(Reader& reader) {
  Header header{};
  for (std::uint32_t* count :
       {&header.columns, &header.rows, &header.components, &header.clusters, &header.local}) {
    *count = reader.take<std::uint32_t>();
  }
  header.size.x() = reader.take<double>();
  header.size.y() = reader.take<double>();
  for (material::Colour* colour : {&header.look.warp, &header.look.weft}) {
    for (double& share : *colour) share = reader.take<double>();
  }
  header.look.gloss = reader.take<double>();
  header.look.width = reader.take<double>();
  // Before anything is allocated by them.
  for (const auto& [name, texels] : {std::pair("columns", header.columns), {"rows", header.rows}}) {
    if (texels < ReliefSurface::kMinTexels || texels > ReliefSurface::kMaxTexels) {
      base::refuse("has ", texels, " ", name, " of texels: allowed are ", ReliefSurface::kMinTexels,
                   " to ", ReliefSurface::kMaxTexels);
    }
  }
  requireSound(Compression{static_cast<int>(header.components), static_cast<int>(header.clusters),
                           static_cast<int>(header.local)});
  return header;
}

std::string wholeText(const std::string& path) {
  std::error_code error;
  std::ifstream stream(path, std::ios::binary);
  if (!stream || std::filesystem::is_directory(path, error)) {
    throw std::runtime_error(base::shortened(path) + ": cannot be read");
  }
  base::requireFileSize(path, kLargestFile);
  return {std::istreambuf_iterator<char>(stream), {}};
}

Btf btfOf(const std::string& text) {
  if (text.size() < kMagicBytes || text.compare(0, kMagicBytes, kMagic) != 0) {
    base::refuse("is no bidirectional texture function of this version: it does not begin with ",
                 kMagic);
  }
  if (text.size() < kHeaderBytes) {
    base::refuse("has ", text.size(), " bytes: a header has ", kHeaderBytes);
  }
  Reader reader(text, kMagicBytes);
  const Header header = takeHeader(reader);
  if (text.size() != bytesOf(header)) {
    base::refuse("has ", text.size(), " bytes: ", header.columns, " x ", header.rows,
                 " texels with ", header.components, " components, ", header.clusters,
                 " clusters and ", header.local, " local components take ", bytesOf(header));
  }
  const std::size_t content = text.size() - kChecksumBytes;
  if (Reader(text, content).take<std::uint64_t>() !=
      base::checksum(std::string_view(text).substr(0, content))) {
    base::refuse("is damaged: its checksum is another one");
  }
  const int columns = static_cast<int>(header.columns), rows = static_cast<int>(header.rows);
  const int texels = columns * rows;
  CompressedRows indirect;
  indirect.size = {static_cast<int>(header.components), static_cast<int>(header.clusters),
                   static_cast<int>(header.local)};
  const auto& [components, clusters, local] = indirect.size;
  Eigen::VectorXf heights(texels);
  reader.takeAll("height", heights);
  std::vector<bool> warp_on_top;
  for (int i = 0; i < texels; ++i) warp_on_top.push_back(reader.takeByte() != 0);
  indirect.mean.resize(Btf::kColumns);
  indirect.basis.resize(components, Btf::kColumns);
  indirect.offsets.resize(components, clusters);
  indirect.axes.resize(components, clusters * local);
  indirect.scales.resize(local, clusters);
  indirect.coefficients.resize(local, texels);
  reader.takeAll("mean", indirect.mean);
  reader.takeAll("number of the basis", indirect.basis);
  reader.takeAll("offset", indirect.offsets);
  reader.takeAll("number of the axes", indirect.axes);
  reader.takeAll("scale", indirect.scales);
  for (int i = 0; i < texels; ++i) {
    indirect.clusters.push_back(reader.takeByte());
    if (indirect.clusters.back() < clusters) continue;
    base::refuse("has texel ", i, " in cluster ", int{indirect.clusters.back()}, " of ", clusters);
  }
  reader.takeAll("coefficient", indirect.coefficients);
  return Btf(ReliefSurface(columns, rows, header.size, {heights.begin(), heights.end()},
                           std::move(warp_on_top)),
             header.look, std::move(indirect));
}

}  // namespace

std::size_t writeBtf(const Btf& btf, const std::string& path) {
  const ReliefSurface& surface = btf.surface();
  const CompressedRows& indirect = btf.indirect();
  const material::Look& look = btf.reflectance().look();
  Writer writer;
  writer.text = kMagic;
  for (const int count : {surface.columns(), surface.rows(), indirect.size.components,
                          indirect.size.clusters, indirect.size.local}) {
    writer.put(static_cast<std::uint32_t>(count));
  }
  writer.putAll(surface.size());
  for (const material::Colour& colour : {look.warp, look.weft}) {
    for (const double share : colour) writer.put(share);
  }
  writer.put(look.gloss);
  writer.put(look.width);
  for (const float height : surface.heights()) writer.put(height);
  for (const bool warp : surface.warpOnTop()) writer.text.push_back(warp ? 1 : 0);
  writer.putAll(indirect.mean);
  writer.putAll(indirect.basis);
  writer.putAll(indirect.offsets);
  writer.putAll(indirect.axes);
  writer.putAll(indirect.scales);
  for (const std::uint8_t cluster : indirect.clusters) {
    writer.text.push_back(static_cast<char>(cluster));
  }
  writer.putAll(indirect.coefficients);
  writer.put(base::checksum(writer.text));
  base::writeWholeFile(path, writer.text);
  return writer.text.size();
}

Btf readBtf(const std::string& path) {
  const std::string text = wholeText(path);
  try {
    return btfOf(text);
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(base::shortened(path) + ": " + error.what());
  }
}

}  // namespace haptex::appearance
