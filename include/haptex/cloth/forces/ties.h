// Particles that are sewn to others, taken out of the equations of motion.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "haptex/cloth/forces/jacobian_rows.h"
#include "haptex/linear/block_matrix.h"
#include "haptex/mesh/ties.h"

namespace haptex::cloth {

/// With the places q of the free particles those of all are x = T q + g. A row of T is that of the
/// identity, or has the shares of a tied particle (mesh::ResolvedTie). The gaps g are zero, but for
/// seams that are being closed (closeFrom()). The virtual work of all forces is that of T^T F, and
///   T^T A T dq = T^T b
/// is what is left of a linear system A dx = b: symmetric, and positive definite if A is so for the
/// free particles. Its pattern is found once; tied particles keep empty rows. Their masses go to
/// the free particles by the same shares, so that sum, centre and momentum stay what they are and
/// the mass matrix stays diagonal.
///
/// Without ties nothing is done.
class Ties {
 public:
  Ties() = default;
  /// @throws std::invalid_argument as mesh::resolveTies()
  explicit Ties(const mesh::ClothMesh& mesh);

  bool empty() const { return resolved_.empty(); }
  const std::vector<mesh::ResolvedTie>& resolved() const { return resolved_; }
  bool isTied(int particle) const { return !tied_.empty() && tied_[particle] != 0; }

  // Forces and the matrix. Nothing of the sizes is checked.

  /// Pairs of particles that the matrix couples beside those of triangles and forces.
  /// @param pairs of the forces
  std::vector<std::array<int, 2>> pairs(const std::vector<std::array<int, 2>>& pairs) const;
  /// Looks up what goes where in a matrix with these pairs.
  /// @throws std::out_of_range if the pattern lacks a block
  void bind(const linear::SymmetricBlockMatrix& matrix);

  /// F becomes T^T F: what tied particles have goes to the free ones.
  void gather(std::vector<Eigen::Vector3d>& forces) const;
  void gather(std::vector<double>& masses) const;
  /// Likewise of a system; rows of tied particles become those of the identity with the right-hand
  /// side zero. After bind(), without couplings beyond the pattern.
  void gather(linear::SymmetricBlockMatrix& matrix, linear::BlockVector& rhs) const;
  /// The particles whose rows of the Jacobian have a part in those that are asked for.
  std::vector<int> rowsBehind(const JacobianRows& rows) const;
  /// @param from of rowsBehind() @param to those asked for; tied ones have empty rows
  void gather(const std::vector<JacobianBlock>& from, JacobianRows& to) const;

  // Places and velocities.

  /// From now on gaps are those of the positions, and close at a speed.
  /// @param time s, simulated @param speed m/s, finite and > 0
  /// @throws std::invalid_argument if the speed is not allowed or a gap is not finite
  void closeFrom(const std::vector<Eigen::Vector3d>& positions, double time, double speed);
  /// Of the largest gap at a time (m).
  double gapAt(double time) const;
  /// Of a tied particle (m). @param tie in resolved()
  Eigen::Vector3d gap(std::size_t tie, double time) const;

  /// x_s = sum of w x_m + gap, or v_s likewise with the rate of the gap.
  void place(double time, std::vector<Eigen::Vector3d>& positions) const;
  void carry(double time, std::vector<Eigen::Vector3d>& velocities) const;
  /// sum of w x_m
  Eigen::Vector3d mean(std::size_t tie, const std::vector<Eigen::Vector3d>& vectors) const;

 private:
  /// Of one block of the full matrix that a tied particle has: where a share of it goes.
  struct Move {
    enum class To : char { kLower, kLowerTransposed, kDiagonal, kDiagonalTwice };
    int from;  ///< slot, or row if from_diagonal
    int to;    ///< slot or row
    double weight;
    bool from_diagonal;
    To kind;
  };
  struct Gap {
    Eigen::Vector3d start = Eigen::Vector3d::Zero();  // m
    double duration = 0.0;                            // s, until it is closed
  };
  void moveBlock(const linear::SymmetricBlockMatrix& matrix, int row, int column, int slot);
  std::vector<mesh::TieShare> sharesOf(int particle) const;

  std::vector<mesh::ResolvedTie> resolved_;
  std::vector<int> tied_;  // by particle, 1 + place in resolved_; 0: free. Empty: no ties
  std::vector<std::array<int, 3>> triangles_;
  std::vector<Move> moves_;
  std::vector<int> emptied_;    // slots
  std::vector<Gap> gaps_;       // by tie; empty: all are closed
  double closing_since_ = 0.0;  // s
};

}  // namespace haptex::cloth
