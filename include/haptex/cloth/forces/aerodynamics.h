// Aerodynamic drag and lift on the triangles of a cloth, in air at rest or in wind.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "haptex/cloth/forces/element_assembly.h"
#include "haptex/cloth/forces/force.h"
#include "haptex/linear/block_matrix.h"

namespace haptex::cloth {

constexpr double kAirDensity = 1.2;  ///< kg/m^3, near 20 degrees and sea level

/// A part of the wind that comes and goes.
struct Gust {
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< m/s, amplitude
  double frequency = 0.0;                              ///< Hz, >= 0
  double phase = 0.0;                                  ///< rad
};

/// The velocity of the air, alike everywhere.
struct Wind {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();  ///< m/s
  std::vector<Gust> gusts;

  /// mean + sum of velocity sin(2 pi frequency time + phase), m/s: smooth, and the same in every
  /// run. @param time s, simulated
  Eigen::Vector3d velocity(double time) const;
  /// Whether it is the same at all times.
  bool isSteady() const;
};

/// Coefficients without a unit; what they multiply: Aerodynamics.
struct AirCoefficients {
  double normal = 1.17;      ///< square plate across the wind (Hoerner 1965, Fluid-Dynamic Drag)
  double tangential = 0.02;  ///< laminar boundary layers on both sides, 0.2 m at 1 m/s (Blasius)
  double lift = 1.57;        ///< slope pi/2 by angle of a square wing (Jones 1946, NACA Report 835)
};

struct Air {
  AirCoefficients coefficients;
  Wind wind;
};

/// The force of the air on a triangle with the unit normal n and the area A that it has now, and
/// the velocity w = m n + q t relative to the air, the mean of its corners', with t in its plane:
///   F = -rho A / 2 { (normal |m| m + lift m q^2 / s) n + (tangential q^2 - lift m^2 q / s) t },
/// s = |w|. A third of it acts on each corner. The lift stands on w, so in air at rest all forces
/// together take
///   rho A / 2 (normal |m|^3 + tangential q^3) >= 0
/// of power from the cloth. They depend on the velocity relative to the air alone: wind on a
/// resting cloth is the same as a cloth that moves through still air.
///
/// Newton iterations hold the wind, normals, areas and lifts: what is left is the drag on them,
/// whose potential is convex,
///   a sum of rho A / 6 (normal |m|^3 + tangential q^3) - lift . mean velocity.
class Aerodynamics final : public Force {
 public:
  /// @param elements of restElements()
  /// @throws std::invalid_argument naming the coefficient or gust if a number is not finite, or a
  ///   coefficient or frequency is negative
  Aerodynamics(std::vector<MembraneElement> elements, const Air& air);

  void bind(const linear::SymmetricBlockMatrix& matrix) override;
  void addForces(const ForceState& state, std::vector<Eigen::Vector3d>& forces) const override;
  /// The air holds none.
  double energy(const ForceState& /*state*/) const override { return 0.0; }
  void addJacobian(const ForceState& state, JacobianRows& rows) const override;

  bool isDriven() const override { return true; }
  bool changesWithTime() const override { return !air_.wind.isSteady(); }
  /// Of the wind: its velocity times the force of the air. What the air does at all is less by what
  /// it takes from any motion relative to it.
  double drivingPower(const ForceState& state) const override;

  /// The places, so normals and areas, are those that the velocities lead to in times.ahead; what
  /// depends on them is not stiff, and not in the matrix. D is projected to be symmetric and
  /// negative semidefinite; without lift it is so by itself.
  void assembleLinearised(const ForceState& state, const StageTimes& times,
                          linear::SymmetricBlockMatrix& matrix,
                          linear::BlockVector& rhs) const override;

  /// The wind, and the area vector (m^2) and the lift (N) of every element. A lift that is held for
  /// long does work, which the true one in still air does not: a passive start has none.
  std::size_t heldSize() const override { return 1 + 2 * elements_.size(); }
  void hold(const NewtonStart& start, Eigen::Vector3d* held) const override;
  void assembleNewton(const ForceState& state, const Eigen::Vector3d* held, double a,
                      Hessian hessian, linear::SymmetricBlockMatrix& matrix,
                      linear::BlockVector& rhs) const override;
  double incrementalPotential(const ForceState& state, const Eigen::Vector3d* held,
                              double a) const override;

  /// The exact Jacobians of the force on any one corner of an element: dF/dP_j (N/m) by its
  /// corners, and dF/dv (N.s/m), alike for all three. Not symmetric.
  struct Jacobian {
    std::array<Eigen::Matrix3d, 3> by_position;
    Eigen::Matrix3d by_velocity;
  };
  Jacobian exactJacobian(const MembraneElement& element, const Positions& positions,
                         const Velocities& velocities, double time) const;

 private:
  std::vector<MembraneElement> elements_;
  Air air_;
};

}  // namespace haptex::cloth
