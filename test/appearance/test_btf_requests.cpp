#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>

#include "../refusal.h"
#include "fixtures.h"
#include "haptex/appearance/btf_measures.h"
#include "haptex/appearance/btf_requests.h"

namespace haptex::appearance::test_btf_requests {
namespace {

const Btf& btf() {
  static const Btf made =
      makeBtf(twill(), {{0.2, 0.4, 0.6}, {0.5, 0.3, 0.1}, 0.1, 0.5}, {24, 20, {6, 3, 4}});
  return made;
}

std::vector<BtfRequest> someRequests(int count) {
  std::vector<BtfRequest> requests;
  for (int i = 0; i < count; ++i) {
    const auto turn = static_cast<float>(i);
    requests.push_back({{std::sin(turn), std::cos(turn), 0.5f},
                        {0.3f * std::cos(2.0f * turn), 0.1f, 1.0f},
                        {1e-4f * turn, -2e-4f * turn},
                        0.0f});
  }
  return requests;
}

TEST(BtfRequests, AreAnsweredAsOneByOneByAnyNumberOfThreads) {
  const std::vector<BtfRequest> requests = someRequests(100);
  const std::vector<Radiance> values = radianceOf(btf(), requests, 1);
  ASSERT_EQ(values.size(), 100u);
  for (int i : {0, 17, 99}) {
    const auto& [view, light, seen, width] = requests[i];
    ASSERT_EQ(width, 0.0f);
    const Eigen::Vector3d exact =
        btf()
            .pair({view[0], view[1], view[2]}, {light[0], light[1], light[2]})
            .at({seen[0], seen[1]});
    for (int channel : {0, 1, 2}) {
      EXPECT_FLOAT_EQ(values[i][channel], static_cast<float>(exact[channel])) << i;
    }
  }
  for (int threads : {2, 3, 7, 200}) {
    EXPECT_EQ(radianceOf(btf(), requests, threads), values) << threads;
  }
  EXPECT_TRUE(radianceOf(btf(), {}, 2).empty());
}

TEST(BtfRequests, OfAWidthAreTheMeanOverIt) {
  // As wide as the piece, all of it is seen wherever the middle is.
  const auto width = static_cast<float>(btf().surface().size().x());
  const std::vector<BtfRequest> requests(
      400, BtfRequest{{0.2f, 0.1f, 1.0f}, {0.5f, 0.0f, 1.0f}, {0.0f, 0.0f}, width});
  const Btf::Pair pair = btf().pair({0.2, 0.1, 1.0}, {0.5, 0.0, 1.0});
  const Eigen::Vector3d exact = meanRadiance(pair, placesOver(btf().surface().size(), 100, 1));
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Radiance& value : radianceOf(btf(), requests, 2)) {
    mean += Eigen::Vector3f(value.data()).cast<double>() / 400.0;
  }
  EXPECT_LT((mean - exact).norm(), 0.01 * exact.norm());
}

TEST(BtfRequests, NamesTheFirstThatIsNotSound) {
  for (const float wrong : {0.0f, -1.0f, std::numeric_limits<float>::quiet_NaN()}) {
    std::vector<BtfRequest> requests = someRequests(5);
    requests[3].light[2] = wrong;
    const std::string refusal = test::refusalOf([&] { radianceOf(btf(), requests, 2); });
    EXPECT_NE(refusal.find("request 3: "), std::string::npos) << refusal;
    EXPECT_NE(refusal.find("allowed are finite numbers"), std::string::npos) << refusal;
  }
}

TEST(BtfRequests, AreReadFromAFileOfWholeRecords) {
  const std::string path =
      (std::filesystem::temp_directory_path() / ("haptex_requests_" + std::to_string(getpid())))
          .string();
  const std::vector<BtfRequest> requests = someRequests(3);
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(requests.data()), 3 * sizeof(BtfRequest));
  EXPECT_EQ(radianceOf(btf(), readRequests(path), 1), radianceOf(btf(), requests, 1));
  std::filesystem::resize_file(path, 74);
  EXPECT_THROW(readRequests(path), std::runtime_error);
  writeRadiance({{1.0f, 2.0f, 3.0f}, {4.0f, 5.0f, 6.0f}}, path);
  EXPECT_EQ(std::filesystem::file_size(path), 24u);
  std::filesystem::remove(path);
  EXPECT_THROW(readRequests(path), std::runtime_error);
  EXPECT_THROW(writeRadiance({}, "/nowhere/values"), std::runtime_error);
}

}  // namespace
}  // namespace haptex::appearance::test_btf_requests
