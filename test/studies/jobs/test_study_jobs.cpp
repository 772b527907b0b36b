#include <iterator>

#include "jobs_fixtures.h"

namespace haptex::studies::test_study_jobs {
namespace {

const StudyInputs kInputs = {{"units", "100"}, {"program", "0123"}};

TEST(StudyJob, TogetherHaveEveryUnitOnce) {
  for (const std::size_t units : {1u, 7u, 100u, 1000003u}) {
    for (const std::size_t count : {1u, 2u, 7u, 64u}) {
      std::size_t next = 0;
      for (std::size_t i = 1; i <= count; ++i) {
        const StudyJob job{i, count};
        EXPECT_EQ(job.first(units), next);
        next = job.end(units);
        EXPECT_LE(next - job.first(units), units / count + 1);
        EXPECT_GE(next - job.first(units), units / count);
      }
      EXPECT_EQ(next, units);
    }
  }
}

TEST_F(StudyJobs, MergeToTheSameBytesHoweverManyThereWere) {
  const Squares study(100);
  runAll(study, 1, kInputs);
  const std::string whole = mergedText(study, 1);
  EXPECT_EQ(whole, base::readTextFile(path(study, 1, 1)));
  for (const std::size_t jobs : {2u, 7u, 100u}) {
    runAll(study, jobs, kInputs);
    EXPECT_EQ(mergedText(study, jobs), whole) << jobs;
  }
}

TEST_F(StudyJobs, ThatAreThereAreNotComputedAgain) {
  const Squares study(100);
  runAll(study, 7, kInputs);
  EXPECT_EQ(study.runs, 100u);
  runAll(study, 7, kInputs);
  EXPECT_EQ(study.runs, 100u);
  std::filesystem::remove(path(study, 3, 7));
  EXPECT_TRUE(runJob(study, kInputs, {3, 7}, directory_).computed);
  EXPECT_EQ(study.runs, 114u);
}

TEST_F(StudyJobs, ThatWereKilledLeaveNothingAndAreBegunAnew) {
  Squares study(100);
  study.fails_at = 20;
  EXPECT_EQ(refusalOf([&] { runAll(study, 7, kInputs); }), "killed");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(directory_), {}), 1);
  study.fails_at = ~std::size_t{0};
  runAll(study, 7, kInputs);
  const std::string resumed = mergedText(study, 7);
  runAll(study, 1, kInputs);
  EXPECT_EQ(resumed, mergedText(study, 1));
}

TEST_F(StudyJobs, WithOtherInputsAreComputedAnew) {
  const Squares study(100);
  runAll(study, 2, kInputs);
  const JobReport report =
      runJob(study, {{"units", "100"}, {"program", "4567"}}, {1, 2}, directory_);
  EXPECT_TRUE(report.computed);
  EXPECT_EQ(report.replaced, path(study, 1, 2) + ": input program is '0123' and '4567'");
  EXPECT_EQ(refusalOf([&] { mergedText(study, 2); }),
            path(study, 1, 2) + " and " + path(study, 2, 2) +
                " do not belong together: input program is '4567' and '0123'");
}

TEST_F(StudyJobs, ThatAreMissingAreNamed) {
  const Squares study(100);
  runAll(study, 7, kInputs);
  std::filesystem::remove(path(study, 2, 7));
  std::filesystem::remove(path(study, 7, 7));
  EXPECT_EQ(refusalOf([&] { mergedText(study, 7); }),
            "2 of 7 jobs are missing: " + path(study, 2, 7) + ", " + path(study, 7, 7));
  EXPECT_NE(refusalOf([&] { mergedText(study, 90); }).find("squares_5_of_90.txt, ..."),
            std::string::npos);
}

TEST_F(StudyJobs, ThatAreDamagedAreRefusedByNameAndComputedAnew) {
  const Squares study(20);
  runAll(study, 2, kInputs);
  const std::string sound = mergedText(study, 2), file = path(study, 2, 2);
  const std::string text = base::readTextFile(file);
  for (std::size_t i = 0; i < text.size(); ++i) {
    std::string changed = text;
    changed[i] ^= 1;
    for (const std::string& damaged : {changed, text.substr(0, i)}) {
      overwrite(file, damaged);
      const std::string refusal = refusalOf([&] { mergedText(study, 2); });
      EXPECT_EQ(refusal.find(file + ": "), 0u) << i << ' ' << refusal;
    }
  }
  const JobReport report = runJob(study, kInputs, {2, 2}, directory_);
  EXPECT_TRUE(report.computed);
  EXPECT_EQ(report.replaced.find(file + ": is incomplete"), 0u) << report.replaced;
  EXPECT_EQ(mergedText(study, 2), sound);
}

TEST_F(StudyJobs, UnderAnotherNameAreRefused) {
  const Squares study(100);
  runAll(study, 2, kInputs);
  std::filesystem::copy_file(path(study, 1, 2), path(study, 2, 2),
                             std::filesystem::copy_options::overwrite_existing);
  EXPECT_EQ(refusalOf([&] { mergedText(study, 2); }),
            path(study, 2, 2) +
                ": is job 1 of 2 of the study 'squares', must be the one that its name says");
}

TEST_F(StudyJobs, ThatThereAreNotAreRefused) {
  const Squares study(5);
  const auto refusal = [&](std::size_t index, std::size_t count) {
    return refusalOf([&] { runJob(study, kInputs, {index, count}, directory_); });
  };
  EXPECT_EQ(refusal(1, 6), "jobs = 6: allowed are 1 to 5, one for each unit");
  EXPECT_EQ(refusal(1, 0), "jobs = 0: allowed are 1 to 5, one for each unit");
  EXPECT_EQ(refusal(3, 2), "job = 3: allowed are 1 to 2");
  EXPECT_EQ(refusal(0, 2), "job = 0: allowed are 1 to 2");
  EXPECT_NE(refusalOf([&] {
              runJob(study, kInputs, {1, 2}, directory_ + "/none");
            }).find("cannot be written: No such file"),
            std::string::npos);
  EXPECT_EQ(study.runs, 2u);
}

TEST(JobFile, IsReadBackAsItWas) {
  const JobResult result{"squares", {2, 3}, 10, kInputs, {"9", "16", "25"}};
  const JobResult again = parseJobResult(toText(result), "file");
  EXPECT_EQ(toText(again), toText(result));
  EXPECT_EQ(again.inputs, kInputs);
  EXPECT_EQ(again.records, result.records);
}

TEST(JobFile, RefusesWhatItDoesNotSay) {
  JobResult result{"squares", {2, 3}, 10, kInputs, {"9", "16"}};
  EXPECT_EQ(refusalOf([&] { parseJobResult(toText(result), "file"); }),
            "file: has results of 2 units, must have 3 as it says");
  result.job = {4, 3};
  EXPECT_EQ(refusalOf([&] { parseJobResult(toText(result), "file"); }),
            "file: line 1 must be 'haptex study NAME, job INDEX of COUNT, UNITS units'");
  EXPECT_EQ(refusalOf([&] { parseJobResult("", "file"); }),
            "file: is incomplete: its last line has no end");
}

}  // namespace
}  // namespace haptex::studies::test_study_jobs
