// How long does it take to lay a garment around a body, the search for intersections included?
// About 27 500 triangles, as many as the jacket of seed 003 has. Prints the triangles, how many
// pairs of them intersect, and the processor time, the shortest of five. Then both
// garments on 20 bodies with random measurements: how many lie there without intersections.
#include "haptex/garment/placement/preposition.h"

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include "haptex/base/repeatable_random.h"
#include "haptex/base/yaml_reader.h"
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
    const double begin = bench::processorSeconds();
    benchmark::DoNotOptimize(garment::preposition(pattern, body, laid));
    shortest = std::min(shortest, bench::processorSeconds() - begin);
  }
  bench::printLine(name, 1e3 * shortest, "ms");
}

/// The shipped body with other measurements, as they are spread around those of the figure.
garment::Body randomBody(bool female, base::RepeatableRandom& random) {
  const std::string directory = HAPTEX_CONFIG_DIRECTORY "/bodies";
  const double height = female ? random.uniform(1.55, 1.80) : random.uniform(1.65, 1.95);
  const double scale = height / (female ? 1.605 : 1.748);
  std::ostringstream measurements;
  measurements << "measurements: {height: " << height;
  const double least[][3] = {{0.88, 0.72, 0.88}, {0.76, 0.62, 0.89}};
  const double largest[][3] = {{1.06, 0.84, 1.04}, {0.96, 0.73, 1.05}};
  const char* const names[] = {"chest", "waist", "hips"};
  for (int i = 0; i < 3; ++i) {
    measurements << ", " << names[i] << ": "
                 << scale * random.uniform(least[female][i], largest[female][i]);
  }
  measurements << '}';
  std::string text = base::readTextFile(directory + (female ? "/woman.yaml" : "/man.yaml"));
  const std::size_t begin = text.find("measurements:");
  text.replace(begin, text.find('\n', begin) - begin, measurements.str());
  return garment::parseBody(text, directory, "random body");
}

void countClean() {
  base::RepeatableRandom random(7);
  int garments = 0, clean = 0;
  for (int i = 0; i < 20; ++i) {
    const garment::Body body = randomBody(i % 2 == 0, random);
    for (const std::string garment : {"fitted_shirt", "fitted_dress"}) {
      const garment::Pattern pattern =
          garment::loadPattern(HAPTEX_CONFIG_DIRECTORY "/garments/" + garment + ".yaml");
      std::vector<garment::PanelMesh> meshes;
      for (const garment::Panel& panel : pattern.panels) {
        meshes.push_back(garment::triangulate(panel, 0.02));
      }
      ++garments;
      if (garment::preposition(pattern, body, meshes).overlaps.empty()) ++clean;
    }
  }
  bench::printLine("preposition/random_bodies/garments", garments, "1");
  bench::printLine("preposition/random_bodies/without_intersections", clean, "1");
}

}  // namespace

int main() {
  for (const char* body : {"woman", "man"}) {
    measure("fitted_shirt", body, 0.0074);
    measure("fitted_dress", body, 0.01);
  }
  measure("jacket", "figure", 0.0132);
  countClean();
}
