// Friction in a fabric that is bent: the hysteresis of its bending moment.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "haptex/cloth/forces/bending/normal_hinges.h"
#include "haptex/cloth/forces/bending/rest_curvature.h"
#include "haptex/cloth/forces/force.h"
#include "haptex/linear/block_matrix.h"
#include "haptex/material/fabric.h"

namespace haptex::cloth {

/// Beside the elastic hinges, elements of Prandtl: a spring and a sliding block in series. At the
/// bend y of a hinge (NormalHinges) with the plastic part p the friction is
///   c = spring (y - p), from -yield to yield,
/// and after every accepted step p, which is the memory of the force, follows so that the spring
/// alone gives c (remember()). So moment
/// against curvature is a loop of the width 2 yield, KES value 2HB, around the elastic line.
///
/// A hinge of the stiffness k that resists s = (suu, svv, suv) has yield = k |s . (kw, kp, 0)| with
/// the curvatures kw, kp at which the elastic moment is half of 2HB: as all hinges together deliver
/// the rigidity of weft and warp, they deliver half of 2HB. A cylinder whose axis is at the angle t
/// to the warp meets the moment (cos^2 t 2HB weft + sin^2 t 2HB warp) / 2, and twist meets none:
/// KES measures neither.
class BendingFriction final : public Force {
 public:
  /// 1/m: bent by this much along weft or warp from a state without friction, the springs yield. A
  /// hundredth of the largest curvature of KES.
  static constexpr double kYieldCurvature = 2.5;

  /// @param hinges     of Bending with the rigidity, @param corners of the hinges
  /// @param hysteresis not both 0
  /// @throws std::invalid_argument if a hysteresis is not finite and >= 0, or is > 0 where the
  ///   rigidity is 0
  BendingFriction(const mesh::ClothMesh& mesh, const std::vector<Hinge>& hinges,
                  const std::vector<HingeCorner>& corners,
                  const material::BendingRigidity& rigidity,
                  const material::BendingHysteresis& hysteresis);

  /// As Bending::renumber().
  void renumber(const std::vector<int>& particles) { hinges_.renumber(particles); }

  void bind(const linear::SymmetricBlockMatrix& matrix) override;

  /// The plastic bend of every hinge with friction, m.
  std::size_t memorySize() const override { return elements_.size(); }
  std::vector<std::vector<int>> memoryOwners() const override;
  /// To those with which there is no friction at these positions.
  void forget(const Positions& positions, double* plastic) const override;
  /// Lets the plastic bends follow what exceeds the yield. Takes the energy
  /// yield (|spring (y - p)| - yield) / spring out of every hinge that does.
  void remember(const Positions& positions, double* plastic) const override;

  /// That of the springs, and where they yield, of that and what remember() will take out. After
  /// remember() it is what the springs hold.
  double energy(const ForceState& state) const override;
  void addForces(const ForceState& state, std::vector<Eigen::Vector3d>& forces) const override;
  void addJacobian(const ForceState& state, JacobianRows& rows) const override;

  /// Linearised about x + ahead v,
  ///   matrix += a^2 secant g g^T,  rhs += a F(x + ahead v),  secant = c / (y - p) > 0,
  /// g the bend's gradient without the turning of the normal: the parabola that touches the energy
  /// there lies above it everywhere, so the solve does not overshoot where friction changes sign.
  void assembleLinearised(const ForceState& state, const StageTimes& times,
                          linear::SymmetricBlockMatrix& matrix,
                          linear::BlockVector& rhs) const override;
  /// The same at the positions: the exact Hessian has the tangent, 0 where the friction yields, in
  /// place of the secant; the turning of the normal is left out of both, so that both are
  /// semidefinite.
  void assembleNewton(const ForceState& state, const Eigen::Vector3d* held, double a,
                      Hessian hessian, linear::SymmetricBlockMatrix& matrix,
                      linear::BlockVector& rhs) const override;

 private:
  struct Element {
    double spring;  // N/m
    double yield;   // N
  };
  struct Friction {
    double force;    // c, N
    double tangent;  // N/m
    double secant;   // N/m
  };
  static Friction frictionOf(const Element& element, double stretch);
  void addLinearised(std::size_t hinge, const NormalHinges::Frame& at, double force,
                     double stiffness, double a, linear::SymmetricBlockMatrix& matrix,
                     linear::BlockVector& rhs) const;

  NormalHinges hinges_;
  std::vector<Element> elements_;  // by hinge
  std::vector<int> first_slot_;    // by hinge, in slots_
  std::vector<int> slots_;         // of the pairs of its corners; -1 where one has no weight
};

}  // namespace haptex::cloth
