#include "haptex/cloth/forces/jacobian_rows.h"

namespace haptex::cloth {

using Eigen::Matrix3d;

JacobianRows::JacobianRows(const std::vector<int>& particles) : rows_(particles.size()) {
  for (std::size_t r = 0; r < particles.size(); ++r) places_[particles[r]].push_back(r);
}

void JacobianRows::add(int row, int column, const Matrix3d& by_position,
                       const Matrix3d& by_velocity) {
  const auto asked = places_.find(row);
  if (asked == places_.end()) return;
  for (const std::size_t r : asked->second) {
    const JacobianBlock empty{row, column, Matrix3d::Zero(), Matrix3d::Zero()};
    JacobianBlock& block = rows_[r].emplace(column, empty).first->second;
    block.by_position += by_position;
    block.by_velocity += by_velocity;
  }
}

std::vector<JacobianBlock> JacobianRows::blocks() const {
  std::vector<JacobianBlock> blocks;
  for (const auto& row : rows_) {
    for (const auto& entry : row) blocks.push_back(entry.second);
  }
  return blocks;
}

}  // namespace haptex::cloth
