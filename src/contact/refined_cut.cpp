#include "haptex/contact/refined_cut.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

namespace haptex::contact {
namespace {

std::pair<int, int> edgeOpposite(const std::array<int, 3>& triangle, int corner) {
  return std::minmax(triangle[(corner + 1) % 3], triangle[(corner + 2) % 3]);
}

Support supportOf(const std::array<int, 3>& triangle, const std::array<int, 3>& shares) {
  std::array<std::pair<int, int>, 3> pairs;
  for (int k = 0; k < 3; ++k) pairs[k] = {shares[k] > 0 ? triangle[k] : -1, shares[k]};
  std::sort(pairs.begin(), pairs.end());
  Support support;
  for (int k = 0; k < 3; ++k) {
    support.particles[k] = pairs[k].first;
    support.shares[k] = pairs[k].second;
  }
  return support;
}

/// Whether the mesh goes on beyond the edge or corner that a support lies on, outside of the cut.
class Rim {
 public:
  Rim(const mesh::ClothMesh& mesh, const MeshTopology& topology, const std::vector<int>& triangles,
      const std::vector<char>& attached)
      : topology_(topology), attached_(attached), inside_(mesh.triangles.size(), 0) {
    for (int triangle : triangles) inside_[triangle] = 1;
    for (int triangle : triangles) {
      for (int corner = 0; corner < 3; ++corner) {
        const int neighbour = topology.neighbour(triangle, corner);
        if (neighbour >= 0 && !inside_[neighbour]) {
          edges_.push_back(edgeOpposite(mesh.triangles[triangle], corner));
        }
      }
    }
    std::sort(edges_.begin(), edges_.end());
  }

  bool contains(const Support& support) const {
    const auto& p = support.particles;
    const bool held = std::all_of(
        p.begin(), p.end(), [this](int particle) { return particle < 0 || attached_[particle]; });
    if (held) return true;
    if (p[0] >= 0) return false;  // inside of a triangle
    if (p[1] >= 0)
      return std::binary_search(edges_.begin(), edges_.end(), std::make_pair(p[1], p[2]));
    const std::vector<int>& around = topology_.trianglesOf(p[2]);
    return std::any_of(around.begin(), around.end(), [this](int t) { return !inside_[t]; });
  }

 private:
  const MeshTopology& topology_;
  const std::vector<char>& attached_;
  std::vector<char> inside_;
  std::vector<std::pair<int, int>> edges_;
};

struct Builder {
  const mesh::ClothMesh& mesh;
  int divisions;
  std::map<Support, int> index_of;
  RefinedCut cut;

  int particle(int owner, int a, int b) {
    const std::array<int, 3>& triangle = mesh.triangles[owner];
    const std::array<int, 3> shares = {divisions - a - b, a, b};
    const Support support = supportOf(triangle, shares);
    const auto [entry, is_new] = index_of.emplace(support, static_cast<int>(cut.supports.size()));
    if (is_new) {
      const Eigen::Vector3d weights = Eigen::Vector3d(shares[0], shares[1], shares[2]) / divisions;
      cut.supports.push_back(support);
      cut.owners.push_back(owner);
      cut.weights.push_back(weights);
      cut.mesh.rest_coordinates.push_back(weights[0] * mesh.rest_coordinates[triangle[0]] +
                                          weights[1] * mesh.rest_coordinates[triangle[1]] +
                                          weights[2] * mesh.rest_coordinates[triangle[2]]);
    }
    return entry->second;
  }

  void addFabric(int owner) {
    if (mesh.triangle_fabrics.empty()) return;
    cut.mesh.triangle_fabrics.push_back(mesh.triangle_fabrics[owner]);
  }

  void split(int owner) {
    for (int b = 0; b < divisions; ++b) {
      for (int a = 0; a + b < divisions; ++a) {
        const int origin = particle(owner, a, b);
        const int right = particle(owner, a + 1, b);
        const int up = particle(owner, a, b + 1);
        cut.mesh.triangles.push_back({origin, right, up});
        addFabric(owner);
        if (a + b + 1 < divisions) {
          cut.mesh.triangles.push_back({right, particle(owner, a + 1, b + 1), up});
          addFabric(owner);
        }
      }
    }
  }
};

template <typename T>
std::vector<T> reordered(const std::vector<T>& values, const std::vector<int>& order) {
  std::vector<T> result;
  result.reserve(values.size());
  for (int old : order) result.push_back(values[old]);
  return result;
}

/// Of the first triangle that has all of a support's particles, whatever was cut: patches that
/// follow each other agree.
std::uint8_t fabricAt(const mesh::ClothMesh& mesh, const MeshTopology& topology,
                      const Support& support) {
  for (const int triangle : topology.trianglesOf(support.particles[2])) {
    const std::array<int, 3>& corners = mesh.triangles[triangle];
    const bool has_all =
        std::all_of(support.particles.begin(), support.particles.end(), [&](int p) {
          return p < 0 || std::find(corners.begin(), corners.end(), p) != corners.end();
        });
    if (has_all) return static_cast<std::uint8_t>(mesh.triangle_fabrics[triangle]);
  }
  return 0;
}

}  // namespace

MeshTopology::MeshTopology(const mesh::ClothMesh& mesh)
    : neighbours_(mesh.triangles.size(), {-1, -1, -1}),
      triangles_of_(mesh.rest_coordinates.size()) {
  std::map<std::pair<int, int>, std::pair<int, int>> first_side;  // of an edge: triangle, corner
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) {
    for (int corner = 0; corner < 3; ++corner) {
      triangles_of_[mesh.triangles[t][corner]].push_back(t);
      const auto [side, is_first] =
          first_side.emplace(edgeOpposite(mesh.triangles[t], corner), std::make_pair(t, corner));
      if (is_first) continue;
      neighbours_[t][corner] = side->second.first;
      neighbours_[side->second.first][side->second.second] = t;
    }
  }
}

RefinedCut cutAndRefine(const mesh::ClothMesh& mesh, const MeshTopology& topology,
                        const std::vector<int>& triangles, const std::vector<char>& attached,
                        int refinement) {
  Builder builder{mesh, 1 << refinement, {}, {}};
  for (int triangle : triangles) builder.split(triangle);
  RefinedCut& cut = builder.cut;
  cut.refinement = refinement;
  cut.elements = triangles;

  const Rim rim(mesh, topology, triangles, attached);
  const int count = static_cast<int>(cut.supports.size());
  std::vector<int> order(count);
  std::iota(order.begin(), order.end(), 0);
  const auto rim_begin = std::stable_partition(
      order.begin(), order.end(), [&](int i) { return !rim.contains(cut.supports[i]); });
  cut.free_count = static_cast<int>(rim_begin - order.begin());
  cut.supports = reordered(cut.supports, order);
  cut.owners = reordered(cut.owners, order);
  cut.weights = reordered(cut.weights, order);
  cut.mesh.rest_coordinates = reordered(cut.mesh.rest_coordinates, order);
  if (!mesh.triangle_fabrics.empty()) {
    for (const Support& support : cut.supports) {
      cut.fabrics.push_back(fabricAt(mesh, topology, support));
    }
  }
  cut.mesh.initial_positions.assign(count, Eigen::Vector3d::Zero());
  std::vector<int> place(count);
  for (int i = 0; i < count; ++i) place[order[i]] = i;
  for (std::array<int, 3>& triangle : cut.mesh.triangles) {
    for (int& particle : triangle) particle = place[particle];
  }
  cut.order.resize(count);
  std::iota(cut.order.begin(), cut.order.end(), 0);
  std::sort(cut.order.begin(), cut.order.end(),
            [&](int a, int b) { return cut.supports[a] < cut.supports[b]; });
  return std::move(builder.cut);
}

}  // namespace haptex::contact
