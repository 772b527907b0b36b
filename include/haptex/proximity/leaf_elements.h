// The elements of a mesh by the leaves of its hierarchy, with boxes around them.
#pragma once

#include <cstdint>
#include <vector>

#include "haptex/proximity/element_pair.h"
#include "haptex/proximity/kdop_hierarchy.h"

namespace haptex::proximity {

/// A box with faces along the axes: x, y, z and 0 (m), as the local positions of the hierarchy.
struct ElementBox {
  typedef float Floats __attribute__((vector_size(16)));
  Floats least, most;
};

struct LeafElement {
  int index;                   ///< of the vertex, edge or triangle
  std::array<int, 3> corners;  ///< vertices, the last one repeated
};

/// Every vertex and every edge belongs to one leaf: to the first that has a triangle with it. So
/// any two elements meet in one pair of leaves, and if they are near, so are the volumes of the
/// leaves.
class LeafElements {
  enum Part { kVertices, kEdges, kTriangles, kParts };
  // Of a part of a leaf, those that reach into a box.
  struct Chosen {
    std::vector<LeafElement> element;
    std::vector<ElementBox> box;
  };

 public:
  /// What a thread writes in findCandidates().
  struct Scratch {
    Chosen chosen[2][kParts];
  };

  /// @param hierarchy over the triangles of the elements
  LeafElements(const KdopHierarchy& hierarchy, const MeshElements& elements);

  /// With room for the largest leaf.
  Scratch scratch() const;

  /// After the hierarchy has moved.
  /// @param distance m, up to which elements are looked for
  void begin(const KdopHierarchy& hierarchy, double distance);
  /// Whether a leaf is asked for the first time since: then fit() is to be called before
  /// findCandidates().
  bool isNew(int leaf);
  /// Several threads may do so with different leaves.
  void fit(const KdopHierarchy& hierarchy, int leaf);

  /// Pairs of elements of one leaf, or of two, that are not adjacent and whose boxes are within the
  /// distance, always in the same order.
  /// @param found added to
  void findCandidates(int first, int second, Scratch& scratch,
                      std::vector<ElementPair>& found) const;

 private:
  using Box = ElementBox;
  using Element = LeafElement;

  int beginOf(int leaf, int part) const { return begin_[kParts * std::size_t(leaf) + part]; }
  void choose(int leaf, const Box& within, Chosen* chosen) const;
  void addPairs(ElementPairKind kind, const Chosen& first, const Chosen& second,
                std::vector<ElementPair>& found) const;

  std::vector<int> begin_;  // in element_, of each part of each leaf, and the end
  std::vector<Element> element_;
  std::vector<Box> boxes_;           // of element_
  std::vector<Box> around_;          // each leaf
  std::vector<std::int64_t> asked_;  // per leaf, in which step
  std::int64_t step_ = 0;
  float reach_ = 0.0f;  // m, distance with a margin
};

}  // namespace haptex::proximity
