// Sewing: edges of panels that become one line, by ties or in one mesh.
#pragma once

#include <vector>

#include "haptex/mesh/mesh.h"

namespace haptex::mesh {

/// Two edges that are sewn together. Each is a row of particles along the border of the mesh, from
/// the same end of the seam to the other; the two may differ in number and length, and may begin or
/// end with the same particle, as the sides of a dart do.
struct Seam {
  std::vector<int> first;   ///< at least two
  std::vector<int> second;  ///< likewise
  /// Where the particles are along the seam, ascending from 0 to 1, so that equal places meet.
  /// Empty: their share of the edge's length at rest.
  std::vector<double> first_places = {};
  std::vector<double> second_places = {};
  /// rad: SeamHinge::angle, above -pi and below pi.
  double angle = 0.0;
};

/// Sews by exact constraints: ties the particles of the edge that has more of them, or the second,
/// to the other edge, and adds the seams' hinges. Where several seams meet in a point their ends
/// are tied to one particle, whatever the order of the seams.
/// @throws std::invalid_argument if an edge has less than two particles, does not run along the
///   border, a place is not as Seam says, the angle is not allowed, or the seams contradict each
///   other: a particle would lie on two edges at once, or on an edge that ends in itself; the mesh
///   is then as before
void sew(ClothMesh& mesh, const std::vector<Seam>& seams);

/// A mesh in which edges have become one.
struct MergedMesh {
  ClothMesh mesh;
  std::vector<int> particles;  ///< of `mesh`, for every one of the mesh before
};

/// Sews by refining and merging: every edge gets particles where the other one has some, the
/// triangles along it are cut accordingly, and the particles of both edges become one, which starts
/// in the middle of theirs. Places that differ by less than 1e-9 of the seam are one; others may
/// lie close together and give narrow triangles.
/// @throws std::invalid_argument as sew() does for the seams, or if the mesh has ties or hinges
///   already, or a triangle's corners become one; whether the mesh is sound is not looked at
MergedMesh merge(const ClothMesh& mesh, const std::vector<Seam>& seams);

}  // namespace haptex::mesh
