// A garment as its maker knows it: panels that are cut from fabrics, and what is sewn to what.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "haptex/garment/pattern/curve.h"

namespace haptex::garment {

// What is larger is refused, before time or memory go into it.
constexpr std::size_t kMostPanels = 500;
constexpr std::size_t kMostEdges = 2000;   ///< of a panel
constexpr std::size_t kMostLines = 20000;  ///< straight ones that a panel's outlines are taken for
constexpr std::size_t kMostSeams = 5000;
constexpr std::size_t kMostPatternPoints = 500000;  ///< that the curves of a pattern are made of
constexpr double kLargestCoordinate = 20.0;         ///< m, of outlines and placements
constexpr double kSmallestArea = 1e-6;              ///< m^2, of a panel
constexpr double kShortestEdge = 1e-4;              ///< m
constexpr double kLargestEasing = 0.9;
constexpr int kLargestLayer = 15;
/// Ends of successive edges that are as near as that (m) are one corner.
constexpr double kJoin = 1e-6;
/// How far (m) straight lines may be from the outline where it is looked at whether it crosses
/// itself.
constexpr double kCrossingTolerance = 1e-4;
/// How much the lengths of the two sides of a seam may differ where nothing is said about it.
constexpr double kUsualEasing = 0.01;

struct Edge {
  Curve curve;
  std::string name = {};  ///< empty, or one that no other edge of the panel has
};

/// A closed chain of edges: each starts where the one before ends.
using Outline = std::vector<Edge>;

/// A cylinder or cone around a segment of a body, on which panels are laid before they are sewn.
struct Carrier {
  enum class Shape { kCylinder, kCone };
  std::string name;
  Shape shape = Shape::kCylinder;
  std::string segment;  ///< of the body, by its name
};

/// Where the middle of a panel lies on a carrier; what is not said follows from its seams.
struct OnCarrier {
  std::string carrier;
  /// rad, around the segment from its front, counter-clockwise from its end
  std::optional<double> angle = {};
  std::optional<double> along = {};  ///< of the segment's length, from its beginning
  /// rad, counter-clockwise as seen from the right side; at 0 the panel's y axis runs along the
  /// segment towards its higher end.
  double turn = 0.0;
};

/// A panel lies in a plane (x, y), in metres. Seen from the right side of its fabric, its outline
/// runs counter-clockwise: an outline that runs clockwise is cut from the fabric turned over.
struct Panel {
  std::string name;
  std::string fabric;
  int layer = 0;                                    ///< 0 is the nearest to the body
  Eigen::Vector2d warp = Eigen::Vector2d::UnitY();  ///< direction of the grain, of length 1
  std::vector<Outline> outlines;                    ///< its own, then those of its holes
  /// What is drawn on it and not cut: a point each, as for a button, or a line of more (m).
  std::vector<std::vector<Eigen::Vector2d>> marks = {};
  /// From its plane, as z = 0, into the world frame (m); or where it is laid on.
  std::variant<Eigen::Isometry3d, OnCarrier> placement = Eigen::Isometry3d::Identity();
};

/// One side of a seam: successive edges of an outline.
struct SeamSide {
  int panel = 0;
  int outline = 0;  ///< 0, or 1 and more for a hole
  int first = 0;    ///< edge, and
  int last = 0;  ///< edge, in the direction of the outline; may lie before the first: it is closed
  bool reversed = false;  ///< sewn from the end of the last edge to the start of the first
};

/// Two sides that are sewn together from start to end.
struct Seam {
  std::array<SeamSide, 2> sides;
  double easing = kUsualEasing;  ///< allowed difference of lengths, of the longer one
};

/// A place on a panel, in its plane (m).
struct PlaceOnPanel {
  int panel = 0;
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
};

/// Two places that are fastened to each other, as by a button, where the garment is worn.
struct Fastening {
  std::string name;
  std::array<PlaceOnPanel, 2> places;
};

struct Pattern {
  std::string source;  ///< where it comes from
  std::vector<Carrier> carriers;
  std::vector<Panel> panels;
  std::vector<Seam> seams;  ///< darts, too: seams of two edges that meet
  std::vector<Fastening> fastenings = {};
};

/// m^2, of a panel without its holes. Exact to rounding.
double areaOf(const Panel& panel);
/// Whether the outline runs clockwise in its plane.
bool isTurnedOver(const Panel& panel);
/// The edges of a side, in the direction of the outline.
/// @param side of a panel of the pattern
std::vector<int> edgesOf(const Pattern& pattern, const SeamSide& side);
/// m, of all edges of the side. @param side of a panel of the pattern
double lengthOf(const Pattern& pattern, const SeamSide& side);
/// Whether it is a dart: two edges of one outline that meet in a corner, sewn from it.
bool isDart(const Pattern& pattern, const Seam& seam);
/// How much the lengths of its sides differ, of the longer one.
double lengthDifference(const Pattern& pattern, const Seam& seam);

/// An edge in messages: "panel 'front', edge 2 'hem'", "panel 'front', hole 0, edge 1".
std::string describeEdge(const Panel& panel, int outline, int edge);

/// @param file the pattern's, for messages
/// @throws std::invalid_argument naming file, panel, edge, the value and what is allowed, if there
///   is no panel or more of anything than is allowed, an outline is open, touches itself or
///   another (by an exact test of lines no farther than kCrossingTolerance from it), a hole lies
///   outside, an edge or area is too small, a number is not finite or too large, a name is given
///   twice, a carrier is unknown, the sides of a seam do not exist, share an edge or differ in
///   length by more than its easing, or a place to fasten is on no panel
void requireSound(const Pattern& pattern, const std::string& file);

}  // namespace haptex::garment
