// A person's body as a surface, with the segments that move it.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <map>
#include <string>
#include <vector>

namespace haptex::garment {

/// A part of a body between two joints. What lies beyond its end follows it.
struct Segment {
  std::string name;
  int parent = -1;     ///< which segment it hangs on, an earlier one; -1: on none
  std::string chain;   ///< of segments that a tube may go around in one, as an arm
  std::string within;  ///< another chain, whose tubes go around this one, too; or empty
  Eigen::Vector3d start = Eigen::Vector3d::Zero();  ///< m, world frame
  Eigen::Vector3d end = Eigen::Vector3d::Zero();    ///< m, world frame
};

/// How much a vertex goes with a segment.
struct SegmentShare {
  int segment = 0;
  double weight = 0.0;  ///< > 0; those of a vertex have the sum 1
};

/// Lengths in metres, world frame: x forward, y to the body's left, z up. A body stands with its
/// lowest point at z = 0.
struct Body {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<std::array<int, 3>> triangles;      ///< counter-clockwise from outside
  std::vector<Segment> segments;                  ///< parents before their children
  std::vector<std::vector<SegmentShare>> shares;  ///< per vertex, at least one, the largest first
};

/// Turns of segments about their starts, in the axes of the world, before those of the segments
/// that they hang on.
using Pose = std::map<std::string, Eigen::Quaterniond>;

/// @throws std::invalid_argument naming the segment and all that there are
int segmentNamed(const Body& body, const std::string& name);

/// The body in another pose, by linear blend skinning (Magnenat-Thalmann, Laperriere and Thalmann
/// 1988): every vertex goes with its segments by its shares. It is set down again on z = 0.
/// @throws std::invalid_argument naming a segment that is not there
Body posed(const Body& body, const Pose& pose);

/// Moves the body up or down until its lowest vertex is at z = 0.
void setDown(Body& body);

/// m^3, within a closed surface.
double volumeOf(const Body& body);

/// Whether every edge of the surface has exactly two triangles, which run along it in opposite
/// directions.
bool isClosed(const std::vector<std::array<int, 3>>& triangles);

}  // namespace haptex::garment
