#include "haptex/linear/coarse_product.h"

#include <algorithm>

namespace haptex::linear {

CoarseProduct::CoarseProduct(const BlockRows& fine, const Interpolation& interpolation) {
  planRows(fine, interpolation);
  findCoarsePattern(interpolation);
  planTargets(interpolation);
  splitRows(interpolation);
  int most_columns = 0;
  for (int i = 0; i < fine.size(); ++i)
    most_columns = std::max(most_columns, begin_[i + 1] - begin_[i]);
  for (std::vector<BlockColumns>& sums : sums_) sums.resize(most_columns);
}

void CoarseProduct::planRows(const BlockRows& fine, const Interpolation& interpolation) {
  begin_.push_back(0);
  first_place_.push_back(0);
  for (int i = 0; i < fine.size(); ++i) {
    const auto first = static_cast<std::ptrdiff_t>(columns_.size());
    for (int s = fine.begin(i); s < fine.begin(i + 1); ++s) {
      const int j = fine.column(s);
      for (int k = interpolation.begin[j]; k < interpolation.begin[j + 1]; ++k) {
        const int column = interpolation.columns[k];
        const auto found = std::find(columns_.begin() + first, columns_.end(), column);
        const auto place = found - columns_.begin() - first;
        if (found == columns_.end()) columns_.push_back(column);
        places_.push_back(static_cast<int>(place));
      }
    }
    begin_.push_back(static_cast<int>(columns_.size()));
    first_place_.push_back(static_cast<int>(places_.size()));
  }
}

void CoarseProduct::findCoarsePattern(const Interpolation& interpolation) {
  const Interpolation restriction = interpolation.transposed();
  std::vector<int> last_row(interpolation.coarse_size, -1);  // that has the column
  coarse_begin_.push_back(0);
  for (int row = 0; row < interpolation.coarse_size; ++row) {
    last_row[row] = row;
    const auto first = static_cast<std::ptrdiff_t>(coarse_columns_.size()) + 1;
    coarse_columns_.push_back(row);
    for (int k = restriction.begin[row]; k < restriction.begin[row + 1]; ++k) {
      const int i = restriction.columns[k];
      for (int m = begin_[i]; m < begin_[i + 1]; ++m) {
        if (last_row[columns_[m]] == row) continue;
        last_row[columns_[m]] = row;
        coarse_columns_.push_back(columns_[m]);
      }
    }
    std::sort(coarse_columns_.begin() + first, coarse_columns_.end());
    coarse_begin_.push_back(static_cast<int>(coarse_columns_.size()));
  }
}

void CoarseProduct::planTargets(const Interpolation& interpolation) {
  first_target_.push_back(0);
  for (int i = 0; i + 1 < static_cast<int>(begin_.size()); ++i) {
    for (int k = interpolation.begin[i]; k < interpolation.begin[i + 1]; ++k) {
      const int row = interpolation.columns[k];
      const auto first = coarse_columns_.begin() + coarse_begin_[row];
      const auto end = coarse_columns_.begin() + coarse_begin_[row + 1];
      for (int m = begin_[i]; m < begin_[i + 1]; ++m) {
        const auto found =
            columns_[m] == row ? first : std::lower_bound(first + 1, end, columns_[m]);
        targets_.push_back(static_cast<int>(found - coarse_columns_.begin()));
      }
    }
    first_target_.push_back(static_cast<int>(targets_.size()));
  }
}

void CoarseProduct::splitRows(const Interpolation& interpolation) {
  const long size = static_cast<long>(begin_.size()) - 1;
  const auto forEachRow = [&](const auto& function) {
    for (int part = 0; part < kParts; ++part) {
      const long end = size * (part + 1) / kParts;
      for (long i = size * part / kParts; i < end; ++i) function(part, static_cast<int>(i));
    }
  };
  constexpr int kNone = -1, kSeveral = -2;
  std::vector<int> part_of(interpolation.coarse_size, kNone);
  const auto forEachCoarse = [&](int row, const auto& function) {
    for (int k = interpolation.begin[row]; k < interpolation.begin[row + 1]; ++k) {
      function(part_of[interpolation.columns[k]]);
    }
  };
  forEachRow([&](int part, int row) {
    forEachCoarse(row, [&](int& its) { its = its == kNone || its == part ? part : kSeveral; });
  });
  forEachRow([&](int part, int row) {
    bool is_shared = false;
    forEachCoarse(row, [&](int its) { is_shared = is_shared || its == kSeveral; });
    (is_shared ? shared_ : parts_[part]).push_back(row);
  });
}

void CoarseProduct::addRow(int row, const BlockRows& fine, const Interpolation& interpolation,
                           std::vector<BlockColumns>& sums, BlockRows& coarse) const {
  using Column = Eigen::Map<const Eigen::Array4f>;  // and the number behind it
  const int count = begin_[row + 1] - begin_[row];
  for (int m = 0; m < count; ++m) {
    sums[m].fill(Eigen::Array4f::Zero());
  }
  const int* place = &places_[first_place_[row]];
  for (int s = fine.begin(row); s < fine.begin(row + 1); ++s) {
    const int j = fine.column(s);
    const int weights = interpolation.begin[j + 1] - interpolation.begin[j];
    if (!fine.isAlone(j)) {
      const float* block = fine.block(s);
      for (int k = 0; k < weights; ++k) {
        const float weight = interpolation.weights[interpolation.begin[j] + k];
        for (int c = 0; c < 3; ++c) sums[place[k]][c] += weight * Column(block + 3 * c);
      }
    }
    place += weights;
  }
  const int* target = &targets_[first_target_[row]];
  for (int k = interpolation.begin[row]; k < interpolation.begin[row + 1]; ++k) {
    for (int m = 0; m < count; ++m) {
      Eigen::Map<Eigen::Matrix3f> block(coarse.block(*target++));
      for (int c = 0; c < 3; ++c) {
        block.col(c) += interpolation.weights[k] * sums[m][c].head<3>().matrix();
      }
    }
  }
}

void CoarseProduct::multiply(const BlockRows& fine, const Interpolation& interpolation,
                             BlockRows& coarse, ThreadPool* pool) {
  coarse.setZero();
  const auto addRows = [&](const std::vector<int>& rows, std::vector<BlockColumns>& sums) {
    for (const int row : rows) {
      if (!fine.isAlone(row)) addRow(row, fine, interpolation, sums, coarse);
    }
  };
  runTasks(pool, kParts, [&](int part, int) { addRows(parts_[part], sums_[part]); });
  addRows(shared_, sums_[kParts]);
  for (int row = 0; row < coarse.size(); ++row) {
    Eigen::Map<Eigen::Matrix3f> diagonal(coarse.block(coarse.begin(row)));
    if (diagonal.isZero(0.0f)) diagonal.setIdentity();
  }
  coarse.finish(pool);
}

}  // namespace haptex::linear
