#include "haptex/cloth/forces/self_contact/pair_energies.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

namespace haptex::cloth {
namespace {

using Eigen::Vector3d;

// Of the squares of both rest lengths: edges at an angle of less than about 1.8 degrees.
constexpr double kParallel = 1e-3;

std::vector<double> edgeSquares(const std::vector<proximity::Edge>& edges,
                                const std::vector<Vector3d>& positions) {
  std::vector<double> squares;
  for (const auto& [a, b] : edges) squares.push_back((positions[b] - positions[a]).squaredNorm());
  return squares;
}

/// Of one layer, and at half of the distance, from that of two layers that mirror each other.
LayerPressure mirrored(const LayerPressure& layers) {
  return {0.5 * layers.energy, layers.pressure, 2.0 * layers.slope};
}

/// m, between the surface of an obstacle and the cloth. Places that no state has, where attachments
/// have jumped for a comparison of energies, may lie inside.
double gapOf(double distance, double radius) { return std::max(1e-9, distance - radius); }

/// Zero where both places are the same.
Vector3d directionOf(const Vector3d& away, double distance) {
  return distance > 0.0 ? Vector3d(away / distance) : Vector3d(Vector3d::Zero());
}

/// @param area m^2, < 0 of what is subtracted
void spread(const LayerPressure& law, double area, PairEnergy& energy) {
  energy.energy = area * law.energy;
  energy.force = area * law.pressure;
  energy.stiffness = std::max(0.0, area) * law.slope;
}

/// Of two edges with the edge vectors a and b; whole: at 1.
void fadeWhereParallel(const Vector3d& a, const Vector3d& b, double whole, double area,
                       const LayerPressure& law, PairEnergy& energy) {
  const Vector3d product = a.cross(b);
  const double c = std::min(1.0, product.squaredNorm() / whole);
  const double m = c * (2.0 - c);
  spread(law, m * area, energy);
  if (c < 1.0) {
    energy.parallel = true;
    const double slope = area * law.energy * 2.0 * (1.0 - c) * 2.0 / whole;
    energy.by_first = slope * b.cross(product);
    energy.by_second = slope * product.cross(a);
  }
}

}  // namespace

PairEnergies::PairEnergies(const RestSurface& rest, FabricLayers layers)
    : layers_(std::move(layers)),
      particles_(static_cast<int>(rest.places().size())),
      triangles_(rest.triangles),
      cloth_(rest.triangles, rest.places().size(), rest.fabrics),
      fabrics_(rest.fabrics) {
  const proximity::MeshElements elements(triangles_);
  edge_areas_.assign(elements.edges.size(), 0.0);
  edge_squares_.assign(elements.edges.size(), 0.0);
  if (!fabrics_.empty()) edge_fabrics_.resize(elements.edges.size());
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    triangle_areas_.push_back(rest.area(t));
    for (int i = 0; i < 3; ++i) {
      const int next = (i + 1) % 3;
      const int edge =
          elements.indexOf(proximity::edgeBetween(triangles_[t][i], triangles_[t][next]));
      edge_areas_[edge] += triangle_areas_[t] / 6.0;
      if (!fabrics_.empty()) edge_fabrics_[edge] = fabrics_[t];
      // Of a seam, the longer of its two edges.
      edge_squares_[edge] =
          std::max(edge_squares_[edge], (rest.corners[t][next] - rest.corners[t][i]).squaredNorm());
    }
  }
  addAreas();
}

void PairEnergies::addAreas() {
  std::vector<std::vector<Area>> of_vertices(particles_);
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    const int fabric = fabricOf(static_cast<int>(t));
    for (const int vertex : triangles_[t]) {
      std::vector<Area>& areas = of_vertices[vertex];
      auto area = std::find_if(areas.begin(), areas.end(),
                               [&](const Area& other) { return other.fabric == fabric; });
      if (area == areas.end()) area = areas.insert(area, {fabric, 0.0});
      area->area += triangle_areas_[t] / 6.0;
    }
  }
  for (const std::vector<Area>& areas : of_vertices) {
    first_area_.push_back(static_cast<int>(areas_.size()));
    areas_.insert(areas_.end(), areas.begin(), areas.end());
  }
  first_area_.push_back(static_cast<int>(areas_.size()));
}

void PairEnergies::setObstacles(const ObstacleSurfaces& surfaces) {
  obstacles_.emplace(surfaces.elements().triangles, surfaces.vertexCount());
  obstacle_edge_squares_ = edgeSquares(surfaces.elements().edges, surfaces.atEnd());
}

void PairEnergies::find(const Positions& positions, const NearPairs& near,
                        std::vector<PairEnergy>& found) {
  found.clear();
  const Pair* pair = near.pairs().data();
  const Pair* const end = pair + near.pairs().size();
  while (pair != end && pair->kind == proximity::ElementPairKind::kVertexTriangle) {
    const int vertex = pair->first;
    near_.clear();
    for (; pair != end && pair->kind == proximity::ElementPairKind::kVertexTriangle &&
           pair->first == vertex;
         ++pair) {
      if (!near.isBeyond(*pair, layers_.thickness())) near_.push_back(pair->second);
    }
    if (!near_.empty()) addVertex(positions, vertex, found);
  }
  for (; pair != end; ++pair) {
    if (!near.isBeyond(*pair, layers_.leastDistance())) addEdges(positions, *pair, found);
  }
}

/// That is near the triangles near_.
void PairEnergies::addVertex(const Positions& positions, int vertex,
                             std::vector<PairEnergy>& found) {
  const Vector3d& place = positions[vertex];
  for (const auto& feature : cloth_.nearest(positions, place, near_, layers_.thickness())) {
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
    energy.normal = directionOf(away, energy.distance);
    for (int a = first_area_[vertex]; a < first_area_[vertex + 1]; ++a) {
      const LayerPair law = layers_.pair(areas_[a].fabric, feature.fabric);
      if (energy.distance >= law.thickness()) continue;
      energy.fabrics = {areas_[a].fabric, feature.fabric};
      spread(law.at(energy.distance), feature.times * areas_[a].area, energy);
      found.push_back(energy);
    }
  }
}

void PairEnergies::addEdges(const Positions& positions, const Pair& pair,
                            std::vector<PairEnergy>& found) const {
  const auto& v = pair.vertices;
  const std::array<Vector3d, 4> places = {positions[v[0]], positions[v[1]], positions[v[2]],
                                          positions[v[3]]};
  const std::array<int, 2> fabrics = {fabricOfEdge(pair.first), fabricOfEdge(pair.second)};
  const LayerPair law = layers_.pair(fabrics[0], fabrics[1]);
  if (proximity::isSurelyApart(pair.kind, places, law.leastDistance())) return;
  const proximity::Separation nearest = proximity::separationOf(pair.kind, places);
  if (nearest.distance >= law.leastDistance()) return;
  PairEnergy energy{};
  energy.fabrics = fabrics;
  energy.count = 4;
  energy.vertices = v;
  for (int i = 0; i < 4; ++i) energy.weights[i] = nearest.weights[i];
  energy.distance = nearest.distance;
  energy.normal = directionOf(nearest.away, nearest.distance);
  fadeWhereParallel(places[1] - places[0], places[3] - places[2],
                    kParallel * edge_squares_[pair.first] * edge_squares_[pair.second],
                    0.5 * (edge_areas_[pair.first] + edge_areas_[pair.second]),
                    law.guardAt(nearest.distance), energy);
  found.push_back(energy);
}

void PairEnergies::findOfObstacles(const Positions& positions, const NearObstacles& near,
                                   bool at_end, std::vector<PairEnergy>& found) {
  const ObstacleSurfaces& surfaces = near.surfaces();
  const Obstacles obstacles = {surfaces, at_end, at_end ? surfaces.atEnd() : surfaces.atBegin()};
  const Pair* pair = near.pairs().data();
  const Pair* const end = pair + near.pairs().size();
  const auto is_vertex = [&](const Pair& other) {
    return other.kind == proximity::ElementPairKind::kVertexTriangle && other.first < particles_;
  };
  while (pair != end && is_vertex(*pair)) {
    const Pair& first = *pair;
    near_.clear();
    for (; pair != end && is_vertex(*pair) && pair->first == first.first &&
           pair->obstacle == first.obstacle;
         ++pair) {
      if (!near.isBeyond(*pair, 0.5 * layers_.thickness())) near_.push_back(pair->second);
    }
    if (!near_.empty()) addVertexAtObstacle(positions, obstacles, first, found);
  }
  for (; pair != end; ++pair) {
    if (near.isBeyond(*pair, 0.5 * layers_.leastDistance())) continue;
    if (pair->kind == proximity::ElementPairKind::kVertexTriangle) {
      addObstacleVertex(positions, obstacles, *pair, found);
    } else {
      addEdgesAtObstacle(positions, obstacles, *pair, found);
    }
  }
}

/// That is near the triangles near_. @param pair any of these
void PairEnergies::addVertexAtObstacle(const Positions& positions, const Obstacles& obstacles,
                                       const Pair& pair, std::vector<PairEnergy>& found) {
  const int vertex = pair.first;
  const double reach = pair.radius + 0.5 * layers_.thickness();
  for (const auto& feature :
       obstacles_->nearest(obstacles.places, positions[vertex], near_, reach)) {
    Vector3d away = positions[vertex];
    for (int i = 0; i < feature.size; ++i) {
      away -= feature.weights[i] * obstacles.places[feature.ids[i]];
    }
    const double distance = away.norm();
    if (distance >= reach) continue;
    PairEnergy energy{};
    energy.obstacle = pair.obstacle;
    energy.count = 1;
    energy.vertices[0] = vertex;
    energy.weights[0] = 1.0;
    energy.distance = gapOf(distance, pair.radius);
    energy.normal = directionOf(away, distance);
    energy.way = obstacles.surfaces.wayOf(energy.obstacle, feature.size, feature.ids.data(),
                                          feature.weights.data(), pair.radius * energy.normal,
                                          obstacles.at_end);
    for (int a = first_area_[vertex]; a < first_area_[vertex + 1]; ++a) {
      const LayerLaw& law = layers_.law(areas_[a].fabric);
      if (2.0 * energy.distance >= law.thickness()) continue;
      energy.fabrics = {areas_[a].fabric, areas_[a].fabric};
      spread(mirrored(law.at(2.0 * energy.distance)), 2.0 * feature.times * areas_[a].area, energy);
      found.push_back(energy);
    }
  }
}

void PairEnergies::addObstacleVertex(const Positions& positions, const Obstacles& obstacles,
                                     const Pair& pair, std::vector<PairEnergy>& found) const {
  const auto& v = pair.vertices;
  const int vertex = v[0] - particles_;
  const std::array<Vector3d, 4> places = {obstacles.places[vertex], positions[v[1]],
                                          positions[v[2]], positions[v[3]]};
  const int fabric = fabricOf(pair.second);
  const LayerLaw& law = layers_.law(fabric);
  const double reach = pair.radius + 0.5 * law.leastDistance();
  if (proximity::isSurelyApart(pair.kind, places, reach)) return;
  const proximity::PairDistance nearest = proximity::vertexTriangleDistance(places);
  if (nearest.distance >= reach) return;
  PairEnergy energy{};
  energy.fabrics = {fabric, fabric};
  energy.obstacle = pair.obstacle;
  energy.count = 3;
  Vector3d away = -places[0];
  for (int i = 0; i < 3; ++i) {
    energy.vertices[i] = v[i + 1];
    energy.weights[i] = nearest.weights[i + 1];
    away += nearest.weights[i + 1] * places[i + 1];
  }
  energy.distance = gapOf(nearest.distance, pair.radius);
  energy.normal = away / away.norm();
  spread(mirrored(law.guardAt(2.0 * energy.distance)), triangle_areas_[pair.second] / 3.0, energy);
  constexpr double kWhole = 1.0;
  energy.way = obstacles.surfaces.wayOf(pair.obstacle, 1, &vertex, &kWhole,
                                        pair.radius * energy.normal, obstacles.at_end);
  found.push_back(energy);
}

void PairEnergies::addEdgesAtObstacle(const Positions& positions, const Obstacles& obstacles,
                                      const Pair& pair, std::vector<PairEnergy>& found) const {
  const auto& v = pair.vertices;
  const std::array<int, 2> ends = {v[2] - particles_, v[3] - particles_};
  const std::array<Vector3d, 4> places = {positions[v[0]], positions[v[1]],
                                          obstacles.places[ends[0]], obstacles.places[ends[1]]};
  const int fabric = fabricOfEdge(pair.first);
  const LayerLaw& law = layers_.law(fabric);
  const double reach = pair.radius + 0.5 * law.leastDistance();
  if (proximity::isSurelyApart(pair.kind, places, reach)) return;
  const proximity::PairDistance nearest = proximity::edgeEdgeDistance(places);
  if (nearest.distance >= reach) return;
  const auto& w = nearest.weights;
  PairEnergy energy{};
  energy.fabrics = {fabric, fabric};
  energy.obstacle = pair.obstacle;
  energy.count = 2;
  energy.vertices = {v[0], v[1], -1, -1};
  energy.weights = {w[0], w[1], 0.0, 0.0};
  energy.distance = gapOf(nearest.distance, pair.radius);
  energy.normal = (w[0] * places[0] + w[1] * places[1] - w[2] * places[2] - w[3] * places[3]) /
                  nearest.distance;
  fadeWhereParallel(places[1] - places[0], places[3] - places[2],
                    kParallel * edge_squares_[pair.first] * obstacle_edge_squares_[pair.second],
                    edge_areas_[pair.first], mirrored(law.guardAt(2.0 * energy.distance)), energy);
  const std::array<double, 2> of_obstacle = {w[2], w[3]};
  energy.way = obstacles.surfaces.wayOf(pair.obstacle, 2, ends.data(), of_obstacle.data(),
                                        pair.radius * energy.normal, obstacles.at_end);
  found.push_back(energy);
}

}  // namespace haptex::cloth
