// How factored supernodes update the later ones that they couple.
#include <algorithm>

#include "haptex/linear/block_cholesky.h"
#include "haptex/linear/dense_kernels.h"

namespace haptex::linear {
namespace {

// Block columns of supernodes that update others without a buffer: for those their depth makes up
// for the short runs of rows.
constexpr int kDirectWidth = 24;

}  // namespace

template <typename T>
void BasicBlockCholesky<T>::placeRows(int target, std::vector<int>& panel_row) const {
  const Supernode& supernode = elimination_.supernodes[target];
  for (int k = 0; k < supernode.width(); ++k) panel_row[supernode.first + k] = k;
  for (std::size_t r = 0; r < supernode.rows.size(); ++r) {
    panel_row[supernode.rows[r]] = supernode.width() + static_cast<int>(r);
  }
}

/// Subtracts what a factored supernode contributes to the rows [first_row, end_row), which are
/// block rows of the target's panel.
template <typename T>
void BasicBlockCholesky<T>::applyDescendant(int descendant, int target, int first_row, int end_row,
                                            const std::vector<int>& panel_row, Workspace& work) {
  const Supernode& source = elimination_.supernodes[descendant];
  const Supernode& sink = elimination_.supernodes[target];
  const Panel& from = panel_of_[descendant];
  const Panel& to = panel_of_[target];
  const int begin = next_row_[descendant];
  const int total = static_cast<int>(source.rows.size());
  const auto row_at = [&](int place) {  // the first source row from this place on
    const auto found = std::partition_point(source.rows.begin() + begin, source.rows.end(),
                                            [&](int row) { return panel_row[row] < place; });
    return static_cast<int>(found - source.rows.begin());
  };
  const bool whole = first_row == 0 && 3 * end_row == to.leading;
  const int first = whole ? begin : row_at(first_row);
  const int last = whole ? total : row_at(end_row);
  if (source.width() >= kDirectWidth) {
    return applyDirectly(descendant, target, first, last, panel_row);
  }
  int columns_last = begin;
  while (columns_last < last && source.rows[columns_last] < sink.end) ++columns_last;
  if (first == last) return;
  const T* const rows = panels_ + from.offset + 3 * source.width();
  T* const panel = panels_ + to.offset;
  for (int b = begin; b < columns_last; b += kUpdateColumns) {
    const int columns_end = std::min(columns_last, b + kUpdateColumns);
    const int top = std::max(first, b);
    const int height = 3 * (last - top);
    multiply(height, 3 * (columns_end - b), 3 * source.width(), rows + 3 * top, from.leading,
             rows + 3 * b, from.leading, work.columns.data(), height);
    const int runs = findRuns(source.rows, top, last, panel_row, work.runs);
    const T* column = work.columns.data();
    for (int c = b; c < columns_end; ++c, column += std::ptrdiff_t{3} * height) {
      T* const destination =
          panel + static_cast<std::size_t>(to.leading) * 3 * panel_row[source.rows[c]];
      subtractRuns(work.runs.data(), runs, column, height, destination, to.leading);
    }
  }
}

/// Runs of the source rows [first, last) that follow each other in the target as well.
/// @returns their number
template <typename T>
int BasicBlockCholesky<T>::findRuns(const std::vector<int>& rows, int first, int last,
                                    const std::vector<int>& panel_row,
                                    std::vector<RowRun>& runs) const {
  int count = 0;
  for (int row = first; row < last;) {
    const int place = panel_row[rows[row]];
    int end = row + 1;
    while (end < last && panel_row[rows[end]] == place + end - row) ++end;
    runs[count++] = {3 * (row - first), 3 * place, 3 * (end - row)};
    row = end;
  }
  return count;
}

/// The same for the source rows [first, last), without a buffer: rows of wide supernodes that
/// follow each other mostly do so in the target as well. Spoils numbers of the target above its
/// diagonal, which nothing reads.
template <typename T>
void BasicBlockCholesky<T>::applyDirectly(int descendant, int target, int first, int last,
                                          const std::vector<int>& panel_row) {
  const Supernode& source = elimination_.supernodes[descendant];
  const Supernode& sink = elimination_.supernodes[target];
  const Panel& from = panel_of_[descendant];
  const Panel& to = panel_of_[target];
  const int depth = 3 * source.width();
  const T* const rows = panels_ + from.offset + depth;
  T* const panel = panels_ + to.offset;
  const auto place = [&](int row) { return panel_row[source.rows[row]]; };
  const auto run_end = [&](int begin, int most) {
    int end = begin + 1;
    while (end < most && place(end) == place(end - 1) + 1) ++end;
    return end;
  };
  int columns_last = next_row_[descendant];
  while (columns_last < last && source.rows[columns_last] < sink.end) ++columns_last;
  for (int b = next_row_[descendant]; b < columns_last;) {
    const int columns_end = run_end(b, std::min(columns_last, b + kUpdateColumns));
    T* const column = panel + static_cast<std::size_t>(to.leading) * 3 * place(b);
    for (int a = std::max(first, b); a < last;) {
      const int end = run_end(a, last);
      subtractProduct(3 * (end - a), 3 * (columns_end - b), depth, rows + 3 * a, from.leading,
                      rows + 3 * b, from.leading, column + 3 * place(a), to.leading);
      a = end;
    }
    b = columns_end;
  }
}

/// After the target has been updated: on to the supernode that comes next, if its place is known.
template <typename T>
void BasicBlockCholesky<T>::advance(int descendant, int target, bool into_top) {
  const Supernode& source = elimination_.supernodes[descendant];
  const int total = static_cast<int>(source.rows.size());
  int end = next_row_[descendant];
  while (end < total && source.rows[end] < elimination_.supernodes[target].end) ++end;
  next_row_[descendant] = end;
  if (end == total) return;
  if (!into_top && top_place_[source.rows[end]] != -1) return;
  const int later = elimination_.supernode_of[source.rows[end]];
  next_descendant_[descendant] = first_descendant_[later];
  first_descendant_[later] = descendant;
}

#define HAPTEX_INSTANTIATE(T)                                                                      \
  template void BasicBlockCholesky<T>::placeRows(int, std::vector<int>&) const;                    \
  template void BasicBlockCholesky<T>::applyDescendant(int, int, int, int,                         \
                                                       const std::vector<int>&, Workspace&);       \
  template int BasicBlockCholesky<T>::findRuns(                                                    \
      const std::vector<int>&, int, int, const std::vector<int>&, std::vector<RowRun>&) const;     \
  template void BasicBlockCholesky<T>::applyDirectly(int, int, int, int, const std::vector<int>&); \
  template void BasicBlockCholesky<T>::advance(int, int, bool);

HAPTEX_INSTANTIATE(double)
HAPTEX_INSTANTIATE(float)
#undef HAPTEX_INSTANTIATE

}  // namespace haptex::linear
