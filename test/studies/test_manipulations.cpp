#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include "haptex/base/workload.h"
#include "haptex/material/fabric_file.h"
#include "haptex/studies/evaluation/manipulations.h"

namespace haptex::studies::test_manipulations {
namespace {

material::Fabric wool() {
  return material::loadFabric(std::string(HAPTEX_CONFIG_DIRECTORY) + "/fabrics/wool.yaml");
}

DeviceRecord run(const std::string& name, std::uint64_t seed) {
  ManipulationSettings settings;
  settings.tremor = seed;
  settings.cells = 8;
  for (const Manipulation& manipulation : manipulations()) {
    if (manipulation.name == name) return manipulation.run(wool(), settings);
  }
  return {};
}

TEST(Manipulations, HaveNamesOfTheirOwn) {
  std::set<std::string> names;
  for (const Manipulation& manipulation : manipulations()) names.insert(manipulation.name);
  EXPECT_EQ(names.size(), manipulations().size());
  EXPECT_EQ(names.count("weigh"), 1u);
}

TEST(Manipulations, AreMeasuredEveryMillisecondAndTheSameAgain) {
  const DeviceRecord first = run("drag", 1), again = run("drag", 1), other = run("drag", 2);
  ASSERT_EQ(first.size(), 1500u);
  ASSERT_EQ(other.size(), first.size());
  bool differs = false;
  for (std::size_t i = 0; i < first.size(); ++i) {
    if (i > 0) {
      ASSERT_NEAR(first[i].time - first[i - 1].time, 1e-3, 1e-9);
    }
    for (const base::Finger finger : base::kFingers) {
      ASSERT_TRUE(first[i].forces[finger].allFinite());
      ASSERT_EQ(first[i].forces[finger], again[i].forces[finger]);
      differs = differs || first[i].positions[finger] != other[i].positions[finger];
    }
  }
  EXPECT_TRUE(differs) << "another seed trembles in another way";
  EXPECT_GT(first.back().forces[base::Finger::kIndex].norm(), 0.01) << "it is still pinched";
}

TEST(Manipulations, TheHandTremblesByFourteenMicrometres) {
  const DeviceRecord record = run("drag", 3);
  double squares = 0.0;
  for (const DeviceSample& sample : record) {
    const double aside = sample.positions[base::Finger::kIndex].y();  // it slides down along z
    squares += aside * aside;
  }
  EXPECT_NEAR(std::sqrt(squares / static_cast<double>(record.size())), 20e-6 / std::sqrt(2.0),
              8e-6);
}

TEST(Manipulations, AStripThatIsPressedResistsUntilTheHandCeasesOrItSlipsOff) {
  const DeviceRecord record = run("press_warp", 1);
  ASSERT_FALSE(record.empty());
  double largest = 0.0, other = 0.0;
  for (const DeviceSample& sample : record) {
    largest = std::max(largest, sample.forces[base::Finger::kIndex].x());
    other = std::max(other, sample.forces[base::Finger::kThumb].norm());
  }
  EXPECT_GT(largest, 1.5) << "it is pressed with the forces of KES's stretch";
  EXPECT_EQ(other, 0.0) << "the thumb stays behind";
}

TEST(Manipulations, AnOverhangIsBorneByTheFingerUntilItHangsByItself) {
  if (base::kSanitized) GTEST_SKIP() << "takes minutes; the strip that is pressed runs its lines";
  const DeviceRecord record = run("lower_weft", 1);
  ASSERT_EQ(record.size(), 8000u);
  const double weight = 0.15 * 9.80665 * kOverhang.length * kOverhang.width;
  const auto mean = [&](std::size_t begin) {
    double sum = 0.0;
    for (std::size_t i = begin; i < begin + 200; ++i) {
      sum -= record[i].forces[base::Finger::kIndex].z() / 200.0;
    }
    return sum;
  };
  EXPECT_GT(mean(0), 0.4 * weight);
  EXPECT_LT(mean(0), 1.5 * weight);
  EXPECT_LT(mean(7800), 0.1 * weight);
}

}  // namespace
}  // namespace haptex::studies::test_manipulations
