// A part of a cloth that is computed while the rest stands still.
#pragma once

#include <vector>

#include "haptex/cloth/dynamics/cloth.h"

namespace haptex::cloth {

/// The triangles that act on some particles of a cloth, as a cloth of its own: what they do to
/// those particles is what they do in the whole, to rounding. The others of its particles, the rim,
/// stand still. A step of the part costs what a cloth of its size costs.
class ClothPart {
 public:
  /// Makes it with the whole's user-defined forces, point loads and number of rigid bodies.
  /// @param included per particle of the whole, nonzero where it moves; at least one is
  /// @throws std::invalid_argument if there is not one per particle or none moves, the cloth
  ///   collides with itself (what stands still would not be met), has ties, or its panels bend by
  ///   different kinds of hinges (Bending::model())
  ClothPart(const Cloth& whole, const std::vector<char>& included);

  Cloth& cloth() { return cloth_; }

  /// Takes over the whole's attachments, and its state as that of the part. Allocates nothing.
  /// @param whole that of the constructor, with everything attached that is not included
  /// @param state of the whole
  /// @returns the part's, to be stepped
  ClothState& begin(const Cloth& whole, const ClothState& state);
  /// Writes it back: the included particles, what forces remember, and the time.
  void end(ClothState& state) const;

  /// Those on triangles that are not in the part do nothing. Allocates nothing.
  /// @param loads that the whole has accepted
  void setPointLoads(const std::vector<PointLoad>& loads);
  /// Nothing where the particle is not in the part.
  void setExternalForce(int particle, const Eigen::Vector3d& force);

 private:
  /// @param triangles of the whole that are in the part, ascending
  ClothPart(const Cloth& whole, const std::vector<char>& included,
            const std::vector<int>& triangles);

  std::vector<int> particles_;                        // of the whole, ascending
  std::vector<int> moved_;                            // of the part: which are included
  std::vector<int> triangle_place_, particle_place_;  // by those of the whole; -1: not in the part
  Cloth cloth_;
  ClothState state_;
  std::vector<int> memory_;  // of the whole, by the numbers that the part remembers
  std::vector<PointLoad> loads_;
};

}  // namespace haptex::cloth
