// Aerodynamic drag and lift on the triangles of a cloth, in air at rest or in wind.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "haptex/cloth/forces/membrane.h"
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

/// What Newton iterations of a stage hold fixed of a triangle's air.
struct AirPanel {
  Eigen::Vector3d area;  ///< normal times area, m^2
  Eigen::Vector3d lift;  ///< N
};

/// Of all triangles.
struct FixedAir {
  Eigen::Vector3d wind = Eigen::Vector3d::Zero();  ///< m/s
  std::vector<AirPanel> panels;
};

/// The force of the air on a triangle with the unit normal n and the area A that it has now, and
/// the velocity w = m n + q t relative to the air, the mean of its corners', with t in its plane:
///   F = -rho A / 2 { (normal |m| m + lift m q^2 / s) n + (tangential q^2 - lift m^2 q / s) t },
/// s = |w|. A third of it acts on each corner. The lift stands on w, so in air at rest all forces
/// together take
///   rho A / 2 (normal |m|^3 + tangential q^3) >= 0
/// of power from the cloth. They depend on the velocity relative to the air alone: wind on a
/// resting cloth is the same as a cloth that moves through still air.
class Aerodynamics {
 public:
  /// @throws std::invalid_argument naming the coefficient or gust if a number is not finite, or a
  ///   coefficient or frequency is negative
  explicit Aerodynamics(const Air& air);

  const Wind& wind() const { return air_.wind; }

  /// Adds the forces (N) on the particles.
  void addForces(const std::vector<MembraneElement>& elements, const Positions& positions,
                 const Velocities& velocities, double time,
                 std::vector<Eigen::Vector3d>& forces) const;

  /// Power (W) that the wind feeds into the cloth: its velocity times the force of the air. What
  /// the air does at all is less by what it takes from any motion relative to it.
  double windPower(const std::vector<MembraneElement>& elements, const Positions& positions,
                   const Velocities& velocities, double time) const;

  /// Adds what the air contributes to a linearised stage (Stage),
  ///   matrix += -a D,  rhs += a F.
  /// The places, so normals and areas, are those that the velocities lead to in times.ahead; what
  /// depends on them is not stiff, and not in the matrix. D is projected to be symmetric and
  /// negative semidefinite; without lift it is so by itself.
  void addStep(const std::vector<MembraneElement>& elements, const Positions& positions,
               const Velocities& velocities, const StageTimes& times,
               linear::SymmetricBlockMatrix& matrix, linear::BlockVector& rhs) const;

  /// Normals, areas and lifts of a state, and the wind at the time.
  /// @param fixed its panels have the size of the elements
  void fix(const std::vector<MembraneElement>& elements, const Positions& positions,
           const Velocities& velocities, double time, FixedAir& fixed) const;

  /// Adds what the air contributes to a Newton iteration (Cloth::addNewton): the drag on fixed
  /// normals and areas, whose potential is convex, and the fixed lift.
  void addNewton(const std::vector<MembraneElement>& elements, const Velocities& velocities,
                 const FixedAir& fixed, double a, linear::SymmetricBlockMatrix& matrix,
                 linear::BlockVector& rhs) const;
  /// The potential of addNewton() (J):
  ///   a sum of rho A / 6 (normal |m|^3 + tangential q^3) - lift . mean velocity.
  double incrementalPotential(const std::vector<MembraneElement>& elements,
                              const Velocities& velocities, const FixedAir& fixed, double a) const;

  /// The exact Jacobians of the force on any one corner of an element: dF/dP_j (N/m) by its
  /// corners, and dF/dv (N.s/m), alike for all three. Not symmetric.
  struct Jacobian {
    std::array<Eigen::Matrix3d, 3> by_position;
    Eigen::Matrix3d by_velocity;
  };
  Jacobian exactJacobian(const MembraneElement& element, const Positions& positions,
                         const Velocities& velocities, double time) const;

 private:
  Air air_;
};

}  // namespace haptex::cloth
