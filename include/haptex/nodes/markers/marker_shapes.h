// What the markers of several classes are made of.
#pragma once

#include <geometry_msgs/Point.h>
#include <std_msgs/ColorRGBA.h>
#include <visualization_msgs/Marker.h>

#include <Eigen/Core>
#include <string>
#include <vector>

#include "haptex/proximity/cursor.h"

namespace haptex::nodes {

/// A marker to be added in the frame fixedFrame(), at its origin, of scale 1, opaque.
visualization_msgs::Marker makeMarker(const std::string& name, int id, int type);

/// @param colour red, green and blue from 0 to 1 @param opacity from 0 to 1
std_msgs::ColorRGBA colourMessage(const Eigen::Vector3f& colour, float opacity = 1.0F);

/// The fixed light of shade(): so much of it comes evenly from all around, the rest from a sun.
constexpr double kAmbient = 0.35;
/// Unit length, in the frame of markers.
Eigen::Vector3d towardsSun();

/// Brightness from 0 to 1 of a surface in a fixed light by Lambert's law, the same for both sides.
/// rviz does not light triangles that have colours of their own, and its own light leaves what lies
/// flat in the dark.
/// @param normal unit length
float shade(const Eigen::Vector3d& normal);

/// Gives the corners of a TRIANGLE_LIST their shaded colours.
void shadeTriangles(visualization_msgs::Marker& marker, const Eigen::Vector3f& colour,
                    float opacity);

/// Deletes a marker that has no points: rviz warns of empty lists.
void deleteIfEmpty(visualization_msgs::Marker& marker);

/// Appends the surface of a tapered capsule as triangles, counter-clockwise seen from outside. Its
/// corners lie on the surface.
void appendSurface(const proximity::TaperedCapsule& capsule,
                   std::vector<geometry_msgs::Point>& corners);

/// Appends the faces of a box along the axes with its middle in the origin, likewise.
/// @param sides m, whole edge lengths
void appendBox(const Eigen::Vector3d& sides, std::vector<geometry_msgs::Point>& corners);

}  // namespace haptex::nodes
