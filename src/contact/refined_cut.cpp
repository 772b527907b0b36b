#include "haptex/contact/refined_cut.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <map>
#include <numeric>
#include <queue>
#include <utility>

#include "haptex/mesh/merged_seams.h"

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

/// Nonzero for these triangles of a mesh.
std::vector<char> marked(const std::vector<int>& triangles, const mesh::ClothMesh& mesh) {
  std::vector<char> marks(mesh.triangles.size(), 0);
  for (const int triangle : triangles) marks[triangle] = 1;
  return marks;
}

/// The corners of a triangle with a marked one beyond the opposite edge.
std::vector<int> cornersOpposite(const std::vector<char>& marks, const MeshTopology& topology,
                                 int triangle) {
  std::vector<int> corners;
  for (int corner = 0; corner < 3; ++corner) {
    const int neighbour = topology.neighbour(triangle, corner);
    if (neighbour >= 0 && marks[neighbour]) corners.push_back(corner);
  }
  return corners;
}

/// Takes out of `around`, into `triangles`, what has edges to two of these.
void takeCornered(const mesh::ClothMesh& mesh, const MeshTopology& topology,
                  std::vector<int>& triangles, std::vector<int>& around) {
  std::vector<char> refined = marked(triangles, mesh);
  for (bool goes_on = true; goes_on;) {
    const auto cornered = std::stable_partition(around.begin(), around.end(), [&](int triangle) {
      return cornersOpposite(refined, topology, triangle).size() < 2;
    });
    goes_on = cornered != around.end();
    for (auto taken = cornered; taken != around.end(); ++taken) {
      refined[*taken] = 1;
      triangles.push_back(*taken);
    }
    around.erase(cornered, around.end());
  }
}

/// Whether the mesh goes on beyond the edge or corner that a support lies on, outside of the cut.
class Rim {
 public:
  Rim(const mesh::ClothMesh& mesh, const MeshTopology& topology, const std::vector<int>& triangles,
      const std::vector<char>& attached)
      : topology_(topology), attached_(attached), inside_(marked(triangles, mesh)) {
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

  int particle(int owner, const std::array<int, 3>& shares) {
    const std::array<int, 3>& triangle = mesh.triangles[owner];
    const Support support = supportOf(triangle, shares);
    const auto [entry, is_new] = index_of.emplace(support, static_cast<int>(cut.supports.size()));
    if (is_new) {
      const Eigen::Vector3d weights = Eigen::Vector3d(shares[0], shares[1], shares[2]) / divisions;
      cut.supports.push_back(support);
      cut.owners.push_back(owner);
      cut.weights.push_back(weights);
      cut.mesh.rest_coordinates.push_back(restAt(mesh.restCorners(owner), weights));
    }
    return entry->second;
  }

  int particle(int owner, int a, int b) { return particle(owner, {divisions - a - b, a, b}); }

  static Eigen::Vector2d restAt(const std::array<Eigen::Vector2d, 3>& corners,
                                const Eigen::Vector3d& weights) {
    return weights[0] * corners[0] + weights[1] * corners[1] + weights[2] * corners[2];
  }

  void add(int owner, const std::array<int, 3>& triangle) {
    cut.mesh.triangles.push_back(triangle);
    if (!mesh.triangle_fabrics.empty()) {
      cut.mesh.triangle_fabrics.push_back(mesh.triangle_fabrics[owner]);
    }
    if (mesh.corner_coordinates.empty()) return;
    cut.mesh.triangle_panels.push_back(mesh.panelOf(owner));
    std::array<Eigen::Vector2d, 3>& corners = cut.mesh.corner_coordinates.emplace_back();
    for (int i = 0; i < 3; ++i) {
      corners[i] = restAt(mesh.restCorners(owner), weightsIn(owner, triangle[i]));
    }
  }

  /// Of the corners of an element at a particle of the cut that lies on it.
  Eigen::Vector3d weightsIn(int owner, int particle) const {
    const Support& support = cut.supports[particle];
    Eigen::Vector3d weights = Eigen::Vector3d::Zero();
    for (int corner = 0; corner < 3; ++corner) {
      for (int i = 0; i < 3; ++i) {
        if (support.particles[i] != mesh.triangles[owner][corner]) continue;
        weights[corner] = static_cast<double>(support.shares[i]) / divisions;
      }
    }
    return weights;
  }

  void split(int owner) {
    for (int b = 0; b < divisions; ++b) {
      for (int a = 0; a + b < divisions; ++a) {
        const int origin = particle(owner, a, b);
        const int right = particle(owner, a + 1, b);
        const int up = particle(owner, a, b + 1);
        add(owner, {origin, right, up});
        if (a + b + 1 < divisions) add(owner, {right, particle(owner, a + 1, b + 1), up});
      }
    }
  }
};

void addWhole(Builder& builder, int owner) {
  const int all = builder.divisions;
  builder.add(owner, {builder.particle(owner, {all, 0, 0}), builder.particle(owner, {0, all, 0}),
                      builder.particle(owner, {0, 0, all})});
}

/// From a corner to the parts of the edge opposite to it.
void addFan(Builder& builder, int owner, int corner) {
  const auto on_edge = [&](int part) {
    std::array<int, 3> shares{};
    shares[(corner + 1) % 3] = builder.divisions - part;
    shares[(corner + 2) % 3] = part;
    return builder.particle(owner, shares);
  };
  std::array<int, 3> shares{};
  shares[corner] = builder.divisions;
  const int apex = builder.particle(owner, shares);
  for (int part = 0; part < builder.divisions; ++part) {
    builder.add(owner, {apex, on_edge(part), on_edge(part + 1)});
  }
}

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

/// m, at rest along edges of the mesh, of every particle from the nearest corner of some triangles;
/// infinite beyond the reach (Dijkstra 1959, A note on two problems in connexion with graphs).
std::vector<double> distancesFrom(const mesh::ClothMesh& mesh, const MeshTopology& topology,
                                  const std::vector<int>& triangles, double reach) {
  std::vector<double> distances(topology.particleCount(), std::numeric_limits<double>::infinity());
  using Reached = std::pair<double, int>;
  std::priority_queue<Reached, std::vector<Reached>, std::greater<>> next;
  const auto arrive = [&](int particle, double distance) {
    if (distance > reach || distance >= distances[particle]) return;
    distances[particle] = distance;
    next.emplace(distance, particle);
  };
  for (const int triangle : triangles) {
    for (const int particle : mesh.triangles[triangle]) arrive(particle, 0.0);
  }
  while (!next.empty()) {
    const auto [distance, from] = next.top();
    next.pop();
    if (distance > distances[from]) continue;
    for (const int triangle : topology.trianglesOf(from)) {
      const std::array<int, 3>& corners = mesh.triangles[triangle];
      const std::array<Eigen::Vector2d, 3> rest = mesh.restCorners(triangle);
      const auto at = std::find(corners.begin(), corners.end(), from) - corners.begin();
      for (int i = 0; i < 3; ++i) arrive(corners[i], distance + (rest[i] - rest[at]).norm());
    }
  }
  return distances;
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
                        std::vector<int> triangles, const std::vector<char>& attached,
                        int refinement, std::vector<int> around) {
  takeCornered(mesh, topology, triangles, around);
  const std::vector<char> refined = marked(triangles, mesh);
  Builder builder{mesh, 1 << refinement, {}, {}};
  for (const int triangle : triangles) builder.split(triangle);
  for (const int triangle : around) {
    const std::vector<int> corners = cornersOpposite(refined, topology, triangle);
    corners.empty() ? addWhole(builder, triangle) : addFan(builder, triangle, corners.front());
  }
  RefinedCut& cut = builder.cut;
  cut.refinement = refinement;
  cut.refined_count = static_cast<int>(triangles.size());
  cut.elements = std::move(triangles);
  cut.elements.insert(cut.elements.end(), around.begin(), around.end());

  const Rim rim(mesh, topology, cut.elements, attached);
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
  if (!mesh.corner_coordinates.empty()) {
    for (const mesh::Panel& panel : mesh.panels) cut.mesh.panels.push_back({panel.fabric, 0.0});
    mesh::addHingesOfMergedSeams(cut.mesh);
  }
  cut.order.resize(count);
  std::iota(cut.order.begin(), cut.order.end(), 0);
  std::sort(cut.order.begin(), cut.order.end(),
            [&](int a, int b) { return cut.supports[a] < cut.supports[b]; });
  return std::move(builder.cut);
}

int cornerIn(const RefinedCut& cut, int particle) {
  const Support support{{-1, -1, particle}, {0, 0, 1 << cut.refinement}};
  const auto found =
      std::lower_bound(cut.order.begin(), cut.order.end(), support,
                       [&](int i, const Support& sought) { return cut.supports[i] < sought; });
  const bool is_there = found != cut.order.end() && cut.supports[*found] == support;
  return is_there ? *found : -1;
}

std::vector<int> trianglesAround(const mesh::ClothMesh& mesh, const MeshTopology& topology,
                                 const std::vector<int>& triangles, double reach,
                                 std::size_t most) {
  const std::vector<char> marks = marked(triangles, mesh);
  const std::vector<double> distances = distancesFrom(mesh, topology, triangles, reach);
  std::vector<std::pair<double, int>> near;  // m, triangle
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    const double farthest = std::max({distances[a], distances[b], distances[c]});
    if (!marks[t] && farthest <= reach) near.emplace_back(farthest, t);
  }
  std::sort(near.begin(), near.end());
  near.resize(std::min(near.size(), most));
  std::vector<int> around;
  for (const auto& [distance, triangle] : near) around.push_back(triangle);
  return around;
}

}  // namespace haptex::contact
