#include "haptex/cloth/forces/self_contact/pair_energies.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>

namespace haptex::cloth {
namespace {

using Eigen::Vector3d;

// Of the squares of both rest lengths: edges at an angle of less than about 1.8 degrees.
constexpr double kParallel = 1e-3;

using Edge = std::array<int, 2>;
Edge edgeFrom(const std::array<int, 3>& triangle, int corner) {
  const int a = triangle[corner], b = triangle[(corner + 1) % 3];
  return {std::min(a, b), std::max(a, b)};
}

}  // namespace

PairEnergies::PairEnergies(const std::vector<std::array<int, 3>>& triangles,
                           const std::vector<Vector3d>& reference, const LayerLaw& law)
    : law_(law),
      triangles_(triangles),
      across_(triangles.size(), {-1, -1, -1}),
      around_(reference.size()),
      vertex_areas_(reference.size(), 0.0) {
  const std::vector<Edge> edges = proximity::MeshElements(triangles).edges;
  edge_areas_.assign(edges.size(), 0.0);
  for (const Edge& edge : edges) {
    edge_squares_.push_back((reference[edge[1]] - reference[edge[0]]).squaredNorm());
  }
  std::map<Edge, std::vector<std::array<int, 2>>> owners;  // triangle and corner
  for (int t = 0; t < static_cast<int>(triangles.size()); ++t) {
    const auto& [a, b, c] = triangles[t];
    const Vector3d ab = reference[b] - reference[a], ac = reference[c] - reference[a];
    const double part = 0.5 * ab.cross(ac).norm() / 6.0;
    for (int i = 0; i < 3; ++i) {
      const Edge edge = edgeFrom(triangles[t], i);
      vertex_areas_[triangles[t][i]] += part;
      edge_areas_[std::lower_bound(edges.begin(), edges.end(), edge) - edges.begin()] += part;
      around_[triangles[t][i]].push_back(t);
      owners[edge].push_back({t, i});
    }
  }
  for (const auto& [edge, of_edge] : owners) {
    if (of_edge.size() == 2) {
      across_[of_edge[0][0]][of_edge[0][1]] = of_edge[1][0];
      across_[of_edge[1][0]][of_edge[1][1]] = of_edge[0][0];
    } else {
      for (int vertex : edge) around_[vertex].clear();
    }
  }
}

void PairEnergies::find(const Positions& positions, const std::vector<Pair>& pairs,
                        std::vector<PairEnergy>& found) {
  found.clear();
  const Pair* pair = pairs.data();
  const Pair* const end = pair + pairs.size();
  while (pair != end && pair->kind == proximity::ElementPairKind::kVertexTriangle) {
    const Pair* const begin = pair;
    while (pair != end && pair->kind == begin->kind && pair->first == begin->first) ++pair;
    addVertex(positions, begin, pair, found);
  }
  for (; pair != end; ++pair) addEdges(positions, *pair, found);
}

/// @param begin, end pairs of a vertex
void PairEnergies::addVertex(const Positions& positions, const Pair* begin, const Pair* end,
                             std::vector<PairEnergy>& found) {
  const int vertex = begin->first;
  const Vector3d& place = positions[vertex];
  near_.clear();
  features_.clear();
  for (const Pair* pair = begin; pair != end; ++pair) near_.push_back(pair->second);
  for (int triangle : near_) countTriangle(positions, vertex, triangles_[triangle]);
  for (int triangle : near_) countShared(positions, vertex, triangle);
  for (const Feature& feature : features_) {
    if (feature.times == 0) continue;
    PairEnergy energy{};
    energy.count = 1 + feature.size;
    energy.vertices[0] = vertex;
    energy.weights[0] = 1.0;
    Vector3d away = place;
    for (int i = 0; i < feature.size; ++i) {
      energy.vertices[i + 1] = feature.ids[i];
      energy.weights[i + 1] = -feature.weights[i];
      away -= feature.weights[i] * positions[feature.ids[i]];
    }
    energy.distance = away.norm();
    if (energy.distance >= law_.thickness()) continue;
    energy.normal = away / energy.distance;
    const LayerPressure law = law_.at(energy.distance);
    const double area = feature.times * vertex_areas_[vertex];
    energy.energy = area * law.energy;
    energy.force = area * law.pressure;
    energy.stiffness = std::max(0.0, area) * law.slope;
    found.push_back(energy);
  }
}

void PairEnergies::countTriangle(const Positions& positions, int vertex,
                                 const std::array<int, 3>& corners) {
  const proximity::TrianglePoint nearest = proximity::closestPoint(
      {positions[corners[0]], positions[corners[1]], positions[corners[2]]}, positions[vertex]);
  if (nearest.distance >= law_.thickness()) return;
  Feature feature = {0, {-1, -1, -1}, {}, 1};
  for (int i = 0; i < 3; ++i) {
    if (nearest.barycentric[i] == 0.0) continue;
    feature.ids[feature.size] = corners[i];
    feature.weights[feature.size++] = nearest.barycentric[i];
  }
  count(feature);
}

/// Counts down.
void PairEnergies::countEdge(const Positions& positions, int vertex, int from, int to) {
  const Vector3d way = positions[to] - positions[from];
  const double square = way.squaredNorm();
  const double t = way.dot(positions[vertex] - positions[from]);
  if (!(t > 0.0)) return count({1, {from, -1, -1}, {1.0}, -1});
  if (!(t < square)) return count({1, {to, -1, -1}, {1.0}, -1});
  count({2, {from, to, -1}, {1.0 - t / square, t / square}, -1});
}

void PairEnergies::count(Feature feature) {
  // In ascending order, with the weights.
  for (int i = 0; i + 1 < feature.size; ++i) {
    for (int j = i + 1; j < feature.size; ++j) {
      if (feature.ids[j] > feature.ids[i]) continue;
      std::swap(feature.ids[i], feature.ids[j]);
      std::swap(feature.weights[i], feature.weights[j]);
    }
  }
  for (Feature& known : features_) {
    if (known.ids != feature.ids) continue;
    known.times += feature.times;
    return;
  }
  features_.push_back(feature);
}

/// The inner edges and vertices whose first triangle this is: all of their triangles are near.
void PairEnergies::countShared(const Positions& positions, int vertex, int triangle) {
  for (int i = 0; i < 3; ++i) {
    const int corner = triangles_[triangle][i];
    if (across_[triangle][i] > triangle && isNear(across_[triangle][i])) {
      countEdge(positions, vertex, corner, triangles_[triangle][(i + 1) % 3]);
    }
    const std::vector<int>& around = around_[corner];
    if (around.empty() || around.front() != triangle) continue;
    const auto is_near = [this](int other) { return isNear(other); };
    if (std::all_of(around.begin(), around.end(), is_near)) {
      count({1, {corner, -1, -1}, {1.0}, 1});
    }
  }
}

bool PairEnergies::isNear(int triangle) const {
  return std::binary_search(near_.begin(), near_.end(), triangle);
}

void PairEnergies::addEdges(const Positions& positions, const Pair& pair,
                            std::vector<PairEnergy>& found) const {
  const auto& v = pair.vertices;
  const std::array<Vector3d, 4> places = {positions[v[0]], positions[v[1]], positions[v[2]],
                                          positions[v[3]]};
  if (proximity::isSurelyApart(pair.kind, places, law_.leastDistance())) return;
  const proximity::PairDistance nearest = proximity::edgeEdgeDistance(places);
  if (nearest.distance >= law_.leastDistance()) return;
  PairEnergy energy{};
  energy.count = 4;
  energy.vertices = v;
  Vector3d away = Vector3d::Zero();
  for (int i = 0; i < 4; ++i) {
    energy.weights[i] = (i < 2 ? 1.0 : -1.0) * nearest.weights[i];
    away += energy.weights[i] * places[i];
  }
  energy.distance = nearest.distance;
  energy.normal = away / nearest.distance;
  const LayerPressure law = law_.guardAt(nearest.distance);
  const double area = 0.5 * (edge_areas_[pair.first] + edge_areas_[pair.second]);
  const Vector3d a = places[1] - places[0], b = places[3] - places[2];
  const Vector3d product = a.cross(b);
  const double whole = kParallel * edge_squares_[pair.first] * edge_squares_[pair.second];
  const double c = std::min(1.0, product.squaredNorm() / whole);
  const double m = c * (2.0 - c);
  energy.energy = m * area * law.energy;
  energy.force = m * area * law.pressure;
  energy.stiffness = m * area * law.slope;
  if (c < 1.0) {
    energy.parallel = true;
    const double slope = area * law.energy * 2.0 * (1.0 - c) * 2.0 / whole;
    energy.by_first = slope * b.cross(product);
    energy.by_second = slope * product.cross(a);
  }
  found.push_back(energy);
}

}  // namespace haptex::cloth
