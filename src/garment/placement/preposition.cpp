#include "haptex/garment/placement/preposition.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "haptex/base/require.h"
#include "haptex/garment/placement/carrier_fit.h"
#include "haptex/garment/placement/overlaps.h"
#include "haptex/garment/placement/seam_placement.h"

namespace haptex::garment {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kFits = 3;  // of surfaces and places, each by the other
constexpr int kMostWidenings = 5;
constexpr double kRoom = 1.5;  // of the gap that a panel gets beside it, so that it can give way
constexpr double kFirstShift = 0.01;  // m
constexpr double kRow = 0.01;         // m, between heights at which panels are side by side

/// Panels of one layer on one carrier.
struct Ring {
  int carrier = 0;
  int layer = 0;
  int segment = 0;
  std::vector<int> panels;
  HeightRange range = {};
  CarrierSurface surface = {};
  double shift = 0.0;  // m, towards the segment's end
};

class Prepositioner {
 public:
  Prepositioner(const Pattern& pattern, const Body& body, std::vector<PanelMesh>& meshes)
      : pattern_(pattern), meshes_(meshes), gaps_(pattern.seams.size(), kSeamGap) {
    for (const Carrier& carrier : pattern.carriers) {
      segments_.push_back(segmentOf(carrier, body));
      axes_.try_emplace(segments_.back(), body, segments_.back());
    }
    ring_of_.assign(pattern.panels.size(), -1);
    for (std::size_t i = 0; i < pattern.panels.size(); ++i) addPanel(static_cast<int>(i));
    makeRings();
  }

  Preposition run(const Body& body) {
    for (int widening = 0;; ++widening) {
      for (int fit = 0; fit < (widening == 0 ? kFits : 1); ++fit) {
        fitSurfaces(widening == 0 && fit == 0);
        for (PanelToPlace& panel : panels_) panel.placed = widening > 0;
        placeBySeams(pattern_, gaps_, panels_);
        shiftRings();
      }
      layAll();
      overlaps_ = findOverlaps(joined(meshes_), body.vertices, body.triangles);
      if (widening == kMostWidenings || !widen(body)) break;
    }
    Preposition result;
    for (const Ring& ring : rings_) {
      for (const int panel : ring.panels) result.panels.push_back(report(ring, panel));
    }
    std::sort(result.panels.begin(), result.panels.end(),
              [](const LaidPanel& a, const LaidPanel& b) { return a.panel < b.panel; });
    for (const auto& [pair, count] : overlaps_) {
      result.overlaps.push_back({nameOf(pair[0]), nameOf(pair[1]), count});
    }
    return result;
  }

 private:
  static int segmentOf(const Carrier& carrier, const Body& body) {
    try {
      return segmentNamed(body, carrier.segment);
    } catch (const std::invalid_argument& error) {
      base::refuse("carrier '", carrier.name, "': ", error.what());
    }
  }

  std::string nameOf(int panel) const {
    const bool is_body = panel == static_cast<int>(meshes_.size());
    return is_body ? "body" : pattern_.panels[panel].name;
  }

  void addPanel(int index) {
    const Panel& panel = pattern_.panels[index];
    const auto* on = std::get_if<OnCarrier>(&panel.placement);
    panels_.push_back({PanelView(panel, on != nullptr ? on->turn : 0.0)});
    PanelToPlace& to_place = panels_.back();
    if (on == nullptr) {
      to_place.pose = std::get<Eigen::Isometry3d>(panel.placement);
      return;
    }
    const SegmentAxis& axis = axes_.at(segments_[carrierIndex(on->carrier)]);
    const double sign = axis.startsBelow() ? 1.0 : -1.0;
    if (on->angle) to_place.angle = sign * *on->angle;
    if (on->along) {
      to_place.height = (axis.startsBelow() ? *on->along : 1.0 - *on->along) * axis.length();
    }
    to_place.place.height = to_place.height.value_or(0.5 * axis.length());
    to_place.least_height = -axis.length();
    to_place.largest_height = 2.0 * axis.length();
  }

  int carrierIndex(const std::string& name) const {
    int index = 0;
    while (pattern_.carriers[index].name != name) ++index;
    return index;
  }

  void makeRings() {
    std::map<std::pair<int, int>, std::vector<int>> panels_of;  // by layer and carrier
    for (std::size_t i = 0; i < pattern_.panels.size(); ++i) {
      const Panel& panel = pattern_.panels[i];
      const auto* on = std::get_if<OnCarrier>(&panel.placement);
      if (on == nullptr) continue;
      panels_of[{panel.layer, carrierIndex(on->carrier)}].push_back(static_cast<int>(i));
    }
    for (auto& [key, panels] : panels_of) {
      for (const int panel : panels) ring_of_[panel] = static_cast<int>(rings_.size());
      rings_.push_back({key.second, key.first, segments_[key.second], std::move(panels)});
    }
  }

  /// @param heights_unknown no cones then, whose radius is of no use at other heights
  void fitSurfaces(bool heights_unknown) {
    std::map<int, HeightRange> ranges;  // by segment
    for (Ring& ring : rings_) {
      ring.range = rangeOf(ring);
      const auto [of_segment, is_first] = ranges.try_emplace(ring.segment, ring.range);
      if (is_first) continue;
      of_segment->second.low = std::min(of_segment->second.low, ring.range.low);
      of_segment->second.high = std::max(of_segment->second.high, ring.range.high);
    }
    std::map<int, SegmentAxis> axes = axes_;
    for (auto& [segment, axis] : axes) {
      if (ranges.count(segment) > 0) axis.centre(ranges.at(segment));
    }
    for (std::size_t i = 0; i < rings_.size(); ++i)
      fitSurface(i, axes.at(rings_[i].segment), heights_unknown);
  }

  HeightRange rangeOf(const Ring& ring) const {
    HeightRange range{std::numeric_limits<double>::infinity(),
                      -std::numeric_limits<double>::infinity()};
    for (const int index : ring.panels) {
      const PanelToPlace& panel = panels_[index];
      range.low = std::min(range.low, panel.place.height - panel.view.halfHeight());
      range.high = std::max(range.high, panel.place.height + panel.view.halfHeight());
    }
    return range;
  }

  void fitSurface(std::size_t index, const SegmentAxis& axis, bool heights_unknown) {
    Ring& ring = rings_[index];
    std::vector<NeededRadius> needed = axis.bodyRadii(ring.range);
    for (NeededRadius& radius : needed) radius.radius += kBodyMargin;
    addRows(ring, needed);
    for (std::size_t i = 0; i < index; ++i) {
      const Ring& inner = rings_[i];
      const double low = std::max(ring.range.low, inner.range.low);
      const double high = std::min(ring.range.high, inner.range.high);
      if (inner.segment != ring.segment || low > high) continue;
      for (const double height : {low, high}) {
        needed.push_back({height, inner.surface.radiusAt(height) + kLayerGap});
      }
    }
    ring.surface = axis.axis();
    const Carrier::Shape shape = pattern_.carriers[ring.carrier].shape;
    fitRadius(heights_unknown ? Carrier::Shape::kCylinder : shape, needed, ring.surface);
    for (const int panel : ring.panels) {
      panels_[panel].surface = ring.surface;
      panels_[panel].radius = ring.surface.radiusAt(0.5 * (ring.range.low + ring.range.high));
    }
  }

  /// What the panels need side by side, with a gap beside each of them.
  void addRows(const Ring& ring, std::vector<NeededRadius>& needed) const {
    const double rows = std::max(1.0, std::ceil((ring.range.high - ring.range.low) / kRow));
    for (double row = 0.5; row < rows; ++row) {
      const double height = ring.range.low + row / rows * (ring.range.high - ring.range.low);
      double width = 0.0;
      for (const int index : ring.panels) {
        const PanelToPlace& panel = panels_[index];
        const double here = panel.view.widthAt(height - panel.place.height);
        if (here > 0.0) width += here + kRoom * gapBeside(index);
      }
      needed.push_back({height, width / (2.0 * M_PI)});
    }
  }

  /// The largest of its seams within its ring.
  double gapBeside(int panel) const {
    double gap = kSeamGap;
    for (std::size_t i = 0; i < gaps_.size(); ++i) {
      const auto& sides = pattern_.seams[i].sides;
      const bool has = sides[0].panel == panel || sides[1].panel == panel;
      if (has && ring_of_[sides[0].panel] == ring_of_[sides[1].panel])
        gap = std::max(gap, gaps_[i]);
    }
    return gap;
  }

  void layAll() {
    for (const Ring& ring : rings_) {
      for (const int index : ring.panels) {
        const PanelToPlace& panel = panels_[index];
        mesh::ClothMesh& mesh = meshes_[index].mesh;
        if (flat_.count(index) == 0) flat_[index] = mesh.initial_positions;
        for (std::size_t i = 0; i < mesh.initial_positions.size(); ++i) {
          const Vector2d offset = panel.view.offsetOf(flat_.at(index)[i].head<2>());
          mesh.initial_positions[i] = lay(ring.surface, panel.place, offset);
        }
      }
    }
  }

  void shiftRings() {
    for (const Ring& ring : rings_) {
      const double up = axes_.at(ring.segment).startsBelow() ? ring.shift : -ring.shift;
      for (const int panel : ring.panels) {
        if (!panels_[panel].height) panels_[panel].place.height += up;
      }
    }
  }

  /// Makes room where something intersects; whether there is anything to be done.
  bool widen(const Body& body) {
    bool any = false;
    std::set<int> shifted;  // segments: layers that are sewn to each other go together
    for (const auto& overlap : overlaps_) {
      const auto [a, b] = overlap.first;
      const int first = ring_of_[a];
      if (b == static_cast<int>(meshes_.size())) {
        if (first >= 0 && depthOf(body, first) > 0) shifted.insert(rings_[first].segment);
        continue;
      }
      const int second = ring_of_[b];
      if (first >= 0 && second >= 0 && rings_[first].segment != rings_[second].segment) {
        const int outer = depthOf(body, first) >= depthOf(body, second) ? first : second;
        shifted.insert(rings_[outer].segment);
      } else {
        any = widenSeams(a, b) || any;
      }
    }
    for (Ring& ring : rings_) {
      if (shifted.count(ring.segment) == 0) continue;
      ring.shift = ring.shift == 0.0 ? kFirstShift : 2.0 * ring.shift;
    }
    return any || !shifted.empty();
  }

  /// How many segments are between a ring's and the one that hangs on none.
  int depthOf(const Body& body, int ring) const {
    int depth = 0;
    for (int i = rings_[ring].segment; body.segments[i].parent >= 0; ++depth) {
      i = body.segments[i].parent;
    }
    return depth;
  }

  bool widenSeams(int a, int b) {
    bool any = false;
    for (std::size_t i = 0; i < gaps_.size(); ++i) {
      const auto& sides = pattern_.seams[i].sides;
      if (std::minmax(sides[0].panel, sides[1].panel) != std::minmax(a, b)) continue;
      gaps_[i] *= 2.0;
      any = true;
    }
    return any;
  }

  LaidPanel report(const Ring& ring, int index) const {
    const SegmentAxis& axis = axes_.at(ring.segment);
    const PlaceOnSurface& place = panels_[index].place;
    const double along = place.height / axis.length();
    LaidPanel laid{index, ring.surface};
    laid.angle = std::remainder(axis.startsBelow() ? place.angle : -place.angle, 2.0 * M_PI);
    laid.along = axis.startsBelow() ? along : 1.0 - along;
    const mesh::ClothMesh& mesh = meshes_[index].mesh;
    for (const auto& triangle : mesh.triangles) {
      for (int i = 0; i < 3; ++i) addEdge(mesh, triangle[i], triangle[(i + 1) % 3], laid);
    }
    return laid;
  }

  static void addEdge(const mesh::ClothMesh& mesh, int i, int j, LaidPanel& laid) {
    const Vector3d &a = mesh.initial_positions[i], &b = mesh.initial_positions[j];
    const double rest = (mesh.rest_coordinates[i] - mesh.rest_coordinates[j]).norm();
    const double on_surface = lengthOnSurface(laid.surface, a, b);
    laid.surface_change = std::max(laid.surface_change, std::abs(on_surface / rest - 1.0));
    laid.straight_change = std::max(laid.straight_change, std::abs((a - b).norm() / rest - 1.0));
    const Vector3d middle = 0.5 * (a + b) - laid.surface.origin;
    const double height = middle.dot(laid.surface.up);
    const double inside =
        laid.surface.radiusAt(height) - (middle - height * laid.surface.up).norm();
    laid.sagitta = std::max(laid.sagitta, inside / std::hypot(1.0, laid.surface.slope));
  }

  const Pattern& pattern_;
  std::vector<PanelMesh>& meshes_;
  std::vector<int> segments_;        // per carrier
  std::map<int, SegmentAxis> axes_;  // by segment, as the skeleton has them
  std::vector<PanelToPlace> panels_;
  std::vector<Ring> rings_;                    // from the body outwards
  std::vector<int> ring_of_;                   // per panel; -1: it has a position
  std::vector<double> gaps_;                   // m, per seam
  std::map<int, std::vector<Vector3d>> flat_;  // positions in the panels' planes, m
  std::map<std::array<int, 2>, int> overlaps_;
};

}  // namespace

Preposition preposition(const Pattern& pattern, const Body& body, std::vector<PanelMesh>& meshes) {
  if (meshes.size() != pattern.panels.size()) {
    base::refuse("preposition: ", meshes.size(), " meshes: must be as many as panels, ",
                 pattern.panels.size());
  }
  return Prepositioner(pattern, body, meshes).run(body);
}

}  // namespace haptex::garment
