// The relief of a fabric as a surface that rays meet.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "haptex/tactile/relief_picture.h"

namespace haptex::appearance {

/// A height field over a grid of square or oblong texels that repeats without end along weft (x)
/// and warp (y). Heights stand at the corners of the texels and are bilinear within each. What one
/// texel shows is of one yarn. Lengths and places are in m.
class ReliefSurface {
 public:
  static constexpr int kMinTexels = 4, kMaxTexels = 1024;  ///< along a side

  /// The whole relief, resampled: periodic cubic (Catmull-Rom) between its samples.
  /// @param columns, rows texels along weft and warp
  /// @throws std::invalid_argument what requireSound() throws for the heights, and naming columns
  ///   or rows out of kMinTexels to kMaxTexels, or a number of warp_on_top other than of heights
  ReliefSurface(const tactile::FaceRelief& relief, int columns, int rows);

  /// As it is stored.
  /// @param heights m, row by row, at the corner of each texel with the lowest x and y
  /// @param warp_on_top of each texel, in the same order
  /// @throws std::invalid_argument as above, and naming a size, height or number of heights
  ReliefSurface(int columns, int rows, const Eigen::Vector2d& size, std::vector<float> heights,
                std::vector<bool> warp_on_top);

  int columns() const { return columns_; }
  int rows() const { return rows_; }
  int texels() const { return columns_ * rows_; }
  const Eigen::Vector2d& size() const { return size_; }  ///< m, of a repeat
  double highest() const { return highest_; }            ///< m
  const std::vector<float>& heights() const { return heights_; }
  const std::vector<bool>& warpOnTop() const { return warp_on_top_; }

  /// A place on the surface. Index of a texel: columns row + column.
  struct Point {
    int texel;
    Eigen::Vector3d place;   ///< m
    Eigen::Vector3d normal;  ///< unit, of the bilinear surface there, z > 0
  };
  Point centreOf(int texel) const;

  /// Where a view ray first meets the surface.
  /// @param seen m, x and y on the plane at the height highest(), where the ray passes
  /// @param towards_eye unit, z >= kFlattest
  Point seenAt(const Eigen::Vector2d& seen, const Eigen::Vector3d& towards_eye) const;

  /// What a ray from a point of the surface meets, nothing if it leaves the relief.
  /// @param direction unit, out of the surface: with a positive component along the normal
  std::optional<Point> met(const Point& from, const Eigen::Vector3d& direction) const;

 private:
  struct Meeting {
    int texel;
    double distance;  // m
  };
  std::optional<Meeting> meet(const Eigen::Vector3d& origin,
                              const Eigen::Vector3d& direction) const;
  Point pointIn(int texel, const Eigen::Vector3d& place) const;
  void prepare();
  /// Height over a texel: h + x hx + y hy + x y hxy, x and y from its corner, in texels.
  struct Patch {
    float h, hx, hy, hxy, highest;
  };

  int columns_, rows_;
  Eigen::Vector2d size_, spacing_;
  std::vector<float> heights_;
  std::vector<bool> warp_on_top_;
  std::vector<Patch> patches_;
  double highest_, lift_;
};

}  // namespace haptex::appearance
