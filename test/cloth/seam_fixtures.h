// Two panels beside each other, and ways to sew them.
#pragma once

#include <gtest/gtest.h>

#include "fixtures.h"
#include "haptex/mesh/seam.h"

namespace haptex::cloth {

/// A square of 0.1 m cut along its middle line u = 0.05 m; the halves have cells_left and
/// cells_right cells along the cut and half as many across. They lie in the plane z = 0.
struct Halves {
  mesh::ClothMesh mesh;
  mesh::Seam seam;  ///< from v = 0 upwards, left first
};

inline Halves halves(int cells_left, int cells_right) {
  constexpr double kSize = 0.1;
  Halves made;
  for (int side = 0; side < 2; ++side) {
    const int cells = side == 0 ? cells_left : cells_right;
    mesh::ClothMesh half = mesh::makeRectangle(0.5 * kSize, kSize, std::max(1, cells / 2), cells,
                                               mesh::Triangulation::kAlternating);
    const int before = static_cast<int>(made.mesh.rest_coordinates.size());
    std::vector<int>& edge = side == 0 ? made.seam.first : made.seam.second;
    for (const int particle :
         mesh::sideParticles(half, side == 0 ? mesh::Side::kRight : mesh::Side::kLeft)) {
      edge.push_back(before + particle);
    }
    for (Eigen::Vector2d rest : half.rest_coordinates) {
      rest.x() += 0.5 * kSize * side;
      made.mesh.rest_coordinates.push_back(rest);
      made.mesh.initial_positions.emplace_back(rest.x(), rest.y(), 0.0);
    }
    for (const auto& [a, b, c] : half.triangles) {
      made.mesh.triangles.push_back({a + before, b + before, c + before});
      made.mesh.triangle_panels.push_back(side);
    }
  }
  made.mesh.panels = {{0, 0.0}, {0, 0.0}};
  return made;
}

/// By ties.
inline mesh::ClothMesh sewnHalves(int cells_left, int cells_right) {
  Halves made = halves(cells_left, cells_right);
  mesh::sew(made.mesh, {made.seam});
  return made.mesh;
}

/// Moves every free particle at random, and tied ones with them.
inline ClothState randomSewnState(const Cloth& cloth, double displacement, double speed,
                                  unsigned seed = 1) {
  ClothState state = randomState(cloth, displacement, speed, seed);
  cloth.ties().place(0.0, state.positions);
  cloth.ties().carry(0.0, state.velocities);
  return state;
}

/// T of Ties, with one row and column for every component.
inline Eigen::MatrixXd denseTies(const Cloth& cloth) {
  const auto size = static_cast<Eigen::Index>(3 * cloth.particleCount());
  Eigen::MatrixXd all = Eigen::MatrixXd::Identity(size, size);
  for (const mesh::ResolvedTie& tie : cloth.ties().resolved()) {
    all.middleRows<3>(3 * tie.particle).setZero();
    for (const mesh::TieShare& share : tie.shares) {
      all.block<3, 3>(3 * tie.particle, 3 * share.particle) =
          share.weight * Eigen::Matrix3d::Identity();
    }
  }
  return all;
}

/// The farthest that a tied particle is from its place (m).
inline double largestGap(const Cloth& cloth, const ClothState& state) {
  double largest = 0.0;
  for (std::size_t t = 0; t < cloth.ties().resolved().size(); ++t) {
    const int particle = cloth.ties().resolved()[t].particle;
    largest = std::max(largest,
                       (state.positions[particle] - cloth.ties().mean(t, state.positions)).norm());
  }
  return largest;
}

}  // namespace haptex::cloth
