// Forces that bring the sides of open seams together.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "haptex/cloth/forces/point_loads.h"
#include "haptex/garment/garment_mesh.h"

namespace haptex::dressing {

/// Every particle of a seam is pulled to the middle of those that it will be one with, as by hands:
/// with a bounded force, at a bounded speed, and harder where it does not come nearer.
class SeamPull {
 public:
  /// @param tension N/m, of a seam's length, > 0; up to 20 times that where it is stuck
  SeamPull(const garment::GarmentMesh& garment, double tension);

  /// @param positions m, of the garment's particles
  /// @param farthest  m, > 0: how far a particle is pulled in a step at most
  /// @param onwards   0 to 1: by which part of its way in the last step the middle of a group is
  ///   expected to go on. With more, what moves together is held back less, but a blow goes on
  ///   until the next one
  const std::vector<cloth::PointLoad>& loads(const std::vector<Eigen::Vector3d>& positions,
                                             double farthest, double onwards);
  /// m, the largest distance of a particle from the middle of its group.
  double gap(const std::vector<Eigen::Vector3d>& positions) const;
  /// The seam that has it; -1 if there is no seam.
  int widestSeam(const std::vector<Eigen::Vector3d>& positions) const;

 private:
  struct Member {
    int particle;
    int group;
    int triangle;  // that it is a corner of, and
    int corner;
    int seam;             // the first that has it
    double force = 0.0;   // N, by which it is pulled
    double most = 0.0;    // N
    double length = 0.0;  // m, from the middle of its group in the last step
  };

  std::vector<Eigen::Vector3d> middles(const std::vector<Eigen::Vector3d>& positions) const;

  std::vector<Member> members_;
  std::vector<int> sizes_;  // of groups
  std::vector<cloth::PointLoad> loads_;
  std::vector<Eigen::Vector3d> middles_before_;  // m, of groups in the last step
};

}  // namespace haptex::dressing
