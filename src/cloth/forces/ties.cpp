#include "haptex/cloth/forces/ties.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "haptex/base/require.h"

namespace haptex::cloth {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using mesh::ResolvedTie;
using mesh::TieShare;

Ties::Ties(const mesh::ClothMesh& mesh)
    : resolved_(mesh::resolveTies(mesh.ties, mesh.rest_coordinates.size())) {
  if (resolved_.empty()) return;
  triangles_ = mesh.triangles;
  tied_.assign(mesh.rest_coordinates.size(), 0);
  for (std::size_t t = 0; t < resolved_.size(); ++t) {
    tied_[resolved_[t].particle] = static_cast<int>(t) + 1;
  }
}

std::vector<TieShare> Ties::sharesOf(int particle) const {
  if (!isTied(particle)) return {{particle, 1.0}};
  return resolved_[tied_[particle] - 1].shares;
}

std::vector<std::array<int, 2>> Ties::pairs(const std::vector<std::array<int, 2>>& pairs) const {
  std::set<std::array<int, 2>> found;
  const auto couple = [&](int i, int j) {
    if (!isTied(i) && !isTied(j)) return;
    for (const TieShare& a : sharesOf(i)) {
      for (const TieShare& b : sharesOf(j)) {
        if (a.particle != b.particle)
          found.insert({std::min(a.particle, b.particle), std::max(a.particle, b.particle)});
      }
    }
  };
  for (const ResolvedTie& tie : resolved_) couple(tie.particle, tie.particle);
  for (const auto& [a, b, c] : triangles_) {
    couple(a, b);
    couple(b, c);
    couple(c, a);
  }
  for (const auto& [a, b] : pairs) couple(a, b);
  return {found.begin(), found.end()};
}

void Ties::bind(const linear::SymmetricBlockMatrix& matrix) {
  moves_.clear();
  emptied_.clear();
  if (empty()) return;
  for (int row = 0; row < matrix.size(); ++row) {
    for (int slot = matrix.rowBegin(row); slot < matrix.rowBegin(row + 1); ++slot) {
      if (isTied(row) || isTied(matrix.column(slot))) {
        moveBlock(matrix, row, matrix.column(slot), slot);
      }
    }
  }
  for (const ResolvedTie& tie : resolved_) {
    for (const TieShare& a : tie.shares) {
      for (const TieShare& b : tie.shares) {
        const double weight = a.weight * b.weight;
        if (a.particle == b.particle) {
          moves_.push_back({tie.particle, a.particle, weight, true, Move::To::kDiagonal});
        } else if (a.particle > b.particle) {
          moves_.push_back(
              {tie.particle, matrix.slot(a.particle, b.particle), weight, true, Move::To::kLower});
        }
      }
    }
  }
}

void Ties::moveBlock(const linear::SymmetricBlockMatrix& matrix, int row, int column, int slot) {
  emptied_.push_back(slot);
  for (const TieShare& a : sharesOf(row)) {
    for (const TieShare& b : sharesOf(column)) {
      const double weight = a.weight * b.weight;
      if (a.particle == b.particle) {
        moves_.push_back({slot, a.particle, weight, false, Move::To::kDiagonalTwice});
      } else if (a.particle > b.particle) {
        moves_.push_back(
            {slot, matrix.slot(a.particle, b.particle), weight, false, Move::To::kLower});
      } else {
        moves_.push_back(
            {slot, matrix.slot(b.particle, a.particle), weight, false, Move::To::kLowerTransposed});
      }
    }
  }
}

void Ties::gather(std::vector<Vector3d>& forces) const {
  for (const ResolvedTie& tie : resolved_) {
    for (const TieShare& share : tie.shares) {
      forces[share.particle] += share.weight * forces[tie.particle];
    }
    forces[tie.particle].setZero();
  }
}

void Ties::gather(std::vector<double>& masses) const {
  for (const ResolvedTie& tie : resolved_) {
    for (const TieShare& share : tie.shares) {
      masses[share.particle] += share.weight * masses[tie.particle];
    }
    masses[tie.particle] = 0.0;
  }
}

void Ties::gather(linear::SymmetricBlockMatrix& matrix, linear::BlockVector& rhs) const {
  for (const Move& move : moves_) {
    const Matrix3d block =
        move.weight * (move.from_diagonal ? matrix.diagonal(move.from) : matrix.lower(move.from));
    switch (move.kind) {
      case Move::To::kLower:
        matrix.lower(move.to) += block;
        break;
      case Move::To::kLowerTransposed:
        matrix.lower(move.to) += block.transpose();
        break;
      case Move::To::kDiagonal:
        matrix.diagonal(move.to) += block;
        break;
      case Move::To::kDiagonalTwice:  // the block and the transposed one above the diagonal
        matrix.diagonal(move.to) += block + block.transpose();
        break;
    }
  }
  for (const int slot : emptied_) matrix.lower(slot).setZero();
  for (const ResolvedTie& tie : resolved_) {
    for (const TieShare& share : tie.shares) {
      rhs.col(share.particle) += share.weight * rhs.col(tie.particle);
    }
    rhs.col(tie.particle).setZero();
    matrix.diagonal(tie.particle).setIdentity();
  }
}

std::vector<int> Ties::rowsBehind(const JacobianRows& rows) const {
  std::set<int> behind;
  for (int i = 0; i < static_cast<int>(tied_.size()); ++i) {
    for (const TieShare& share : sharesOf(i)) {
      if (rows.asksFor(share.particle)) behind.insert(i);
    }
  }
  return {behind.begin(), behind.end()};
}

void Ties::gather(const std::vector<JacobianBlock>& from, JacobianRows& to) const {
  for (const JacobianBlock& block : from) {
    for (const TieShare& a : sharesOf(block.row)) {
      for (const TieShare& b : sharesOf(block.column)) {
        const double weight = a.weight * b.weight;
        to.add(a.particle, b.particle, weight * block.by_position, weight * block.by_velocity);
      }
    }
  }
}

void Ties::closeFrom(const std::vector<Vector3d>& positions, double time, double speed) {
  if (!std::isfinite(speed) || speed <= 0.0) {
    base::refuse("the speed of closing seams is ", speed,
                 " m/s; it must be finite and greater than 0");
  }
  std::vector<Gap> gaps(resolved_.size());
  for (std::size_t t = 0; t < gaps.size(); ++t) {
    gaps[t].start = positions[resolved_[t].particle] - mean(t, positions);
    gaps[t].duration = gaps[t].start.norm() / speed;
    if (std::isfinite(gaps[t].duration)) continue;
    base::refuse("the gap of the tied particle ", resolved_[t].particle, " is not finite");
  }
  gaps_ = std::move(gaps);
  closing_since_ = time;
}

Vector3d Ties::gap(std::size_t tie, double time) const {
  if (gaps_.empty()) return Vector3d::Zero();
  const Gap& gap = gaps_[tie];
  const double left = closing_since_ + gap.duration - time;
  if (left <= 0.0) return Vector3d::Zero();
  return std::min(1.0, left / gap.duration) * gap.start;
}

double Ties::gapAt(double time) const {
  double largest = 0.0;
  for (std::size_t t = 0; t < gaps_.size(); ++t) largest = std::max(largest, gap(t, time).norm());
  return largest;
}

Vector3d Ties::mean(std::size_t tie, const std::vector<Vector3d>& vectors) const {
  Vector3d sum = Vector3d::Zero();
  for (const TieShare& share : resolved_[tie].shares) sum += share.weight * vectors[share.particle];
  return sum;
}

void Ties::place(double time, std::vector<Vector3d>& positions) const {
  for (std::size_t t = 0; t < resolved_.size(); ++t) {
    positions[resolved_[t].particle] = mean(t, positions) + gap(t, time);
  }
}

void Ties::carry(double time, std::vector<Vector3d>& velocities) const {
  for (std::size_t t = 0; t < resolved_.size(); ++t) {
    Vector3d& velocity = velocities[resolved_[t].particle];
    velocity = mean(t, velocities);
    if (gaps_.empty()) continue;
    const double left = closing_since_ + gaps_[t].duration - time;
    if (left > 0.0 && time >= closing_since_) velocity -= gaps_[t].start / gaps_[t].duration;
  }
}

}  // namespace haptex::cloth
