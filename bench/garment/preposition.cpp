// How long does it take to lay a garment around a body, the search for intersections included?
// About 27 500 triangles, as many as the jacket of seed 003 has. Prints the triangles, how many
// pairs of them intersect, and the processor time, the shortest of five.
#include "haptex/garment/placement/preposition.h"

#include <algorithm>
#include <ctime>
#include <string>
#include <vector>

#include "haptex/garment/body/body_file.h"
#include "haptex/garment/pattern/pattern_file.h"
#include "tab_lines.h"

namespace {

using namespace haptex;

void measure(const std::string& garment, const std::string& body_name, double edge_length) {
  const garment::Pattern pattern =
      garment::loadPattern(HAPTEX_CONFIG_DIRECTORY "/garments/" + garment + ".yaml");
  const garment::Body body =
      garment::loadBody(HAPTEX_CONFIG_DIRECTORY "/bodies/" + body_name + ".yaml");
  std::vector<garment::PanelMesh> flat;
  std::size_t triangles = 0;
  for (const garment::Panel& panel : pattern.panels) {
    flat.push_back(garment::triangulate(panel, edge_length));
    triangles += flat.back().mesh.triangles.size();
  }
  const std::string name = "preposition/" + garment + "_on_" + body_name;
  std::vector<garment::PanelMesh> meshes = flat;
  int pairs = 0;
  for (const auto& overlap : garment::preposition(pattern, body, meshes).overlaps) {
    pairs += overlap.pairs;
  }
  bench::printLine(name + "/triangles", static_cast<double>(triangles), "1");
  bench::printLine(name + "/intersections", pairs, "1");
  double shortest = 1e9;
  for (int i = 0; i < 5; ++i) {
    std::vector<garment::PanelMesh> laid = flat;
    const std::clock_t begin = std::clock();
    benchmark::DoNotOptimize(garment::preposition(pattern, body, laid));
    shortest = std::min(shortest, static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
  }
  bench::printLine(name, 1e3 * shortest, "ms");
}

}  // namespace

int main() {
  for (const char* body : {"woman", "man"}) {
    measure("fitted_shirt", body, 0.0074);
    measure("fitted_dress", body, 0.01);
  }
}
