#include <sys/stat.h>

#include <fstream>
#include <sstream>

#include "../../temporary_directory.h"
#include "haptex/studies/jobs/script_study.h"
#include "jobs_fixtures.h"

namespace haptex::studies::test_script_study {
namespace {

/// A script of the shell that is given "5" before what it is asked.
class Script {
 public:
  explicit Script(const std::string& text) : path_(folder_.path() + "/script") {
    std::ofstream(path_) << "#!/bin/sh\n" << text;
    chmod(path_.c_str(), 0700);
  }
  ScriptStudy study() const { return {"script", {path_, "5"}}; }

 private:
  test::TemporaryDirectory folder_;
  std::string path_;
};

constexpr const char* kSquares =
    "case $2 in\n"
    "  describe) printf 'units\\t9\\nfrom\\t%s\\n' $1;;\n"
    "  run) echo $(($1 + $3)) $(($3 * $3));;\n"
    "  summary) while read one other; do sum=$((sum + other)); done; echo \"sum $sum\";;\n"
    "esac\n";

std::string summaryOf(const Study& study, const std::vector<std::string>& records) {
  std::ostringstream out;
  study.summarise(records, out);
  return out.str();
}

TEST_F(StudyJobs, OfAScriptMergeToTheSameBytesHoweverManyThereWere) {
  const Script script(kSquares);
  const ScriptStudy study = script.study();
  EXPECT_EQ(study.unitCount(), 9u);
  EXPECT_EQ(study.inputs(), (StudyInputs{{"from", "5"}}));
  std::string whole;
  for (const std::size_t jobs : {1u, 2u, 9u}) {
    runAll(study, jobs, study.inputs());
    const std::string merged = mergedText(study, jobs);
    if (whole.empty()) whole = merged;
    EXPECT_EQ(merged, whole) << jobs;
  }
  const JobResult result = parseJobResult(whole, "whole");
  EXPECT_EQ(result.records[8], "13 64");
  EXPECT_EQ(summaryOf(study, result.records), "sum 204\n");
}

TEST(ScriptStudy, PassesMoreThanAPipeHolds) {
  const Script script("case $2 in describe) printf 'units\\t1\\n';; summary) cat;; esac\n");
  const std::string record(100000, 'x');
  EXPECT_EQ(summaryOf(script.study(), {record, record}), record + '\n' + record + '\n');
}

TEST(ScriptStudy, SaysWhichCallDidNotDoWhatItMust) {
  const auto refusal = [](const std::string& text, const auto& call) {
    const Script script(text);
    const std::string message = refusalOf([&] { call(script.study()); });
    return message.substr(message.find("/script ") + 1);
  };
  const auto nothing = [](const ScriptStudy&) {};
  EXPECT_EQ(refusal("echo units\n", nothing),
            "script 5 describe: has printed a line that is no name with a value");
  EXPECT_EQ(refusal("printf 'units\\t0\\n'\n", nothing),
            "script 5 describe: must first print units, 1 or more");
  EXPECT_EQ(refusal("true\n", nothing), "script 5 describe: must first print units, 1 or more");
  EXPECT_EQ(refusal("exit 3\n", nothing), "script 5 describe: ended with 3");
  EXPECT_EQ(refusal("kill -9 $$\n", nothing), "script 5 describe: was killed");
  EXPECT_EQ(refusalOf([] { ScriptStudy("none", {"/none/script"}); }),
            "/none/script describe: No such file or directory");
  const std::string well = "[ $2 = describe ] && printf 'units\\t1\\n' && exit\n";
  const auto run = [](const ScriptStudy& study) { study.run(0); };
  EXPECT_EQ(refusal(well, run), "script 5 run 0: ended with 1");
  EXPECT_EQ(refusal(well + "true\n", run), "script 5 run 0: must print one line");
  EXPECT_EQ(refusal(well + "echo\n", run), "script 5 run 0: must print one line");
  EXPECT_EQ(refusal(well + "echo a; echo b\n", run), "script 5 run 0: must print one line");
  EXPECT_EQ(refusal(well + "printf a\n", run), "script 5 run 0: must print one line");
  EXPECT_EQ(refusal(well, [](const ScriptStudy& study) { summaryOf(study, {}); }),
            "script 5 summary: ended with 1");
}

}  // namespace
}  // namespace haptex::studies::test_script_study
