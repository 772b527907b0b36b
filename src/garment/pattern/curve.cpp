#include "haptex/garment/pattern/curve.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "haptex/base/require.h"

namespace haptex::garment {
namespace {

using Eigen::Vector2d;

// m. Products of coordinates that are smaller would leave what exact predicates can compute.
constexpr double kNothing = 1e-15;

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

// Abscissas > 0 and weights of the Gauss-Legendre rule of ten points on [-1, 1].
constexpr std::array<double, 5> kGaussAt = {0.1488743389816312, 0.4333953941292472,
                                            0.6794095682990244, 0.8650633666889845,
                                            0.9739065285171717};
constexpr std::array<double, 5> kGaussWeight = {0.2955242247147529, 0.2692667193099963,
                                                0.2190863625159820, 0.1494513491505806,
                                                0.0666713443086881};

template <typename Function>
double gauss(const Function& function, double from, double to) {
  const double middle = 0.5 * (from + to), half = 0.5 * (to - from);
  double sum = 0.0;
  for (std::size_t i = 0; i < kGaussAt.size(); ++i) {
    const double step = half * kGaussAt[i];
    sum += kGaussWeight[i] * (function(middle - step) + function(middle + step));
  }
  return half * sum;
}

template <typename Function>
double integral(const Function& function, double from, double to, double tolerance, int depth) {
  const double middle = 0.5 * (from + to);
  const double whole = gauss(function, from, to);
  const double parts = gauss(function, from, middle) + gauss(function, middle, to);
  if (depth == 0 || !(std::abs(whole - parts) > tolerance)) return parts;
  return integral(function, from, middle, tolerance, depth - 1) +
         integral(function, middle, to, tolerance, depth - 1);
}

Vector2d directionOf(const Vector2d& vector) {
  const double norm = vector.norm();
  return norm > 0.0 ? Vector2d(vector / norm) : Vector2d(1.0, 0.0);
}

}  // namespace

Curve::Curve(Kind kind, std::vector<Vector2d> points) : kind_(kind), points_(std::move(points)) {
  for (Vector2d& point : points_) {
    for (double& coordinate : point) {
      if (!(std::abs(coordinate) <= kFarthestPoint)) {
        base::refuse("a point has the coordinate ", coordinate,
                     " m: allowed are finite ones up to ", kFarthestPoint, " m");
      }
      if (std::abs(coordinate) < kNothing) coordinate = 0.0;
    }
  }
  if (kind_ == Kind::kArc) setArc();
  setLength();
}

Curve Curve::line(std::vector<Vector2d> points) {
  if (points.size() < 2) base::refuse("a line has ", points.size(), " points: allowed are >= 2");
  return Curve(Kind::kLine, std::move(points));
}

Curve Curve::quadratic(const Vector2d& start, const Vector2d& control, const Vector2d& end) {
  return Curve(Kind::kQuadratic, {start, control, end});
}

Curve Curve::cubic(const Vector2d& start, const Vector2d& first_control,
                   const Vector2d& second_control, const Vector2d& end) {
  return Curve(Kind::kCubic, {start, first_control, second_control, end});
}

Curve Curve::arc(const Vector2d& start, const Vector2d& through, const Vector2d& end) {
  return Curve(Kind::kArc, {start, through, end});
}

void Curve::setArc() {
  const Vector2d u = points_[1] - points_[0], v = points_[2] - points_[0];
  const double area = cross(u, v);  // twice that of the triangle
  const double longest = std::max({u.norm(), v.norm(), (v - u).norm()});
  // Flatter than that, the centre would be lost in rounding.
  if (!(std::abs(area) > 1e-8 * longest * longest)) {
    base::refuse("the three points of an arc lie on a line: they must determine a circle");
  }
  const Vector2d from_start = Vector2d(v.y() * u.squaredNorm() - u.y() * v.squaredNorm(),
                                       u.x() * v.squaredNorm() - v.x() * u.squaredNorm()) /
                              (2.0 * area);
  centre_ = points_[0] + from_start;
  radius_ = from_start.norm();
  begin_ = std::atan2(-from_start.y(), -from_start.x());
  // The angle at the centre is twice that between the chords at `through`, which lies outside.
  const Vector2d to_start = points_[0] - points_[1], to_end = points_[2] - points_[1];
  const double at_through = std::atan2(std::abs(cross(to_start, to_end)), to_start.dot(to_end));
  sweep_ = std::copysign(2.0 * (M_PI - at_through), area);
}

void Curve::setLength() {
  switch (kind_) {
    case Kind::kLine:
      passed_ = {0.0};
      for (std::size_t i = 1; i < points_.size(); ++i) {
        passed_.push_back(passed_.back() + (points_[i] - points_[i - 1]).norm());
      }
      length_ = passed_.back();
      break;
    case Kind::kArc:
      length_ = radius_ * std::abs(sweep_);
      break;
    default:
      length_ = bezierLength(0.0, 1.0);
  }
}

Vector2d Curve::at(double t) const {
  if (t <= 0.0) return start();
  if (t >= 1.0) return end();
  const double s = 1.0 - t;
  const std::vector<Vector2d>& p = points_;
  switch (kind_) {
    case Kind::kLine: {
      const auto after = std::upper_bound(passed_.begin() + 1, passed_.end() - 1, t * length_);
      const std::size_t i = after - passed_.begin();
      const double step = passed_[i] - passed_[i - 1];
      const double part = step > 0.0 ? (t * length_ - passed_[i - 1]) / step : 0.0;
      return p[i - 1] + part * (p[i] - p[i - 1]);
    }
    case Kind::kQuadratic:
      return s * s * p[0] + 2.0 * s * t * p[1] + t * t * p[2];
    case Kind::kCubic:
      return s * s * s * p[0] + 3.0 * s * t * (s * p[1] + t * p[2]) + t * t * t * p[3];
    default:
      return centre_ +
             radius_ * Vector2d(std::cos(begin_ + t * sweep_), std::sin(begin_ + t * sweep_));
  }
}

Vector2d Curve::derivative(double t) const {
  const double s = 1.0 - t;
  const std::vector<Vector2d>& p = points_;
  if (kind_ == Kind::kQuadratic) return 2.0 * (s * (p[1] - p[0]) + t * (p[2] - p[1]));
  return 3.0 * (s * s * (p[1] - p[0]) + 2.0 * s * t * (p[2] - p[1]) + t * t * (p[3] - p[2]));
}

double Curve::bezierLength(double from, double to) const {
  double polygon = 0.0;  // not shorter than the curve
  for (std::size_t i = 1; i < points_.size(); ++i) polygon += (points_[i] - points_[i - 1]).norm();
  const auto speed = [this](double t) { return derivative(t).norm(); };
  return integral(speed, from, to, 1e-13 * polygon, 24);
}

double Curve::parameterAt(double length) const {
  if (!(length > 0.0)) return 0.0;
  if (length >= length_) return 1.0;
  if (kind_ == Kind::kLine || kind_ == Kind::kArc) return length / length_;
  // Newton's method, kept inside of what is known by bisection.
  double low = 0.0, high = 1.0, t = length / length_;
  for (int i = 0; i < 60; ++i) {
    const double excess = bezierLength(0.0, t) - length;
    if (std::abs(excess) <= 1e-12 * length_) break;
    (excess > 0.0 ? high : low) = t;
    const double speed = derivative(t).norm();
    const double next = speed > 0.0 ? t - excess / speed : low;
    t = next > low && next < high ? next : 0.5 * (low + high);
  }
  return t;
}

double Curve::sweptArea() const {
  if (kind_ == Kind::kLine) {
    double sum = 0.0;
    for (std::size_t i = 1; i < points_.size(); ++i) sum += cross(points_[i - 1], points_[i]);
    return 0.5 * sum;
  }
  if (kind_ ==
      Kind::kArc) {  // the sector seen from the centre, and the centre seen from the origin
    return 0.5 * (radius_ * radius_ * sweep_ + cross(centre_, end() - start()));
  }
  // A polynomial of degree 5 at most, for which the rule is exact.
  return 0.5 * gauss([this](double t) { return cross(at(t), derivative(t)); }, 0.0, 1.0);
}

std::vector<Vector2d> Curve::flattened(double tolerance) const {
  if (kind_ == Kind::kLine) return points_;
  // Between parameters that differ by d, a curve is at most d^2 / 8 of its largest second
  // derivative away from the chord.
  double bend = 0.0;
  if (kind_ == Kind::kArc) bend = radius_ * sweep_ * sweep_;
  const double degree = kind_ == Kind::kQuadratic ? 2.0 : 6.0;
  for (std::size_t i = 2; kind_ != Kind::kArc && i < points_.size(); ++i) {
    bend = std::max(bend, degree * (points_[i] - 2.0 * points_[i - 1] + points_[i - 2]).norm());
  }
  const double steps = std::ceil(std::sqrt(bend / (8.0 * tolerance)));
  const int count = static_cast<int>(std::clamp(steps, 1.0, 10000.0));
  std::vector<Vector2d> points;
  for (int i = 0; i <= count; ++i) points.push_back(at(static_cast<double>(i) / count));
  return points;
}

Vector2d Curve::startDirection() const {
  if (kind_ == Kind::kArc) {
    const double turn = std::copysign(1.0, sweep_);
    return turn * Vector2d(-std::sin(begin_), std::cos(begin_));
  }
  // The first point that differs.
  for (std::size_t i = 1; i < points_.size(); ++i) {
    if (points_[i] != points_[0]) return directionOf(points_[i] - points_[0]);
  }
  return Vector2d(1.0, 0.0);
}

Vector2d Curve::endDirection() const { return -reversed().startDirection(); }

Curve Curve::reversed() const {
  return Curve(kind_, std::vector<Vector2d>(points_.rbegin(), points_.rend()));
}

Curve Curve::mirrored() const {
  std::vector<Vector2d> points = points_;
  for (Vector2d& point : points) point.x() = -point.x();
  return Curve(kind_, std::move(points));
}

Curve Curve::withStart(const Vector2d& start) const {
  std::vector<Vector2d> points = points_;
  points.front() = start;
  return Curve(kind_, std::move(points));
}

}  // namespace haptex::garment
