// Constrained Delaunay triangulations of polygons.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace haptex::garment {

/// Triangles between points of a plane, with edges that stay: the outline of a polygon and of its
/// holes, and nothing outside. A triangle is Delaunay if no point that it sees, across no edge that
/// stays, lies inside of its circle; all of them are, decided exactly. Lawson, Software for C1
/// surface interpolation, 1977; Sloan, A fast algorithm for generating constrained Delaunay
/// triangulations, Computers & Structures 47 (1993).
class Delaunay {
 public:
  /// Corner i is opposite to side i, behind which lies neighbour i, -1 outside of the polygon.
  struct Triangle {
    std::array<int, 3> corners;  ///< points, counter-clockwise
    std::array<int, 3> neighbours;
    std::array<bool, 3> fixed;  ///< sides that stay
  };

  /// @param loops closed polygons of points that differ, each joined to the next and the last to
  ///   the first: the outline counter-clockwise or clockwise, then holes inside of it, three points
  ///   or more each. They neither touch nor cross themselves or each other: findCrossing() tells.
  /// @param inside further points, inside of the polygon, that differ
  explicit Delaunay(const std::vector<std::vector<Eigen::Vector2d>>& loops,
                    const std::vector<Eigen::Vector2d>& inside = {});

  /// In the order of the loops, then those inside, then as they were added.
  const std::vector<Eigen::Vector2d>& points() const { return points_; }
  const std::vector<Triangle>& triangles() const { return triangles_; }
  /// Any triangle of a point.
  int triangleOf(int point) const { return triangle_of_[point]; }

  /// Where one arrives from the middle of a triangle on the straight way to a place: the triangle
  /// with the place, or the first with a side that stays in the way and which one.
  struct Arrival {
    int triangle = 0;
    int blocked_by = -1;  ///< side of the triangle, -1 if the place was reached
  };
  Arrival walk(int triangle, const Eigen::Vector2d& place) const;

  /// Adds a point in a triangle or on one of its sides that do not stay.
  /// @return its number; -1 if it coincides with a corner
  int add(const Eigen::Vector2d& point, int triangle);
  /// Adds a point on a side that stays, whose two halves then stay. @return its number
  int split(int triangle, int side, const Eigen::Vector2d& point);
  /// Moves a point that lies on no side that stays, to where all of its triangles still turn
  /// counter-clockwise. @return whether it did: otherwise nothing has changed
  bool move(int point, const Eigen::Vector2d& to);
  bool isOnOutline(int point) const;
  /// The points around one, counter-clockwise, and the triangles between each and the next. Around
  /// a point of an outline there is one triangle less than points; the first and the last point are
  /// its neighbours on the outline.
  void around(int point, std::vector<int>& points, std::vector<int>& triangles) const;

 private:
  int cornerOf(int triangle, int point) const;
  int sideTo(int triangle, int neighbour) const;
  void tell(int neighbour, int before, int after);
  int newTriangle(const std::array<int, 3>& corners);
  void remember(int triangle);
  void flip(int triangle, int side);
  void legalize(std::vector<int> unchecked);
  int addPoint(const Eigen::Vector2d& point);
  void splitInside(int triangle, int point);
  void splitSide(int triangle, int side, int point);
  void enclose();
  void fix(int from, int to);
  std::vector<std::array<int, 2>> sidesAcross(int from, int to) const;
  std::array<int, 2> findSide(int from, int to) const;
  void removeOutside(int points);

  std::vector<Eigen::Vector2d> points_;
  std::vector<Triangle> triangles_;
  std::vector<int> triangle_of_;
};

}  // namespace haptex::garment
