// Whether outlines cross themselves or each other, decided without rounding.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "haptex/garment/pattern/pattern.h"

namespace haptex::garment {

struct OutlineEdge {
  int outline = 0;
  int edge = 0;
  bool operator==(const OutlineEdge& other) const {
    return outline == other.outline && edge == other.edge;
  }
};

/// A straight piece of an outline.
struct OutlineLine {
  Eigen::Vector2d start, end;  ///< m
  OutlineEdge of;
};

/// Lines of closed outlines, one outline after the other, that are no farther from the edges than
/// a tolerance (m, > 0): each starts where the one before it in its outline ends.
std::vector<OutlineLine> straightLines(const std::vector<Outline>& outlines, double tolerance);

/// Two edges that have a point in common beside the corner between successive lines, if there are
/// any.
/// @param lines of closed outlines, as straightLines() makes them
std::optional<std::pair<OutlineEdge, OutlineEdge>> findCrossing(
    const std::vector<OutlineLine>& lines);

/// Whether a point lies inside of an outline, exactly. A point on it may lie on either side.
/// @param outline whose lines count, from 0
bool isInside(const Eigen::Vector2d& point, const std::vector<OutlineLine>& lines, int outline);

/// The first hole that does not lie inside of the first outline or lies in another hole, from 0;
/// -1 if there is none.
/// @param lines of outlines that do not cross
int findHoleOutside(const std::vector<OutlineLine>& lines);

}  // namespace haptex::garment
