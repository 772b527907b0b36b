// The triangular solves with the panels of a factor.
#include <algorithm>
#include <cstddef>
#include <type_traits>

#include "haptex/linear/block_cholesky.h"
#include "haptex/linear/shared_rows.h"

namespace haptex::linear {

/// L y = b for the unknowns of one supernode.
/// @param outside what is added to unknowns of the top; null in the top itself
template <typename T>
void BasicBlockCholesky<T>::forward(int s, T* outside, std::vector<T>& front) {
  const Supernode& supernode = elimination_.supernodes[s];
  const Panel& panel = panel_of_[s];
  const int width = 3 * supernode.width();
  T* const values = permuted_.data();
  T* const own = values + 3 * supernode.first;
  std::copy_n(own, width, front.data());
  std::fill(front.data() + width, front.data() + panel.leading, T(0));
  substituteForward(panel.leading, width, panels_ + panel.offset, panel.leading, front.data());
  std::copy_n(front.data(), width, own);
  const T* change = front.data() + width;
  const auto add = [&change](T* to) {
    to[0] += change[0];
    to[1] += change[1];
    to[2] += change[2];
    change += 3;
  };
  const int total = static_cast<int>(supernode.rows.size());
  const int inner = outside ? panel.inner_rows : total;
  for (int r = 0; r < inner; ++r) add(values + 3 * supernode.rows[r]);
  for (int r = inner; r < total; ++r) add(outside + 3 * top_place_[supernode.rows[r]]);
}

/// L^T x = y for the unknowns of one supernode.
template <typename T>
void BasicBlockCholesky<T>::backward(int s, std::vector<T>& front) {
  const Supernode& supernode = elimination_.supernodes[s];
  const Panel& panel = panel_of_[s];
  const int width = 3 * supernode.width();
  T* const values = permuted_.data();
  T* const own = values + 3 * supernode.first;
  std::copy_n(own, width, front.data());
  T* below = front.data() + width;
  for (int row : supernode.rows) {
    const T* other = values + 3 * row;
    below[0] = other[0];
    below[1] = other[1];
    below[2] = other[2];
    below += 3;
  }
  substituteBackward(panel.leading, width, panels_ + panel.offset, panel.leading, front.data());
  std::copy_n(front.data(), width, own);
}

/// Takes x to that of the scaled matrix. @return its largest number, or 1
template <typename T>
double BasicBlockCholesky<T>::scale(BlockVector& x) {
  shareRows(pool_, static_cast<int>(permuted_.cols()), [&](int begin, int end) {
    auto part = x.middleCols(begin, end - begin).array();
    part *= scales_.middleCols(begin, end - begin).array();
    largest_[begin / kSharedRows] = part.abs().maxCoeff();
  });
  const double size = *std::max_element(largest_.begin(), largest_.end());
  return size > 0.0 ? size : 1.0;
}

template <typename T>
void BasicBlockCholesky<T>::solve(BlockVector& x) {
  const int n = static_cast<int>(permuted_.cols());
  constexpr bool is_scaled = std::is_same_v<T, float>;
  const double size = is_scaled ? scale(x) : 1.0;
  shareRows(pool_, n, [&](int begin, int end) {
    for (int k = begin; k < end; ++k) {
      auto value = x.col(elimination_.order[k]);
      if constexpr (is_scaled) value /= size;
      permuted_.col(k) = value.template cast<T>();
    }
  });
  const std::size_t stride = std::size_t{3} * top_columns_;
  const int groups = top_.empty() ? 1 : kGroups;
  share(groups, [&](int group, int thread) {
    T* const outside = outside_.data() + group * stride;
    std::fill_n(outside, stride, T(0));
    for (const Subtree& subtree : subtrees_) {
      if (subtree.group != group) continue;
      for (int s = subtree.first; s < subtree.end; ++s) {
        forward(s, top_.empty() ? nullptr : outside, work_[thread].front);
      }
    }
  });
  for (int s : top_) {
    const Supernode& supernode = elimination_.supernodes[s];
    for (int k = supernode.first; k < supernode.end; ++k) {
      for (int group = 0; group < groups; ++group) {
        const T* added = outside_.data() + group * stride + std::size_t{3} * top_place_[k];
        for (int c = 0; c < 3; ++c) permuted_(c, k) += added[c];
      }
    }
    forward(s, nullptr, work_[0].front);
  }
  for (std::size_t t = top_.size(); t-- > 0;) backward(top_[t], work_[0].front);
  share(groups, [&](int group, int thread) {
    for (std::size_t t = subtrees_.size(); t-- > 0;) {
      if (subtrees_[t].group != group) continue;
      for (int s = subtrees_[t].end; s-- > subtrees_[t].first;) {
        backward(s, work_[thread].front);
      }
    }
  });
  shareRows(pool_, n, [&](int begin, int end) {
    for (int k = begin; k < end; ++k) {
      const int i = elimination_.order[k];
      x.col(i) = permuted_.col(k).template cast<double>();
      if constexpr (is_scaled) x.col(i).array() *= size * scales_.col(i).array();
    }
  });
}

#define HAPTEX_INSTANTIATE(T)                                             \
  template void BasicBlockCholesky<T>::forward(int, T*, std::vector<T>&); \
  template void BasicBlockCholesky<T>::backward(int, std::vector<T>&);    \
  template double BasicBlockCholesky<T>::scale(BlockVector&);             \
  template void BasicBlockCholesky<T>::solve(BlockVector&);

HAPTEX_INSTANTIATE(double)
HAPTEX_INSTANTIATE(float)
#undef HAPTEX_INSTANTIATE

}  // namespace haptex::linear
