// Forces on points of a cloth that depend linearly on where the point is.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "haptex/cloth/forces/element_assembly.h"
#include "haptex/cloth/forces/force.h"
#include "haptex/linear/block_matrix.h"

namespace haptex::cloth {

/// A force on a point of a triangle that depends on where the point is:
///   force(x) = force - stiffness (x - position),  x = sum_i weights[i] x_i over the corners.
/// World frame.
struct PointLoad {
  int triangle;               ///< of the mesh
  Eigen::Vector3d weights;    ///< barycentric, sum 1
  Eigen::Vector3d position;   ///< m
  Eigen::Vector3d force;      ///< N
  Eigen::Matrix3d stiffness;  ///< N/m, symmetric, positive semidefinite
};

/// The load with the part of its stiffness that is exactly symmetric and positive semidefinite.
/// @param index for the message
/// @throws std::invalid_argument as PointLoads::set(), but for their number
PointLoad checkedLoad(const PointLoad& load, std::size_t index, std::size_t triangle_count);

/// Loads that act until they are replaced; none at first. Their stiffness is in the matrix, so that
/// a stiff contact stays stable at every time step.
class PointLoads final : public Force {
 public:
  static constexpr std::size_t kMax = 4096;  ///< loads

  /// @param mesh without defects
  explicit PointLoads(const mesh::ClothMesh& mesh);

  /// Takes the part of each stiffness that is exactly symmetric and positive semidefinite, which
  /// the tolerances leave a little beside it. Allocates nothing.
  /// @throws std::invalid_argument naming the load if its triangle does not exist, a number is not
  ///   finite, the weights do not sum to 1 within 1e-6, the stiffness is not symmetric and positive
  ///   semidefinite to 1e-6 of its norm, or there are more than kMax; nothing has changed then
  void set(const std::vector<PointLoad>& loads);
  const std::vector<PointLoad>& loads() const { return loads_; }

  void bind(const linear::SymmetricBlockMatrix& matrix) override;
  void addForces(const ForceState& state, std::vector<Eigen::Vector3d>& forces) const override;
  /// Sum of -force . d + d . stiffness d / 2 with d = x - position.
  double energy(const ForceState& state) const override;
  void addJacobian(const ForceState& state, JacobianRows& rows) const override;
  /// For all corners i and j of their triangles:
  ///   matrix_ij += a^2 weights_i weights_j stiffness
  ///   rhs_i     += a weights_i (force - stiffness (x + ahead v - position)).
  void assembleLinearised(const ForceState& state, const StageTimes& times,
                          linear::SymmetricBlockMatrix& matrix,
                          linear::BlockVector& rhs) const override;

 private:
  std::vector<std::array<int, 3>> triangles_;
  std::vector<MembraneElement> elements_;  // on the triangles
  std::vector<PointLoad> loads_;           // has the capacity of kMax
};

}  // namespace haptex::cloth
