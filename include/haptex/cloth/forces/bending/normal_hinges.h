// How far hinges are bent towards the normal of the present sheet, and its derivatives.
#pragma once

#include <Eigen/Dense>
#include <utility>
#include <vector>

#include "haptex/cloth/forces/bending/bending_hinge.h"
#include "haptex/cloth/forces/force.h"
#include "haptex/mesh/mesh.h"

namespace haptex::cloth {

/// A hinge with the bending vector b has the bend b . n (m). n is the direction of U x V, the
/// images of the unit vectors along weft and warp in the affine map nearest to the hinge's
/// particles, so the bend does not depend on where the sheet is and how it is turned, and forces
/// along its exact gradient have neither a sum nor a moment. What is approximated is that one
/// normal stands for the whole hinge, which is of the second order in its size over the radius.
class NormalHinges {
 public:
  struct Corner {
    int particle;
    double weight;  ///< of the bending vector, no unit
    double weft;    ///< of U, 1/m
    double warp;    ///< of V, 1/m
  };
  struct NormalHinge {
    int begin;  ///< of its corners
    int end;
    double stiffness;  ///< N/m, the hinge's
    double bend;       ///< m, of the sheet without forces; not 0
    double length;     ///< m^2, |resists| without the part of twist
  };
  struct Frame {
    Eigen::Vector3d bending = Eigen::Vector3d::Zero();  ///< b, m
    Eigen::Vector3d weft = Eigen::Vector3d::Zero();     ///< U
    Eigen::Vector3d warp = Eigen::Vector3d::Zero();     ///< V
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();   ///< n; zero if there is none
    Eigen::Vector3d across = Eigen::Vector3d::Zero();   ///< of b, across n, over |U x V|, m
    double area = 0.0;                                  ///< |U x V|

    double bend() const { return bending.dot(normal); }  ///< m
  };

  /// The hinges that a sheet with these curvatures (1/m) along weft and warp bends.
  NormalHinges(const mesh::ClothMesh& mesh, const std::vector<Hinge>& hinges,
               const std::vector<HingeCorner>& corners, const Eigen::Vector2d& curvature);
  /// Of hinges whose bends at rest are known.
  NormalHinges(std::vector<NormalHinge> hinges, std::vector<Corner> corners)
      : hinges_(std::move(hinges)), corners_(std::move(corners)) {}

  /// Makes them hinges on some particles of a larger mesh, by the numbers there.
  void renumber(const std::vector<int>& particles);

  const std::vector<NormalHinge>& hinges() const { return hinges_; }
  const std::vector<Corner>& corners() const { return corners_; }

  /// @param place of a particle (m)
  template <typename Place>
  Frame frame(const NormalHinge& hinge, const Place& place) const {
    Frame at;
    const Eigen::Vector3d& origin = place(corners_[hinge.begin].particle);
    for (int i = hinge.begin + 1; i < hinge.end; ++i) {
      const Corner& corner = corners_[i];
      const Eigen::Vector3d from = place(corner.particle) - origin;
      at.bending += corner.weight * from;
      at.weft += corner.weft * from;
      at.warp += corner.warp * from;
    }
    const Eigen::Vector3d normal = at.weft.cross(at.warp);
    at.area = normal.norm();
    if (at.area == 0.0) return at;  // no normal, no bend
    at.normal = normal / at.area;
    at.across = (at.bending - at.bend() * at.normal) / at.area;
    return at;
  }
  Frame frame(const NormalHinge& hinge, const Positions& positions) const {
    return frame(hinge, [&](int i) -> const Eigen::Vector3d& { return positions[i]; });
  }

  /// Derivative of the bend by the place of a corner's particle.
  static Eigen::Vector3d gradient(const Frame& at, const Corner& corner) {
    // d(b . n) = n . db + across . d(U x V)
    return corner.weight * at.normal + corner.weft * at.warp.cross(at.across) +
           corner.warp * at.across.cross(at.weft);
  }

  /// Second derivative of the bend by the places of two corners' particles, of a frame with a
  /// normal.
  static Eigen::Matrix3d hessian(const Frame& at, const Corner& row, const Corner& column);

 private:
  std::vector<NormalHinge> hinges_;
  std::vector<Corner> corners_;
};

}  // namespace haptex::cloth
