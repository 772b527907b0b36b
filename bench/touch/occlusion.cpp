// What does it cost to know how much of the sky the particles of a cloth see past the cloth, and is
// it proportional to the triangles? On two threads. The sheets are those that proximity is measured
// with.
#include <string>
#include <vector>

#include "haptex/mesh/mesh.h"
#include "haptex/oracles/scenes/deformed_sheets.h"
#include "haptex/proximity/sky_occlusion.h"
#include "tab_lines.h"

int main(int argc, char** argv) {
  using namespace haptex;
  constexpr double kMinTime = 0.1;  // s per repetition
  std::vector<std::string> names;
  for (const int cells : {16, 32, 64}) {
    const mesh::ClothMesh mesh =
        mesh::makeRectangle(0.2, 0.2, cells, cells, mesh::Triangulation::kAlternating);
    for (const char* state : {"hanging", "draped", "folded", "waved", "rolled", "crumpled_1"}) {
      names.push_back("occlusion/" + std::string(state) + "/" +
                      std::to_string(mesh.triangles.size()));
      const auto positions = oracles::deformedSheet(mesh, state);
      bench::add(names.back(), kMinTime, [mesh, positions](benchmark::State& run) {
        linear::ThreadPool pool(2);
        proximity::SkyOcclusion sky(mesh.triangles, positions.size(), &pool);
        for (auto _ : run) sky.compute(positions);
      });
    }
  }
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  bench::TabReporter reporter;
  benchmark::RunSpecifiedBenchmarks(&reporter);
  const std::string largest = "occlusion/draped/8192", middle = "occlusion/draped/2048";
  if (reporter.has(largest) && reporter.has(middle)) {
    bench::printLine("occlusion/draped/8192_over_2048",
                     reporter.time(largest) / reporter.time(middle), "1");
  }
  return reporter.failed() ? 1 : 0;
}
