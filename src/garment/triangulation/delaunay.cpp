#include "haptex/garment/triangulation/delaunay.h"

#include <algorithm>
#include <deque>
#include <utility>

#include "haptex/base/require.h"
#include "haptex/garment/pattern/plane_predicates.h"

namespace haptex::garment {
namespace {

using Eigen::Vector2d;

constexpr int next(int i) { return i == 2 ? 0 : i + 1; }
constexpr int before(int i) { return i == 0 ? 2 : i - 1; }

}  // namespace

Delaunay::Delaunay(const std::vector<std::vector<Vector2d>>& loops,
                   const std::vector<Vector2d>& inside) {
  for (const auto& loop : loops) points_.insert(points_.end(), loop.begin(), loop.end());
  points_.insert(points_.end(), inside.begin(), inside.end());
  const int count = static_cast<int>(points_.size());
  enclose();
  int at = 0;
  for (int point = 0; point < count; ++point) {
    // Towards the point, over sides behind which it lies.
    for (int side = 0; side < 3; ++side) {
      const auto& corners = triangles_[at].corners;
      if (turn(points_[corners[next(side)]], points_[corners[before(side)]], points_[point]) < 0) {
        at = triangles_[at].neighbours[side];
        side = -1;
      }
    }
    int on = -1;
    for (int side = 0; side < 3; ++side) {
      const auto& corners = triangles_[at].corners;
      if (turn(points_[corners[next(side)]], points_[corners[before(side)]], points_[point]) == 0) {
        on = side;
      }
    }
    on < 0 ? splitInside(at, point) : splitSide(at, on, point);
  }
  int begin = 0;
  for (const auto& loop : loops) {
    const int size = static_cast<int>(loop.size());
    for (int i = 0; i < size; ++i) fix(begin + i, begin + (i + 1) % size);
    begin += size;
  }
  std::vector<int> all(triangles_.size());
  for (std::size_t t = 0; t < all.size(); ++t) all[t] = static_cast<int>(t);
  legalize(std::move(all));
  removeOutside(count);
}

// One triangle around all points.
void Delaunay::enclose() {
  Vector2d low = points_.front(), high = low;
  for (const Vector2d& point : points_) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  const Vector2d middle = 0.5 * (low + high);
  const double size = 100.0 * (high - low).maxCoeff();
  const int first = static_cast<int>(points_.size());
  triangle_of_.assign(points_.size(), 0);
  addPoint(middle + Vector2d(-size, -size));
  addPoint(middle + Vector2d(size, -size));
  addPoint(middle + Vector2d(0.0, size));
  newTriangle({first, first + 1, first + 2});
}

int Delaunay::addPoint(const Vector2d& point) {
  points_.push_back(point);
  triangle_of_.push_back(0);
  return static_cast<int>(points_.size()) - 1;
}

int Delaunay::newTriangle(const std::array<int, 3>& corners) {
  triangles_.push_back({corners, {-1, -1, -1}, {false, false, false}});
  const int triangle = static_cast<int>(triangles_.size()) - 1;
  remember(triangle);
  return triangle;
}

void Delaunay::remember(int triangle) {
  for (const int corner : triangles_[triangle].corners) triangle_of_[corner] = triangle;
}

int Delaunay::cornerOf(int triangle, int point) const {
  const auto& corners = triangles_[triangle].corners;
  return static_cast<int>(std::find(corners.begin(), corners.end(), point) - corners.begin());
}

int Delaunay::sideTo(int triangle, int neighbour) const {
  const auto& neighbours = triangles_[triangle].neighbours;
  return static_cast<int>(std::find(neighbours.begin(), neighbours.end(), neighbour) -
                          neighbours.begin());
}

// A neighbour that its triangle has another number.
void Delaunay::tell(int neighbour, int before, int after) {
  if (neighbour >= 0) triangles_[neighbour].neighbours[sideTo(neighbour, before)] = after;
}

// Of the triangles (p, a, b) and (q, b, a) it makes (p, a, q) and (p, q, b).
void Delaunay::flip(int triangle, int side) {
  const int other = triangles_[triangle].neighbours[side];
  const Triangle t = triangles_[triangle], n = triangles_[other];
  const int i = side, j = sideTo(other, triangle);
  const int p = t.corners[i], a = t.corners[next(i)], b = t.corners[before(i)], q = n.corners[j];
  triangles_[triangle] = {{p, a, q},
                          {n.neighbours[next(j)], other, t.neighbours[before(i)]},
                          {n.fixed[next(j)], false, t.fixed[before(i)]}};
  triangles_[other] = {{p, q, b},
                       {n.neighbours[before(j)], t.neighbours[next(i)], triangle},
                       {n.fixed[before(j)], t.fixed[next(i)], false}};
  tell(n.neighbours[next(j)], other, triangle);
  tell(t.neighbours[next(i)], triangle, other);
  remember(triangle);
  remember(other);
}

void Delaunay::legalize(std::vector<int> unchecked) {
  while (!unchecked.empty()) {
    const int t = unchecked.back();
    unchecked.pop_back();
    for (int side = 0; side < 3; ++side) {
      const Triangle& triangle = triangles_[t];
      const int other = triangle.neighbours[side];
      if (other < 0 || triangle.fixed[side]) continue;
      const int opposite = triangles_[other].corners[sideTo(other, t)];
      const auto& [a, b, c] = triangle.corners;
      if (inCircle(points_[a], points_[b], points_[c], points_[opposite]) <= 0) continue;
      flip(t, side);
      unchecked.push_back(t);
      unchecked.push_back(other);
      break;
    }
  }
}

void Delaunay::splitInside(int triangle, int point) {
  const Triangle t = triangles_[triangle];
  const auto [a, b, c] = t.corners;
  const int second = newTriangle({b, c, point}), third = newTriangle({c, a, point});
  triangles_[triangle] = {
      {a, b, point}, {second, third, t.neighbours[2]}, {false, false, t.fixed[2]}};
  triangles_[second].neighbours = {third, triangle, t.neighbours[0]};
  triangles_[second].fixed[2] = t.fixed[0];
  triangles_[third].neighbours = {triangle, second, t.neighbours[1]};
  triangles_[third].fixed[2] = t.fixed[1];
  tell(t.neighbours[0], triangle, second);
  tell(t.neighbours[1], triangle, third);
  remember(triangle);
  legalize({triangle, second, third});
}

// Of (c, a, b) it makes (c, a, point) and (c, point, b), and of (q, b, a) behind the side between
// a and b (q, b, point) and (q, point, a).
void Delaunay::splitSide(int triangle, int side, int point) {
  const Triangle t = triangles_[triangle];
  const int other = t.neighbours[side];
  const bool fixed = t.fixed[side];
  const int c = t.corners[side], a = t.corners[next(side)], b = t.corners[before(side)];
  const int second = newTriangle({c, point, b});
  triangles_[triangle] = {{c, a, point},
                          {-1, second, t.neighbours[before(side)]},
                          {fixed, false, t.fixed[before(side)]}};
  triangles_[second].neighbours = {-1, t.neighbours[next(side)], triangle};
  triangles_[second].fixed = {fixed, t.fixed[next(side)], false};
  tell(t.neighbours[next(side)], triangle, second);
  remember(triangle);
  std::vector<int> changed = {triangle, second};
  if (other >= 0) {
    const Triangle n = triangles_[other];
    const int j = sideTo(other, triangle);
    const int q = n.corners[j];
    const int fourth = newTriangle({q, point, a});
    triangles_[other] = {{q, b, point},
                         {second, fourth, n.neighbours[before(j)]},
                         {fixed, false, n.fixed[before(j)]}};
    triangles_[fourth].neighbours = {triangle, n.neighbours[next(j)], other};
    triangles_[fourth].fixed = {fixed, n.fixed[next(j)], false};
    tell(n.neighbours[next(j)], other, fourth);
    triangles_[triangle].neighbours[0] = fourth;
    triangles_[second].neighbours[0] = other;
    remember(other);
    changed.push_back(other);
    changed.push_back(fourth);
  }
  remember(second);
  legalize(std::move(changed));
}

// The triangle and side between two points; {-1, -1} if there is none.
std::array<int, 2> Delaunay::findSide(int from, int to) const {
  std::vector<int> points, triangles;
  around(from, points, triangles);
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const int corner = cornerOf(triangles[i], from);
    if (triangles_[triangles[i]].corners[next(corner)] == to) return {triangles[i], before(corner)};
    if (triangles_[triangles[i]].corners[before(corner)] == to) return {triangles[i], next(corner)};
  }
  return {-1, -1};
}

// The ends of all sides that the way between two points crosses, in its order.
std::vector<std::array<int, 2>> Delaunay::sidesAcross(int from, int to) const {
  const auto side_of_way = [&](int point) {
    return turn(points_[from], points_[to], points_[point]);
  };
  std::vector<int> points, triangles;
  around(from, points, triangles);
  int at = -1;
  for (const int triangle : triangles) {
    const int corner = cornerOf(triangle, from);
    const auto& corners = triangles_[triangle].corners;
    if (side_of_way(corners[next(corner)]) < 0 && side_of_way(corners[before(corner)]) > 0) {
      at = triangle;
    }
  }
  std::vector<std::array<int, 2>> sides;
  int side = at < 0 ? -1 : cornerOf(at, from);
  while (at >= 0) {
    const auto& corners = triangles_[at].corners;
    sides.push_back({corners[next(side)], corners[before(side)]});
    const int other = triangles_[at].neighbours[side];
    const int entered = sideTo(other, at);
    const int opposite = triangles_[other].corners[entered];
    if (opposite == to) break;
    // Out through the side that has an end on each side of the way.
    side = side_of_way(opposite) > 0 ? before(entered) : next(entered);
    at = other;
  }
  return sides;
}

// Makes two points the ends of a side that stays: Sloan 1993.
void Delaunay::fix(int from, int to) {
  const auto sides_of_way = [&](int a, int b) {
    return turn(points_[from], points_[to], points_[a]) *
           turn(points_[from], points_[to], points_[b]);
  };
  const auto crossing = sidesAcross(from, to);
  std::deque<std::array<int, 2>> left(crossing.begin(), crossing.end());
  if (findSide(from, to)[0] >= 0) left.clear();
  while (!left.empty()) {
    const auto [a, b] = left.front();
    left.pop_front();
    const auto [triangle, side] = findSide(a, b);
    const int other = triangles_[triangle].neighbours[side];
    const int p = triangles_[triangle].corners[side];
    const int q = triangles_[other].corners[sideTo(other, triangle)];
    const bool convex =
        turn(points_[p], points_[q], points_[a]) * turn(points_[p], points_[q], points_[b]) < 0;
    if (!convex) {
      left.push_back({a, b});
      continue;
    }
    flip(triangle, side);
    const bool at_end = p == from || p == to || q == from || q == to;
    if (!at_end && sides_of_way(p, q) < 0) left.push_back({p, q});
  }
  const auto [triangle, side] = findSide(from, to);
  if (triangle < 0) base::refuse("points ", from, " and ", to, " of a polygon cannot be joined");
  const int other = triangles_[triangle].neighbours[side];
  triangles_[triangle].fixed[side] = true;
  if (other >= 0) triangles_[other].fixed[sideTo(other, triangle)] = true;
}

// Inside is what is an odd number of sides that stay away from the triangles of the corners of
// enclose().
void Delaunay::removeOutside(int points) {
  std::vector<int> depth(triangles_.size(), -1), open = {triangle_of_[points]};
  depth[open.front()] = 0;
  while (!open.empty()) {
    const int t = open.back();
    open.pop_back();
    for (int side = 0; side < 3; ++side) {
      const int other = triangles_[t].neighbours[side];
      if (other < 0 || depth[other] >= 0) continue;
      depth[other] = depth[t] + (triangles_[t].fixed[side] ? 1 : 0);
      open.push_back(other);
    }
  }
  std::vector<int> place(triangles_.size(), -1);
  int count = 0;
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    if (depth[t] % 2 == 1) place[t] = count++;
  }
  std::vector<Triangle> kept;
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    if (place[t] < 0) continue;
    kept.push_back(triangles_[t]);
    for (int& neighbour : kept.back().neighbours) {
      if (neighbour >= 0) neighbour = place[neighbour];
    }
  }
  triangles_ = std::move(kept);
  points_.resize(points);
  triangle_of_.resize(points);
  for (int t = 0; t < count; ++t) remember(t);
}

void Delaunay::around(int point, std::vector<int>& points, std::vector<int>& triangles) const {
  points.clear();
  triangles.clear();
  // Back to the outline, or once around.
  const int start = triangle_of_[point];
  int first = start;
  for (;;) {
    const int other = triangles_[first].neighbours[before(cornerOf(first, point))];
    if (other < 0) break;
    first = other;
    if (first == start) break;
  }
  int at = first;
  for (;;) {
    const int corner = cornerOf(at, point);
    points.push_back(triangles_[at].corners[next(corner)]);
    triangles.push_back(at);
    const int last = triangles_[at].corners[before(corner)];
    at = triangles_[at].neighbours[next(corner)];
    if (at == first) return;
    if (at < 0) {
      points.push_back(last);
      return;
    }
  }
}

bool Delaunay::isOnOutline(int point) const {
  std::vector<int> points, triangles;
  around(point, points, triangles);
  return points.size() != triangles.size();
}

Delaunay::Arrival Delaunay::walk(int triangle, const Vector2d& place) const {
  const auto corner = [&](int t, int i) -> const Vector2d& {
    return points_[triangles_[t].corners[i]];
  };
  const Vector2d from = (corner(triangle, 0) + corner(triangle, 1) + corner(triangle, 2)) / 3.0;
  int at = triangle, entered = -1;
  for (std::size_t steps = 0; steps <= triangles_.size(); ++steps) {
    int exit = -1;
    for (int side = 0; side < 3; ++side) {
      const Vector2d &a = corner(at, next(side)), &b = corner(at, before(side));
      if (side == entered || turn(a, b, place) >= 0) continue;
      // Where the way leads through a corner, either side will do.
      if (exit < 0 || (turn(from, place, a) <= 0 && turn(from, place, b) >= 0)) exit = side;
    }
    if (exit < 0) return {at, -1};
    if (triangles_[at].fixed[exit] || triangles_[at].neighbours[exit] < 0) return {at, exit};
    const int other = triangles_[at].neighbours[exit];
    entered = sideTo(other, at);
    at = other;
  }
  return {at, entered};
}

int Delaunay::add(const Vector2d& point, int triangle) {
  int on = -1;
  for (int side = 0; side < 3; ++side) {
    const auto& corners = triangles_[triangle].corners;
    if (points_[corners[side]] == point) return -1;
    if (turn(points_[corners[next(side)]], points_[corners[before(side)]], point) == 0) on = side;
  }
  const int added = addPoint(point);
  on < 0 ? splitInside(triangle, added) : splitSide(triangle, on, added);
  return added;
}

int Delaunay::split(int triangle, int side, const Vector2d& point) {
  const int added = addPoint(point);
  splitSide(triangle, side, added);
  return added;
}

bool Delaunay::move(int point, const Vector2d& to) {
  if (isOnOutline(point)) return false;
  std::vector<int> points, triangles;
  around(point, points, triangles);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vector2d &a = points_[points[i]], &b = points_[points[(i + 1) % points.size()]];
    if (turn(a, b, to) <= 0) return false;
  }
  points_[point] = to;
  legalize(std::move(triangles));
  return true;
}

}  // namespace haptex::garment
