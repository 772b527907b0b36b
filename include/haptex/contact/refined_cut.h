// Cutting elements out of a mesh and refining them.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "haptex/mesh/mesh.h"

namespace haptex::contact {

/// Which triangles of a mesh share its edges and particles.
class MeshTopology {
 public:
  explicit MeshTopology(const mesh::ClothMesh& mesh);

  /// The triangle beyond the edge opposite to a corner (0 to 2), -1 on the border of the mesh.
  int neighbour(int triangle, int corner) const { return neighbours_[triangle][corner]; }
  const std::vector<int>& trianglesOf(int particle) const { return triangles_of_[particle]; }
  std::size_t particleCount() const { return triangles_of_.size(); }

 private:
  std::vector<std::array<int, 3>> neighbours_;
  std::vector<std::vector<int>> triangles_of_;
};

/// Where a particle of a refined mesh lies on the mesh that it was cut from: on one of its
/// triangles, with weights that are whole multiples of 1 / 2^refinement. Two cuts with the same
/// refinement have the same support for the same place of the fabric.
struct Support {
  std::array<int, 3> particles;        ///< ascending; those with zero weight are -1 and first
  std::array<std::int32_t, 3> shares;  ///< of each, their sum is 2^refinement

  bool operator<(const Support& other) const {
    return particles != other.particles ? particles < other.particles : shares < other.shares;
  }
  bool operator==(const Support& other) const {
    return particles == other.particles && shares == other.shares;
  }
};

/// Some triangles of a mesh, each split into 4^refinement, and around them others that stay whole,
/// but for those with an edge to a split one, which fan out from the corner opposite to it, so that
/// every corner lies on corners. The particles that are free to move come
/// first, then those of the rim, which follow the mesh: they lie on an edge or corner that the cut
/// shares with triangles outside of it, or are attached.
///
/// Elements belong together by the edges that they share, whichever panels they are of: a cut goes
/// on over seams that are merged.
struct RefinedCut {
  /// Rest coordinates along weft and warp: where the mesh has panels that are merged by corner,
  /// each in its own panel, with hinges at the seams; of a particle those in its owner. Initial
  /// positions are zero.
  mesh::ClothMesh mesh;
  int free_count = 0;  ///< particles before the rim
  int refinement = 0;
  int refined_count = 0;                 ///< elements before those that stay coarse
  std::vector<int> elements;             ///< of the original mesh, that were cut
  std::vector<Support> supports;         ///< per particle
  std::vector<int> owners;               ///< per particle, a triangle of the original mesh
  std::vector<Eigen::Vector3d> weights;  ///< per particle, of its owner's corners, sum 1
  /// Per particle, which of the cloth's fabrics it is of: on the border of two that of the first
  /// triangle around it in the original mesh. Empty: all are of the first fabric.
  std::vector<std::uint8_t> fabrics;
  std::vector<int> order;  ///< particles sorted by support

  /// Whether some elements stay coarse.
  bool isSurrounded() const { return refined_count < static_cast<int>(elements.size()); }
};

/// @param triangles of the mesh, at least one, each once
/// @param attached  per particle of the mesh, nonzero where it is held
/// @param refinement 0 to 4
/// @param around    other triangles of the mesh, each once, that are cut out and stay coarse; one
///   with edges to two of the refined ones is refined, too
RefinedCut cutAndRefine(const mesh::ClothMesh& mesh, const MeshTopology& topology,
                        std::vector<int> triangles, const std::vector<char>& attached,
                        int refinement, std::vector<int> around = {});

/// The particle of a cut at a particle of the mesh that was cut; -1: none.
int cornerIn(const RefinedCut& cut, int particle);

/// The triangles around some of a mesh, nearest first, without these.
/// @param triangles each once
/// @param reach m, >= 0, along the edges of the mesh at rest, from the triangles to the farthest
///   corner
/// @param most  how many at most
std::vector<int> trianglesAround(const mesh::ClothMesh& mesh, const MeshTopology& topology,
                                 const std::vector<int>& triangles, double reach, std::size_t most);

}  // namespace haptex::contact
