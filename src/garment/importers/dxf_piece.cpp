#include "haptex/garment/importers/dxf_piece.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <set>
#include <utility>

#include "haptex/base/require.h"

namespace haptex::garment {
namespace {

using base::refuse;
using Eigen::Vector2d;
using Points = std::vector<Vector2d>;

constexpr double kSame = 1e-5;        // m: points that near are one
constexpr double kJoinLines = 1e-4;   // m: ends of lines that near are joined
constexpr double kOnOutline = 1e-3;   // m: of mirror lines
constexpr double kNotchReach = 0.03;  // m: of notches of the cut from the sew line
constexpr double kNearSplit = 2e-3;   // m: no two divisions are nearer
constexpr double kCorner = M_PI / 6.0;

/// A closed polygon, some of whose corners divide it into edges.
struct Polygon {
  Points points;
  std::vector<bool> divides;

  std::size_t next(std::size_t i) const { return i + 1 == points.size() ? 0 : i + 1; }
  std::size_t before(std::size_t i) const { return i == 0 ? points.size() - 1 : i - 1; }
};

bool onLayer(const DxfEntity& entity, const char* layer) { return entity.layer == layer; }

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

class PieceReader {
 public:
  PieceReader(const DxfBlock& block, std::string where, double metre,
              std::vector<std::string>& notes)
      : block_(block), where_(std::move(where)), metre_(metre), notes_(notes) {}

  Panel read() {
    Panel panel;
    panel.warp = readGrain();
    std::vector<Polygon> polygons = {readOutline()};
    for (Polygon& hole : loopsOf("11", Open::kRefused)) polygons.push_back(std::move(hole));
    for (const DxfEntity& entity : block_.entities) {
      if (onLayer(entity, "8") && entity.points.size() >= 2) panel.marks.push_back(scaled(entity));
      if (onLayer(entity, "13") && entity.kind == DxfEntity::Kind::kPoint) {
        panel.marks.push_back(scaled(entity));
      }
    }
    for (Polygon& polygon : polygons) divide(polygon);
    unfold(polygons, panel.marks);
    showRightSide(polygons.front());
    for (const Polygon& polygon : polygons) panel.outlines.push_back(outlineOf(polygon));
    return panel;
  }

 private:
  Points scaled(const DxfEntity& entity) const {
    Points points;
    for (const Vector2d& point : entity.points) points.push_back(point * metre_);
    return points;
  }

  void requireCount(const char* layer, const char* what, std::size_t count,
                    std::size_t most) const {
    if (count <= most) return;
    refuse(where_, ": layer ", layer, " has ", count, " ", what, ": allowed are up to ", most);
  }

  Points pointsOn(const char* layer, std::size_t most) const {
    Points points;
    for (const DxfEntity& entity : block_.entities) {
      if (!onLayer(entity, layer) || entity.kind != DxfEntity::Kind::kPoint) continue;
      points.push_back(entity.points.front() * metre_);
    }
    requireCount(layer, "points", points.size(), most);
    return points;
  }

  Vector2d readGrain() const {
    for (const DxfEntity& entity : block_.entities) {
      if (!onLayer(entity, "7") || entity.points.size() < 2) continue;
      const Vector2d along = (entity.points.back() - entity.points.front()) * metre_;
      if (!(along.norm() > kSame)) refuse(where_, ": the grain line (layer 7) has no length");
      return along.normalized();
    }
    notes_.push_back(where_ + ": has no grain line (layer 7): taken along y");
    return Vector2d::UnitY();
  }

  Polygon readOutline() const {
    std::vector<Polygon> cut = loopsOf("1", Open::kRefused);
    if (cut.size() != 1) {
      refuse(where_, ": has ", cut.size(), " outlines (layer 1): allowed is one");
    }
    const bool any_sew_line = std::any_of(block_.entities.begin(), block_.entities.end(),
                                          [](const auto& entity) { return onLayer(entity, "14"); });
    std::vector<Polygon> sewn = loopsOf("14", Open::kLeftOut);
    if (sewn.size() == 1) return sewn.front();
    if (any_sew_line) {
      notes_.push_back(where_ +
                       ": its sew lines (layer 14) are not one closed line: the outline is "
                       "that of layer 1");
    }
    return cut.front();
  }

  enum class Open { kRefused, kLeftOut };

  // Outlines may be drawn as one polyline, or as several and lines that follow each other.
  std::vector<Polygon> loopsOf(const char* layer, Open open) const {
    std::vector<Polygon> loops;
    std::vector<Points> pieces;
    for (const DxfEntity& entity : block_.entities) {
      if (!onLayer(entity, layer) || entity.points.size() < 2) continue;
      Points points = scaled(entity);
      const bool closed = entity.closed || (points.back() - points.front()).norm() <= kSame;
      if (closed) {
        loops.push_back(polygonOf({points}, layer));
      } else {
        pieces.push_back(std::move(points));
      }
    }
    requireCount(layer, "lines", pieces.size(), kMostEdges);
    while (!pieces.empty()) {
      const std::vector<Points> chain = takeChain(pieces);
      const double gap = (chain.back().back() - chain.front().front()).norm();
      if (gap <= kJoinLines) {
        loops.push_back(polygonOf(chain, layer));
      } else if (open == Open::kRefused) {
        refuse(where_, ": the outline of layer ", layer, " is open, its ends are ", gap,
               " m apart: allowed are ", kJoinLines, " m");
      } else {
        return {};
      }
    }
    return loops;
  }

  // The first piece and those that follow its end, turned around where need be.
  static std::vector<Points> takeChain(std::vector<Points>& pieces) {
    std::vector<Points> chain = {pieces.front()};
    pieces.erase(pieces.begin());
    for (;;) {
      const Vector2d end = chain.back().back();
      if ((end - chain.front().front()).norm() <= kJoinLines && chain.size() > 1) return chain;
      const auto next = std::find_if(pieces.begin(), pieces.end(), [&](const Points& piece) {
        return (piece.front() - end).norm() <= kJoinLines ||
               (piece.back() - end).norm() <= kJoinLines;
      });
      if (next == pieces.end()) return chain;
      if ((next->front() - end).norm() > kJoinLines) std::reverse(next->begin(), next->end());
      chain.push_back(*next);
      pieces.erase(next);
    }
  }

  // Divided where the pieces meet.
  Polygon polygonOf(const std::vector<Points>& chain, const char* layer) const {
    Polygon polygon;
    for (const Points& piece : chain) {
      const double join = polygon.points.empty() ? 0.0 : kJoinLines;
      for (std::size_t i = 0; i < piece.size(); ++i) {
        const double same = i == 0 ? std::max(join, kSame) : kSame;
        if (polygon.points.empty() || (piece[i] - polygon.points.back()).norm() > same) {
          polygon.points.push_back(piece[i]);
          polygon.divides.push_back(false);
        }
        if (i == 0) polygon.divides.back() = chain.size() > 1;
      }
    }
    while (polygon.points.size() > 1 && (polygon.points.back() - polygon.points.front()).norm() <=
                                            (chain.size() > 1 ? kJoinLines : kSame)) {
      polygon.points.pop_back();
      polygon.divides.pop_back();
    }
    requireCount(layer, "points in an outline", polygon.points.size(), kMostLines);
    if (polygon.points.size() < 3) {
      refuse(where_, ": the outline of layer ", layer, " has ", polygon.points.size(),
             " points: allowed are 3 or more");
    }
    return polygon;
  }

  // At turn points, or at corners where there is none, and at notches.
  void divide(Polygon& polygon) const {
    const Points turns = pointsOn("2", kMostLines), curves = pointsOn("3", kMostLines);
    const auto lies_on = [](const Points& points, const Vector2d& at) {
      return std::any_of(points.begin(), points.end(),
                         [&](const Vector2d& point) { return (point - at).norm() <= 1e-4; });
    };
    for (std::size_t i = 0; i < polygon.points.size(); ++i) {
      if (turns.empty()) {
        const Vector2d in = polygon.points[i] - polygon.points[polygon.before(i)];
        const Vector2d out = polygon.points[polygon.next(i)] - polygon.points[i];
        const double turn = std::abs(std::atan2(cross(in, out), in.dot(out)));
        if (turn > kCorner && !lies_on(curves, polygon.points[i])) polygon.divides[i] = true;
      } else {
        if (lies_on(turns, polygon.points[i])) polygon.divides[i] = true;
      }
    }
    for (const Vector2d& notch : pointsOn("4", kMostEdges)) divideAt(polygon, notch);
  }

  static void divideAt(Polygon& polygon, const Vector2d& notch) {
    double nearest = kNotchReach;
    std::size_t after = 0;
    Vector2d at = Vector2d::Zero();
    for (std::size_t i = 0; i < polygon.points.size(); ++i) {
      const Vector2d& a = polygon.points[i];
      const Vector2d ab = polygon.points[polygon.next(i)] - a;
      const double t = std::clamp((notch - a).dot(ab) / ab.squaredNorm(), 0.0, 1.0);
      const Vector2d point = a + t * ab;
      if ((point - notch).norm() >= nearest) continue;
      nearest = (point - notch).norm();
      after = i;
      at = point;
    }
    if (nearest == kNotchReach) return;
    for (std::size_t i = 0; i < polygon.points.size(); ++i) {
      if (polygon.divides[i] && (polygon.points[i] - at).norm() <= kNearSplit) return;
    }
    for (const std::size_t i : {after, polygon.next(after)}) {
      if ((polygon.points[i] - at).norm() > kSame) continue;
      polygon.divides[i] = true;
      return;
    }
    polygon.points.insert(polygon.points.begin() + static_cast<std::ptrdiff_t>(after) + 1, at);
    polygon.divides.insert(polygon.divides.begin() + static_cast<std::ptrdiff_t>(after) + 1, true);
  }

  // A mirror line that is a side of the outline is the fold of a half piece.
  void unfold(std::vector<Polygon>& polygons, std::vector<Points>& marks) const {
    for (const DxfEntity& entity : block_.entities) {
      if (!onLayer(entity, "6") || entity.points.size() < 2) continue;
      const Vector2d from = entity.points.front() * metre_, to = entity.points.back() * metre_;
      if (!unfoldOutline(polygons.front(), from, to)) continue;
      const auto mirrored = [&](const Vector2d& point) { return mirror(point, from, to); };
      for (std::size_t k = polygons.size() - 1; k > 0; --k) {
        Polygon hole = polygons[k];
        std::transform(hole.points.begin(), hole.points.end(), hole.points.begin(), mirrored);
        polygons.push_back(std::move(hole));
      }
      for (std::size_t m = marks.size(); m > 0; --m) {
        Points mark = marks[m - 1];
        std::transform(mark.begin(), mark.end(), mark.begin(), mirrored);
        marks.push_back(std::move(mark));
      }
      return;
    }
  }

  static Vector2d mirror(const Vector2d& point, const Vector2d& from, const Vector2d& to) {
    const Vector2d along = (to - from).normalized();
    const Vector2d foot = from + along * along.dot(point - from);
    return 2.0 * foot - point;
  }

  static bool unfoldOutline(Polygon& polygon, const Vector2d& from, const Vector2d& to) {
    if (!((to - from).norm() > kSame)) return false;
    const Vector2d along = (to - from).normalized();
    const auto on_fold = [&](const Vector2d& point) {
      return std::abs(cross(along, point - from)) <= kOnOutline;
    };
    const std::size_t count = polygon.points.size();
    // The first corner of the fold, and the last one.
    std::size_t begin = count;
    for (std::size_t i = 0; i < count; ++i) {
      if (on_fold(polygon.points[i]) && !on_fold(polygon.points[polygon.before(i)])) begin = i;
    }
    if (begin == count) return false;
    std::size_t end = begin;
    while (on_fold(polygon.points[polygon.next(end)])) end = polygon.next(end);
    if (end == begin) return false;
    Polygon whole;
    for (std::size_t i = end; i != begin; i = polygon.next(i)) {
      whole.points.push_back(polygon.points[i]);
      whole.divides.push_back(i != end && polygon.divides[i]);
    }
    whole.points.push_back(polygon.points[begin]);
    whole.divides.push_back(false);
    for (std::size_t i = whole.points.size() - 1; i-- > 1;) {
      whole.points.push_back(mirror(whole.points[i], from, to));
      whole.divides.push_back(static_cast<bool>(whole.divides[i]));
    }
    // Where the two halves meet in a corner, they divide.
    for (const std::size_t i : {std::size_t{0}, (whole.points.size()) / 2}) {
      const Vector2d in = whole.points[i] - whole.points[whole.before(i)];
      const Vector2d out = whole.points[whole.next(i)] - whole.points[i];
      whole.divides[i] = std::abs(std::atan2(cross(in, out), in.dot(out))) > kCorner;
    }
    polygon = std::move(whole);
    return true;
  }

  // In these files it means nothing which way round an outline is drawn.
  static void showRightSide(Polygon& polygon) {
    double area = 0.0;
    for (std::size_t i = 0; i < polygon.points.size(); ++i) {
      area += cross(polygon.points[i], polygon.points[polygon.next(i)]);
    }
    if (area >= 0.0) return;
    std::reverse(polygon.points.begin(), polygon.points.end());
    std::reverse(polygon.divides.begin(), polygon.divides.end());
  }

  // From one corner that divides it to the next; from the first point if there is none.
  static Outline outlineOf(const Polygon& polygon) {
    const std::size_t count = polygon.points.size();
    std::size_t begin = 0;
    while (begin < count && !polygon.divides[begin]) ++begin;
    if (begin == count) begin = 0;
    Outline outline;
    Points points = {polygon.points[begin]};
    for (std::size_t step = 1; step <= count; ++step) {
      const std::size_t i = (begin + step) % count;
      points.push_back(polygon.points[i]);
      if (!polygon.divides[i] && i != begin) continue;
      outline.push_back({Curve::line(points)});
      points = {polygon.points[i]};
    }
    return outline;
  }

  const DxfBlock& block_;
  const std::string where_;
  const double metre_;
  std::vector<std::string>& notes_;
};

std::string lower(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

}  // namespace

bool isPiece(const DxfBlock& block) {
  return std::any_of(block.entities.begin(), block.entities.end(), [](const DxfEntity& entity) {
    return onLayer(entity, "1") && entity.points.size() >= 2;
  });
}

std::string systemText(const std::vector<DxfEntity>& entities, const std::string& key) {
  for (const DxfEntity& entity : entities) {
    if (entity.kind != DxfEntity::Kind::kText) continue;
    const std::size_t colon = entity.text.find(':');
    if (colon == std::string::npos || lower(entity.text.substr(0, colon)) != lower(key)) continue;
    const std::size_t begin = entity.text.find_first_not_of(" \t", colon + 1);
    if (begin != std::string::npos) return entity.text.substr(begin);
  }
  return "";
}

Panel readPiece(const DxfBlock& block, const std::string& where, double metre,
                std::vector<std::string>& notes) {
  return PieceReader(block, where, metre, notes).read();
}

}  // namespace haptex::garment
