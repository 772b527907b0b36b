// The program run_study: computes and merges the jobs of a study, see docs/studies.md.
#include <iostream>
#include <string>
#include <vector>

#include "haptex/studies/jobs/study_program.h"

int main(int argc, char** argv) {
  return haptex::studies::studyProgram({argv + 1, argv + argc}, HAPTEX_SOURCE_DIRECTORY, std::cout,
                                       std::cerr);
}
