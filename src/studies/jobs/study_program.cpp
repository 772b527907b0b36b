#include "haptex/studies/jobs/study_program.h"

#include <algorithm>
#include <chrono>
#include <memory>
#include <ostream>
#include <stdexcept>
#include <string>

#include "haptex/base/command_line.h"
#include "haptex/base/quoted.h"
#include "haptex/base/require.h"
#include "haptex/base/whole_file.h"
#include "haptex/studies/jobs/extremes_study.h"
#include "haptex/studies/jobs/garment_study.h"
#include "haptex/studies/jobs/script_study.h"
#include "haptex/studies/jobs/study_jobs.h"
#include "haptex/studies/jobs/trade_off_sweep.h"

namespace haptex::studies {
namespace {

const char* const kUsage =
    "usage: run_study STUDY [--cases N] [--seed S]\n"
    "       run_study STUDY [--cases N] [--seed S] --jobs N --job I --directory DIR\n"
    "       run_study STUDY [--cases N] [--seed S] --jobs N --merge OUT --directory DIR\n"
    "Tells what a study has to compute, computes one of N jobs, or merges them. STUDY is "
    "extremes,\n"
    "self_colliding, garments, evaluation, or trade_off, which has no --seed: docs/studies.md.\n";

struct Request {
  std::string directory, merge;
  std::size_t jobs = 0, job = 0;  // 0: not asked for
  std::unique_ptr<Study> study;
};

template <typename Number>
Number numberOf(const base::CommandLine& line, const std::string& option, Number otherwise,
                Number least) {
  return line.number(
      option, otherwise, [&](Number number) { return number >= least; },
      "are whole numbers from " + std::to_string(least) + " on");
}

std::unique_ptr<Study> studyOf(const base::CommandLine& line, const std::string& package) {
  const std::string config = package + "/config";
  if (line.files.size() != 1) {
    base::refuse(line.files.size(),
                 " studies are named: allowed is one, extremes, self_colliding, garments, "
                 "trade_off or evaluation");
  }
  const std::string& name = line.files[0];
  if (name == "garments") {
    return std::make_unique<GarmentStudy>(
        GarmentSettings{numberOf<std::size_t>(line, "--cases", 20, 1),
                        numberOf<unsigned>(line, "--seed", 1, 0), config});
  }
  if (name == "trade_off") {
    if (line.options.count("--seed") > 0) base::refuse("--seed: trade_off draws nothing");
    TradeOffSweepSettings settings;
    settings.fabrics = numberOf<std::size_t>(line, "--cases", tradeOffFabrics().size(), 1);
    settings.config = config;
    return std::make_unique<TradeOffSweep>(settings);
  }
  if (name == "evaluation") {
    const auto cases = std::to_string(numberOf<unsigned>(line, "--cases", 2, 1));
    const auto seed = std::to_string(numberOf<unsigned>(line, "--seed", 1, 0));
    return std::make_unique<ScriptStudy>(
        name, std::vector<std::string>{package + "/scripts/machine_rater/units.py", cases, seed});
  }
  if (name != "extremes" && name != "self_colliding") {
    base::refuse("there is no study ", base::quoted(name),
                 ": allowed are extremes, self_colliding, garments, trade_off and evaluation");
  }
  ExtremesSettings settings;
  settings.self_colliding = name == "self_colliding";
  settings.cases =
      numberOf<std::size_t>(line, "--cases", settings.self_colliding ? 1000 : 50000, 1);
  settings.seed = numberOf<std::uint64_t>(line, "--seed", settings.seed, 0);
  return std::make_unique<ExtremesStudy>(settings);
}

Request parse(const std::vector<std::string>& arguments, const std::string& package) {
  const base::CommandLine line = base::readCommandLine(
      arguments, {"--cases", "--seed", "--jobs", "--job", "--merge", "--directory"});
  Request request;
  request.study = studyOf(line, package);
  request.jobs = numberOf<std::size_t>(line, "--jobs", 0, 1);
  request.job = numberOf<std::size_t>(line, "--job", 0, 1);
  request.merge = line.value("--merge");
  request.directory = line.value("--directory");
  const bool works = request.job > 0 || !request.merge.empty();
  if (request.job > 0 && !request.merge.empty()) base::refuse("--job and --merge: allowed is one");
  if (works != (request.jobs > 0) || works != !request.directory.empty()) {
    base::refuse("--job or --merge needs both --jobs and --directory, and these need one of them");
  }
  return request;
}

void describe(const Request& request, std::ostream& out) {
  out << "units\t" << request.study->unitCount() << '\n';
  for (const StudyInputs& inputs : {request.study->inputs(), inputsOfProgram()}) {
    for (const auto& [name, value] : inputs) out << name << '\t' << value << '\n';
  }
}

void compute(const Request& request, std::ostream& err) {
  const StudyJob job{request.job, request.jobs};
  StudyInputs inputs = request.study->inputs();
  for (const auto& input : inputsOfProgram()) inputs.push_back(input);
  const auto begin = std::chrono::steady_clock::now();
  const JobReport report = runJob(*request.study, inputs, job, request.directory);
  if (!report.replaced.empty()) err << report.replaced << ": computed anew\n";
  err << request.study->name() << ", job " << job.index << " of " << job.count << ": ";
  if (report.computed) {
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
    err << job.end(request.study->unitCount()) - job.first(request.study->unitCount())
        << " units in " << taken.count() << " s\n";
  } else {
    err << "is there\n";
  }
}

void merge(const Request& request, std::ostream& out) {
  const JobResult merged = mergedJobs(request.study->name(), request.jobs, request.directory);
  for (const auto& input : request.study->inputs()) {
    if (std::find(merged.inputs.begin(), merged.inputs.end(), input) != merged.inputs.end())
      continue;
    base::refuse("the jobs in ", request.directory, " have not the input ", input.first, " ",
                 input.second, " that was asked for");
  }
  base::writeWholeFile(request.merge, toText(merged));
  request.study->summarise(merged.records, out);
}

}  // namespace

int studyProgram(const std::vector<std::string>& arguments, const std::string& package,
                 std::ostream& out, std::ostream& err) {
  Request request;
  const auto read = [&] { request = parse(arguments, package); };
  return base::runProgram(kUsage, err, read, [&] {
    if (request.job > 0) {
      compute(request, err);
    } else if (!request.merge.empty()) {
      merge(request, out);
    } else {
      describe(request, out);
    }
    return 0;
  });
}

}  // namespace haptex::studies
