#include <gtest/gtest.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <stdexcept>
#include <string>

#include "../refusal.h"
#include "fixtures.h"
#include "haptex/appearance/btf_file.h"
#include "haptex/base/checksum.h"

namespace haptex::appearance::test_btf_file {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kCounts = 8;    // where the whole numbers begin
constexpr std::size_t kNumbers = 28;  // and those of 8 bytes
constexpr std::size_t kHeights = 108;

class BtfFile : public testing::Test {
 protected:
  BtfFile()
      : folder_(std::filesystem::temp_directory_path() /
                ("haptex_btf_" + std::to_string(getpid()))),
        path_((folder_ / "fabric.btf").string()) {
    std::filesystem::create_directories(folder_);
  }
  ~BtfFile() override { std::filesystem::remove_all(folder_); }

  static const Btf& btf() {
    static const Btf made =
        makeBtf(twill(), {{0.2, 0.4, 0.6}, {0.5, 0.3, 0.1}, 0.1, 0.5}, {24, 20, {6, 3, 4}});
    return made;
  }
  std::string bytes() const {
    std::ifstream stream(path_, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  void write(const std::string& bytes) const { std::ofstream(path_, std::ios::binary) << bytes; }
  /// With a checksum that is right again.
  void writeSigned(std::string bytes) const {
    bytes.resize(bytes.size() - 8);
    std::uint64_t sum = base::checksum(bytes);
    for (int i = 0; i < 8; ++i, sum >>= 8) bytes.push_back(static_cast<char>(sum & 0xff));
    write(bytes);
  }
  template <typename Number>
  std::string with(std::size_t at, Number number) const {
    std::string changed = bytes();
    std::memcpy(changed.data() + at, &number,
                sizeof number);  // tests run where the lowest is first
    return changed;
  }
  void expectRefusal(const std::string& text) const {
    const std::string refusal = test::refusalOf<std::runtime_error>([&] { readBtf(path_); });
    EXPECT_EQ(refusal.rfind(path_ + ": ", 0), 0u) << refusal;
    EXPECT_NE(refusal.find(text), std::string::npos) << refusal;
  }

  std::filesystem::path folder_;
  std::string path_;
};

TEST_F(BtfFile, GivesBackTheFunctionToTheLastBit) {
  const std::size_t size = writeBtf(btf(), path_);
  EXPECT_EQ(std::filesystem::file_size(path_), size);
  const Btf read = readBtf(path_);
  for (const Vector3d& view : {Vector3d(0.0, 0.0, 1.0), Vector3d(0.5, -0.3, 0.4)}) {
    for (const Vector3d& light : {Vector3d(0.1, 0.0, 1.0), Vector3d(-0.7, 0.2, 0.3)}) {
      const auto exact = btf().pair(view, light), same = read.pair(view, light);
      for (int i = 0; i < 50; ++i) {
        const Eigen::Vector2d place(3.1e-4 * i, 1.7e-4 * i);
        ASSERT_EQ(exact.at(place), same.at(place));
      }
    }
  }
  EXPECT_EQ(read.surface().size(), btf().surface().size());
}

TEST_F(BtfFile, TakesWhatItsNumbersTakeAndAHeader) {
  EXPECT_EQ(writeBtf(btf(), path_), btf().bytes() + kHeights + 8);
}

TEST_F(BtfFile, IsRefusedIfItIsNone) {
  expectRefusal("cannot be read");
  write(
      "PNG and so on, which is long enough for a header, but it is something else altogether, or "
      "an empty file, or a folder");
  expectRefusal("is no bidirectional texture function of this version");
  write("");
  expectRefusal("is no bidirectional texture function of this version");
  std::filesystem::remove(path_);
  std::filesystem::create_directory(path_);
  expectRefusal("cannot be read");
}

TEST_F(BtfFile, IsRefusedWithoutItsEnd) {
  writeBtf(btf(), path_);
  const std::string whole = bytes();
  write(whole.substr(0, 50));
  expectRefusal("has 50 bytes: a header has 108");
  for (const std::size_t lost : {std::size_t{1}, std::size_t{8}, whole.size() / 2}) {
    write(whole.substr(0, whole.size() - lost));
    expectRefusal("take " + std::to_string(whole.size()));
  }
  write(whole + "x");
  expectRefusal("has " + std::to_string(whole.size() + 1) + " bytes");
}

TEST_F(BtfFile, IsRefusedIfItClaimsMoreThanItHas) {
  writeBtf(btf(), path_);
  const auto expect = [&](std::size_t count, std::uint32_t number, const std::string& text) {
    const std::string good = bytes();
    writeSigned(with(kCounts + 4 * count, number));
    expectRefusal(text);
    write(good);
  };
  expect(0, 1024, "1024 x 20 texels");
  expect(0, 4294967295u, "4294967295 columns of texels: allowed are 4 to 1024");
  expect(1, 0, "0 rows of texels");
  expect(2, 4294967295u, "components: allowed are 1 to 256");
  expect(2, 200, "200 components");
  expect(3, 300, "300 clusters: allowed are 1 to 256");
  expect(4, 7, "7 local components: allowed are 1 to 6");
}

TEST_F(BtfFile, IsRefusedWithNumbersThatAreNone) {
  writeBtf(btf(), path_);
  const std::string good = bytes();
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr float kInfinite = std::numeric_limits<float>::infinity();
  writeSigned(with(kNumbers, kNan));
  expectRefusal("size is nan");
  write(good);
  writeSigned(with(kNumbers + 8 * 8, 1.5));
  expectRefusal("gloss is 1.5");
  write(good);
  writeSigned(with(kHeights + 4 * 3, kInfinite));
  expectRefusal("height 3 is inf: it must be finite");
  write(good);
  const std::size_t texels = 24 * 20, mean = kHeights + 5 * texels;
  writeSigned(with(mean + 4 * 7, kInfinite));
  expectRefusal("mean 7 is inf");
  write(good);
  const std::size_t basis = mean + 4 * Btf::kColumns;
  writeSigned(with(basis + 4, kInfinite));
  expectRefusal("number of the basis 1 is inf");
  write(good);
  const std::size_t clusters = good.size() - 8 - texels * (1 + 2 * 4);
  writeSigned(with(clusters + 2, std::uint8_t{3}));
  expectRefusal("has texel 2 in cluster 3 of 3");
}

TEST_F(BtfFile, IsRefusedWithDamageThatNumbersDoNotShow) {
  writeBtf(btf(), path_);
  std::string damaged = bytes();
  damaged[damaged.size() - 20] ^= 1;
  write(damaged);
  expectRefusal("is damaged");
}

TEST_F(BtfFile, IsNotWrittenWhereItCannotBe) {
  EXPECT_THROW(writeBtf(btf(), (folder_ / "no such folder" / "x.btf").string()),
               std::runtime_error);
}

}  // namespace
}  // namespace haptex::appearance::test_btf_file
