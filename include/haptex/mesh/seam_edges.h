// What sew() and merge() know of the edges that a seam joins.
#pragma once

#include <array>
#include <map>
#include <vector>

#include "haptex/mesh/mesh.h"

namespace haptex::mesh {

/// By the particles of an edge, the smaller one first, its only triangle; -1: it has several.
using BorderTriangles = std::map<std::array<int, 2>, int>;
BorderTriangles borderTriangles(const ClothMesh& mesh);
/// @throws std::invalid_argument if no triangle or several have the edge
int borderTriangle(const BorderTriangles& triangles, int a, int b);

/// Rest coordinates (m, weft and warp) of a particle in a triangle that it is a corner of.
Eigen::Vector2d restCorner(const ClothMesh& mesh, int triangle, int particle);

/// One edge of a seam.
struct SeamEdge {
  std::vector<int> particles;
  std::vector<double> places;  ///< from 0 to 1
  std::vector<int> triangles;  ///< of every piece between two particles
  double length = 0.0;         ///< m, at rest

  int pieceCount() const { return static_cast<int>(triangles.size()); }
};

/// @param name "first" or "second", for messages @param places may be empty
/// @throws std::invalid_argument as sew()
SeamEdge seamEdge(const ClothMesh& mesh, const BorderTriangles& triangles, const char* name,
                  const std::vector<int>& particles, const std::vector<double>& places);

/// Adds one hinge for every pair of pieces that lie beside each other along the seam.
void addSeamHinges(const SeamEdge& first, const SeamEdge& second, double angle, ClothMesh& mesh);

/// Places (of the whole seam) that differ by less than this are one.
constexpr double kSamePlace = 1e-9;

/// @throws std::invalid_argument if it is not finite, or not above -pi and below pi
void requireSeamAngle(double angle);

}  // namespace haptex::mesh
