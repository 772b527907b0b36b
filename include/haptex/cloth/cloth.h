// The mechanical model of a piece of cloth: mesh, fabric, what is modelled, attachments and loads.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "haptex/cloth/bending.h"
#include "haptex/cloth/block_matrix.h"
#include "haptex/cloth/membrane.h"
#include "haptex/cloth/mesh.h"
#include "haptex/cloth/point_load.h"
#include "haptex/material/fabric.h"

namespace haptex::cloth {

/// What changes from step to step. World frame, SI units.
struct ClothState {
  std::vector<Eigen::Vector3d> positions;   ///< m
  std::vector<Eigen::Vector3d> velocities;  ///< m/s
  double time = 0.0;                        ///< s
};

/// What is modelled besides elasticity and inertia. What is not asked for is not computed.
struct ModelledEffects {
  bool viscosity = false;
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();  ///< m/s^2
  bool bending = false;                               ///< by the fabric's rigidity
};

/// The place of an attached particle: it rests at `start` until `start_time`, then follows a
/// straight minimum-jerk path (Flash and Hogan 1985) by `displacement` over `duration`, and rests
/// at its end.
struct AttachmentPath {
  Eigen::Vector3d start = Eigen::Vector3d::Zero();         ///< m
  Eigen::Vector3d displacement = Eigen::Vector3d::Zero();  ///< m
  double start_time = 0.0;                                 ///< s, simulated
  double duration = 0.0;                                   ///< s, 0: at once

  Eigen::Vector3d position(double time) const;
  /// m/s; zero in the moment of a jump, where `duration` is 0.
  Eigen::Vector3d velocity(double time) const;
};

/// One block of the exact Jacobians of the internal forces.
struct JacobianBlock {
  int row;                      ///< particle whose force is differentiated
  int column;                   ///< particle by whose position or velocity
  Eigen::Matrix3d by_position;  ///< N/m
  Eigen::Matrix3d by_velocity;  ///< N.s/m
};

class Cloth {
 public:
  static constexpr std::size_t kMostPointLoads = 4096;

  /// @throws std::invalid_argument if the mesh has defects, the density is not finite and > 0,
  ///   gravity is not finite, or bending is modelled and the fabric has none
  Cloth(ClothMesh mesh, material::Fabric fabric, const ModelledEffects& effects);

  const ClothMesh& mesh() const { return mesh_; }
  const material::Fabric& fabric() const { return fabric_; }
  const ModelledEffects& effects() const { return effects_; }
  std::size_t particleCount() const { return masses_.size(); }
  /// Lumped particle masses (kg): a third of each adjacent triangle.
  const std::vector<double>& masses() const { return masses_; }
  const Membrane& membrane() const { return membrane_; }
  /// Null if bending is not modelled.
  const Bending* bending() const { return bending_ ? &*bending_ : nullptr; }
  /// A matrix with the pattern that membrane and bending are bound to.
  SymmetricBlockMatrix pattern() const;

  /// The state at rest in the initial positions at time 0.
  ClothState initialState() const;

  /// Changes the fabric from the next step on: masses and curves, not positions or velocities.
  /// With bending another rigidity may change pattern(): make a new integrator.
  /// @throws std::invalid_argument if the density is not finite and > 0, or bending is modelled and
  ///   the fabric has none; nothing has changed then
  void setFabric(material::Fabric fabric);

  /// User-defined external force (N) on a particle, until set again; zero at first.
  /// @throws std::invalid_argument if the particle does not exist or the force is not finite
  void setExternalForce(int particle, const Eigen::Vector3d& force);
  const std::vector<Eigen::Vector3d>& externalForces() const { return external_forces_; }

  /// Replaces the point loads, which act until replaced; none at first. The step treats their
  /// stiffness implicitly, so that a stiff contact stays stable at every time step. Allocates
  /// nothing. On attached particles they act as any force: not.
  /// @throws std::invalid_argument naming the load if its triangle does not exist, a number is not
  ///   finite, the weights do not sum to 1 within 1e-6, the stiffness is not symmetric and positive
  ///   semidefinite to 1e-6 of its norm, or there are more than kMostPointLoads; nothing has
  ///   changed then
  void setPointLoads(const std::vector<PointLoad>& loads);
  /// As set, their stiffness made exactly symmetric and positive semidefinite.
  const std::vector<PointLoad>& pointLoads() const { return point_loads_; }

  /// Attaches a particle to a place, or gives an attached one a new path.
  /// @throws std::invalid_argument if the particle does not exist, a number is not finite, or the
  ///   duration is negative
  void attach(int particle, const AttachmentPath& path);
  /// @throws std::invalid_argument if the particle does not exist or is not attached
  void release(int particle);
  void releaseAll();
  bool isAttached(int particle) const;
  /// Empty where the particle is free.
  const std::vector<std::optional<AttachmentPath>>& attachments() const { return attachments_; }

  // The functions below throw std::invalid_argument if the state's size is not the cloth's.

  /// Internal and external forces (N) on every particle: membrane, gravity, user-defined and point
  /// loads, not the reaction of an attachment. At rest the reaction at an attached particle is the
  /// negative.
  /// @param forces resized to particleCount()
  void computeForces(const ClothState& state, std::vector<Eigen::Vector3d>& forces) const;

  /// Elastic energy, gravity's and the user-defined forces' relative to the world origin, and the
  /// point loads' relative to their positions (J).
  double potentialEnergy(const ClothState& state) const;
  double kineticEnergy(const ClothState& state) const;

  /// All blocks of the exact (not projected) Jacobian in the rows of the given particles,
  /// sorted by row in the order given, then by column.
  /// @throws std::invalid_argument if a particle does not exist
  std::vector<JacobianBlock> jacobian(const ClothState& state,
                                      const std::vector<int>& particles) const;

 private:
  void bindBending();
  void requireParticle(int particle) const;
  void requireState(const ClothState& state) const;
  using JacobianRow = std::map<int, JacobianBlock>;  // by column
  void addBendingJacobian(const std::map<int, std::vector<std::size_t>>& rows_of_particle,
                          std::vector<JacobianRow>& rows) const;
  void addPointLoadJacobian(const std::map<int, std::vector<std::size_t>>& rows_of_particle,
                            std::vector<JacobianRow>& rows) const;

  ClothMesh mesh_;
  material::Fabric fabric_;
  ModelledEffects effects_;
  Membrane membrane_;
  std::optional<Bending> bending_;
  std::vector<double> masses_;
  std::vector<Eigen::Vector3d> external_forces_;
  std::vector<std::optional<AttachmentPath>> attachments_;
  // Both have the capacity of kMostPointLoads.
  std::vector<PointLoad> point_loads_;
  std::vector<PointLoad> checked_loads_;  // of setPointLoads()
};

}  // namespace haptex::cloth
