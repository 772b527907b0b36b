#include <limits>
#include <sstream>

#include "haptex/base/workload.h"
#include "haptex/studies/extreme_run.h"
#include "haptex/studies/extreme_tally.h"
#include "haptex/studies/jobs/extremes_study.h"
#include "haptex/studies/jobs/study_program.h"
#include "jobs_fixtures.h"

namespace haptex::studies::test_extremes_study {
namespace {

constexpr std::size_t kCases = base::unlessSanitized(22, 7);

std::string summaryOf(const Study& study, const std::vector<std::string>& records) {
  std::ostringstream out;
  study.summarise(records, out);
  return out.str();
}

TEST_F(StudyJobs, OfExtremeCasesMergeToTheSameBytesHoweverManyThereWere) {
  for (const bool self_colliding : {false, true}) {
    const ExtremesStudy study({self_colliding ? 7 : kCases, 1, self_colliding});
    std::string whole;
    for (const std::size_t jobs : {1u, 2u, 7u}) {
      runAll(study, jobs, study.inputs());
      const std::string merged = mergedText(study, jobs);
      if (whole.empty()) whole = merged;
      EXPECT_EQ(merged, whole) << jobs;
    }
  }
}

TEST(ExtremesStudy, TellsWhatRunningTheCasesTells) {
  const ExtremesStudy study({kCases, 5, false});
  ExtremeTally tally;
  std::vector<std::string> records;
  for (std::size_t i = 0; i < kCases; ++i) {
    const ExtremeCase extreme = drawExtremeCase(5 + i);
    tally.add(extreme, runExtremeCase(extreme));
    records.push_back(study.run(i));
  }
  std::ostringstream expected;
  tally.print("stability/", [&](const std::string& name, double value, const char* unit) {
    expected << name << '\t' << value << '\t' << unit << '\n';
  });
  EXPECT_EQ(summaryOf(study, records), expected.str());
}

TEST(ExtremesStudy, CountsFailedCases) {
  const ExtremesStudy study({1, 5, false});
  const std::string summary = summaryOf(
      study, {"seed=5 kind=fast method=bdf2\tno_return\tnan\t0.5\t10\t2\t30\t1\t0\t0\t\tseed=5"});
  EXPECT_NE(summary.find("stability/fast/failures\t1\tcases\n"), std::string::npos) << summary;
  EXPECT_NE(summary.find("stability/worst_growth\tnan\t"), std::string::npos) << summary;
  EXPECT_NE(summary.find("stability/worst_return_error\t0.5\t"), std::string::npos) << summary;
}

TEST(ExtremesStudy, RefusesRecordsThatItHasNotWritten) {
  const ExtremesStudy study({1, 5, false});
  for (const std::string record :
       {"", "1\t2", "seed=5 kind=fast method=bdf2\tgone\t0\t0\t1\t0\t1\t0\t0\t0",
        "seed=5 kind=fast method=bdf2\tnone\tx\t0\t1\t0\t1\t0\t0\t0",
        "seed=5 kind=slow method=bdf2\tnone\t0\t0\t1\t0\t1\t0\t0\t0"}) {
    EXPECT_THROW(summaryOf(study, {record}), std::invalid_argument) << record;
  }
}

TEST(ExtremesStudy, RefusesNoCasesAndSeedsBeyondTheLast) {
  EXPECT_EQ(refusalOf([] { ExtremesStudy({0, 1, false}); }), "cases = 0: allowed is at least 1");
  const std::uint64_t last = std::numeric_limits<std::uint64_t>::max() / 2;
  EXPECT_NE(refusalOf([&] {
              ExtremesStudy({2, last, false});
            }).find("allowed are seeds up to"),
            std::string::npos);
}

TEST(StudyInputs, OfTheProgramAreTheSameInEveryRun) {
  const StudyInputs inputs = inputsOfProgram();
  ASSERT_EQ(inputs.size(), 2u);
  EXPECT_EQ(inputs[0].first, "program");
  EXPECT_EQ(inputs[0].second.size(), 16u);
  EXPECT_EQ(inputs[1].first, "instructions");
  EXPECT_EQ(inputsOfProgram(), inputs);
}

class StudyProgram : public StudyJobs {
 protected:
  int run(const std::vector<std::string>& arguments) {
    std::ostringstream out, err;
    const int status = studyProgram(arguments, HAPTEX_SOURCE_DIRECTORY, out, err);
    out_ = out.str();
    err_ = err.str();
    return status;
  }

  std::string out_, err_;
};

TEST_F(StudyProgram, TellsComputesAndMerges) {
  EXPECT_EQ(run({"extremes", "--cases", "3"}), 0) << err_;
  EXPECT_EQ(out_.find("units\t3\ncases\t3\nseed\t1\nself_collision\t0\nprogram\t"), 0u) << out_;
  const std::vector<std::string> study = {"extremes", "--cases", "3", "--directory",
                                          directory_, "--jobs",  "2"};
  const auto with = [&](const std::string& option, const std::string& value) {
    std::vector<std::string> arguments = study;
    arguments.insert(arguments.end(), {option, value});
    return arguments;
  };
  EXPECT_EQ(run(with("--merge", directory_ + "/all")), 1);
  EXPECT_EQ(err_.find("2 of 2 jobs are missing"), 0u) << err_;
  for (const char* job : {"1", "2"}) EXPECT_EQ(run(with("--job", job)), 0) << err_;
  EXPECT_EQ(err_.find("extremes, job 2 of 2: 2 units in "), 0u) << err_;
  EXPECT_EQ(run(with("--job", "2")), 0);
  EXPECT_EQ(err_, "extremes, job 2 of 2: is there\n");
  EXPECT_EQ(run(with("--merge", directory_ + "/all")), 0) << err_;
  EXPECT_NE(out_.find("stability/failures\t0\tcases\n"), std::string::npos) << out_;
  EXPECT_EQ(loadJobResult(directory_ + "/all").records.size(), 3u);
  std::vector<std::string> other = with("--merge", directory_ + "/all");
  other.insert(other.end(), {"--seed", "9"});
  EXPECT_EQ(run(other), 1);
  EXPECT_NE(err_.find("have not the input seed 9"), std::string::npos) << err_;
}

TEST_F(StudyProgram, SaysWhatIsWrongWithItsArguments) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> refused = {
      {{}, "0 studies are named"},
      {{"extremes", "drape"}, "2 studies are named"},
      {{"drape"}, "there is no study 'drape'"},
      {{"garments", "--cases", "-1"}, "--cases is '-1'"},
      {{"extremes", "--cases", "0"}, "--cases is '0': allowed are whole numbers from 1 on"},
      {{"extremes", "--cases", "1e3"}, "--cases is '1e3'"},
      {{"extremes", "--seed", "-1"}, "--seed is '-1': allowed are whole numbers from 0 on"},
      {{"extremes", "--jobs", "2"}, "--job or --merge needs both"},
      {{"extremes", "--jobs", "2", "--job", "1"}, "--job or --merge needs both"},
      {{"extremes", "--job", "1", "--directory", "x"}, "--job or --merge needs both"},
      {{"extremes", "--job", "1", "--merge", "x"}, "--job and --merge: allowed is one"},
      {{"trade_off", "--seed", "1"}, "--seed: trade_off draws nothing"},
      {{"trade_off", "--cases", "1000"}, "cases = 1000: allowed are 1 to "},
      {{"evaluation", "--cases", "0"}, "--cases is '0': allowed are whole numbers from 1 on"},
      {{"extremes", "--size", "3"}, "--size is unknown"}};
  for (const auto& [arguments, message] : refused) {
    EXPECT_EQ(run(arguments), 2);
    EXPECT_EQ(err_.find(message), 0u) << err_;
    EXPECT_NE(err_.find("usage: run_study"), std::string::npos);
  }
}

}  // namespace
}  // namespace haptex::studies::test_extremes_study
