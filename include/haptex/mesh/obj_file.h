// Triangle meshes from Wavefront OBJ files.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "haptex/mesh/mesh.h"
#include "haptex/mesh/obstacle.h"

namespace haptex::mesh {

/// What a mesh may have at most: bytes of its file and triangles; and of positions and of texture
/// coordinates three times as many.
constexpr std::size_t kLargestObj = std::size_t{256} << 20;
constexpr std::size_t kMostTriangles = 2'000'000;

/// Reads triangles ("f"), positions ("v", metres, world frame) and texture coordinates ("vt"),
/// which are the rest coordinates (u weft, v warp) in metres, of every corner of a face. Where a
/// position has two of different value, it is on a seam of panels that are merged, or of a dart:
/// the mesh then has rest coordinates by corner, the groups ("g") in the order of the file as
/// panels of fabric 0 along the grain, and hinges at its seams (addHingesOfMergedSeams()); every
/// face must be in exactly one group. Without a seam the mesh is one panel, whatever its groups. A
/// face that is not a triangle is an error. Indices count from 1, or backwards if negative, over
/// what stands before the face in the file. Other statements are ignored. Refusals repeat no words
/// of the file.
/// @throws std::runtime_error if the file cannot be read or has more than kLargestObj bytes
/// @throws std::invalid_argument naming file, line and what is wrong, which is also the first
/// triangle
///   or position too many, or the mesh defects by index
ClothMesh loadObj(const std::string& path);

/// Triangles of each group ("g"), ascending.
using MeshGroups = std::map<std::string, std::vector<int>>;

/// The same, and its groups: a triangle is of all that the "g" before it names. A group without a
/// triangle is none.
ClothMesh loadObj(const std::string& path, MeshGroups& groups);

/// Reads triangles and positions (metres, the obstacle's own frame) only: everything else, texture
/// coordinates too, is ignored. Faces and indices are as for loadObj(); triangles without area and
/// positions in no face are allowed.
/// @throws std::runtime_error if the file cannot be read
/// @throws std::invalid_argument naming file, line and what is wrong, or that there is no triangle
ObstacleMesh loadObjSurface(const std::string& path);

/// The same, and its groups.
ObstacleMesh loadObjSurface(const std::string& path, MeshGroups& groups);

}  // namespace haptex::mesh
