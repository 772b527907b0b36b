// The rim of the patch of a pinch, which the patch takes along between two large-scale states.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "haptex/contact/refined_cut.h"
#include "haptex/linear/block_matrix.h"
#include "haptex/material/fabric.h"

namespace haptex::contact {

/// The rim is shifted as a whole by q from where the large-scale cloth has it, against the inertia
/// of the cloth around it and a spring that draws it back, damped critically:
///
///   m (q'' + w') + 2 m r q' + m r^2 q = F - G
///
/// F (N) is what the patch exerts on its rim, G what the fingers exert on the large-scale cloth,
/// with the patch's weight and what obstacles exert on it, w the velocity of the large-scale cloth
/// there, which jumps from one state to the next. So what goes on as the large-scale layer has
/// foreseen is as if the rim were on its way, and what does not is felt as the inertia of the cloth
/// and not as the stretch of the fabric up to a rim that does not know of it yet. At rest F is G,
/// and q vanishes.
///
/// While the hand rests, the spring is as stiff as the fabric, so that the rim is where the
/// large-scale cloth is: what is around a patch that is pulled holds it by its stretch, of which
/// the rim knows nothing. It gives way when the hand moves, and grows by a constant factor per step
/// from kRest after that on, so that nothing jumps.
///
/// q is one more unknown of the patch's step, in the place of its first rim particle. Nothing
/// allocates after the constructor.
class CarriedRim {
 public:
  static constexpr double kRate = 60.0;   ///< 1/s, r, while the hand moves
  static constexpr double kSpeed = 0.02;  ///< m/s, of the hand, from which on it moves
  static constexpr double kRest = 0.6;    ///< s, from its last motion until the spring grows

  /// @param pattern of the patch's matrix, with pairs()
  /// @param mass    kg, m, > 0
  CarriedRim(const RefinedCut& cut, const linear::SymmetricBlockMatrix& pattern, double mass);

  /// Which particles the rim as a whole acts on, for the pattern of the patch's matrix.
  /// @param pattern of the elements on the cut
  static std::vector<std::array<int, 2>> pairs(const RefinedCut& cut,
                                               const linear::SymmetricBlockMatrix& pattern);

  const Eigen::Vector3d& offset() const { return offset_; }      ///< m, q
  const Eigen::Vector3d& velocity() const { return velocity_; }  ///< m/s, q'

  /// At its place on the large-scale cloth, which moves with this velocity (m/s).
  void start(const Eigen::Vector3d& cloth_velocity);
  /// Goes on with q and q' of another one.
  void goOnFrom(const CarriedRim& other);
  /// The large-scale cloth has taken on another velocity: w (m/s). The rim keeps its own.
  void setClothVelocity(const Eigen::Vector3d& velocity);

  /// Adds the rows and columns of all rim particles to those of the first, and what holds it.
  /// @param outer_force N, G
  /// @param h             s
  void addTo(linear::SymmetricBlockMatrix& matrix, linear::BlockVector& rhs,
             const Eigen::Vector3d& outer_force, double h) const;
  /// One step. @param change m/s, of q', as solved for
  void advance(const Eigen::Vector3d& change, double h);
  /// @param speed m/s, of the hand in a step of h (s)
  void follow(double speed, double h);

 private:
  static constexpr double kMostRate = 4000.0;  // 1/s: as if it were held
  static constexpr double kStiffening = 0.04;  // s, in which r grows by e
  struct Fold {  // lower block `from`, of a rim particle, goes to lower block `to`
    int from, to;
  };
  int first_;                // rim particle
  std::vector<Fold> folds_;  // couplings of rim particles and free ones
  std::vector<int> inner_;   // lower blocks of two rim particles
  double mass_;
  double rate_ = kMostRate;  // 1/s, r
  double rest_ = kRest;      // s, since the hand has moved
  Eigen::Vector3d offset_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d cloth_velocity_ = Eigen::Vector3d::Zero();
};

/// kg, of the cloth that goes along with a pinch for some milliseconds: what is within 30 mm, but
/// not more than there is outside of the patch.
/// @param coarse the mesh that was cut
double massAround(const mesh::ClothMesh& coarse, const RefinedCut& cut,
                  const std::vector<material::Fabric>& fabrics);

/// Whether the rim can be carried: there is one, and nothing of the cut is attached.
bool canBeCarried(const RefinedCut& cut, const std::vector<char>& attached);

}  // namespace haptex::contact
