// What a strip of a sheet needs to be taken through steps of TR-BDF2 (Bank et al. 1985), but for
// the solution of its equations, which all strips have in common.
#pragma once

#include <vector>

#include "haptex/cloth/dynamics/stage.h"
#include "haptex/large/sheet.h"

namespace haptex::large {

/// The two stages of a step are those of cloth::Integrator: find (x, v) with
///   M (v - v*) = a F(x, v),  x = x* + a v.
/// What is held stays where it is. Allocates nothing after construction.
class Strip {
 public:
  /// At rest. @throws what clothOf() throws
  Strip(const Sheet& sheet, const Rows& rows);

  const cloth::Cloth& cloth() const { return cloth_; }
  /// At the end of the last step.
  const cloth::ClothState& state() const { return begin_; }
  linear::SymmetricBlockMatrix pattern() const { return cloth_.pattern(); }
  bool isHeld(int particle) const { return held_particles_[particle] != 0; }

  /// Begins the trapezoidal rule over the first part of a step of h seconds.
  /// Afterwards baseVelocities() lack the forces from beyond a cut.
  void beginTrapezoid(double h);
  /// Goes on from its result() with BDF-2 over the rest.
  void beginBdf2();
  /// Its result() is the end of the step.
  void endStep();

  double a() const { return stage_.a; }                             ///< s, of the stage
  cloth::Velocities& baseVelocities() { return base_.velocities; }  ///< m/s, v*
  const cloth::Velocities& baseVelocities() const { return base_.velocities; }
  /// Of the stage: at first where it is linearised, then as far as it is known.
  const cloth::ClothState& result() const { return result_; }
  cloth::ClothState& result() { return result_; }

  /// Takes the result to where earlier instants lead. @returns false if too few are known
  bool predict();
  /// The system of the stage that is linearised about its first result(). What is held is
  /// eliminated.
  void linearise(linear::SymmetricBlockMatrix& matrix, linear::BlockVector& rhs) const;
  /// Changes the result by the solution of that system.
  void takeLinearised(const linear::BlockVector& solution);
  /// What Newton iterations hold fixed is that of the result.
  void hold();
  /// The system of a Newton iteration from the result on, likewise.
  void assembleNewton(cloth::Hessian hessian, linear::SymmetricBlockMatrix& matrix,
                      linear::BlockVector& rhs) const;
  /// J, of all forces on the strip: their incremental potential.
  double potential(const cloth::ClothState& at) const;

 private:
  cloth::ForceState of(const cloth::Positions& positions,
                       const cloth::Velocities& velocities) const;
  void eliminate(linear::SymmetricBlockMatrix& matrix, linear::BlockVector& rhs) const;

  cloth::Cloth cloth_;
  cloth::RecentMotion motion_;
  cloth::ClothState begin_, base_, result_;
  cloth::StageStart stage_;
  const cloth::Positions* predicted_ = nullptr;  // m; null: too little is known
  double ahead_ = 0.0;                           // s, of a stage from where it is linearised
  double first_ = 0.0, second_ = 0.0;            // s, of both stages
  std::vector<char> held_particles_;             // nonzero: the particle stays
  linear::BlockVector unchanged_;                // m/s, of what is held: zero
  std::vector<Eigen::Vector3d> held_;            // by the forces
};

}  // namespace haptex::large
