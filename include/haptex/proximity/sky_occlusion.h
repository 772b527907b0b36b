// How much of the sky the particles of a cloth see past the cloth itself.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "haptex/linear/thread_pool.h"
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
  /// @param pool shares the work if it is given, to the same result; has to outlive this
  /// @throws std::invalid_argument naming a vertex that is no particle, or an instruction set that
  ///   the processor lacks
  SkyOcclusion(std::vector<std::array<int, 3>> triangles, std::size_t particles,
               linear::ThreadPool* pool = nullptr,
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

  /// Along some of the directions, one after the other.
  struct View {
    View(std::size_t particles, std::size_t cells);
    // By particle:
    std::vector<Place> places;
    float left = 0.0f, low = 0.0f, columns_per_metre = 0.0f, rows_per_metre = 0.0f;
    std::vector<int> cell;
    // By place in the order of cells, which are row by row: with some more that are nowhere.
    std::vector<int> begin, order;
    Numbers sorted_x, sorted_y, sorted_z;
    std::vector<int> hidden;  // 1: along the direction, 2: against it
    // Over its directions, by particle:
    std::vector<float> total;  // cosines
    std::vector<SkyShare> sums;
  };
  static constexpr int kViews = 4;  // any number of threads adds up the same

  void readPositions(const std::vector<Eigen::Vector3d>& positions);
  void sumNormals();
  void look(int number);
  void project(const Eigen::Vector3f& direction, View& view) const;
  void sort(View& view) const;
  void cover(View& view) const;
  void coverWithAvx2(View& view) const;
  template <int kLanes>
  void coverWith(const std::array<int, 3>& triangle, View& view) const;
  void add(const Eigen::Vector3f& direction, View& view) const;

  InstructionSet instruction_set_;
  linear::ThreadPool* pool_;
  std::vector<std::array<int, 3>> triangles_;
  std::vector<Eigen::Vector3f> directions_;
  std::vector<Eigen::Vector3f> points_, normals_;  // by particle: m, and of length 1 or 0
  int columns_, rows_;                             // cells of the grid along x and y
  std::vector<View> views_;
  std::vector<SkyShare> shares_;
};

}  // namespace haptex::proximity
