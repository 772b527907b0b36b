// The mechanical model of a piece of cloth: mesh, fabric, what is modelled, attachments and loads.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "haptex/cloth/dynamics/particle_contact.h"
#include "haptex/cloth/forces/aerodynamics.h"
#include "haptex/cloth/forces/bending.h"
#include "haptex/cloth/forces/corotational.h"
#include "haptex/cloth/forces/membrane.h"
#include "haptex/cloth/forces/point_load.h"
#include "haptex/cloth/forces/spring_lattice.h"
#include "haptex/linear/block_matrix.h"
#include "haptex/material/fabric.h"
#include "haptex/mesh/mesh.h"

namespace haptex::cloth {

/// What changes from step to step. World frame, SI units.
struct ClothState {
  std::vector<Eigen::Vector3d> positions;   ///< m
  std::vector<Eigen::Vector3d> velocities;  ///< m/s
  double time = 0.0;                        ///< s
  PlasticBends plastic_bends;               ///< m; empty if no hysteresis is modelled
};

/// How the cloth resists stretch and shear.
enum class Elasticity {
  kGreenLagrange,  ///< Membrane: nonlinear, exact for every curve
  kMassSpring,     ///< SpringLattice: for comparison, on rectangular cells
  kCorotational,   ///< Corotational: for comparison, linear
};

/// What is modelled besides inertia. What is not asked for is not computed.
struct ModelledEffects {
  bool viscosity = false;
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();     ///< m/s^2
  Elasticity elasticity = Elasticity::kGreenLagrange;    ///< against stretch and shear
  bool bending = false;                                  ///< by the fabric's rigidity
  BendingSettings bending_settings = BendingSettings();  ///< how, if bending is modelled
  bool bending_hysteresis = false;                       ///< of the fabric, only with bending
  bool contraction = false;                              ///< of the fabric, transverse
  std::optional<Air> air = std::nullopt;                 ///< drag and lift, of still air or wind
  bool contacts = false;                                 ///< Cloth::setContacts()
  bool point_loads = false;                              ///< Cloth::setPointLoads()
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
  static constexpr std::size_t kMaxPointLoads = 4096;

  /// @throws std::invalid_argument if the mesh has defects or is not what the elasticity needs
  ///   (findLatticeSprings()), the density is not finite and > 0, gravity is not finite, bending,
  ///   its hysteresis or contraction is modelled and the fabric has none, contraction is modelled
  ///   with another elasticity than Green-Lagrange, hysteresis without bending or with bend
  ///   springs, or as Bending and Aerodynamics
  Cloth(mesh::ClothMesh mesh, material::Fabric fabric, const ModelledEffects& effects);

  const mesh::ClothMesh& mesh() const { return mesh_; }
  const material::Fabric& fabric() const { return fabric_; }
  const ModelledEffects& effects() const { return effects_; }
  std::size_t particleCount() const { return masses_.size(); }
  /// Lumped particle masses (kg): a third of each adjacent triangle.
  const std::vector<double>& masses() const { return masses_; }
  /// The elements of the mesh, whose forces act if the elasticity is Green-Lagrange.
  const Membrane& membrane() const { return membrane_; }
  /// Null if bending is not modelled, or by the springs.
  const Bending* bending() const { return bending_ ? &*bending_ : nullptr; }
  /// Null if hysteresis of bending is not modelled, or the fabric's is 0.
  const BendingFriction* bendingFriction() const {
    return bending_ ? bending_->friction() : nullptr;
  }
  /// Null if the elasticity is another.
  const SpringLattice* springs() const { return springs_ ? &*springs_ : nullptr; }
  /// Null if the air is not modelled.
  const Aerodynamics* air() const { return air_ ? &*air_ : nullptr; }
  /// A matrix with the pattern that membrane and bending are bound to.
  linear::SymmetricBlockMatrix pattern() const;

  /// The state at rest in the initial positions at time 0, without friction in what is bent there.
  ClothState initialState() const;

  /// Changes the fabric from the next step on: masses and curves, not positions or velocities.
  /// With bending another rigidity may change pattern(): make a new integrator. With hysteresis a
  /// state of another fabric is refused: forgetBending() first.
  /// @throws std::invalid_argument if the density is not finite and > 0, or bending, its hysteresis
  ///   or contraction is modelled and the fabric has none; nothing has changed then
  void setFabric(material::Fabric fabric);

  /// Makes the state one without friction in what is bent: the fabric's past is forgotten.
  /// @throws std::invalid_argument if positions or velocities are not as many as particles
  void forgetBending(ClothState& state) const;
  /// Lets the state's plastic bends follow its positions (BendingFriction::yield()); what every
  /// step does at its end.
  void yieldBending(ClothState& state) const;

  /// User-defined external force (N) on a particle, until set again; zero at first.
  /// @throws std::invalid_argument if the particle does not exist or the force is not finite
  void setExternalForce(int particle, const Eigen::Vector3d& force);
  const std::vector<Eigen::Vector3d>& externalForces() const { return external_forces_; }

  /// Replaces the point loads, which act until replaced; none at first. The step treats their
  /// stiffness implicitly, so that a stiff contact stays stable at every time step. Allocates
  /// nothing. On attached particles they act as any force: not.
  /// @throws std::invalid_argument naming the load if its triangle does not exist, a number is not
  ///   finite, the weights do not sum to 1 within 1e-6, the stiffness is not symmetric and positive
  ///   semidefinite to 1e-6 of its norm, there are more than kMaxPointLoads, or any if effects()
  ///   are without point loads; nothing has changed then
  void setPointLoads(const std::vector<PointLoad>& loads);
  /// As set, their stiffness made exactly symmetric and positive semidefinite.
  const std::vector<PointLoad>& pointLoads() const { return point_loads_; }

  /// Replaces the contacts, which hold for steps that end when they say. An implicit step keeps
  /// their particles in their half spaces, with Coulomb friction; an explicit one does not know
  /// them, nor do the functions below. On attached particles they do nothing. Allocates nothing.
  /// @throws std::invalid_argument what requireSound() says, or if effects() are without contacts;
  ///   nothing has changed then
  void setContacts(const std::vector<ParticleContact>& contacts);
  const std::vector<ParticleContact>& contacts() const { return contacts_; }

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

  /// Internal and external forces (N) on every particle: membrane, bending, gravity, air,
  /// user-defined and point loads, not the reaction of an attachment. At rest the reaction at an
  /// attached particle is the negative.
  /// @param forces resized to particleCount()
  void computeForces(const ClothState& state, std::vector<Eigen::Vector3d>& forces) const;

  /// Elastic energy, gravity's and the user-defined forces' relative to the world origin, the point
  /// loads' relative to their positions, and what friction holds (BendingFriction::energy()) (J).
  double potentialEnergy(const ClothState& state) const;
  double kineticEnergy(const ClothState& state) const;
  /// Tells whether potentialEnergy() of a state may be another now: a number greater than 0 that no
  /// other cloth has but copies, and that setFabric(), setExternalForce() and setPointLoads()
  /// change.
  std::uint64_t revision() const { return revision_; }
  /// Power (W) that the wind feeds into the cloth (Aerodynamics::windPower); 0 without air.
  double windPower(const ClothState& state) const;

  // What StageSolver asks for. The sizes are not checked.

  /// Adds what all forces contribute to a linearised stage (Stage),
  ///   matrix += -a D - a^2 K,  rhs += a (F + ahead K v),
  /// with K and D projected as each force says.
  /// @param plastic those of the state in which the step begins
  /// @param matrix  with the pattern of pattern()
  void addStep(const Positions& positions, const Velocities& velocities,
               const PlasticBends& plastic, const StageTimes& times,
               linear::SymmetricBlockMatrix& matrix, linear::BlockVector& rhs) const;

  /// How many entries the vectors of strains have: Membrane's, or what it says where the elasticity
  /// is another.
  std::size_t strainCount() const;
  /// Membrane::computeStrains() and computeStrainsBefore() of what the elasticity is.
  void computeStrains(const Positions& positions, std::vector<MembraneStrain>& strains) const;
  void computeStrainsBefore(const Positions& positions, const Velocities& velocities,
                            double interval, std::vector<MembraneStrain>& strains) const;

  /// What Newton iterations of a stage at the time hold fixed of the air.
  /// @param fixed with a panel per element if the air is modelled
  void fixAir(const Positions& positions, const Velocities& velocities, double time,
              FixedAir& fixed) const;

  /// Adds what all forces contribute to a Newton iteration at the end of a stage:
  ///   matrix += a^2 times the Hessian of their incremental potential, rhs -= a times its gradient.
  /// @param plastic       as for addStep()
  /// @param begin_strains of computeStrains(): Membrane::addNewton()
  /// @param fixed_air     of fixAir()
  void addNewton(const Positions& positions, const Velocities& velocities,
                 const PlasticBends& plastic, const std::vector<MembraneStrain>& begin_strains,
                 const FixedAir& fixed_air, double a, Membrane::Hessian hessian,
                 linear::SymmetricBlockMatrix& matrix, linear::BlockVector& rhs) const;

  /// The incremental potential of addNewton() (J), without that of gravity and the user-defined
  /// forces, which are constant.
  double incrementalPotential(const Positions& positions, const Velocities& velocities,
                              const PlasticBends& plastic,
                              const std::vector<MembraneStrain>& begin_strains,
                              const FixedAir& fixed_air, double a) const;

  /// All blocks of the exact (not projected) Jacobian in the rows of the given particles,
  /// sorted by row in the order given, then by column.
  /// @throws std::invalid_argument if a particle does not exist
  std::vector<JacobianBlock> jacobian(const ClothState& state,
                                      const std::vector<int>& particles) const;

 private:
  void bindPattern();
  template <typename Call>
  auto withElasticity(Call&& call) const;
  void requireParticle(int particle) const;
  void requireState(const ClothState& state) const;
  void requireParticles(const ClothState& state) const;
  void addConstantForces(double a, linear::BlockVector& rhs) const;
  void addLinearForces(const Positions& positions, const Velocities& velocities,
                       const StageTimes& times, linear::SymmetricBlockMatrix& matrix,
                       linear::BlockVector& rhs) const;
  using JacobianRow = std::map<int, JacobianBlock>;  // by column
  template <typename Element>
  void addElementJacobian(const Element& forces, const ClothState& state,
                          const std::map<int, std::vector<std::size_t>>& rows_of_particle,
                          std::vector<JacobianRow>& rows) const;
  void addSpringJacobian(const ClothState& state,
                         const std::map<int, std::vector<std::size_t>>& rows_of_particle,
                         std::vector<JacobianRow>& rows) const;
  void addBendingJacobian(const ClothState& state,
                          const std::map<int, std::vector<std::size_t>>& rows_of_particle,
                          std::vector<JacobianRow>& rows) const;
  void addAirJacobian(const ClothState& state, std::size_t element,
                      const std::map<int, std::vector<std::size_t>>& rows_of_particle,
                      std::vector<JacobianRow>& rows) const;
  void addPointLoadJacobian(const std::map<int, std::vector<std::size_t>>& rows_of_particle,
                            std::vector<JacobianRow>& rows) const;

  std::uint64_t revision_;
  mesh::ClothMesh mesh_;
  material::Fabric fabric_;
  ModelledEffects effects_;
  Membrane membrane_;
  // At most one of them; none: the membrane's forces act.
  std::optional<SpringLattice> springs_;
  std::optional<Corotational> corotational_;
  std::optional<Bending> bending_;
  std::optional<Aerodynamics> air_;
  std::vector<double> masses_;
  std::vector<Eigen::Vector3d> external_forces_;
  std::vector<std::optional<AttachmentPath>> attachments_;
  // Empty unless point loads are modelled, and has the capacity of kMaxPointLoads then.
  std::vector<PointLoad> point_loads_;
  // Both are empty unless contacts are modelled, and have a capacity of one per particle then.
  std::vector<ParticleContact> contacts_;
  std::vector<char> touched_;  // of setContacts()
};

}  // namespace haptex::cloth
