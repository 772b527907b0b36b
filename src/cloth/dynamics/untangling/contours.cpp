#include "haptex/cloth/dynamics/untangling/contours.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "haptex/proximity/intersections.h"

namespace haptex::cloth {
namespace {

using Eigen::Vector3d;
using Positions = std::vector<Vector3d>;
using Triangle = std::array<int, 3>;

bool has(const Triangle& triangle, int vertex) {
  return triangle[0] == vertex || triangle[1] == vertex || triangle[2] == vertex;
}

}  // namespace

MeshTopology::MeshTopology(const std::vector<Triangle>& triangles, std::size_t particles)
    : elements(triangles),
      edges_of(triangles.size()),
      triangles_at(elements.edges.size()),
      neighbours_of(particles) {
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (int i = 0; i < 3; ++i) {
      const int edge =
          elements.indexOf(proximity::edgeBetween(triangles[t][i], triangles[t][(i + 1) % 3]));
      edges_of[t][i] = edge;
      triangles_at[edge].push_back(static_cast<int>(t));
    }
  }
  for (const auto& [a, b] : elements.edges) {
    neighbours_of[a].push_back(b);
    neighbours_of[b].push_back(a);
  }
}

Vector3d MeshTopology::normalOf(const Positions& positions, int triangle) const {
  const auto& [a, b, c] = elements.triangles[triangle];
  return (positions[b] - positions[a]).cross(positions[c] - positions[a]).normalized();
}

IntersectionContours::IntersectionContours(const MeshTopology& topology) : topology_(topology) {}

void IntersectionContours::find(const Positions& positions,
                                const std::vector<proximity::TrianglePair>& pairs) {
  hits_.clear();
  crossings_.clear();
  parent_.resize(pairs.size());
  swapped_.assign(pairs.size(), 0);
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    parent_[p] = static_cast<int>(p);
    findHits(positions, pairs[p], static_cast<int>(p));
  }
  std::sort(hits_.begin(), hits_.end());
  for (std::size_t i = 1; i < hits_.size(); ++i) {
    const Hit &a = hits_[i - 1], &b = hits_[i];
    if (a.edge == b.edge && a.triangle == b.triangle) join(a, b);
  }
  nameContours();
  for (const Hit& hit : hits_) {
    if (crossings_.empty() || crossings_.back().edge != hit.edge ||
        crossings_.back().triangle != hit.triangle) {
      const bool on_first = hit.edge_of_first == (on_first_[hit.pair] != 0);
      const auto& [p, q, r] = topology_.elements.triangles[hit.triangle];
      const Vector3d weights =
          proximity::closestPoint({positions[p], positions[q], positions[r]}, hit.place)
              .barycentric;
      crossings_.push_back({hit.edge, hit.triangle, hit.share, weights, contour_of_[hit.pair],
                            on_first, Vector3d::Zero()});
    }
    crossings_.back().shorter += shorter(positions, hit);
  }
}

/// The ends of the segment in which a pair intersects. One of them may be a vertex that both share.
void IntersectionContours::findHits(const Positions& positions, const proximity::TrianglePair& pair,
                                    int index) {
  const auto& triangles = topology_.elements.triangles;
  const std::size_t first = hits_.size();
  for (const bool of_first : {true, false}) {
    const int own = pair[of_first ? 0 : 1], other = pair[of_first ? 1 : 0];
    const Vector3d normal = topology_.normalOf(positions, other);
    for (const int edge : topology_.edges_of[own]) {
      const auto& [a, b] = topology_.elements.edges[edge];
      if (has(triangles[other], a) || has(triangles[other], b)) continue;
      if (!proximity::passesThrough(positions, {a, b}, triangles[other])) continue;
      const double from = normal.dot(positions[a] - positions[triangles[other][0]]);
      const double to = normal.dot(positions[b] - positions[triangles[other][0]]);
      const double share = from / (from - to);
      if (!(share >= 0.0 && share <= 1.0)) continue;
      hits_.push_back({edge, other, share, index, of_first,
                       positions[a] + share * (positions[b] - positions[a]), Vector3d::Zero()});
    }
  }
  const auto look = [&](Hit& hit, const Vector3d& end) {
    const Vector3d way = end - hit.place;
    if (way.squaredNorm() > 0.0) hit.ahead = way.normalized();
  };
  if (hits_.size() == first + 1) {
    for (const int vertex : triangles[pair[0]]) {
      if (has(triangles[pair[1]], vertex)) look(hits_[first], positions[vertex]);
    }
  } else if (hits_.size() > first + 1) {
    look(hits_[first], hits_.back().place);
    look(hits_.back(), hits_[first].place);
  }
}

/// Its root, to which it is then joined directly.
int IntersectionContours::rootOf(int pair) {
  int root = pair;
  char swapped = 0;
  while (parent_[root] != root) {
    swapped ^= swapped_[root];
    root = parent_[root];
  }
  while (parent_[pair] != root && pair != root) {
    const int next = parent_[pair];
    const char further = swapped_[pair];
    parent_[pair] = root;
    swapped_[pair] = swapped;
    swapped ^= further;
    pair = next;
  }
  return root;
}

/// Two pairs that see the same crossing: the triangle that it is in is on one side of both.
void IntersectionContours::join(const Hit& a, const Hit& b) {
  const int root_a = rootOf(a.pair), root_b = rootOf(b.pair);
  if (root_a == root_b) return;
  const char swapped_a = a.pair == root_a ? 0 : swapped_[a.pair];
  const char swapped_b = b.pair == root_b ? 0 : swapped_[b.pair];
  const int child = std::max(root_a, root_b);
  parent_[child] = std::min(root_a, root_b);
  swapped_[child] = static_cast<char>((a.edge_of_first != b.edge_of_first) ^ swapped_a ^ swapped_b);
}

void IntersectionContours::nameContours() {
  count_ = 0;
  contour_of_.resize(parent_.size());
  on_first_.resize(parent_.size());
  for (int p = 0; p < static_cast<int>(parent_.size()); ++p) {
    const int root = rootOf(p);  // is never after what is joined to it
    contour_of_[p] = root == p ? count_++ : contour_of_[root];
    on_first_[p] = root == p || swapped_[p] == 0;
  }
}

Vector3d IntersectionContours::shorter(const Positions& positions, const Hit& hit) const {
  const auto& [a, b] = topology_.elements.edges[hit.edge];
  const Vector3d along = (positions[b] - positions[a]).normalized();
  const Vector3d normal = topology_.normalOf(positions, hit.triangle);
  const double across = along.dot(normal);
  if (across == 0.0) return Vector3d::Zero();
  const Vector3d way = hit.ahead - 2.0 * along.dot(hit.ahead) / across * normal;
  return way.allFinite() ? way : Vector3d::Zero();
}

}  // namespace haptex::cloth
