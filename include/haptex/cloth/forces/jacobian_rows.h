// Rows of the Jacobian of the forces on a cloth, for those who ask for some particles.
#pragma once

#include <Eigen/Core>
#include <map>
#include <vector>

namespace haptex::cloth {

/// One block of the exact Jacobians of the internal forces.
struct JacobianBlock {
  int row;                      ///< particle whose force is differentiated
  int column;                   ///< particle by whose position or velocity
  Eigen::Matrix3d by_position;  ///< N/m
  Eigen::Matrix3d by_velocity;  ///< N.s/m
};

/// Adds up the blocks of some rows; those of other rows are left out.
class JacobianRows {
 public:
  /// @param particles whose rows are asked for; may repeat
  explicit JacobianRows(const std::vector<int>& particles);

  bool asksFor(int row) const { return places_.count(row) > 0; }
  /// Does nothing if the row is not asked for.
  void add(int row, int column, const Eigen::Matrix3d& by_position,
           const Eigen::Matrix3d& by_velocity = Eigen::Matrix3d::Zero());

  /// Sorted by row in the order asked for, then by column.
  std::vector<JacobianBlock> blocks() const;

 private:
  std::map<int, std::vector<std::size_t>> places_;  // of a row, in rows_
  std::vector<std::map<int, JacobianBlock>> rows_;  // by column
};

}  // namespace haptex::cloth
