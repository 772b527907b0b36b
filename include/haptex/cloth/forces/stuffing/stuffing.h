// Pressure of what a closed cloth is stuffed with.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "haptex/cloth/forces/force.h"
#include "haptex/mesh/mesh.h"

namespace haptex::cloth {

/// A mass of fibres, whose pressure follows its volume V by van Wyk's law (Note on the
/// compressibility of wool, J. Textile Inst. 37, 1946): fibres bend between their contacts, which
/// become more as the cube of their density,
///   p(V) = modulus ((volume / V)^3 - 1), 0 from its own volume on.
/// It is alike everywhere within, and shear of the fibres is left out.
struct StuffingMass {
  double volume = 0.0;   ///< m^3, without pressure, > 0
  double modulus = 0.0;  ///< Pa, > 0
};

/// At one volume.
struct StuffingPressure {
  double energy;    ///< J, zero without pressure
  double pressure;  ///< Pa, its negative derivative by the volume, >= 0
  double slope;     ///< Pa/m^3, the negative derivative of the pressure, >= 0
};

/// Below kLeastVolume of the own volume, which no cloth gets near, the pressure goes on with the
/// slope that it has there, so that trial states of a step have a finite energy.
/// @param volume m^3
StuffingPressure pressureOf(const StuffingMass& mass, double volume);
constexpr double kLeastVolume = 0.02;

/// m^3, within a closed surface whose triangles run counter-clockwise as seen from outside.
double enclosedVolume(const std::vector<std::array<int, 3>>& triangles, const Positions& positions);

/// The energy of pressureOf() at the volume that the cloth encloses. Forces are pressure times the
/// derivative of the volume, a third of the area vectors of the triangles around each particle;
/// they sum up to zero and turn nothing. Their derivative has two parts: slope times the outer
/// product of the volume's derivative with itself, which couples every particle with every other
/// (SymmetricBlockMatrix::setOuterProduct()), and the turning of areas, which is indefinite: exact
/// Hessians have it, projected ones are without.
class Stuffing final : public Force {
 public:
  /// Share of the own volume that the initial positions must enclose.
  static constexpr double kLeastStart = 0.1;

  /// @param mesh sound
  /// @throws std::invalid_argument if a number is not finite and > 0, the mesh is not one closed
  ///   surface whose triangles all run the same way round, or it encloses less than kLeastStart of
  ///   the own volume at the start
  Stuffing(const mesh::ClothMesh& mesh, const StuffingMass& mass);

  void bind(const linear::SymmetricBlockMatrix& matrix) override;
  void addForces(const ForceState& state, std::vector<Eigen::Vector3d>& forces) const override;
  double energy(const ForceState& state) const override;
  void addJacobian(const ForceState& state, JacobianRows& rows) const override;
  void assembleLinearised(const ForceState& state, const StageTimes& times,
                          linear::SymmetricBlockMatrix& matrix,
                          linear::BlockVector& rhs) const override;
  void assembleNewton(const ForceState& state, const Eigen::Vector3d* held, double a,
                      Hessian hessian, linear::SymmetricBlockMatrix& matrix,
                      linear::BlockVector& rhs) const override;

  StuffingPressure pressure(const Positions& positions) const;

 private:
  /// Of two triangles: (ends[0], ends[1], opposite[0]) and (ends[1], ends[0], opposite[1]), the
  /// ends ascending.
  struct InnerEdge {
    std::array<int, 2> ends, opposite;
    int slot;  // of the matrix block (ends[1], ends[0])
  };

  void findEdges();
  void requireOnePiece(std::size_t particles) const;
  const linear::BlockVector& derivative(const Positions& positions) const;
  static Eigen::Matrix3d turning(const InnerEdge& edge, const Positions& positions);

  StuffingMass mass_;
  std::vector<std::array<int, 3>> triangles_;
  std::vector<InnerEdge> edges_;
  mutable linear::BlockVector derivative_;  // m^2, of the volume by the places
};

}  // namespace haptex::cloth
