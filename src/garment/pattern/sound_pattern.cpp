// What is refused in a pattern.
#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "haptex/base/require.h"
#include "haptex/garment/pattern/outline_crossing.h"
#include "haptex/garment/pattern/pattern.h"

namespace haptex::garment {
namespace {

using base::refuse;
using Eigen::Vector2d;

constexpr double kLargestAngle = 2.0 * M_PI;  // rad

class SoundPattern {
 public:
  SoundPattern(const Pattern& pattern, const std::string& file) : pattern_(pattern), file_(file) {}

  void require() const {
    requireCount("panels", pattern_.panels.size(), 1, kMostPanels);
    requireCount("seams", pattern_.seams.size(), 0, kMostSeams);
    requireCount("fasteners", pattern_.fastenings.size(), 0, kMostSeams);
    requireCount("points", countPoints(), 1, kMostPatternPoints);
    std::set<std::string> carriers, names;
    for (const Carrier& carrier : pattern_.carriers) {
      if (!carriers.insert(carrier.name).second) {
        refuse(file_, ": carrier '", carrier.name, "' is there twice: names must differ");
      }
    }
    for (const Panel& panel : pattern_.panels) {
      if (panel.name.empty()) refuse(file_, ": a panel has no name: every one must have its own");
      if (!names.insert(panel.name).second) {
        refuse(file_, ": panel '", panel.name, "' is there twice: names must differ");
      }
      requirePanel(panel);
      requirePlacement(panel, carriers);
    }
    for (std::size_t i = 0; i < pattern_.seams.size(); ++i) requireSeam(i);
    std::set<std::string> fastenings;
    for (const Fastening& fastening : pattern_.fastenings) {
      if (!fastenings.insert(fastening.name).second) {
        refuse(file_, ": fastener '", fastening.name, "' is there twice: names must differ");
      }
      for (const PlaceOnPanel& place : fastening.places) requirePlace(place, fastening.name);
    }
  }

 private:
  void requireCount(const std::string& what, std::size_t count, std::size_t least,
                    std::size_t most) const {
    if (count >= least && count <= most) return;
    refuse(file_, ": has ", count, " ", what, ": allowed are ", least, " to ", most);
  }

  std::size_t countPoints() const {
    std::size_t points = 0;
    for (const Panel& panel : pattern_.panels) {
      for (const Outline& outline : panel.outlines) {
        for (const Edge& edge : outline) points += edge.curve.points().size();
      }
      for (const auto& mark : panel.marks) points += mark.size();
    }
    return points;
  }

  std::string at(const Panel& panel) const { return file_ + ": panel '" + panel.name + "'"; }
  std::string at(const Panel& panel, int outline, int edge) const {
    return file_ + ": " + describeEdge(panel, outline, edge);
  }

  void requirePanel(const Panel& panel) const {
    std::size_t edges = 0;
    for (const Outline& outline : panel.outlines) edges += outline.size();
    if (panel.outlines.empty() || edges > kMostEdges) {
      refuse(at(panel), ": has ", edges, " edges: allowed are 1 to ", kMostEdges);
    }
    if (panel.layer < 0 || panel.layer > kLargestLayer) {
      refuse(at(panel), ": layer is ", panel.layer, ": allowed are 0 to ", kLargestLayer);
    }
    if (!(std::abs(panel.warp.norm() - 1.0) < 1e-9)) {
      refuse(at(panel), ": the direction of the grain is (", panel.warp.x(), ", ", panel.warp.y(),
             "): must be of length 1");
    }
    std::set<std::string> names;
    for (std::size_t k = 0; k < panel.outlines.size(); ++k) {
      requireOutline(panel, static_cast<int>(k), names);
    }
    if (panel.marks.size() > kMostEdges) {
      refuse(at(panel), ": has ", panel.marks.size(), " marks: allowed are up to ", kMostEdges);
    }
    for (const auto& mark : panel.marks) {
      for (const Vector2d& point : mark) requireCoordinates(point, at(panel) + ": a mark");
    }
    requireNoCrossing(panel);
    const double area = areaOf(panel);
    if (!(area >= kSmallestArea)) {
      refuse(at(panel), ": its area is ", area, " m^2: allowed is >= ", kSmallestArea);
    }
  }

  void requireOutline(const Panel& panel, int k, std::set<std::string>& names) const {
    const Outline& outline = panel.outlines[k];
    const int count = static_cast<int>(outline.size());
    if (count == 0) refuse(at(panel), ": outline ", k, " has no edge: allowed are 1 or more");
    for (int i = 0; i < count; ++i) {
      const Curve& curve = outline[i].curve;
      requirePoints(curve, at(panel, k, i));
      const Vector2d& next = outline[(i + 1) % count].curve.start();
      const double gap = (next - curve.end()).norm();
      if (gap > kJoin) {
        refuse(at(panel, k, i), ": ends at (", curve.end().x(), ", ", curve.end().y(), "), ", gap,
               " m from where edge ", (i + 1) % count,
               " starts: the outline is open, allowed is a gap of ", kJoin, " m");
      }
      const std::string& name = outline[i].name;
      if (!name.empty() && !names.insert(name).second) {
        refuse(at(panel, k, i), ": another edge has the same name: names must differ");
      }
    }
  }

  static void requireCoordinates(const Vector2d& point, const std::string& where) {
    if (point.allFinite() && point.cwiseAbs().maxCoeff() <= kLargestCoordinate) return;
    refuse(where, ": has the point (", point.x(), ", ", point.y(), "): allowed are up to ",
           kLargestCoordinate, " m in each direction");
  }

  static void requirePoints(const Curve& curve, const std::string& where) {
    for (const Vector2d& point : curve.points()) requireCoordinates(point, where);
    if (!(curve.length() >= kShortestEdge)) {
      refuse(where, ": is ", curve.length(), " m long: allowed is >= ", kShortestEdge, " m");
    }
  }

  void requireNoCrossing(const Panel& panel) const {
    const std::vector<OutlineLine> lines = straightLines(panel.outlines, kCrossingTolerance);
    if (lines.size() > kMostLines) {
      refuse(at(panel), ": its outlines are ", lines.size(), " straight lines at a tolerance of ",
             kCrossingTolerance, " m: allowed are up to ", kMostLines);
    }
    if (const auto crossing = findCrossing(lines)) {
      const auto& [a, b] = *crossing;
      refuse(at(panel, a.outline, a.edge), ": ",
             a == b ? "crosses itself"
                    : "crosses or touches " + describeEdge(panel, b.outline, b.edge),
             ": outlines may meet in the corners between successive edges only");
    }
    const int outside = findHoleOutside(lines);
    if (outside >= 0) {
      refuse(at(panel), ": hole ", outside,
             " lies outside of the outline or in another hole: must lie inside");
    }
  }

  void requirePlacement(const Panel& panel, const std::set<std::string>& carriers) const {
    if (const auto* pose = std::get_if<Eigen::Isometry3d>(&panel.placement)) {
      const double largest = pose->translation().cwiseAbs().maxCoeff();
      if (!pose->matrix().allFinite() || !(largest <= kLargestCoordinate)) {
        refuse(at(panel), ": its position has a coordinate of ", largest,
               " m: allowed are finite ones up to ", kLargestCoordinate, " m");
      }
      return;
    }
    const auto& on = std::get<OnCarrier>(panel.placement);
    if (carriers.count(on.carrier) == 0) {
      std::string known;
      for (const std::string& name : carriers) known += (known.empty() ? "" : ", ") + name;
      refuse(at(panel), ": carrier '", on.carrier,
             "' is unknown: ", known.empty() ? "there is none" : "there are " + known);
    }
    const double angle = on.angle.value_or(0.0), along = on.along.value_or(0.0);
    if (!(std::abs(angle) <= kLargestAngle && std::abs(on.turn) <= kLargestAngle && along >= -2.0 &&
          along <= 3.0)) {
      refuse(at(panel), ": lies at angle ", angle, " rad, ", along,
             " along its carrier, turned by ", on.turn,
             " rad: allowed are angles of -2 pi to 2 pi and -2 to 3");
    }
  }

  void requirePlace(const PlaceOnPanel& place, const std::string& name) const {
    const std::string where = file_ + ": fastener '" + name + "'";
    requirePanelExists(place.panel, where);
    const Panel& panel = pattern_.panels[place.panel];
    requireCoordinates(place.at, where);
    const std::vector<OutlineLine> lines = straightLines(panel.outlines, kCrossingTolerance);
    bool inside = isInside(place.at, lines, 0);
    for (int hole = 1; hole < static_cast<int>(panel.outlines.size()); ++hole) {
      inside = inside && !isInside(place.at, lines, hole);
    }
    if (inside) return;
    refuse(where, ": (", place.at.x(), ", ", place.at.y(), ") is not on panel '", panel.name,
           "': allowed are places within its outline and outside of its holes");
  }

  void requirePanelExists(int panel, const std::string& where) const {
    const int panels = static_cast<int>(pattern_.panels.size());
    if (panel >= 0 && panel < panels) return;
    refuse(where, ": has panel ", panel, ": allowed are 0 to ", panels - 1);
  }

  void requireSeam(std::size_t index) const {
    const Seam& seam = pattern_.seams[index];
    const std::string where = file_ + ": seam " + std::to_string(index);
    for (const SeamSide& side : seam.sides) requireSide(side, where);
    requireApart(seam, where);
    if (!(seam.easing >= 0.0 && seam.easing <= kLargestEasing)) {
      refuse(where, ": easing is ", seam.easing, ": allowed are 0 to ", kLargestEasing);
    }
    const double difference = lengthDifference(pattern_, seam);
    if (difference > seam.easing) {
      refuse(where, " of ", describeSide(seam.sides[0]), " and ", describeSide(seam.sides[1]),
             ": the lengths differ by ", difference, " of the longer one: its easing allows ",
             seam.easing);
    }
  }

  void requireSide(const SeamSide& side, const std::string& where) const {
    requirePanelExists(side.panel, where);
    const Panel& panel = pattern_.panels[side.panel];
    const int outlines = static_cast<int>(panel.outlines.size());
    if (side.outline < 0 || side.outline >= outlines) {
      refuse(where, ": has hole ", side.outline - 1, " of panel '", panel.name, "': it has ",
             outlines - 1);
    }
    const int edges = static_cast<int>(panel.outlines[side.outline].size());
    for (const int edge : {side.first, side.last}) {
      if (edge >= 0 && edge < edges) continue;
      refuse(where, ": has edge ", edge, " of panel '", panel.name, "': allowed are 0 to ",
             edges - 1);
    }
  }

  void requireApart(const Seam& seam, const std::string& where) const {
    const auto& [a, b] = seam.sides;
    if (a.panel != b.panel || a.outline != b.outline) return;
    const std::vector<int> first = edgesOf(pattern_, a), second = edgesOf(pattern_, b);
    for (const int edge : first) {
      if (std::find(second.begin(), second.end(), edge) == second.end()) continue;
      refuse(where, ": sews ", describeEdge(pattern_.panels[a.panel], a.outline, edge),
             " to itself: the sides of a seam must be different edges");
    }
  }

  std::string describeSide(const SeamSide& side) const {
    const Panel& panel = pattern_.panels[side.panel];
    const std::string text = describeEdge(panel, side.outline, side.first);
    if (side.first == side.last) return text;
    return text + " to " + std::to_string(side.last);
  }

  const Pattern& pattern_;
  const std::string& file_;
};

}  // namespace

void requireSound(const Pattern& pattern, const std::string& file) {
  SoundPattern(pattern, file).require();
}

}  // namespace haptex::garment
