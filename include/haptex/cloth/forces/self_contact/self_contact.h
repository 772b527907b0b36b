// Contact of a cloth with itself and with obstacles: pressure through its thickness, and friction.
#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "haptex/cloth/forces/force.h"
#include "haptex/cloth/forces/self_contact/near_obstacles.h"
#include "haptex/cloth/forces/self_contact/near_pairs.h"
#include "haptex/cloth/forces/self_contact/pair_energies.h"

namespace haptex::cloth {

/// An edge that goes through a triangle of the same cloth: both stick to each other where it does.
struct TangleLink {
  std::array<int, 5> vertices;    ///< particles: of the edge, and of the triangle
  std::array<double, 5> weights;  ///< of the place on the edge less that of the triangle
  double damping;                 ///< N s/m, of their velocity against each other
  int count = 5;                  ///< of vertices
};

/// The sum of PairEnergies, a function of the positions alone, and Coulomb friction as FabricLayers
/// says between the points of each pair that are nearest to each other. Friction is smooth:
/// at a slip speed v below kSlipSpeed the coefficient is MIU times (2 - v/kSlipSpeed) v/kSlipSpeed,
/// so that what sticks creeps. Newton iterations hold the normal forces, the normals and the
/// weights, and friction is the gradient of a convex potential of the slip since the stage's base
/// (Li et al., Incremental Potential Contact, ACM Trans. Graphics 39(4), 2020).
///
/// Obstacles are at the end of the step (ObstacleSurfaces) in states of a time after its beginning,
/// and in linearised stages and what is held passively, which are of the beginning, where they are
/// then. Their friction is their own coefficient, or the fabric's where they have none, and that
/// of their surface's velocity.
///
/// Without obstacles both sums of forces are zero to rounding. The stiffness in matrices is that
/// along the normals alone, which is positive semidefinite; what turns a normal is left out.
///
/// The functions keep what they found last, the result does not depend on it; so one thread at a
/// time may call them. They allocate where more is near than ever before.
class SelfContact final : public Force {
 public:
  static constexpr double kSlipSpeed = 1e-3;  ///< m/s

  /// @param fabrics that the surface names
  /// @throws std::invalid_argument if a fabric has no compression or no friction, or what NearPairs
  ///   says about the thickest one
  SelfContact(const RestSurface& rest, const std::vector<material::Fabric>& fabrics);

  void addForces(const ForceState& state, std::vector<Eigen::Vector3d>& forces) const override;
  double energy(const ForceState& state) const override;
  /// By differences of the forces, right to some 1e-6 of the stiffest blocks.
  void addJacobian(const ForceState& state, JacobianRows& rows) const override;
  void assembleLinearised(const ForceState& state, const StageTimes& times,
                          linear::SymmetricBlockMatrix& matrix,
                          linear::BlockVector& rhs) const override;
  /// Keeps what it holds itself, because pairs come and go.
  void hold(const NewtonStart& start, Eigen::Vector3d* held) const override;
  void assembleNewton(const ForceState& state, const Eigen::Vector3d* held, double a,
                      Hessian hessian, linear::SymmetricBlockMatrix& matrix,
                      linear::BlockVector& rhs) const override;
  double incrementalPotential(const ForceState& state, const Eigen::Vector3d* held,
                              double a) const override;

  /// What touches at these positions, the obstacles being where they are at the end of the step, or
  /// else at its beginning; empty where one of the positions is not finite.
  /// @param pool shares the work if it is given
  const std::vector<PairEnergy>& touching(const Positions& positions, bool at_end = true,
                                          linear::ThreadPool* pool = nullptr) const;
  NearPairs& nearPairs() const { return near_; }
  /// NearPairs::leaveOut(), after which the energy is another one if that is a change. Steps damp
  /// what tangles do against themselves, so that nothing goes on through what has no contact; the
  /// forces are without that.
  bool leaveOut(const TangleSides& sides, const std::vector<TangleLink>& links) const;
  const FabricLayers& layers() const { return energies_.layers(); }
  /// m, LayerLaw::margin() of the fabric that has the most.
  double margin() const;
  /// m, of two elements of cloth the sum of what either has is where motions stop before they
  /// touch: of each particle half of LayerLaw::margin(), between regions the least one. Empty where
  /// all are of one fabric.
  std::vector<double> particleMargins() const;

  /// From now on the cloth is among these; null: among none. Allocates.
  void setObstacles(std::shared_ptr<ObstacleSurfaces> surfaces);
  /// Null if there are none.
  NearObstacles* obstacles() const { return obstacles_ ? &*obstacles_ : nullptr; }
  /// Force (N) of the cloth on an obstacle.
  Eigen::Vector3d forceOn(int obstacle, const ForceState& state) const;
  /// Work (J) that obstacles which move do on the cloth in the step by the forces of its end.
  double obstacleWork(const ForceState& end) const;

 private:
  /// Of a pair, while Newton iterations hold it.
  struct HeldFriction {
    int count;
    std::array<int, 4> vertices;
    std::array<double, 4> weights;
    Eigen::Vector3d normal;
    double most;            // N, friction of what slips
    Eigen::Vector3d start;  // m, sum of weights times positions at the stage's base, and where
                            // an obstacle's surface has carried it since
  };

  bool isEnd(double time) const { return !obstacles_ || obstacles_->surfaces().isEnd(time); }
  double frictionOf(const PairEnergy& pair) const;
  Eigen::Vector3d velocityOf(const PairEnergy& pair, const Velocities& velocities) const;
  Eigen::Vector3d frictionAt(const PairEnergy& pair, const Velocities& velocities) const;
  void addEnergies(const std::vector<PairEnergy>& pairs, double a,
                   linear::SymmetricBlockMatrix& matrix, linear::BlockVector& rhs) const;

  std::vector<int> fabrics_;  // RestSurface::fabrics
  mutable NearPairs near_;
  mutable PairEnergies energies_;
  mutable std::optional<NearObstacles> obstacles_;
  std::vector<std::optional<double>> obstacle_friction_;
  mutable Positions touching_at_;
  mutable bool touching_at_end_ = true;
  mutable int touching_revision_ = 0;  // of the obstacles' places
  mutable std::vector<PairEnergy> touching_;
  mutable std::vector<HeldFriction> held_;
  mutable std::vector<TangleLink> links_;
  mutable std::vector<Eigen::Vector3d> held_links_;  // m, sums at the stage's base
};

}  // namespace haptex::cloth
