#include "haptex/cloth/forces/self_contact/near_obstacles.h"

#include <algorithm>
#include <utility>

#include "haptex/linear/thread_pool.h"

namespace haptex::cloth {
namespace {

using Eigen::Vector3d;
using Places = NearObstacles::Places;
using Box = proximity::BoxTree::Box;
using proximity::ElementPairKind;

constexpr int kTriangles = 128;  // of the cloth, that a thread takes at a time

std::vector<Box> emptyBoxes(std::size_t count) {
  return std::vector<Box>(count, Box(Vector3d::Zero(), Vector3d::Zero()));
}

Box grown(const Box& box, double by) {
  return {box.min() - Vector3d::Constant(by), box.max() + Vector3d::Constant(by)};
}

template <typename Corners>
Box around(const std::vector<Box>& boxes, const Corners& corners, std::size_t begin,
           std::size_t end) {
  Box box = boxes[corners[begin]];
  for (std::size_t i = begin + 1; i < end; ++i) box.extend(boxes[corners[i]]);
  return box;
}

}  // namespace

NearObstacles::OwnElements::OwnElements(const proximity::MeshElements& elements)
    : vertices(elements.triangles.size()), edges(elements.triangles.size()) {
  std::vector<bool> vertex_taken(elements.vertices.empty() ? 0 : elements.vertices.back() + 1);
  std::vector<bool> edge_taken(elements.edges.size());
  const auto take = [](std::vector<bool>& taken, int element, std::vector<int>& own) {
    if (!taken[element]) own.push_back(element);
    taken[element] = true;
  };
  for (std::size_t t = 0; t < elements.triangles.size(); ++t) {
    for (int i = 0; i < 3; ++i) {
      const int a = elements.triangles[t][i], b = elements.triangles[t][(i + 1) % 3];
      take(vertex_taken, a, vertices[t]);
      if (a == b) continue;
      take(edge_taken, elements.indexOf(proximity::edgeBetween(a, b)), edges[t]);
    }
  }
}

NearObstacles::NearObstacles(const std::vector<std::array<int, 3>>& triangles,
                             std::size_t particles, std::shared_ptr<ObstacleSurfaces> surfaces,
                             double searched)
    : surfaces_(std::move(surfaces)),
      cloth_(triangles),
      particles_(static_cast<int>(particles)),
      searched_(searched),
      own_of_cloth_(cloth_),
      own_of_obstacles_(surfaces_->elements()),
      corner_boxes_(emptyBoxes(particles + surfaces_->vertexCount())),
      boxes_(emptyBoxes(surfaces_->elements().triangles.size())),
      tree_(boxes_),
      found_((triangles.size() + kTriangles - 1) / kTriangles) {
  fitObstacleBoxes(surfaces_->atEnd(), nullptr);
  tree_ = proximity::BoxTree(boxes_);
}

/// Those of obstacles at rest stay.
void NearObstacles::fitObstacleBoxes(const Places& places, const Places* ways) {
  if (ways == nullptr && places == fitted_at_) return;
  fitted_at_.clear();
  if (ways == nullptr) fitted_at_ = places;
  for (std::size_t i = 0; i < places.size(); ++i) {
    Box& box = corner_boxes_[particles_ + i];
    box = Box(places[i]);
    if (ways != nullptr) box.extend(places[i] + (*ways)[i]);
  }
  for (std::size_t t = 0; t < boxes_.size(); ++t) {
    std::array<int, 3> corners = surfaces_->elements().triangles[t];
    const double radius = surfaces_->radius(surfaces_->obstacleOf(corners[0]));
    for (int& corner : corners) corner += particles_;
    boxes_[t] = grown(around(corner_boxes_, corners, 0, 3), radius);
  }
  tree_.refit(boxes_);
}

/// All whose boxes are at most a distance apart, into found_.
void NearObstacles::collect(double distance, linear::ThreadPool* pool) {
  const int triangles = static_cast<int>(cloth_.triangles.size());
  linear::runTasks(pool, static_cast<int>(found_.size()), [&](int part, int) {
    std::vector<Pair>& its = found_[part];
    its.clear();
    const int end = std::min(triangles, kTriangles * (part + 1));
    for (int t = kTriangles * part; t < end; ++t) {
      const Box box = around(corner_boxes_, cloth_.triangles[t], 0, 3);
      tree_.visit(grown(box, distance), [&](int other) { addPairs(t, other, distance, its); });
    }
  });
}

/// What found_ has, in order.
void NearObstacles::join(std::vector<Pair>& pairs) const {
  pairs.clear();
  for (const std::vector<Pair>& its : found_) pairs.insert(pairs.end(), its.begin(), its.end());
  std::sort(pairs.begin(), pairs.end());
}

/// m, of the surfaces, or beyond searched_.
double NearObstacles::distanceOf(const Pair& pair, const Places& positions,
                                 const Places& places) const {
  std::array<Vector3d, 4> at;
  for (int i = 0; i < 4; ++i) {
    const int vertex = pair.vertices[i];
    at[i] = vertex < particles_ ? positions[vertex] : places[vertex - particles_];
  }
  return proximity::isSurelyApart(pair.kind, at, pair.radius + searched_)
             ? 2.0 * searched_
             : proximity::distanceOf(pair.kind, at).distance - pair.radius;
}

void NearObstacles::find(const Places& positions, const Places& places, double distance,
                         linear::ThreadPool* pool) {
  if (!searched_at_.empty()) {
    const double moved = NearPairs::farthest(positions, searched_at_) +
                         NearPairs::farthest(places, places_searched_at_);
    if (moved <= searched_ - distance) {
      moved_ = moved;
      return;
    }
  }
  for (std::size_t i = 0; i < positions.size(); ++i) corner_boxes_[i] = Box(positions[i]);
  fitObstacleBoxes(places, nullptr);
  const auto is_far = [&](const Pair& pair) { return pair.distance > searched_; };
  collect(searched_, pool);
  linear::runTasks(pool, static_cast<int>(found_.size()), [&](int part, int) {
    std::vector<Pair>& its = found_[part];
    for (Pair& pair : its) pair.distance = distanceOf(pair, positions, places);
    its.erase(std::remove_if(its.begin(), its.end(), is_far), its.end());
  });
  join(pairs_);
  moved_ = 0.0;
  searched_at_ = positions;
  places_searched_at_ = places;
}

const std::vector<NearObstacles::Pair>& NearObstacles::onWays(
    const Places& positions, const Vector3d& common, const Places& ways, const Places& places,
    const Places* place_ways, double distance, linear::ThreadPool* pool) {
  for (std::size_t i = 0; i < positions.size(); ++i) {
    corner_boxes_[i] = Box(positions[i]);
    corner_boxes_[i].extend(positions[i] + common);
    corner_boxes_[i].extend(positions[i] + common + ways[i]);
  }
  fitObstacleBoxes(places, place_ways);
  collect(distance, pool);
  join(on_ways_);
  return on_ways_;
}

void NearObstacles::addPairs(int of_cloth, int of_obstacle, double distance,
                             std::vector<Pair>& found) const {
  const proximity::MeshElements& others = surfaces_->elements();
  const std::array<int, 3>& face = cloth_.triangles[of_cloth];
  std::array<int, 3> other = others.triangles[of_obstacle];
  const int obstacle = surfaces_->obstacleOf(other[0]);
  const double radius = surfaces_->radius(obstacle);
  for (int& corner : other) corner += particles_;
  const auto add = [&](ElementPairKind kind, int first, int second,
                       const std::array<int, 4>& vertices) {
    const std::size_t first_end = kind == ElementPairKind::kVertexTriangle ? 1 : 2;
    const Box box = around(corner_boxes_, vertices, 0, first_end);
    if (!grown(box, distance + radius).intersects(around(corner_boxes_, vertices, first_end, 4))) {
      return;
    }
    found.push_back({kind, first, second, vertices, obstacle, radius});
  };
  for (const int vertex : own_of_cloth_.vertices[of_cloth]) {
    add(ElementPairKind::kVertexTriangle, vertex, of_obstacle,
        {vertex, other[0], other[1], other[2]});
  }
  for (const int own : own_of_obstacles_.vertices[of_obstacle]) {
    const int vertex = own + particles_;
    add(ElementPairKind::kVertexTriangle, vertex, of_cloth, {vertex, face[0], face[1], face[2]});
  }
  for (const int first : own_of_cloth_.edges[of_cloth]) {
    for (const int second : own_of_obstacles_.edges[of_obstacle]) {
      const proximity::Edge& a = cloth_.edges[first];
      const proximity::Edge& b = others.edges[second];
      add(ElementPairKind::kEdgeEdge, first, second,
          {a[0], a[1], b[0] + particles_, b[1] + particles_});
    }
  }
}

}  // namespace haptex::cloth
