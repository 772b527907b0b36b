// How every benchmark prints: "name<TAB>value<TAB>unit", one line per quantity, and nothing else on
// standard output.
#pragma once

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <functional>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace haptex::bench {

inline void printLine(const std::string& name, double value, const char* unit) {
  std::printf("%s\t%.6g\t%s\n", name.c_str(), value, unit);
  std::fflush(stdout);
}

/// s, that this process has computed.
inline double processorSeconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// Prints the time per iteration of "<bench>/<case>/<triangles>" in ms, of several repetitions the
/// shortest: the others were disturbed. Every other quantity is the benchmark's own to print.
class TabReporter : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context&) override { return true; }
  void ReportRuns(const std::vector<Run>& runs) override {
    double shortest = std::numeric_limits<double>::infinity();
    for (const Run& run : runs) {
      if (run.error_occurred) {
        std::fprintf(stderr, "%s: %s\n", run.run_name.function_name.c_str(),
                     run.error_message.c_str());
        failed_ = true;
        return;
      }
      if (run.run_type != Run::RT_Iteration) continue;
      shortest =
          std::min(shortest, 1e3 * run.real_accumulated_time / static_cast<double>(run.iterations));
    }
    if (std::isinf(shortest)) return;  // means and the like of the repetitions
    times_[runs.front().run_name.function_name] = shortest;
    printLine(runs.front().run_name.function_name, shortest, "ms");
  }

  bool has(const std::string& name) const { return times_.count(name) > 0; }
  /// ms, of a benchmark that has run.
  double time(const std::string& name) const { return times_.at(name); }
  bool failed() const { return failed_; }

 private:
  std::map<std::string, double> times_;
  bool failed_ = false;
};

/// A benchmark for TabReporter whose five repetitions take at least `min_time` (s) each.
inline void add(const std::string& name, double min_time,
                std::function<void(benchmark::State&)> run) {
  benchmark::RegisterBenchmark(name.c_str(), std::move(run))
      ->MinTime(min_time)
      ->Repetitions(5)
      ->Unit(benchmark::kMillisecond);
}

/// main() of a benchmark: runs all registered ones through the reporter.
inline int runAll(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  TabReporter reporter;
  benchmark::RunSpecifiedBenchmarks(&reporter);
  return reporter.failed() ? 1 : 0;
}

}  // namespace haptex::bench
