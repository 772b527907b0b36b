// What a job of a study leaves behind, and what the jobs together do.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "haptex/studies/jobs/study.h"

namespace haptex::studies {

/// Which part of a study.
struct StudyJob {
  std::size_t index = 1;  ///< 1 to count
  std::size_t count = 1;

  /// The job has the units from first() to end() - 1 of so many; jobs differ by one unit at most.
  std::size_t first(std::size_t units) const { return units * (index - 1) / count; }
  std::size_t end(std::size_t units) const { return units * index / count; }
};

/// The result of a job. As text it is, by lines:
///   haptex study NAME, job INDEX of COUNT, UNITS units
///   input NAME VALUE     one for each input
///   RECORD               one for each unit of the job
///   end CHECKSUM         of all before it
/// It says neither when nor where it was computed, so that the same job is the same file.
struct JobResult {
  std::string study;
  StudyJob job;
  std::size_t units = 0;  ///< of the whole study
  StudyInputs inputs;
  std::vector<std::string> records;
};

std::string toText(const JobResult& result);

/// @param path that refusals begin with
/// @throws std::runtime_error naming the path and the line, if the text is damaged or incomplete
JobResult parseJobResult(const std::string& text, const std::string& path);
/// @throws std::runtime_error likewise, and if the file cannot be read
JobResult loadJobResult(const std::string& path);

}  // namespace haptex::studies
