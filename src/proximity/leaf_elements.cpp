#include "haptex/proximity/leaf_elements.h"

#include <algorithm>
#include <cstring>
#include <limits>

namespace haptex::proximity {
namespace {

using Floats = ElementBox::Floats;

inline bool overlap(const ElementBox& a, const ElementBox& b) {
  const auto apart = (a.least > b.most) | (b.least > a.most);
  std::int64_t bits[2];
  std::memcpy(bits, &apart, sizeof(bits));
  return (bits[0] | bits[1]) == 0;
}

inline bool isAdjacent(ElementPairKind kind, const LeafElement& a, const LeafElement& b) {
  const auto has = [&b](int vertex) {
    return vertex == b.corners[0] || vertex == b.corners[1] || vertex == b.corners[2];
  };
  return has(a.corners[0]) || (kind == ElementPairKind::kEdgeEdge && has(a.corners[1]));
}

}  // namespace

LeafElements::LeafElements(const KdopHierarchy& hierarchy, const MeshElements& elements) {
  std::vector<bool> has_vertex(hierarchy.positions().size(), false);
  std::vector<bool> has_edge(elements.edges.size(), false);
  for (int leaf = 0; leaf < hierarchy.leaves(); ++leaf) {
    std::vector<int> parts[kParts];
    for (int i = hierarchy.leafBegin(leaf); i < hierarchy.leafBegin(leaf + 1); ++i) {
      const int index = hierarchy.order()[i];
      const auto& triangle = elements.triangles[index];
      parts[kTriangles].push_back(index);
      for (int k = 0; k < 3; ++k) {
        const int a = triangle[k], b = triangle[(k + 1) % 3];
        if (!has_vertex[a]) parts[kVertices].push_back(a);
        has_vertex[a] = true;
        if (a == b) continue;
        const int at = elements.indexOf(edgeBetween(a, b));
        if (!has_edge[at]) parts[kEdges].push_back(at);
        has_edge[at] = true;
      }
    }
    for (int part = 0; part < kParts; ++part) {
      begin_.push_back(static_cast<int>(element_.size()));
      std::sort(parts[part].begin(), parts[part].end());
      for (int index : parts[part]) {
        Element element = {index, {index, index, index}};
        if (part == kEdges) {
          const Edge& edge = elements.edges[index];
          element.corners = {edge[0], edge[1], edge[1]};
        } else if (part == kTriangles) {
          element.corners = elements.triangles[index];
        }
        element_.push_back(element);
      }
    }
  }
  begin_.push_back(static_cast<int>(element_.size()));
  boxes_.resize(element_.size());
  around_.resize(hierarchy.leaves());
  asked_.assign(hierarchy.leaves(), 0);
}

LeafElements::Scratch LeafElements::scratch() const {
  Scratch scratch;
  // Only a leaf's elements are chosen at a time.
  for (int part = 0; part < kParts; ++part) {
    int most = 0;
    for (int leaf = 0; leaf < static_cast<int>(asked_.size()); ++leaf) {
      most = std::max(most, beginOf(leaf, part + 1) - beginOf(leaf, part));
    }
    for (auto& chosen : scratch.chosen) {
      chosen[part].element.reserve(most);
      chosen[part].box.reserve(most);
    }
  }
  return scratch;
}

void LeafElements::begin(const KdopHierarchy& hierarchy, double distance) {
  ++step_;
  const double margin = kSinglePrecisionMargin;
  reach_ = static_cast<float>((1.0 + margin) * distance + margin * hierarchy.extent());
}

bool LeafElements::isNew(int leaf) {
  if (asked_[leaf] == step_) return false;
  asked_[leaf] = step_;
  return true;
}

/// Boxes of all elements of a leaf and around them.
void LeafElements::fit(const KdopHierarchy& hierarchy, int leaf) {
  const float* positions = hierarchy.localPositions().data();
  const auto place = [&](int vertex) {
    Floats at;
    std::memcpy(&at, positions + 4 * std::ptrdiff_t{vertex}, sizeof(at));
    at[3] = 0.0f;
    return at;
  };
  const auto extend = [](Box& box, const Floats& least, const Floats& most) {
    box.least = least < box.least ? least : box.least;
    box.most = most > box.most ? most : box.most;
  };
  Box around = {};
  for (int part = 0; part < kParts; ++part) {
    for (int i = beginOf(leaf, part); i < beginOf(leaf, part + 1); ++i) {
      const std::array<int, 3>& corners = element_[i].corners;
      const Floats first = place(corners[0]);
      Box box = {first, first};
      for (int k = 1; k < 3 && part != kVertices; ++k) {
        extend(box, place(corners[k]), place(corners[k]));
      }
      boxes_[i] = box;
      if (part == kTriangles && i == beginOf(leaf, kTriangles)) around = box;
      if (part == kTriangles) extend(around, box.least, box.most);
    }
  }
  around_[leaf] = around;
}

void LeafElements::choose(int leaf, const Box& within, Chosen* chosen) const {
  for (int part = 0; part < kParts; ++part) {
    chosen[part].element.clear();
    chosen[part].box.clear();
    for (int i = beginOf(leaf, part); i < beginOf(leaf, part + 1); ++i) {
      if (!overlap(boxes_[i], within)) continue;
      chosen[part].element.push_back(element_[i]);
      chosen[part].box.push_back(boxes_[i]);
    }
  }
}

void LeafElements::addPairs(ElementPairKind kind, const Chosen& first, const Chosen& second,
                            std::vector<ElementPair>& found) const {
  for (std::size_t i = 0; i < first.element.size(); ++i) {
    const Box wide = {first.box[i].least - reach_, first.box[i].most + reach_};
    const Element& a = first.element[i];
    // Of the edges of one leaf each pair once.
    const std::size_t begin = &first == &second && kind == ElementPairKind::kEdgeEdge ? i + 1 : 0;
    for (std::size_t j = begin; j < second.element.size(); ++j) {
      const Element& b = second.element[j];
      if (!overlap(wide, second.box[j]) || isAdjacent(kind, a, b)) continue;
      const bool swap = kind == ElementPairKind::kEdgeEdge && b.index < a.index;
      found.push_back({kind, swap ? b.index : a.index, swap ? a.index : b.index});
    }
  }
}

void LeafElements::findCandidates(int first, int second, Scratch& scratch,
                                  std::vector<ElementPair>& found) const {
  auto& chosen = scratch.chosen;
  if (first == second) {
    choose(first, around_[first], chosen[0]);
    const auto& all = chosen[0];
    addPairs(ElementPairKind::kVertexTriangle, all[kVertices], all[kTriangles], found);
    addPairs(ElementPairKind::kEdgeEdge, all[kEdges], all[kEdges], found);
    return;
  }
  const Floats least =
      around_[first].least > around_[second].least ? around_[first].least : around_[second].least;
  const Floats most =
      around_[first].most < around_[second].most ? around_[first].most : around_[second].most;
  const Box common = {least - reach_, most + reach_};
  choose(first, common, chosen[0]);
  choose(second, common, chosen[1]);
  addPairs(ElementPairKind::kVertexTriangle, chosen[0][kVertices], chosen[1][kTriangles], found);
  addPairs(ElementPairKind::kVertexTriangle, chosen[1][kVertices], chosen[0][kTriangles], found);
  addPairs(ElementPairKind::kEdgeEdge, chosen[0][kEdges], chosen[1][kEdges], found);
}

}  // namespace haptex::proximity
