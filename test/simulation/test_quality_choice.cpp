#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "haptex/simulation/quality_choice.h"
#include "haptex/simulation/studied_fabrics.h"

namespace haptex::simulation::test_quality_choice {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

scene::Quality quality(const std::string& name, double cell_size, double time_step, double cost) {
  scene::Quality quality;
  quality.name = name;
  quality.cell_size = cell_size;
  quality.time_step = time_step;
  quality.measured = {{"swing", "wool", 1e-4, 1e-3, 1e-5, 1.5 * cost},
                      {"swing", "linear", 2e-4, 2e-3, 2e-5, 0.5 * cost}};
  return quality;
}

/// Costs rise from 1 to 8; cells of two sizes.
std::vector<scene::Quality> front() {
  return {quality("a", 0.02, 0.01, 1.0), quality("b", 0.02, 0.005, 2.0),
          quality("c", 0.01, 0.01, 4.0), quality("d", 0.01, 0.005, 8.0)};
}

/// A machine that takes `factor` ms of a cycle for a cost of 1, and 0.1 s for every measurement.
MeasureCycle machine(double factor, int& measurements) {
  return [factor, &measurements](const scene::Quality& quality, int) {
    ++measurements;
    const double cost = quality.measured[0].cost / 1.5;
    return MeasuredCycle{1e-3 * factor * cost, 0.1};
  };
}

std::vector<std::string> names(const std::vector<Candidate>& candidates) {
  std::vector<std::string> list;
  for (const Candidate& candidate : candidates) list.push_back(candidate.quality.name);
  return list;
}

std::vector<Candidate> candidates(const std::vector<double>& milliseconds) {
  std::vector<Candidate> list;
  for (std::size_t i = 0; i < milliseconds.size(); ++i) {
    list.push_back({front().at(i), 1, 1e-3 * milliseconds[i], true});
  }
  return list;
}

using Names = std::vector<std::string>;

TEST(QualityChoice, SubstepsAreAsFewAsMakeNoneTooLong) {
  EXPECT_EQ(substepsOf(0.0125, 0.0125), 1);
  EXPECT_EQ(substepsOf(0.0125, 1.0), 1);
  EXPECT_EQ(substepsOf(0.0125, 0.0124), 2);
  EXPECT_EQ(substepsOf(0.3, 0.1), 3);  // whose quotient is more than 3 in floating point
  EXPECT_EQ(substepsOf(10.0, 1e-6), 10000000);
}

TEST(QualityChoice, PlansKeepTheThreadsOfTheScene) {
  Candidate candidate{front()[1], 3, 1e-3, true};
  candidate.quality.step.newton_iterations = 4;
  const StepPlan plan = planOf(candidate, 2);
  EXPECT_EQ(plan.substeps, 3);
  EXPECT_EQ(plan.step.newton_iterations, 4);
  EXPECT_EQ(plan.step.threads, 2);
}

TEST(QualityChoice, AMethodThatDoesNotKnowSelfCollisionBecomesBackwardEuler) {
  scene::Quality quality;
  quality.name = "fast";
  quality.step.newton_error = 1e-2;
  quality.measured = {{"swing", "wool", 1e-3, 0.01, 2e-5, 0.25}};
  scene::Scene scene;
  cloth::ModelledEffects& effects = scene.effects;
  const auto method = [&](cloth::IntegrationMethod of_quality) {
    quality.step.method = of_quality;
    const scene::Quality known = knownTo(scene, quality);
    EXPECT_EQ(known.measured.empty(), known.step.method != of_quality);
    EXPECT_EQ(known.name == "fast", known.step.method == of_quality);
    EXPECT_EQ(known.step.newton_error, 1e-2);
    return known.step.method;
  };
  using cloth::IntegrationMethod;
  EXPECT_EQ(method(IntegrationMethod::kBackwardMidpoint), IntegrationMethod::kBackwardMidpoint);
  effects.self_collision = true;
  EXPECT_EQ(method(IntegrationMethod::kBackwardMidpoint), IntegrationMethod::kBackwardEuler);
  EXPECT_EQ(method(IntegrationMethod::kTrBdf2), IntegrationMethod::kTrBdf2);
  effects.contacts = true;
  EXPECT_EQ(method(IntegrationMethod::kTrBdf2), IntegrationMethod::kBackwardEuler);
  EXPECT_EQ(method(IntegrationMethod::kBackwardEuler), IntegrationMethod::kBackwardEuler);
}

TEST(QualityChoice, AMethodThatDoesNotKnowObstaclesWithMassBecomesBackwardEuler) {
  scene::Quality quality;
  scene::Scene scene;
  scene.obstacles = {{"ball", mesh::ObstacleSphere{0.1}, Eigen::Isometry3d::Identity()}};
  quality.step.method = cloth::IntegrationMethod::kTrBdf2;
  EXPECT_EQ(knownTo(scene, quality).step.method, cloth::IntegrationMethod::kTrBdf2);
  scene.obstacles[0].body = mesh::ObstacleBody{1.0};
  EXPECT_EQ(knownTo(scene, quality).step.method, cloth::IntegrationMethod::kBackwardEuler);
}

TEST(QualityChoice, OnAMeshThatStaysSettingsCountOnce) {
  std::vector<scene::Quality> qualities = front();
  EXPECT_EQ(settingsAlone(qualities, 0.012).size(), 2u);
  EXPECT_EQ(settingsAlone(qualities, 0.012)[0].name, "c");
  EXPECT_EQ(settingsAlone(qualities, 0.019)[0].name, "a");
  qualities[2].step.method = cloth::IntegrationMethod::kBdf2;
  EXPECT_EQ(settingsAlone(qualities, 0.012).size(), 3u);
}

TEST(QualityChoice, CalibrationMeasuresWhatMayFit) {
  int measurements = 0;
  const auto all = calibrate(front(), 0.01, machine(3.0, measurements), {10.0, 1.0});
  EXPECT_EQ(measurements, 4);
  EXPECT_EQ(all[1].substeps, 2);
  EXPECT_DOUBLE_EQ(all[3].seconds, 24e-3);
  EXPECT_TRUE(all[3].measured);
}

TEST(QualityChoice, CalibrationScalesTheStudyWhereTimeIsShort) {
  int measurements = 0;
  // 0.1 s per measurement: the third would be begun after 0.2 s.
  const auto hurried = calibrate(front(), 0.01, machine(3.0, measurements), {0.15, 1.0});
  EXPECT_EQ(measurements, 2);
  EXPECT_TRUE(hurried[1].measured);
  EXPECT_FALSE(hurried[2].measured);
  EXPECT_DOUBLE_EQ(hurried[3].seconds, 24e-3);

  measurements = 0;  // the third is expected to take 12 ms, which is too long to be worth a look
  const auto short_ones = calibrate(front(), 0.01, machine(3.0, measurements), {10.0, 10e-3});
  EXPECT_EQ(measurements, 2);
  EXPECT_DOUBLE_EQ(short_ones[2].seconds, 12e-3);
  EXPECT_FALSE(short_ones[3].measured);
}

TEST(QualityChoice, WhatCannotComputeTheClothIsNeverChosen) {
  const auto measure = [](const scene::Quality& quality, int) {
    return MeasuredCycle{quality.name == "a" ? kInfinity : 2e-3, 0.0};
  };
  const auto measured = calibrate(front(), 0.01, measure, {10.0, 1.0});
  EXPECT_EQ(names(ladder(measured, 0.02, {})), Names({"b"}));
  EXPECT_EQ(measured[cheapest(measured)].quality.name, "b");
  const auto none = calibrate({front()[0]}, 0.01, measure, {10.0, 1.0});
  EXPECT_TRUE(ladder(none).empty());
  EXPECT_FALSE(mostAccurateWithin(none, 1.0, 1.0));
}

TEST(QualityChoice, IsTheMostAccurateThatLeavesAFifthOfTheBudget) {
  const auto four = candidates({1, 2, 4, 8});
  EXPECT_EQ(mostAccurateWithin(four, 10e-3, 1.0), 3u);
  EXPECT_EQ(mostAccurateWithin(four, 9.9e-3, 1.0), 2u);
  EXPECT_EQ(mostAccurateWithin(four, 10e-3, 2.1), 1u);  // under load
  EXPECT_FALSE(mostAccurateWithin(four, 1e-3, 1.0));
  EXPECT_EQ(cheapest(four), 0u);
  // One that costs more here than in the study does not hide a more accurate one.
  EXPECT_EQ(mostAccurateWithin(candidates({1, 9, 4, 8}), 6e-3, 1.0), 2u);
}

TEST(QualityChoice, TheLadderHasOneMeshAndNothingThatAMoreAccurateOneBeats) {
  EXPECT_EQ(names(ladder(candidates({1, 2, 4, 8}), 0.02, {})), Names({"a", "b"}));
  EXPECT_EQ(names(ladder(candidates({1, 2, 4, 8}), 0.01, {})), Names({"c", "d"}));
  EXPECT_EQ(names(ladder(candidates({1, 2, 4, 8}))), Names({"a", "b", "c", "d"}));
  EXPECT_EQ(names(ladder(candidates({1, 5, 4, 8}))), Names({"a", "c", "d"}));
  EXPECT_EQ(names(ladder(candidates({2, 2, 2, 2}))), Names({"d"}));
}

TEST(QualityChoice, BorrowsCheaperSettingsThatTheCellsLack) {
  std::vector<scene::Quality> qualities = front();
  EXPECT_TRUE(
      borrowedSettings(qualities, 2).empty());  // a and b differ from c and d in cells alone
  qualities[0].step.tolerance = 1e-2;
  const auto borrowed = borrowedSettings(qualities, 2);
  ASSERT_EQ(borrowed.size(), 1u);
  EXPECT_EQ(borrowed[0].name, "a");
  EXPECT_TRUE(borrowedSettings(qualities, 0).empty());  // nothing is cheaper

  const std::vector<Candidate> on_fine_cells = {{qualities[1], 1, 3e-3, true},
                                                {qualities[0], 1, 1e-3, true}};
  EXPECT_EQ(names(ladder(candidates({1, 2, 4, 8}), 0.01, on_fine_cells)),
            Names({"a", "b", "c", "d"}));
  // A borrowed one that takes as long as one with the right cells is no way down.
  EXPECT_EQ(names(ladder(candidates({1, 2, 3, 8}), 0.01, on_fine_cells)), Names({"a", "c", "d"}));
}

TEST(StudiedFabrics, AreFoundByNameOrElseByTensileModulus) {
  material::Fabric fabric;
  fabric.name = "mine";
  fabric.weft.elastic = material::StrainStressCurve::linear(300.0);
  fabric.warp.elastic = material::StrainStressCurve::linear(500.0);
  EXPECT_DOUBLE_EQ(tensileModulus(fabric), 400.0);
  const std::vector<StudiedFabric> studied = {{"linear", 100.0}, {"wool", 1000.0}};
  EXPECT_EQ(nearestStudied(fabric, studied).name, "wool");  // 2.5 times, not a quarter
  fabric.warp.elastic = material::StrainStressCurve::linear(10.0);
  EXPECT_EQ(nearestStudied(fabric, studied).name, "linear");
  fabric.name = "wool";
  EXPECT_EQ(nearestStudied(fabric, studied).name, "wool");
}

TEST(StudiedFabrics, HaveTheirOwnMeasurements) {
  EXPECT_EQ(studiedFabricNames(front()), Names({"wool", "linear"}));
  const auto linear = measurementsOf(front()[0], "linear");
  ASSERT_EQ(linear.size(), 1u);
  EXPECT_EQ(linear[0].position_error, 2e-4);
  EXPECT_TRUE(measurementsOf(front()[0], "silk").empty());
}

TEST(StudiedFabrics, OfTheKindOfAFabricHaveItsQualities) {
  std::vector<scene::Quality> qualities = front();
  qualities[0].fabric = qualities[2].fabric = "wool";
  qualities[1].fabric = "linear";
  const std::vector<StudiedFabric> studied = {{"linear", 100.0}, {"wool", 1000.0}, {"knit", 500.0}};
  const auto names = [&](const std::string& name, double modulus) {
    material::Fabric fabric;
    fabric.name = name;
    fabric.weft.elastic = fabric.warp.elastic = material::StrainStressCurve::linear(modulus);
    Names list;
    for (const scene::Quality& quality : qualitiesFor(fabric, qualities, studied)) {
      list.push_back(quality.name);
    }
    return list;
  };
  EXPECT_EQ(names("mine", 2000.0), Names({"a", "c", "d"}));  // "d" is for any fabric
  EXPECT_EQ(names("linear", 2000.0), Names({"b", "d"}));
  EXPECT_EQ(names("knit", 500.0), Names({"a", "c", "d"}));  // none is for it: wool is next
  qualities = front();
  EXPECT_EQ(names("mine", 2000.0), Names({"a", "b", "c", "d"}));
}

TEST(QualityChoice, CostsAreThoseOfTheFabricThatAQualityIsFor) {
  std::vector<scene::Quality> qualities = front();
  for (scene::Quality& quality : qualities) quality.fabric = "wool";
  qualities[3].measured[1].cost = 1000.0;  // of another fabric
  int measurements = 0;
  const auto scaled = calibrate(qualities, 0.01, machine(3.0, measurements), {0.05, 1.0});
  EXPECT_EQ(measurements, 1);
  EXPECT_NEAR(scaled[3].seconds, 24e-3, 1e-12);
}

scene::Quality implicitQuality(double time_step, int solves) {
  scene::Quality quality;
  quality.name = "fine";
  quality.cell_size = 0.01;
  quality.time_step = time_step;
  quality.step.newton_iterations = solves;
  quality.measured.resize(1);
  return quality;
}

TEST(Reductions, AreFewerSolvesThenFewerSubstepsThenLongerSteps) {
  const std::vector<Candidate> rungs = reductions(implicitQuality(0.005, 2), 0.01, 8e-3, 2);
  ASSERT_EQ(rungs.size(), 4u);
  const std::vector<int> solves = {1, 1, 1, 2}, substeps = {1, 1, 2, 2}, cycles = {2, 1, 1, 1};
  const std::vector<double> seconds = {1e-3, 2e-3, 4e-3, 8e-3};
  for (std::size_t i = 0; i < rungs.size(); ++i) {
    EXPECT_EQ(rungs[i].quality.step.newton_iterations, solves[i]) << i;
    EXPECT_EQ(rungs[i].substeps, substeps[i]) << i;
    EXPECT_EQ(rungs[i].cycles, cycles[i]) << i;
    EXPECT_NEAR(rungs[i].seconds, seconds[i], 1e-12) << i;
    EXPECT_EQ(rungs[i].quality.cell_size, 0.01) << i;
    EXPECT_EQ(rungs[i].quality.measured.empty(), i < 3) << i;  // nobody has measured its error
  }
  EXPECT_EQ(rungs[3].quality.name, "fine");
  EXPECT_EQ(rungs[2].quality.name, "fine, backward_euler, 1 solve in 5 ms");
  EXPECT_EQ(rungs[0].quality.name, "fine, backward_euler, 1 solve in 20 ms");
}

TEST(Reductions, HalveManySolves) {
  const std::vector<Candidate> rungs = reductions(implicitQuality(0.01, 10), 0.01, 1e-2, 1);
  ASSERT_EQ(rungs.size(), 4u);
  const std::vector<int> solves = {1, 2, 5, 10};
  for (std::size_t i = 0; i < rungs.size(); ++i) {
    EXPECT_EQ(rungs[i].quality.step.newton_iterations, solves[i]) << i;
    EXPECT_NEAR(rungs[i].seconds, 1e-3 * solves[i], 1e-12) << i;
  }
}

// With few solves they gain energy: wool's swing in the study ends with 3 J too much.
TEST(Reductions, NeverCutStepsThatEndByAnErrorShort) {
  for (const auto method : {cloth::IntegrationMethod::kBdf2, cloth::IntegrationMethod::kTrBdf2}) {
    scene::Quality quality = implicitQuality(0.01, 20);
    quality.step.method = method;
    quality.step.newton_error = 1e-2;
    const std::vector<Candidate> rungs = reductions(quality, 0.01, 6e-3, 1);
    ASSERT_EQ(rungs.size(), 3u);
    EXPECT_EQ(rungs[2].quality.step.method, method);
    EXPECT_EQ(rungs[2].quality.step.newton_iterations, 20);
    EXPECT_EQ(rungs[2].quality.step.newton_error, 1e-2);
    EXPECT_EQ(rungs[2].seconds, 6e-3);
    for (std::size_t i : {0, 1}) {
      EXPECT_EQ(rungs[i].quality.step.method, cloth::IntegrationMethod::kBackwardEuler);
      EXPECT_EQ(rungs[i].quality.step.newton_error, 0.0);
      EXPECT_EQ(rungs[i].quality.step.newton_iterations, static_cast<int>(i) + 1);
      EXPECT_LT(rungs[i].seconds, rungs[i + 1].seconds);
    }
  }
}

TEST(Reductions, KeepTheRateOfTheStatesWhereItIsAskedFor) {
  const std::vector<Candidate> rungs = reductions(implicitQuality(0.005, 2), 0.01, 8e-3, 1);
  ASSERT_EQ(rungs.size(), 3u);
  for (const Candidate& rung : rungs) EXPECT_EQ(rung.cycles, 1);
  EXPECT_EQ(rungs[0].quality.name, "fine, backward_euler, 1 solve in 10 ms");
}

TEST(Reductions, KeepTheStepsOfExplicitMethods) {
  scene::Quality quality = implicitQuality(0.001, 1);
  quality.step.method = cloth::IntegrationMethod::kExplicitEuler;
  EXPECT_EQ(reductions(quality, 0.01, 1e-3, 2).size(), 1u);
}

}  // namespace
}  // namespace haptex::simulation::test_quality_choice
