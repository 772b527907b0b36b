#include "haptex/garment/pattern/outline_crossing.h"

#include <algorithm>
#include <numeric>

#include "haptex/garment/pattern/plane_predicates.h"

namespace haptex::garment {
namespace {

using Eigen::Vector2d;

// Successive lines share a corner; they cross if they run back over each other.
bool foldsBack(const OutlineLine& line, const OutlineLine& next) {
  return turn(line.start, line.end, next.end) == 0 &&
         (line.start - line.end).dot(next.end - line.end) > 0.0;
}

bool cross(const OutlineLine& a, const OutlineLine& b) {
  if (a.of.outline != b.of.outline) return touch(a.start, a.end, b.start, b.end);
  const bool before = a.end == b.start, after = b.end == a.start;
  if (before && after) return true;  // there and back
  if (before) return foldsBack(a, b);
  if (after) return foldsBack(b, a);
  return touch(a.start, a.end, b.start, b.end);
}

// Whether one lies above the other.
bool apart(const OutlineLine& a, const OutlineLine& b) {
  return std::max(a.start.y(), a.end.y()) < std::min(b.start.y(), b.end.y()) ||
         std::max(b.start.y(), b.end.y()) < std::min(a.start.y(), a.end.y());
}

}  // namespace

std::vector<OutlineLine> straightLines(const std::vector<Outline>& outlines, double tolerance) {
  std::vector<OutlineLine> lines;
  for (std::size_t k = 0; k < outlines.size(); ++k) {
    const std::size_t begin = lines.size();
    for (std::size_t i = 0; i < outlines[k].size(); ++i) {
      const std::vector<Vector2d> points = outlines[k][i].curve.flattened(tolerance);
      for (std::size_t p = 1; p < points.size(); ++p) {
        if (points[p] == points[p - 1]) continue;
        lines.push_back({points[p - 1], points[p], {static_cast<int>(k), static_cast<int>(i)}});
      }
    }
    // Ends that differ by rounding are one corner.
    for (std::size_t l = begin; l < lines.size(); ++l) {
      lines[l].end = lines[l + 1 < lines.size() ? l + 1 : begin].start;
    }
  }
  return lines;
}

std::optional<std::pair<OutlineEdge, OutlineEdge>> findCrossing(
    const std::vector<OutlineLine>& lines) {
  const auto low = [&](int i) { return std::min(lines[i].start.x(), lines[i].end.x()); };
  std::vector<int> order(lines.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&](int i, int j) { return std::make_pair(low(i), i) < std::make_pair(low(j), j); });
  for (std::size_t i = 0; i < order.size(); ++i) {
    const OutlineLine& a = lines[order[i]];
    const double high = std::max(a.start.x(), a.end.x());
    for (std::size_t j = i + 1; j < order.size() && low(order[j]) <= high; ++j) {
      const OutlineLine& b = lines[order[j]];
      if (apart(a, b) || !cross(a, b)) continue;
      const bool first = order[i] < order[j];
      return std::make_pair(first ? a.of : b.of, first ? b.of : a.of);
    }
  }
  return std::nullopt;
}

// A ray from it along +x leaves through the outline an odd number of times.
bool isInside(const Vector2d& point, const std::vector<OutlineLine>& lines, int outline) {
  bool odd = false;
  for (const OutlineLine& line : lines) {
    if (line.of.outline != outline || (line.start.y() > point.y()) == (line.end.y() > point.y())) {
      continue;
    }
    const bool up = line.end.y() > line.start.y();
    if ((turn(line.start, line.end, point) > 0) == up) odd = !odd;
  }
  return odd;
}

int findHoleOutside(const std::vector<OutlineLine>& lines) {
  const int outlines = lines.empty() ? 0 : lines.back().of.outline + 1;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const int hole = lines[i].of.outline;
    if (hole == lines[i - 1].of.outline) continue;  // its first line is enough
    for (int other = 0; other < outlines; ++other) {
      if (other != hole && isInside(lines[i].start, lines, other) != (other == 0)) return hole - 1;
    }
  }
  return -1;
}

}  // namespace haptex::garment
