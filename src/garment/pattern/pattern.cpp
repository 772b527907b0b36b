#include "haptex/garment/pattern/pattern.h"

#include <algorithm>
#include <cmath>

namespace haptex::garment {
namespace {

double sweptArea(const Outline& outline) {
  double area = 0.0;
  for (const Edge& edge : outline) area += edge.curve.sweptArea();
  return area;
}

}  // namespace

double areaOf(const Panel& panel) {
  double area = 0.0;
  for (std::size_t k = 0; k < panel.outlines.size(); ++k) {
    const double part = std::abs(sweptArea(panel.outlines[k]));
    area += k == 0 ? part : -part;
  }
  return area;
}

bool isTurnedOver(const Panel& panel) {
  return !panel.outlines.empty() && sweptArea(panel.outlines.front()) < 0.0;
}

std::vector<int> edgesOf(const Pattern& pattern, const SeamSide& side) {
  const int count = static_cast<int>(pattern.panels[side.panel].outlines[side.outline].size());
  std::vector<int> edges = {side.first};
  while (edges.back() != side.last) edges.push_back((edges.back() + 1) % count);
  return edges;
}

double lengthOf(const Pattern& pattern, const SeamSide& side) {
  const Outline& outline = pattern.panels[side.panel].outlines[side.outline];
  double length = 0.0;
  for (const int edge : edgesOf(pattern, side)) length += outline[edge].curve.length();
  return length;
}

bool isDart(const Pattern& pattern, const Seam& seam) {
  const auto& [a, b] = seam.sides;
  if (a.panel != b.panel || a.outline != b.outline || a.reversed == b.reversed) return false;
  const int count = static_cast<int>(pattern.panels[a.panel].outlines[a.outline].size());
  const SeamSide& forward = a.reversed ? b : a;
  const SeamSide& backward = a.reversed ? a : b;
  // The corner is where both start, or where both end.
  return (backward.last + 1) % count == forward.first ||
         (forward.last + 1) % count == backward.first;
}

double lengthDifference(const Pattern& pattern, const Seam& seam) {
  const double a = lengthOf(pattern, seam.sides[0]), b = lengthOf(pattern, seam.sides[1]);
  return std::abs(a - b) / std::max(a, b);
}

std::string describeEdge(const Panel& panel, int outline, int edge) {
  std::string text = "panel '" + panel.name + "'";
  if (outline > 0) text += ", hole " + std::to_string(outline - 1);
  text += ", edge " + std::to_string(edge);
  const std::string& name = panel.outlines[outline][edge].name;
  return name.empty() ? text : text + " '" + name + "'";
}

}  // namespace haptex::garment
