#include "haptex/garment/triangulation/refinement.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <queue>
#include <tuple>
#include <utility>

#include "haptex/garment/pattern/plane_predicates.h"

namespace haptex::garment {
namespace {

using Eigen::Vector2d;

constexpr int next(int i) { return i == 2 ? 0 : i + 1; }
constexpr int before(int i) { return i == 0 ? 2 : i - 1; }

// Of circles, in edge lengths. The new points are no nearer to others than that; edges between them
// are up to twice as long, 1.3 times on average.
constexpr double kLargestRadius = 0.75;
constexpr double kArmLength = 4.0;            // of sharp corners, in edge lengths
constexpr double kSmallestHalf = 1.0 / 32.0;  // of a side, in edge lengths
constexpr int kSmoothings = 8;
constexpr double kGoodAngle = 0.6108652381980153;  // rad, 35 degrees: smoothing may go down to it

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

double angleAt(const Vector2d& at, const Vector2d& a, const Vector2d& b) {
  return std::atan2(std::abs(cross(a - at, b - at)), (a - at).dot(b - at));
}

struct Shape {
  double shortest = 0.0;  // m, edge
  int opposite = 0;       // corner opposite to it, with the smallest angle
  double angle = 0.0;     // rad, the smallest
  Vector2d centre = Vector2d::Zero();
  double radius = 0.0;  // m, of its circle
};

Shape shapeOf(const std::array<Vector2d, 3>& corners) {
  Shape shape;
  shape.shortest = (corners[2] - corners[1]).norm();
  for (int i = 1; i < 3; ++i) {
    const double length = (corners[before(i)] - corners[next(i)]).norm();
    if (length >= shape.shortest) continue;
    shape.shortest = length;
    shape.opposite = i;
  }
  const int i = shape.opposite;
  shape.angle = angleAt(corners[i], corners[next(i)], corners[before(i)]);
  const Vector2d u = corners[1] - corners[0], v = corners[2] - corners[0];
  const Vector2d from_corner = Vector2d(v.y() * u.squaredNorm() - u.y() * v.squaredNorm(),
                                        u.x() * v.squaredNorm() - v.x() * u.squaredNorm()) /
                               (2.0 * cross(u, v));
  shape.centre = corners[0] + from_corner;
  shape.radius = from_corner.norm();
  return shape;
}

/// Which points lie beside sharp corners of the outlines.
class SharpCorners {
 public:
  SharpCorners(const Delaunay& triangulation, double reach) : arms_(triangulation.points().size()) {
    const std::vector<Vector2d>& points = triangulation.points();
    std::vector<std::array<int, 2>> beside(points.size());  // on the outline
    std::vector<double> angles(points.size(), 0.0);
    std::vector<int> around, triangles;
    for (std::size_t p = 0; p < points.size(); ++p) {
      if (!triangulation.isOnOutline(static_cast<int>(p))) {
        angles[p] = 2.0 * M_PI;
        continue;
      }
      triangulation.around(static_cast<int>(p), around, triangles);
      beside[p] = {around.front(), around.back()};
      for (std::size_t i = 1; i < around.size(); ++i) {
        angles[p] += angleAt(points[p], points[around[i - 1]], points[around[i]]);
      }
    }
    for (std::size_t p = 0; p < points.size(); ++p) {
      if (angles[p] >= kSharpCorner) continue;
      for (int direction = 0; direction < 2; ++direction) {
        int at = beside[p][direction];
        while (at != static_cast<int>(p) && (points[at] - points[p]).norm() <= reach) {
          arms_[at].push_back({static_cast<int>(p), direction});
          at = beside[at][direction];
        }
        // The first one, however far.
        if (arms_[beside[p][direction]].empty()) {
          arms_[beside[p][direction]].push_back({static_cast<int>(p), direction});
        }
      }
    }
  }

  /// Of a new point, between two on an outline or inside (-1).
  void add(int a, int b) {
    arms_.emplace_back();
    if (a < 0) return;
    for (const auto& arm : arms_[a]) {
      if (arm[0] == b || contains(b, arm)) arms_.back().push_back(arm);
    }
    for (const auto& arm : arms_[b]) {
      if (arm[0] == a) arms_.back().push_back(arm);
    }
  }

  /// Whether the points lie on the two sides of one corner.
  bool across(int a, int b) const {
    for (const auto& [corner, direction] : arms_[a]) {
      if (contains(b, {corner, 1 - direction})) return true;
    }
    return false;
  }

 private:
  using Arm = std::array<int, 2>;  // corner and direction

  bool contains(int point, const Arm& arm) const {
    return std::find(arms_[point].begin(), arms_[point].end(), arm) != arms_[point].end();
  }

  std::vector<std::vector<Arm>> arms_;
};

class Refinement {
 public:
  Refinement(Delaunay& triangulation, double edge_length)
      : triangulation_(triangulation),
        edge_length_(edge_length),
        sharp_corners_(triangulation, kArmLength * edge_length) {
    const int count = static_cast<int>(triangulation.points().size());
    for (int p = 0; p < count; ++p) on_outline_.push_back(triangulation.isOnOutline(p));
  }

  std::vector<std::array<int, 3>> run(Filling filling) {
    if (filling == Filling::kEven) addPoints(&Refinement::tooLarge);
    addPoints(&Refinement::tooSharp);
    if (filling == Filling::kEven) {
      for (int i = 0; i < kSmoothings; ++i) smooth();
      addPoints(&Refinement::tooSharp);
    }
    return std::move(halvings_);
  }

 private:
  // How urgent it is to refine a triangle, 0 if it is not.
  using Criterion = double (Refinement::*)(int triangle, const Shape& shape) const;

  double tooLarge(int /*triangle*/, const Shape& shape) const {
    const double excess = shape.radius / (kLargestRadius * edge_length_);
    return excess > 1.0 ? excess : 0.0;
  }

  double tooSharp(int triangle, const Shape& shape) const {
    if (shape.angle >= kLeastAngle) return 0.0;
    const auto& corners = triangulation_.triangles()[triangle].corners;
    const int a = corners[next(shape.opposite)], b = corners[before(shape.opposite)];
    return sharp_corners_.across(a, b) ? 0.0 : 1.0 / std::max(shape.angle, 1e-9);
  }

  Shape shapeOfTriangle(int triangle) const {
    const auto& corners = triangulation_.triangles()[triangle].corners;
    const auto& points = triangulation_.points();
    return shapeOf({points[corners[0]], points[corners[1]], points[corners[2]]});
  }

  // The most urgent triangle first, the older one of two.
  struct Waiting {
    double urgency;
    int triangle;
    std::array<int, 3> corners;
    bool operator<(const Waiting& other) const {
      return std::make_pair(urgency, -triangle) < std::make_pair(other.urgency, -other.triangle);
    }
  };

  void enqueue(int triangle, Criterion criterion) {
    const double urgency = (this->*criterion)(triangle, shapeOfTriangle(triangle));
    if (urgency <= 0.0) return;
    waiting_.push({urgency, triangle, triangulation_.triangles()[triangle].corners});
  }

  void addPoints(Criterion criterion) {
    waiting_ = {};
    const int count = static_cast<int>(triangulation_.triangles().size());
    for (int t = 0; t < count; ++t) enqueue(t, criterion);
    std::vector<int> points, triangles;
    while (!waiting_.empty()) {
      const Waiting first = waiting_.top();
      waiting_.pop();
      if (triangulation_.triangles()[first.triangle].corners != first.corners) continue;
      const int added = addFor(first.triangle, criterion == &Refinement::tooSharp);
      if (added < 0) continue;
      triangulation_.around(added, points, triangles);
      for (const int triangle : triangles) enqueue(triangle, criterion);
    }
  }

  // A point that removes a triangle; -1 if there is none.
  int addFor(int triangle, bool may_halve) {
    const Shape shape = shapeOfTriangle(triangle);
    if (!shape.centre.allFinite()) return -1;
    const Delaunay::Arrival arrival = triangulation_.walk(triangle, shape.centre);
    const auto [at, side] = arrival.blocked_by >= 0
                                ? std::make_pair(arrival.triangle, arrival.blocked_by)
                                : sideCloseTo(shape.centre, arrival.triangle);
    if (side >= 0) return may_halve ? halve(at, side) : -1;
    const int added = triangulation_.add(shape.centre, arrival.triangle);
    if (added < 0) return -1;
    on_outline_.push_back(false);
    sharp_corners_.add(-1, -1);
    return added;
  }

  // A side of an outline that is seen from a point at a right angle or a larger one: a point there
  // would make small angles (Ruppert, A Delaunay refinement algorithm for quality 2-dimensional
  // mesh generation, 1995). It is a side of a triangle whose circle the point lies in.
  std::pair<int, int> sideCloseTo(const Vector2d& point, int triangle) {
    const auto& points = triangulation_.points();
    std::vector<int> open = {triangle}, seen = {triangle};
    while (!open.empty()) {
      const int t = open.back();
      open.pop_back();
      const auto& [corners, neighbours, fixed] = triangulation_.triangles()[t];
      for (int side = 0; side < 3; ++side) {
        const Vector2d &a = points[corners[next(side)]], &b = points[corners[before(side)]];
        if (fixed[side]) {
          if ((a - point).dot(b - point) <= 0.0) return {t, side};
          continue;
        }
        const int other = neighbours[side];
        if (std::find(seen.begin(), seen.end(), other) != seen.end()) continue;
        const auto& o = triangulation_.triangles()[other].corners;
        if (inCircle(points[o[0]], points[o[1]], points[o[2]], point) <= 0) continue;
        seen.push_back(other);
        open.push_back(other);
      }
    }
    return {-1, -1};
  }

  int halve(int triangle, int side) {
    const auto& t = triangulation_.triangles()[triangle];
    if (!t.fixed[side]) return -1;
    const int a = t.corners[next(side)], b = t.corners[before(side)];
    const Vector2d pa = triangulation_.points()[a], pb = triangulation_.points()[b];
    if (0.5 * (pb - pa).norm() < kSmallestHalf * edge_length_) return -1;
    const int added = triangulation_.split(triangle, side, 0.5 * (pa + pb));
    on_outline_.push_back(true);
    sharp_corners_.add(a, b);
    halvings_.push_back({added, a, b});
    return added;
  }

  double smallestAngle(const Vector2d& at, const std::vector<int>& points) const {
    double smallest = M_PI;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vector2d& a = triangulation_.points()[points[i]];
      const Vector2d& b = triangulation_.points()[points[(i + 1) % points.size()]];
      if (cross(a - at, b - at) <= 0.0) return 0.0;
      smallest = std::min(smallest, shapeOf({at, a, b}).angle);
    }
    return smallest;
  }

  void smooth() {
    std::vector<int> points, triangles;
    for (std::size_t p = 0; p < triangulation_.points().size(); ++p) {
      if (on_outline_[p]) continue;
      triangulation_.around(static_cast<int>(p), points, triangles);
      Vector2d middle = Vector2d::Zero();
      for (const int point : points) {
        middle += triangulation_.points()[point] / static_cast<double>(points.size());
      }
      const double before_it = smallestAngle(triangulation_.points()[p], points);
      if (smallestAngle(middle, points) < std::min(before_it, kGoodAngle)) continue;
      triangulation_.move(static_cast<int>(p), middle);
    }
  }

  Delaunay& triangulation_;
  const double edge_length_;
  SharpCorners sharp_corners_;
  std::vector<bool> on_outline_;
  std::priority_queue<Waiting> waiting_;
  std::vector<std::array<int, 3>> halvings_;
};

}  // namespace

std::vector<std::array<int, 3>> refine(Delaunay& triangulation, double edge_length,
                                       Filling filling) {
  return Refinement(triangulation, edge_length).run(filling);
}

}  // namespace haptex::garment
