#include "haptex/studies/jobs/study_jobs.h"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <stdexcept>
#include <vector>

#include "haptex/base/quoted.h"
#include "haptex/base/require.h"
#include "haptex/base/whole_file.h"

namespace haptex::studies {
namespace {

[[noreturn]] void refuseMerge(const std::string& why) { throw std::runtime_error(why); }

std::string valueOf(const StudyInputs& inputs, const std::string& name) {
  for (const auto& [key, value] : inputs) {
    if (key == name) return base::quoted(value);
  }
  return "none";
}

/// The first input that is not the same, with its values; empty: all are.
std::string differenceOf(const StudyInputs& a, const StudyInputs& b) {
  if (a == b) return "";
  std::vector<std::string> names;
  for (const StudyInputs* inputs : {&a, &b}) {
    for (const auto& input : *inputs) names.push_back(input.first);
  }
  for (const std::string& name : names) {
    const std::string of_a = valueOf(a, name), of_b = valueOf(b, name);
    if (of_a != of_b) return "input " + base::shortened(name) + " is " + of_a + " and " + of_b;
  }
  return "inputs are in another order";
}

/// Why a file is not that of the job; empty: it is.
std::string faultOf(const std::string& path, const Study& study, const StudyInputs& inputs) {
  try {
    const JobResult result = loadJobResult(path);
    if (result.study != study.name() || result.units != study.unitCount()) {
      return path + ": is of another study";
    }
    const std::string difference = differenceOf(result.inputs, inputs);
    return difference.empty() ? "" : path + ": " + difference;
  } catch (const std::runtime_error& fault) {
    return fault.what();
  }
}

void requireAllThere(const std::string& study, std::size_t jobs, const std::string& directory) {
  constexpr std::size_t kNamed = 5;
  std::string names;
  std::size_t missing = 0;
  for (std::size_t i = 1; i <= jobs; ++i) {
    const std::string path = jobPath(directory, study, {i, jobs});
    std::error_code error;
    if (std::filesystem::exists(path, error)) continue;
    if (++missing <= kNamed) names += (names.empty() ? "" : ", ") + path;
  }
  if (missing == 0) return;
  refuseMerge(std::to_string(missing) + " of " + std::to_string(jobs) +
              " jobs are missing: " + names + (missing > kNamed ? ", ..." : ""));
}

}  // namespace

std::string jobPath(const std::string& directory, const std::string& study, const StudyJob& job) {
  return directory + "/" + study + "_" + std::to_string(job.index) + "_of_" +
         std::to_string(job.count) + ".txt";
}

JobReport runJob(const Study& study, const StudyInputs& inputs, const StudyJob& job,
                 const std::string& directory) {
  const std::size_t units = study.unitCount();
  if (job.count < 1 || job.count > units) {
    base::refuse("jobs = ", job.count, ": allowed are 1 to ", units, ", one for each unit");
  }
  if (job.index < 1 || job.index > job.count) {
    base::refuse("job = ", job.index, ": allowed are 1 to ", job.count);
  }
  const std::string path = jobPath(directory, study.name(), job);
  JobReport report;
  std::error_code error;
  if (std::filesystem::exists(path, error)) {
    report.replaced = faultOf(path, study, inputs);
    if (report.replaced.empty()) return report;
  }
  JobResult result{study.name(), job, units, inputs, {}};
  for (std::size_t unit = job.first(units); unit < job.end(units); ++unit) {
    result.records.push_back(study.run(unit));
  }
  base::writeWholeFile(path, toText(result));
  report.computed = true;
  return report;
}

JobResult mergedJobs(const std::string& study, std::size_t jobs, const std::string& directory) {
  if (jobs < 1) base::refuse("jobs = ", jobs, ": allowed is at least 1");
  requireAllThere(study, jobs, directory);
  JobResult merged;
  const std::string first = jobPath(directory, study, {1, jobs});
  for (std::size_t i = 1; i <= jobs; ++i) {
    const std::string path = jobPath(directory, study, {i, jobs});
    JobResult part = loadJobResult(path);
    if (part.study != study || part.job.index != i || part.job.count != jobs) {
      refuseMerge(path + ": is job " + std::to_string(part.job.index) + " of " +
                  std::to_string(part.job.count) + " of the study " + base::quoted(part.study) +
                  ", must be the one that its name says");
    }
    if (i == 1) merged = {study, {1, 1}, part.units, part.inputs, {}};
    const std::string difference = differenceOf(merged.inputs, part.inputs);
    if (!difference.empty() || part.units != merged.units) {
      refuseMerge(first + " and " + path + " do not belong together: " +
                  (difference.empty() ? "their studies have other numbers of units" : difference));
    }
    std::move(part.records.begin(), part.records.end(), std::back_inserter(merged.records));
  }
  return merged;
}

}  // namespace haptex::studies
