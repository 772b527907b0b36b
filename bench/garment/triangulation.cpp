// How long does it take to triangulate the shipped garments, and how good are the triangles? Prints
// for edges of 20, 10 and 7 mm the time of all panels together, their triangles, the least angle,
// and mean, standard deviation and extremes of the edges, as parts of the length asked for.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "haptex/garment/pattern/pattern_file.h"
#include "haptex/garment/triangulation/panel_mesh.h"
#include "haptex/garment/triangulation/triangle_quality.h"
#include "tab_lines.h"

namespace {

using namespace haptex;

void printQuality(const std::string& name, const garment::Pattern& pattern, double edge_length) {
  double triangles = 0.0, least_angle = M_PI, mean = 0.0, spread = 0.0, shortest = 1e9,
         longest = 0.0;
  for (const garment::Panel& panel : pattern.panels) {
    const mesh::ClothMesh mesh = garment::triangulate(panel, edge_length).mesh;
    const garment::TriangleQuality quality = garment::qualityOf(mesh);
    const double count = static_cast<double>(mesh.triangles.size());
    triangles += count;
    least_angle = std::min(least_angle, quality.least_angle);
    mean += count * quality.mean;
    spread += count * quality.spread;
    shortest = std::min(shortest, quality.shortest);
    longest = std::max(longest, quality.longest);
  }
  bench::printLine(name + "/triangles", triangles, "1");
  bench::printLine(name + "/least_angle", least_angle * 180.0 / M_PI, "deg");
  bench::printLine(name + "/mean_edge", mean / triangles / edge_length, "1");
  bench::printLine(name + "/spread_of_edges", spread / triangles / edge_length, "1");
  bench::printLine(name + "/shortest_edge", shortest / edge_length, "1");
  bench::printLine(name + "/longest_edge", longest / edge_length, "1");
}

}  // namespace

int main(int argc, char** argv) {
  for (const std::string garment : {"shirt", "pencil_dress"}) {
    const garment::Pattern pattern =
        garment::loadPattern(HAPTEX_CONFIG_DIRECTORY "/garments/" + garment + ".yaml");
    for (const int millimetres : {20, 10, 7}) {
      const double edge_length = 1e-3 * millimetres;
      const std::string name =
          "triangulation/" + garment + "/" + std::to_string(millimetres) + "mm";
      bench::add(name, 0.2, [=](benchmark::State& state) {
        for (auto step : state) {
          for (const garment::Panel& panel : pattern.panels) {
            benchmark::DoNotOptimize(garment::triangulate(panel, edge_length));
          }
        }
      });
      printQuality(name, pattern, edge_length);
    }
  }
  return bench::runAll(argc, argv);
}
