// An oracle for distances between convex bodies that has nothing in common with what it checks.
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include "haptex/proximity/triangle_distance.h"

namespace haptex::proximity {

/// Distance of the origin from the convex hull of some points: the least norm of the points nearest
/// to the origin of all simplices of 1 to 4 of them. Every candidate lies in the hull, and the
/// nearest point of the hull lies in one of the simplices (Caratheodory).
/// @tparam Real long double, or __float128 where the simplices may be very thin: their weights are
///   found through determinants, with an error of the rounding over the square of the thinness
template <typename Real>
class HullDistance {
 public:
  using Vector = Eigen::Matrix<Real, 3, 1>;

  explicit HullDistance(std::vector<Vector> points) : points_(std::move(points)) {
    const std::size_t n = points_.size();
    for (std::size_t i = 0; i < n; ++i) {
      consider(points_[i]);
      for (std::size_t j = 0; j < i; ++j) {
        edge(points_[i], points_[j]);
        for (std::size_t k = 0; k < j; ++k) {
          triangle(points_[i], points_[j], points_[k]);
          for (std::size_t l = 0; l < k; ++l) {
            tetrahedron(points_[i], points_[j], points_[k], points_[l]);
          }
        }
      }
    }
  }

  double value() const { return static_cast<double>(std::sqrt(static_cast<long double>(square_))); }

 private:
  void consider(const Vector& place) { square_ = std::min(square_, place.dot(place)); }

  void edge(const Vector& a, const Vector& b) {
    const Vector way = b - a;
    weighted<2>({a, b}, {b.dot(way), -a.dot(way)});
  }

  void triangle(const Vector& a, const Vector& b, const Vector& c) {
    const Vector normal = cross(b - a, c - a);
    weighted<3>({a, b, c},
                {cross(b, c).dot(normal), cross(c, a).dot(normal), cross(a, b).dot(normal)});
  }

  void tetrahedron(const Vector& a, const Vector& b, const Vector& c, const Vector& d) {
    const Vector ab = cross(a, b), cd = cross(c, d);
    weighted<4>({a, b, c, d}, {b.dot(cd), -a.dot(cd), d.dot(ab), -c.dot(ab)});
  }

  // The point with these weights, if all have the same sign.
  template <std::size_t kSize>
  void weighted(const std::array<Vector, kSize>& corners, const std::array<Real, kSize>& weights) {
    Real sum = 0;
    bool positive = true, negative = true;
    for (const Real& weight : weights) {
      positive = positive && weight >= 0;
      negative = negative && weight <= 0;
      sum += weight;
    }
    if ((!positive && !negative) || sum == 0) return;
    Vector place(0, 0, 0);
    for (std::size_t i = 0; i < kSize; ++i) place += (weights[i] / sum) * corners[i];
    consider(place);
  }

  static Vector cross(const Vector& a, const Vector& b) {
    return Vector(a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]);
  }

  std::vector<Vector> points_;
  Real square_ = std::numeric_limits<double>::max();
};

/// Distance of the convex hulls of two sets of points: that of the origin from the hull of all
/// differences.
template <typename Real>
double exactDistance(const std::vector<Eigen::Vector3d>& first,
                     const std::vector<Eigen::Vector3d>& second) {
  using Vector = Eigen::Matrix<Real, 3, 1>;
  std::vector<Vector> differences;
  for (const Eigen::Vector3d& a : first) {
    for (const Eigen::Vector3d& b : second) {
      differences.push_back(Vector(Real(a[0]) - b[0], Real(a[1]) - b[1], Real(a[2]) - b[2]));
    }
  }
  return HullDistance<Real>(std::move(differences)).value();
}

inline std::vector<Eigen::Vector3d> cornersOf(const Triangle& triangle) {
  return {triangle.begin(), triangle.end()};
}

/// Random triangles of all kinds, sizes from 1 mm to 1 m.
class RandomTriangles {
 public:
  double number(double least, double most) {
    return std::uniform_real_distribution<double>(least, most)(generator_);
  }
  /// Each magnitude between the two powers of ten is as likely as any other.
  double magnitude(double least_power, double most_power) {
    return std::pow(10.0, number(least_power, most_power));
  }
  int index(int count) { return std::uniform_int_distribution<int>(0, count - 1)(generator_); }
  Eigen::Vector3d vector() { return {number(-1, 1), number(-1, 1), number(-1, 1)}; }
  Eigen::Isometry3d pose(double reach) {
    const Eigen::Vector4d q(number(-1, 1), number(-1, 1), number(-1, 1), number(-1, 1));
    Eigen::Isometry3d pose(Eigen::Quaterniond(q.normalized()).normalized());
    pose.translation() = reach * vector();
    return pose;
  }

  static constexpr int kKinds = 6;
  Triangle triangle(int kind) {
    const double size = magnitude(-3, 0);
    const Eigen::Vector3d centre = size * vector();
    Triangle t;
    for (Eigen::Vector3d& corner : t) corner = centre + size * vector();
    switch (kind) {
      case 0:  // any
        break;
      case 1:  // thin: a height of 1e-12 to 1e-3 of its length
        t[2] = t[0] + number(0, 1) * (t[1] - t[0]) + size * magnitude(-12, -3) * vector();
        break;
      case 2:  // three corners in a line, to rounding
        t[2] = t[0] + number(-1, 2) * (t[1] - t[0]);
        break;
      case 3:  // a segment
        std::fill_n(t.begin() + index(2), 2, t[1]);
        break;
      case 4:  // a point
        t[1] = t[2] = t[0];
        break;
      case 5:  // corners on a grid, so that edges and faces are parallel and touch
        for (Eigen::Vector3d& corner : t) {
          corner = Eigen::Vector3d(index(3), index(3), index(3)) / 8.0;
        }
        break;
    }
    return t;
  }

 private:
  std::mt19937 generator_{1};
};

}  // namespace haptex::proximity
