// How much of the sky the particles of a cloth see past the cloth itself.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "haptex/proximity/kdop_kernels.h"

namespace haptex::proximity {

/// Shares of the two half skies above a particle, each weighted by the cosine to the normal, that
/// the cloth does not hide: 1 where nothing is in the way, 0 where all is hidden. What a uniform
/// sky lights on a side is this share of what it would light without the cloth.
struct SkyShare {
  float front = 1.0f;  ///< the side from which triangles are counter-clockwise
  float back = 1.0f;   ///< the other one
};

/// The sky is evenly spread directions and their opposites. Along each, particles are sorted into
/// the cells of a grid across it, and every triangle is held against the particles in the cells
/// that it reaches: which of them it covers, and from which side. So it takes the same time however
/// the cloth is folded, where a hierarchy of volumes is descended for every particle and tells
/// least apart where most is near. Triangles at the particle itself hide nothing from it.
/// Directions within asin(kHorizon) of a particle's tangent plane do not count.
///
/// Measured against 4096 rays per side: docs/proximity.md, What is seen of the sky.
class SkyOcclusion {
 public:
  static constexpr int kDirections = 192;  ///< with their opposites twice as many
  static constexpr float kHorizon = 0.1f;  ///< least cosine to the normal that counts

  /// @param triangles vertex indices; triangles without area are allowed
  /// @param particles of the mesh
  /// @throws std::invalid_argument naming a vertex that is no particle, or an instruction set that
  ///   the processor lacks
  SkyOcclusion(std::vector<std::array<int, 3>> triangles, std::size_t particles,
               InstructionSet instruction_set = bestInstructionSet());

  /// One for every particle; both 1 where it has no triangle with an area. Does not allocate.
  /// @param positions m
  /// @throws std::invalid_argument if their number differs, or one is not finite or beyond
  ///   kMaxLength; the shares are then as before
  const std::vector<SkyShare>& compute(const std::vector<Eigen::Vector3d>& positions);

 private:
  using Numbers = std::vector<float>;
  struct Place {
    float x, y, z, unused;  // m: across a direction, and along it
  };

  void readPositions(const std::vector<Eigen::Vector3d>& positions);
  void sumNormals();
  void project(const Eigen::Vector3f& direction);
  void sort();
  void cover();
  void coverWithAvx2();
  template <int kLanes>
  void coverWith(const std::array<int, 3>& triangle);
  void add(const Eigen::Vector3f& direction);

  InstructionSet instruction_set_;
  std::vector<std::array<int, 3>> triangles_;
  std::vector<Eigen::Vector3f> directions_;
  std::vector<Eigen::Vector3f> points_, normals_;  // by particle: m, and of length 1 or 0
  int columns_, rows_;                             // cells of the grid along x and y

  // Along one direction. By particle:
  std::vector<Place> places_;
  float left_, low_, columns_per_metre_, rows_per_metre_;
  std::vector<int> cell_;
  // By place in the order of cells, which are row by row: with some more that are nowhere.
  std::vector<int> begin_, order_;
  Numbers sorted_x_, sorted_y_, sorted_z_;
  std::vector<int> hidden_;  // 1: along the direction, 2: against it

  std::vector<float> total_;  // by particle, cosines of all directions
  std::vector<SkyShare> sums_, shares_;
};

}  // namespace haptex::proximity
