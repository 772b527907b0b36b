// Computes the jobs of a study, and makes one result of theirs.
#pragma once

#include <cstddef>
#include <string>

#include "haptex/studies/jobs/job_file.h"
#include "haptex/studies/jobs/study.h"

namespace haptex::studies {

/// DIRECTORY/STUDY_INDEX_of_COUNT.txt
std::string jobPath(const std::string& directory, const std::string& study, const StudyJob& job);

/// What runJob() has done.
struct JobReport {
  bool computed = false;  ///< or its file was there already, with the same inputs
  std::string replaced;   ///< why a file that was there is none of it; empty: there was none
};

/// Computes the units of a job and writes its file, whole or not at all; does nothing if that is
/// there, of the same job with the same inputs. A job that was killed is so begun anew.
/// @param inputs of the study and of the program
/// @throws std::invalid_argument naming what is allowed if there are more jobs than units, or no
///   such job; std::runtime_error if the file cannot be written
JobReport runJob(const Study& study, const StudyInputs& inputs, const StudyJob& job,
                 const std::string& directory);

/// All jobs of a study as if they had been one: the same text, bit by bit, however many there were.
/// @param jobs how many there were
/// @throws std::runtime_error naming files that are not there, one that is damaged or of another
///   study, or two whose inputs differ, and which one does
JobResult mergedJobs(const std::string& study, std::size_t jobs, const std::string& directory);

}  // namespace haptex::studies
