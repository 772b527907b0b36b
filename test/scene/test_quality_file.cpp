#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "../refusal.h"
#include "haptex/scene/quality_file.h"

namespace haptex::scene::test_quality_file {
namespace {

namespace fs = std::filesystem;

const fs::path kPresets = HAPTEX_CONFIG_DIRECTORY "/presets";

const std::string kTwoQualities = R"(machine: a desk
qualities:
  - name: quick
    cell_size: 0.025
    time_step: 0.0125
    measured:
      - {motion: swing, fabric: wool, position_error: 0.01, force_error: 0.2, energy_error: 3.0e-3,
         cost: 0.04}
  - name: slow
    cell_size: 0.0125
    time_step: 0.005
    integrator: bdf2
    solver: {method: cholesky, tolerance: 1.0e-5, newton_iterations: 3}
    measured:
      - {motion: swing, fabric: wool, position_error: 0.001, force_error: 0.02, energy_error: 0,
         cost: 0.4}
      - {motion: hang, fabric: wool, position_error: 0, force_error: 0, energy_error: 0, cost: 0.3}
)";

class QualityFile : public testing::Test {
 protected:
  ~QualityFile() override { fs::remove(path_); }

  std::vector<Quality> load(const std::string& text) const {
    std::ofstream(path_) << text;
    return loadQualities(path_.string());
  }

  /// What is said to the two qualities with the first `part` replaced.
  std::string refusalOf(const std::string& part, const std::string& replacement) const {
    std::string text = kTwoQualities;
    const std::size_t begin = text.find(part);
    if (begin == std::string::npos) return "(no such part)";
    return test::refusalOf([&] { load(text.replace(begin, part.size(), replacement)); });
  }

  void expectRefused(const std::string& part, const std::string& replacement,
                     const std::string& says) const {
    const std::string refusal = refusalOf(part, replacement);
    EXPECT_NE(refusal.find(says), std::string::npos) << refusal;
  }

  const fs::path path_ =
      fs::path(testing::TempDir()) / ("haptex_quality_" + std::to_string(getpid()) + ".yaml");
};

TEST_F(QualityFile, IsReadAsWritten) {
  const std::vector<Quality> qualities = load(kTwoQualities);
  ASSERT_EQ(qualities.size(), 2u);
  EXPECT_EQ(qualities[0].name, "quick");
  EXPECT_EQ(qualities[0].fabric, "");
  EXPECT_EQ(qualities[0].cell_size, 0.025);
  EXPECT_EQ(qualities[0].step.method, cloth::IntegrationMethod::kBackwardEuler);
  EXPECT_EQ(qualities[0].step.newton_iterations, 1);
  ASSERT_EQ(qualities[0].measured.size(), 1u);
  EXPECT_EQ(qualities[0].measured[0].motion, "swing");
  EXPECT_EQ(qualities[0].measured[0].fabric, "wool");
  EXPECT_EQ(qualities[0].measured[0].position_error, 0.01);
  EXPECT_EQ(qualities[0].measured[0].force_error, 0.2);
  EXPECT_EQ(qualities[0].measured[0].energy_error, 3e-3);
  EXPECT_EQ(qualities[0].measured[0].cost, 0.04);
  EXPECT_EQ(qualities[1].time_step, 0.005);
  EXPECT_EQ(qualities[1].step.method, cloth::IntegrationMethod::kBdf2);
  EXPECT_EQ(qualities[1].step.solver, linear::LinearSolverMethod::kCholesky);
  EXPECT_EQ(qualities[1].step.tolerance, 1e-5);
  EXPECT_EQ(qualities[1].step.newton_iterations, 3);
  EXPECT_EQ(qualities[1].measured.size(), 2u);
}

TEST_F(QualityFile, RefusesWhatNoQualityHas) {
  expectRefused("cell_size: 0.025", "cell_size: 0", "qualities[0].cell_size: '0' must be > 0");
  expectRefused("time_step: 0.005", "time_step: .nan", "qualities[1].time_step: '.nan' must be");
  expectRefused("time_step: 0.005", "time_step: 20", "must be from 1e-6 to 10 s");
  expectRefused("integrator: bdf2", "integrator: magic", "qualities[1].integrator: 'magic'");
  expectRefused("integrator: bdf2", "integrator: midpoint", "only with an implicit integrator");
  expectRefused("tolerance: 1.0e-5", "tolerance: 1", "must be > 0 and < 1");
  expectRefused("name: quick", "colour: red", "unknown key");
  expectRefused("name: slow", "name: quick", "qualities[1].name: 'quick' is listed twice");
}

TEST_F(QualityFile, MayHaveOneOfANameForEachFabric) {
  std::string text = kTwoQualities;
  const auto replace = [&](const std::string& part, const std::string& by) {
    text.replace(text.find(part), part.size(), by);
  };
  replace("name: slow", "name: quick\n    fabric: linear");
  replace("motion: hang, fabric: wool", "motion: hang, fabric: linear");
  const auto refusal = [&] { return test::refusalOf([&] { load(text); }); };
  EXPECT_NE(refusal().find("qualities[1].name: 'quick' is listed twice for 'linear'"),
            std::string::npos)
      << refusal() << ": the first is for any fabric";
  replace("name: quick", "name: quick\n    fabric: wool");
  const std::vector<Quality> qualities = load(text);
  ASSERT_EQ(qualities.size(), 2u);
  EXPECT_EQ(qualities[0].fabric, "wool");
  EXPECT_EQ(qualities[1].fabric, "linear");
  replace("fabric: linear", "fabric: silk");
  EXPECT_NE(refusal().find("qualities[1].fabric: 'silk' must be one of linear, wool"),
            std::string::npos)
      << refusal();
}

TEST_F(QualityFile, RefusesMeasurementsThatCannotBe) {
  expectRefused("position_error: 0.01", "position_error: -1",
                "qualities[0].measured[0].position_error: '-1' must be a finite number >= 0");
  expectRefused("force_error: 0.2", "force_error: .inf", "measured[0].force_error");
  expectRefused("cost: 0.04", "cost: 0", "measured[0].cost: '0' must be a finite number > 0");
  expectRefused("motion: hang", "motion: swing", "is listed twice");
  expectRefused("energy_error: 3.0e-3,", "", "'energy_error' is missing");
}

TEST_F(QualityFile, RefusesAFileWithoutQualitiesOrMeasurements) {
  EXPECT_THROW(load("machine: a desk\nqualities: []\n"), std::invalid_argument);
  EXPECT_THROW(load("qualities: []\n"), std::invalid_argument);
  EXPECT_THROW(loadQualities("/no/such.yaml"), std::runtime_error);
  const std::string head = "machine: a\nqualities: [{name: a, cell_size: 1, time_step: 1, ";
  EXPECT_THROW(load(head + "measured: []}]\n"), std::invalid_argument);
}

/// Geometric mean of the costs of the motions of the quality's fabric.
double meanCost(const Quality& quality) {
  double cost = 0.0;
  int motions = 0;
  for (const MeasuredQuality& measured : quality.measured) {
    if (measured.fabric != quality.fabric) continue;
    cost += std::log(measured.cost);
    ++motions;
  }
  return std::exp(cost / motions);
}

std::vector<Quality> of(const std::string& fabric, std::vector<Quality> qualities) {
  qualities.erase(std::remove_if(qualities.begin(), qualities.end(),
                                 [&](const Quality& one) { return one.fabric != fabric; }),
                  qualities.end());
  return qualities;
}

TEST(ShippedPresets, AreOfTheFrontOfEveryFabric) {
  const std::vector<Quality> all = loadQualities((kPresets / "front.yaml").string());
  for (const char* fabric : {"linear", "wool", "acrylic_knit"}) {
    const std::vector<Quality> front = of(fabric, all);
    EXPECT_GE(front.size(), 3u);
    for (std::size_t i = 1; i < front.size(); ++i) {
      EXPECT_LT(meanCost(front[i - 1]), meanCost(front[i])) << front[i].name;
    }
    std::size_t place = 0;
    for (const char* name : {"fast", "balanced", "accurate"}) {
      const std::vector<Quality> preset =
          of(fabric, loadQualities((kPresets / (std::string(name) + ".yaml")).string()));
      ASSERT_EQ(preset.size(), 1u);
      EXPECT_EQ(preset.front().name, name);
      while (place < front.size() && front[place].name != name) ++place;
      ASSERT_LT(place, front.size()) << name << " is not on the front of " << fabric;
      EXPECT_EQ(preset.front().cell_size, front[place].cell_size);
      EXPECT_EQ(preset.front().time_step, front[place].time_step);
    }
  }
}

}  // namespace
}  // namespace haptex::scene::test_quality_file
