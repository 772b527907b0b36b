// The public-domain (CC0) human figure of MakeHuman and its changes, from the files as published.
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "haptex/garment/body/body.h"

namespace haptex::garment {

constexpr std::size_t kLargestFigureFile = 8u << 20;  ///< bytes
constexpr std::size_t kMostFigureVertices = 200000;

/// By how much the vertices of a figure go if a change is made in full.
struct Target {
  struct Step {
    int vertex;
    Eigen::Vector3d by;  ///< m, world axes
  };
  std::vector<Step> steps;
};

/// The vertices of the whole figure, of which many are helpers that only tell where joints are.
struct FigureMesh {
  std::vector<Eigen::Vector3d> positions;     ///< m, axes of the world
  std::vector<std::array<int, 3>> triangles;  ///< of the group `body`, quads cut in two
};

/// Where a segment starts and ends: in the mean of some vertices each.
struct SegmentJoints {
  std::vector<int> start, end;
};

/// Bones as a skeleton file has them.
struct Skeleton {
  struct Bone {
    std::string name;
    std::string parent;  ///< empty: none
    std::vector<int> head, tail;
  };
  std::vector<Bone> bones;
};

struct Figure {
  FigureMesh mesh;
  std::vector<int> surface;                       ///< vertices that the triangles have, ascending
  std::vector<Segment> segments;                  ///< without places
  std::vector<SegmentJoints> joints;              ///< per segment
  std::vector<std::vector<SegmentShare>> shares;  ///< per vertex of `surface`
};

// Readers of the files' texts. Files have decimetres with x to the left, y up and z forward.
// All of them throw std::invalid_argument naming the text, the line or key, the value and what is
// allowed; `name` is the text's in messages.

/// Positions and the quads or triangles of the group `body` of a Wavefront OBJ file.
FigureMesh parseFigure(const std::string& text, const std::string& name);
/// Lines "vertex dx dy dz". @param vertices of the figure
Target parseTarget(const std::string& text, const std::string& name, std::size_t vertices);
/// JSON: bones with the names of their two joints, joints as lists of vertices.
Skeleton parseSkeleton(const std::string& text, const std::string& name, std::size_t vertices);
/// JSON: pairs [vertex, weight] per bone. A figure of which every bone's weights go to the segment
/// that the bone belongs to, and with the joints of the segments.
Figure makeFigure(FigureMesh mesh, const Skeleton& skeleton, const std::string& weights,
                  const std::string& name);

/// base.obj, default.mhskel and default_weights.mhw of a directory.
/// @throws std::runtime_error naming a file that cannot be read or is larger than allowed
Figure loadFigure(const std::string& directory);
/// @throws likewise
Target loadTarget(const std::string& path, std::size_t vertices);

/// The body of the figure with its vertices at other places, set down on z = 0.
/// @param positions m, per vertex of the whole figure @param scale of all lengths, > 0
Body bodyOf(const Figure& figure, const std::vector<Eigen::Vector3d>& positions, double scale);
/// Moves such a body to other places.
void moveTo(const Figure& figure, const std::vector<Eigen::Vector3d>& positions, double scale,
            Body& body);

}  // namespace haptex::garment
