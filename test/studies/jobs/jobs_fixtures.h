// A study that takes no time, and a directory for its jobs.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <ostream>
#include <stdexcept>
#include <string>
#include <vector>

#include "../../refusal.h"
#include "haptex/base/yaml_reader.h"
#include "haptex/studies/jobs/study_jobs.h"

namespace haptex::studies {

inline const auto refusalOf = [](const auto& call) {
  return test::refusalOf<std::exception>(call);
};

/// Tells the squares of numbers.
class Squares final : public Study {
 public:
  explicit Squares(std::size_t units) : units_(units) {}

  std::string name() const override { return "squares"; }
  std::size_t unitCount() const override { return units_; }
  StudyInputs inputs() const override { return {{"units", std::to_string(units_)}}; }
  std::string run(std::size_t unit) const override {
    if (unit == fails_at) throw std::runtime_error("killed");
    ++runs;
    return std::to_string(unit * unit);
  }
  void summarise(const std::vector<std::string>& records, std::ostream& out) const override {
    out << records.size() << '\n';
  }

  std::size_t fails_at = ~std::size_t{0};
  mutable std::size_t runs = 0;

 private:
  std::size_t units_;
};

class StudyJobs : public testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(directory_); }
  void TearDown() override { std::filesystem::remove_all(directory_); }

  void runAll(const Study& study, std::size_t jobs, const StudyInputs& inputs) const {
    for (std::size_t i = 1; i <= jobs; ++i) runJob(study, inputs, {i, jobs}, directory_);
  }
  std::string mergedText(const Study& study, std::size_t jobs) const {
    return toText(mergedJobs(study.name(), jobs, directory_));
  }
  std::string path(const Study& study, std::size_t index, std::size_t count) const {
    return jobPath(directory_, study.name(), {index, count});
  }
  static void overwrite(const std::string& path, const std::string& text) {
    std::ofstream(path, std::ios::binary) << text;
  }

  const std::string directory_ = testing::TempDir() + "study_jobs_" + std::to_string(getpid());
};

}  // namespace haptex::studies
