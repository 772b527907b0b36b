#include <fstream>
#include <set>
#include <sstream>

#include "../../temporary_directory.h"
#include "haptex/studies/jobs/trade_off_sweep.h"
#include "jobs_fixtures.h"

namespace haptex::studies::test_trade_off_sweep {
namespace {

constexpr std::size_t kHang = 2, kFold = 4;  // units, of one fabric

TradeOffPoint coarse() {
  TradeOffPoint point;
  point.cells = 8;
  return point;
}

/// Of `linear`, with references that take a moment only.
TradeOffSweepSettings small(std::vector<TradeOffPoint> points) {
  return {1, HAPTEX_CONFIG_DIRECTORY, std::move(points), {8, 2}};
}

std::string summaryOf(const std::vector<std::string>& records) {
  std::ostringstream out;
  TradeOffSweep(small({})).summarise(records, out);
  return out.str();
}

TEST_F(StudyJobs, OfTheTradeOffMergeToTheSameBytesHoweverManyThereWere) {
  const TradeOffSweep study(small({coarse()}));
  std::string whole;
  for (const std::size_t jobs : {1u, 2u, 5u}) {  // so every unit is computed three times
    runAll(study, jobs, study.inputs());
    const std::string merged = mergedText(study, jobs);
    if (whole.empty()) whole = merged;
    EXPECT_EQ(merged, whole) << jobs;
  }
}

TEST(TradeOffSweep, TellsTheErrorsThatTheBenchFinds) {
  TradeOffPoint other = coarse();
  other.step.method = cloth::IntegrationMethod::kBackwardMidpoint;
  const std::vector<TradeOffPoint> points = {coarse(), other};
  const TradeOffSweep study(small(points));
  for (const std::size_t unit : {kHang, kFold}) {
    const TradeOffCase of = loadCase(tradeOffCases({"linear"})[unit], HAPTEX_CONFIG_DIRECTORY);
    const std::vector<Reference> references = {computeReference(of, {8, 2})};
    const auto results = followPoints(points, {of}, references, 1e9, 1, {});
    std::ostringstream expected;
    const auto tell = [&](const std::string& name, double value, const char* unit_of_it) {
      expected << name << '\t' << value << '\t' << unit_of_it << '\n';
    };
    const std::string begin = std::string("trade_off/") + nameOf(of.motion) + "/linear/";
    tellErrors(begin + "reference", references[0].own_error, tell);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const TradeOffResult& result = results[i][0];
      if (!result.followed) continue;
      tellErrors(begin + nameOf(points[i]), result.error, tell);
      tell(begin + nameOf(points[i]) + "/solves_per_step", result.solves_per_step, "1");
      tell(begin + nameOf(points[i]) + "/stable", result.stable, "1");
    }
    EXPECT_EQ(results[1][0].followed, unit == kHang);
    EXPECT_EQ(summaryOf({study.run(unit)}), expected.str());
  }
}

TEST(TradeOffSweep, CountsStepsOfAPointThatBlowsUpUntilThen) {
  TradeOffPoint point = coarse();
  point.step.method = cloth::IntegrationMethod::kExplicitEuler;
  const std::string record = TradeOffSweep(small({coarse(), point})).run(kHang);
  EXPECT_NE(record.find("\t1\t1\t120\tgreen_lagrange-explicit_euler-12.5ms-8cells\tinf\tinf\tinf"),
            std::string::npos)
      << record;
  EXPECT_NE(record.find("\tinf\t0\t"), std::string::npos) << record;
  EXPECT_EQ(record.find("\t120", record.find("explicit")), std::string::npos) << record;
}

TEST(TradeOffSweep, TellsWhyACaseWasRefused) {
  TradeOffPoint point;
  point.cells = 0;
  const std::string record = TradeOffSweep(small({point})).run(kHang);
  EXPECT_EQ(record, "hang\tlinear\tcells is 0; it must be positive");
  EXPECT_EQ(summaryOf({record}),
            "trade_off/hang/linear/refused\tcells is 0; it must be positive\t\n");
}

TEST(TradeOffSweep, RefusesRecordsThatItHasNotWritten) {
  for (const char* record :
       {"", "hang\tlinear", "walk\tlinear\twhy", "hang\tlinear\t1\t2", "hang\tlinear\t1\t2\tmany",
        "hang\tlinear\t1\t2\t3\tpoint\t1\t2\t3\t1\t2"}) {
    EXPECT_NE(refusalOf([&] { summaryOf({record}); }).find("no result of a case of the trade-off"),
              std::string::npos)
        << record;
  }
}

TEST(TradeOffSweep, HasTheBenchsFabricsFirstAndNoMoreThanThereAre) {
  const std::vector<std::string> fabrics = sweptFabrics(HAPTEX_CONFIG_DIRECTORY);
  ASSERT_GT(fabrics.size(), 5u);
  EXPECT_EQ(
      std::vector<std::string>(fabrics.begin(), fabrics.begin() + 5),
      (std::vector<std::string>{"linear", "wool", "acrylic_knit", "cotton_canvas", "cotton_knit"}));
  EXPECT_EQ(std::set<std::string>(fabrics.begin(), fabrics.end()).size(), fabrics.size());
  EXPECT_EQ(TradeOffSweep({fabrics.size(), HAPTEX_CONFIG_DIRECTORY, {}, {}}).unitCount(),
            fabrics.size() * kMotions.size());
  for (const std::size_t count : {std::size_t{0}, fabrics.size() + 1}) {
    EXPECT_EQ(refusalOf([&] {
                TradeOffSweep({count, HAPTEX_CONFIG_DIRECTORY, {}, {}});
              })
                  .find("cases = " + std::to_string(count) + ": allowed are 1 to " +
                        std::to_string(fabrics.size()) + ", the fabrics of "),
              0u);
  }
}

TEST(TradeOffSweep, KnowsWhatItDependsOn) {
  const test::TemporaryDirectory config;
  std::filesystem::create_directory(config.path() + "/fabrics");
  const auto inputs_with = [&](const char* fabric, const TradeOffPoint& point, int cells) {
    std::ofstream(config.path() + "/fabrics/wool.yaml") << fabric;
    return TradeOffSweep({3, config.path(), {point}, {cells, 2}}).inputs();
  };
  TradeOffPoint finer = coarse();
  finer.cells = 9;
  const StudyInputs inputs = inputs_with("a", coarse(), 8);
  EXPECT_EQ(inputs[0], (std::pair<std::string, std::string>("cases", "3")));
  EXPECT_NE(inputs_with("b", coarse(), 8), inputs);
  EXPECT_NE(inputs_with("a", finer, 8), inputs);
  EXPECT_NE(inputs_with("a", coarse(), 16), inputs);
  EXPECT_EQ(inputs_with("a", coarse(), 8), inputs);
}

TEST(TradeOffPoints, HaveNamesOfTheirOwn) {
  std::set<std::string> names;
  for (const TradeOffPoint& point : tradeOffPoints()) names.insert(nameOf(point));
  EXPECT_EQ(names.size(), tradeOffPoints().size());
}

TEST(TradeOffCases, AreOneMotionAfterTheOther) {
  const std::vector<TradeOffCaseName> cases = tradeOffCases(tradeOffFabrics());
  ASSERT_EQ(cases.size(), 15u);
  EXPECT_EQ(cases[1].motion, Motion::kSwing);
  EXPECT_EQ(cases[1].fabric, "wool");
  EXPECT_EQ(cases[14].motion, Motion::kFold);
  EXPECT_EQ(loadCase(cases[14], HAPTEX_CONFIG_DIRECTORY).fabric.name, "acrylic_knit");
}

}  // namespace
}  // namespace haptex::studies::test_trade_off_sweep
