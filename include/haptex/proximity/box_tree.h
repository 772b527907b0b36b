// A tree of boxes over parts that move.
#pragma once

#include <Eigen/Geometry>
#include <vector>

namespace haptex::proximity {

/// A binary tree of boxes with faces along the axes over parts that are boxes themselves. Which
/// parts belong together is decided once, at construction. Neither refit() nor visit() allocates.
class BoxTree {
 public:
  using Box = Eigen::AlignedBox3d;  ///< m

  /// @param parts at least one, none of them empty
  /// @throws std::invalid_argument if there is none
  explicit BoxTree(const std::vector<Box>& parts);

  /// Adapts all boxes. @param parts as many as at construction
  void refit(const std::vector<Box>& parts);

  /// Around all parts.
  const Box& box() const { return nodes_.front().box; }

  /// Calls use(part) for every part whose box has a point in common with a box, always in the same
  /// order.
  template <typename Use>
  void visit(const Box& within, const Use& use) const {
    for (std::size_t at = 0; at < nodes_.size();) {
      const Node& node = nodes_[at];
      if (!node.box.intersects(within)) {
        at = node.next;
        continue;
      }
      if (node.part >= 0) use(node.part);
      ++at;
    }
  }

 private:
  /// Depth first: what is below a node follows it.
  struct Node {
    Box box;
    int part;          // -1: has two nodes below
    std::size_t next;  // after all that is below
  };

  void build(const std::vector<Box>& parts, int* begin, int* end);

  std::vector<Node> nodes_;
};

}  // namespace haptex::proximity
