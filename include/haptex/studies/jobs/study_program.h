// The program run_study: docs/studies.md describes it.
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

namespace haptex::studies {

/// @param arguments STUDY with [--cases N] [--seed S], and
///   nothing else: tells units and inputs;
///   --jobs N --job I --directory DIR: computes job I of N into DIR, unless it is there;
///   --jobs N --merge OUT --directory DIR: makes one file of all jobs, and tells what follows
/// @param package its directory
/// @param out what it tells, lines with tabs between; `err` for progress and refusals
/// @returns the exit status: 1 if something was refused or failed, 2 if the arguments were wrong
int studyProgram(const std::vector<std::string>& arguments, const std::string& package,
                 std::ostream& out, std::ostream& err);

}  // namespace haptex::studies
