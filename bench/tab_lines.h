// How every benchmark prints: "name<TAB>value<TAB>unit", one line per quantity, and nothing else on
// standard output.
#pragma once

#include <benchmark/benchmark.h>

#include <cstdio>
#include <string>

namespace haptex::bench {

inline void printLine(const std::string& name, double value, const char* unit) {
  std::printf("%s\t%.6g\t%s\n", name.c_str(), value, unit);
  std::fflush(stdout);
}

/// Prints the time per iteration of "<bench>/<case>/<triangles>" in ms. Every other quantity is the
/// benchmark's own to print.
class TabReporter : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context&) override { return true; }
  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs) {
      if (run.error_occurred) {
        std::fprintf(stderr, "%s: %s\n", run.run_name.function_name.c_str(),
                     run.error_message.c_str());
        failed_ = true;
        continue;
      }
      printLine(run.run_name.function_name, 1e3 * run.real_accumulated_time / run.iterations, "ms");
    }
  }
  bool failed() const { return failed_; }

 private:
  bool failed_ = false;
};

/// main() of a benchmark: runs all registered ones through the reporter.
inline int runAll(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  TabReporter reporter;
  benchmark::RunSpecifiedBenchmarks(&reporter);
  return reporter.failed() ? 1 : 0;
}

}  // namespace haptex::bench
