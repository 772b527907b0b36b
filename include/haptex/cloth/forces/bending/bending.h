// Bending of a cloth by forces that are linear in the positions.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "haptex/cloth/forces/bending/bending_fit.h"
#include "haptex/cloth/forces/bending/bending_hinge.h"
#include "haptex/cloth/forces/bending/bending_stencils.h"
#include "haptex/cloth/forces/bending/rest_curvature.h"
#include "haptex/cloth/forces/force.h"
#include "haptex/linear/block_matrix.h"
#include "haptex/material/fabric.h"
#include "haptex/mesh/mesh.h"

namespace haptex::cloth {

/// What hinges there are.
enum class BendingModel {
  /// Up to four particles each (Volino and Magnenat-Thalmann 2006): the corners of two triangles
  /// that share an edge; or a particle, one of its neighbours and those on either side of the line
  /// from that neighbour through it. Their stiffnesses are fitted to the mesh. Where that is not
  /// exact inside of the mesh, which it is on grids of rectangular cells however they are cut, the
  /// hinges of kQuadratic replace them: non-negative stiffnesses smear rigidity from one particle
  /// to the next, and irregular meshes are then 23 to 30 % too soft.
  kLinear,
  /// The square of the curvature vectors of every triangle, which is quadratic in the positions
  /// because a fabric that bends does hardly stretch (Bergou et al. 2006, who square the Laplacian;
  /// the second derivatives in its place let weft and warp differ). Up to 12 particles each
  /// (findCurvatureStencils()). Exact on every mesh, with a wider pattern.
  kQuadratic,
};

struct BendingSettings {
  BendingModel model = BendingModel::kLinear;
  /// 1/m, of the sheet without forces, when the weft and when the warp is curved; positive towards
  /// the normal, weft x warp.
  Eigen::Vector2d rest_curvature = Eigen::Vector2d::Zero();
};

/// Bending forces of all hinges of a mesh. Their Jacobian does not depend on the positions, but for
/// the part of a rest curvature.
///
/// What hinges resist is fitted to the mesh: for every small displacement w with constant second
/// derivatives the energy per area is
///   (weft wuu^2 + warp wvv^2) / 2 + sqrt(weft warp) wuv^2,
/// a plate without transverse contraction. Across a free edge, where no moment can act, nothing is
/// resisted: the half of a cell along it that no hinge sees stays without curvature.
class Bending final : public Force {
 public:
  /// @param mesh without defects
  /// @throws std::invalid_argument if a rigidity is not finite and >= 0, or a rest curvature is not
  ///   finite
  Bending(const mesh::ClothMesh& mesh, const material::BendingRigidity& rigidity,
          const BendingSettings& settings = {});
  /// Of several fabrics, which are one piece: a moment goes on over the border between two. A
  /// hinge there resists with what it covers of both, bent alike; where the border lies across the
  /// bend, the stiffer one so acts up to half of a cell beyond it.
  /// @param rigidities of the fabrics that the triangles name
  Bending(const mesh::ClothMesh& mesh, const std::vector<material::BendingRigidity>& rigidities,
          const BendingSettings& settings = {});

  /// Makes it one on some particles of a larger mesh. Before bind().
  /// @param particles of that mesh, for every one of this, ascending
  void renumber(const std::vector<int>& particles);

  /// That of its hinges, which is kQuadratic where kLinear is not exact.
  BendingModel model() const { return model_; }
  const std::vector<Hinge>& hinges() const { return hinges_; }
  const std::vector<HingeCorner>& corners() const { return corners_; }
  /// Null if there is none.
  const RestCurvature* restCurvature() const { return rest_ ? &*rest_ : nullptr; }

  std::vector<std::array<int, 2>> pairs() const override { return pairs_; }
  void bind(const linear::SymmetricBlockMatrix& matrix) override;
  void addForces(const ForceState& state, std::vector<Eigen::Vector3d>& forces) const override;
  double energy(const ForceState& state) const override;
  void addJacobian(const ForceState& state, JacobianRows& rows) const override;
  /// K is without the part of a rest curvature (RestCurvature::assembleLinearised()).
  void assembleLinearised(const ForceState& state, const StageTimes& times,
                          linear::SymmetricBlockMatrix& matrix,
                          linear::BlockVector& rhs) const override;

  /// The sum over all hinges of stiffness weight_i weight_j, at rest in the plane: force on `row`
  /// stiffness (P_row - P_column), and the opposite on `column`.
  struct Coupling {
    int row;
    int column;        ///< < row
    int slot;          ///< of the block in the matrix, -1 before bind()
    double stiffness;  ///< N/m
  };
  const std::vector<Coupling>& couplings() const { return couplings_; }

 private:
  Bending(const mesh::ClothMesh& mesh, const std::vector<material::BendingRigidity>& rigidities,
          const PlateMap& plates, const BendingSettings& settings);
  void addFittedHinges(const BendingStencils& found, const std::vector<double>& stiffnesses);
  void addCurvatureHinges(const mesh::ClothMesh& mesh, const PlateMap& plates);
  void couple(const mesh::ClothMesh& mesh);

  BendingModel model_;
  std::vector<Hinge> hinges_;
  std::vector<HingeCorner> corners_;
  std::optional<RestCurvature> rest_;
  std::vector<Coupling> couplings_;
  std::vector<double> diagonal_;  // N/m, by particle
  std::vector<std::array<int, 2>> pairs_;
};

}  // namespace haptex::cloth
