#include "haptex/proximity/box_tree.h"

#include <algorithm>
#include <numeric>
#include <stdexcept>

namespace haptex::proximity {

BoxTree::BoxTree(const std::vector<Box>& parts) {
  if (parts.empty()) throw std::invalid_argument("a tree of boxes must have one part at least");
  std::vector<int> order(parts.size());
  std::iota(order.begin(), order.end(), 0);
  nodes_.reserve(2 * parts.size() - 1);
  build(parts, order.data(), order.data() + order.size());
  refit(parts);
}

/// Halves the parts at the median along the longest side of the box around their middles.
void BoxTree::build(const std::vector<Box>& parts, int* begin, int* end) {
  const std::size_t at = nodes_.size();
  nodes_.push_back({Box(), end - begin == 1 ? *begin : -1, 0});
  if (end - begin > 1) {
    Box middles;
    for (const int* part = begin; part != end; ++part) middles.extend(parts[*part].center());
    int axis = 0;
    middles.sizes().maxCoeff(&axis);
    int* const half = begin + (end - begin) / 2;
    std::nth_element(begin, half, end, [&](int a, int b) {
      const double of_a = parts[a].center()[axis], of_b = parts[b].center()[axis];
      return of_a != of_b ? of_a < of_b : a < b;
    });
    build(parts, begin, half);
    build(parts, half, end);
  }
  nodes_[at].next = nodes_.size();
}

void BoxTree::refit(const std::vector<Box>& parts) {
  for (std::size_t at = nodes_.size(); at-- > 0;) {
    Node& node = nodes_[at];
    node.box = node.part >= 0 ? parts[node.part]
                              : nodes_[at + 1].box.merged(nodes_[nodes_[at + 1].next].box);
  }
}

}  // namespace haptex::proximity
