// Which parts of a mesh are not curved enough to come near themselves.
//
// Volino and Magnenat-Thalmann, Efficient self-collision detection on smoothly discretized surface
// animations using geometrical shape regularity, Computer Graphics Forum 13(3) (1994): a surface
// does not intersect itself if its normals lie in a cone and its contour, projected along the axis
// of the cone, does not cross itself. Here both are decided at once, and with a distance: the
// deformation gradients take the place of the normals, and the reference state, which lies in a
// plane, the place of the projection.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "haptex/proximity/kdop_hierarchy.h"

namespace haptex::proximity {

/// Let f map a plane region to where the cloth is, F be its gradient (3x2), Q two orthonormal
/// vectors of space, and
///   sym(Q^T F) >= kLeastStretch in every triangle that the convex hull of the region reaches into,
/// the hull being covered by triangles. For any two points x and y of the hull the integral along
/// the straight way between them gives
///   |f(x) - f(y)| |x - y| >= (Q (x - y)) . (f(x) - f(y)) >= kLeastStretch |x - y|^2:
/// what is at a distance d now was at most d / kLeastStretch apart in the reference state. Normals
/// deviate from the cone's axis by up to 60 degrees then, less where the cloth is compressed. The
/// contour cannot cross itself: in the reference state the hull, which is convex, holds no gap.
class FlatRegions {
 public:
  static constexpr double kLeastStretch = 0.5;  ///< of distances, between reference and now

  /// @param hierarchy whose volumes are the regions
  /// @param reference positions (m) at which no two elements touch but where they are adjacent. If
  ///   they do not lie in a plane, no region is flat
  FlatRegions(const KdopHierarchy& hierarchy, const std::vector<Eigen::Vector3d>& reference);

  /// Whether the triangles below a volume are known to be flat as said above. Never so for small
  /// volumes, and for those whose hull leaves the mesh. Does not allocate.
  bool isFlat(const KdopHierarchy& hierarchy, int volume) const;

 private:
  using Vector2 = Eigen::Vector2d;
  struct Region {
    bool is_convex = false;                // the hull is covered by triangles
    int begin = 0, end = 0;                // its own triangles, in the order of the leaves
    int more_begin = 0, more_end = 0;      // in more_, which the hull reaches into, too
    int weight_begin = 0, weight_end = 0;  // in weights_
  };
  // Of a particle in the mean of F over the region, which is the sum of x g^T. It is zero inside.
  struct Weight {
    int particle;
    float x, y;  // 1/m
  };
  // By columns, so that the compiler can take several triangles at a time.
  struct Triangles {
    std::vector<int> corner[3];
    std::vector<float> inverse[4];  // of the reference edges, by rows, 1/m
  };
  class Builder;

  bool isSteep(const float* positions, const float* frame, float least, int begin, int end,
               const int* more) const;

  std::vector<Region> regions_;  // by volume
  Triangles triangles_;          // in the order of the leaves
  std::vector<int> more_;        // in that order
  std::vector<Weight> weights_;
  double largest_inverse_ = 0.0;  // 1/m
};

}  // namespace haptex::proximity
