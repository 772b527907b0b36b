// Pulls a cloth apart that intersects itself.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "haptex/cloth/dynamics/cloth.h"
#include "haptex/cloth/dynamics/safe_motion.h"
#include "haptex/cloth/dynamics/stages/stage_solver.h"
#include "haptex/cloth/dynamics/step.h"
#include "haptex/cloth/dynamics/untangling/contours.h"
#include "haptex/cloth/dynamics/untangling/regions.h"
#include "haptex/proximity/mesh_intersections.h"

namespace haptex::cloth {

/// Of a cloth that collides with itself and starts, or is put, where it intersects itself: takes
/// what is on both sides of a tangle out of contact with each other (NearPairs::leaveOut()), and
/// makes it stick where it crosses. After every step it moves that a little on its way out
/// (TangleRegions), as impulses of that way would in the step (StageSolver::respond()), and as far
/// as nothing else passes through (SafeMotion). Velocities stay as they are, so momentum does. What
/// is out of tangles has contact again, and no longer passes through.
///
/// States that step() has left without an intersection, and that the next one begins with, cost a
/// comparison. Allocates nothing once its buffers have had the size that they need.
class Untangling {
 public:
  /// @param cloth collides with itself
  explicit Untangling(const Cloth& cloth);

  /// Before a step of h seconds from this state: looks at it unless it is what the last step left.
  void begin(const Cloth& cloth, const ClothState& state, double h);

  /// After it.
  /// @param h   s, of the step
  /// @param end changes its positions
  /// @return whether potential energies are other ones now
  bool end(const Cloth& cloth, double h, StageSolver& stages, ClothState& end,
           TangleReport& report);

 private:
  using Positions = std::vector<Eigen::Vector3d>;

  bool find(const Positions& positions);
  bool leaveOut(const Cloth& cloth);
  void linkCrossings();
  void chooseWays(const Positions& positions);
  void moveOut(const Cloth& cloth, double h, StageSolver& stages, ClothState& end);

  MeshTopology topology_;
  proximity::MeshIntersections intersections_;
  IntersectionContours contours_;
  TangleRegions regions_;
  SafeMotion motion_;
  double edge_length_;  // m, mean
  std::vector<proximity::TrianglePair> pairs_;
  Positions last_;  // m, that the last step left; empty: none
  Positions targets_;
  std::vector<Eigen::Vector3d> ways_;
  std::vector<double> weights_;
  std::vector<char> is_crossed_;  // of a contour
  std::vector<TangleLink> links_;
  double damping_ = 0.0;  // N s/m, of a link
};

}  // namespace haptex::cloth
