#include "haptex/garment/triangulation/doubled_edges.h"

#include <algorithm>
#include <array>
#include <set>

#include "haptex/base/disjoint_sets.h"
#include "haptex/mesh/seam_edges.h"
#include "haptex/mesh/seam_partners.h"

namespace haptex::garment {
namespace {

/// A new particle in the middle between two, in all triangles that have both.
void split(mesh::ClothMesh& mesh, int a, int b) {
  const int added = static_cast<int>(mesh.rest_coordinates.size());
  mesh.rest_coordinates.push_back(0.5 * (mesh.rest_coordinates[a] + mesh.rest_coordinates[b]));
  mesh.initial_positions.push_back(0.5 * (mesh.initial_positions[a] + mesh.initial_positions[b]));
  const std::size_t count = mesh.triangles.size();
  for (std::size_t t = 0; t < count; ++t) {
    std::array<int, 3> half = mesh.triangles[t];
    const auto at_a = std::find(half.begin(), half.end(), a);
    const auto at_b = std::find(half.begin(), half.end(), b);
    if (at_a == half.end() || at_b == half.end()) continue;
    mesh.triangles[t][at_b - half.begin()] = added;
    *at_a = added;
    mesh.triangles.push_back(half);
  }
}

}  // namespace

void splitDoubledEdges(const std::vector<mesh::Seam>& seams, std::vector<PanelMesh>& panels) {
  const std::vector<int> first = firstParticles(panels);
  if (panels.empty()) return;
  base::DisjointSets together(first.back() + panels.back().mesh.rest_coordinates.size());
  for (const mesh::Seam& seam : seams) {
    for (const auto& [a, b] : mesh::partners(seam)) together.join(a, b);
  }
  // Edges of outlines first: they stay.
  std::set<std::array<int, 2>> taken;
  for (const bool inner : {false, true}) {
    for (std::size_t p = 0; p < panels.size(); ++p) {
      mesh::ClothMesh& mesh = panels[p].mesh;
      for (const auto& [edge, triangle] : mesh::borderTriangles(mesh)) {
        const bool is_inner = triangle < 0;
        if (is_inner != inner) continue;
        const auto [a, b] =
            std::minmax({together.root(first[p] + edge[0]), together.root(first[p] + edge[1])});
        const bool is_new = taken.insert({a, b}).second;
        if (inner && !is_new) split(mesh, edge[0], edge[1]);
      }
    }
  }
}

}  // namespace haptex::garment
