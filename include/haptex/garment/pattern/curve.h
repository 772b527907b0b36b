// Curves in the plane of a panel, from which its outline is made.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace haptex::garment {

constexpr double kFarthestPoint = 1000.0;  ///< m, in each coordinate

/// A piece of an outline from its start to its end. All coordinates and lengths are in metres.
/// A parameter t runs from 0 at the start to 1 at the end: along lines and arcs in proportion to
/// length, along the others it is that of Bezier.
class Curve {
 public:
  enum class Kind { kLine, kQuadratic, kCubic, kArc };

  /// A line through two or more points.
  static Curve line(std::vector<Eigen::Vector2d> points);
  /// Bezier curves with one or two control points.
  static Curve quadratic(const Eigen::Vector2d& start, const Eigen::Vector2d& control,
                         const Eigen::Vector2d& end);
  static Curve cubic(const Eigen::Vector2d& start, const Eigen::Vector2d& first_control,
                     const Eigen::Vector2d& second_control, const Eigen::Vector2d& end);
  /// The circular arc from start to end that passes through a point between them.
  /// @throws std::invalid_argument if the three do not determine a circle
  static Curve arc(const Eigen::Vector2d& start, const Eigen::Vector2d& through,
                   const Eigen::Vector2d& end);
  // All of them throw std::invalid_argument if a coordinate is not finite or beyond kFarthestPoint.

  Kind kind() const { return kind_; }
  /// What it was made of: points of the line, control points, or the three points of the arc.
  const std::vector<Eigen::Vector2d>& points() const { return points_; }
  const Eigen::Vector2d& start() const { return points_.front(); }
  const Eigen::Vector2d& end() const { return points_.back(); }

  Eigen::Vector2d at(double t) const;
  /// Exact for lines and arcs, by adaptive Gauss quadrature to 1e-12 of itself for the others.
  double length() const { return length_; }
  /// The parameter at which so much of the length has passed, to 1e-12 of the length.
  /// @param length from 0 to length(), what is beyond counts as the nearest of these
  double parameterAt(double length) const;
  /// Half the integral of x dy - y dx, in m^2: what it adds to the area of the outline that it is
  /// a piece of, counter-clockwise. Exact to rounding.
  double sweptArea() const;
  /// Points along the curve, its start and end among them, between which straight lines are no
  /// farther than so much (m, > 0) from it; no more than 10 001.
  std::vector<Eigen::Vector2d> flattened(double tolerance) const;
  /// Directions, of length 1, in which it leaves its start and arrives at its end.
  Eigen::Vector2d startDirection() const;
  Eigen::Vector2d endDirection() const;

  Curve reversed() const;
  /// Mirrored at the line x = 0.
  Curve mirrored() const;
  /// The same with another start, for ends that differ by rounding.
  Curve withStart(const Eigen::Vector2d& start) const;

 private:
  Curve(Kind kind, std::vector<Eigen::Vector2d> points);

  Eigen::Vector2d derivative(double t) const;
  double bezierLength(double from, double to) const;
  void setArc();
  void setLength();

  Kind kind_;
  std::vector<Eigen::Vector2d> points_;
  std::vector<double> passed_;                        // of a line, up to each of its points, m
  Eigen::Vector2d centre_ = Eigen::Vector2d::Zero();  // of an arc
  double radius_ = 0.0, begin_ = 0.0, sweep_ = 0.0;   // m, rad; sweep > 0 counter-clockwise
  double length_ = 0.0;
};

}  // namespace haptex::garment
