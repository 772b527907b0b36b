#include "haptex/linear/aggregation.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace haptex::linear {
namespace {

constexpr float kStrong = 0.5f;     // of the largest coupling of a row
constexpr float kSmoothing = 0.8f;  // from a row's own group to those of its neighbours
constexpr int kNone = -1;

/// Of every slot: the Frobenius norm of a strong coupling's block, zero for others.
std::vector<float> strongCouplings(const BlockRows& matrix) {
  std::vector<float> strength(matrix.begin(matrix.size()), 0.0f);
  std::vector<float> largest(matrix.size(), 0.0f);
  for (int i = 0; i < matrix.size(); ++i) {
    for (int s = matrix.begin(i) + 1; s < matrix.begin(i + 1); ++s) {
      strength[s] = Eigen::Map<const Eigen::Matrix3f>(matrix.block(s)).norm();
      largest[i] = std::max(largest[i], strength[s]);
    }
  }
  for (int i = 0; i < matrix.size(); ++i) {
    for (int s = matrix.begin(i) + 1; s < matrix.begin(i + 1); ++s) {
      const float least = kStrong * std::min(largest[i], largest[matrix.column(s)]);
      if (!(strength[s] >= least)) strength[s] = 0.0f;
    }
  }
  return strength;
}

struct Groups {
  int count = 0;
  std::vector<int> of_row;  // kNone: of no group
};

Groups group(const BlockRows& matrix, const std::vector<float>& strength) {
  Groups groups{0, std::vector<int>(matrix.size(), kNone)};
  std::vector<int>& of_row = groups.of_row;
  const auto forEachStrong = [&](int row, const auto& function) {
    for (int s = matrix.begin(row) + 1; s < matrix.begin(row + 1); ++s) {
      if (strength[s] > 0.0f) function(matrix.column(s), strength[s]);
    }
  };
  const auto found = [&](int row) {
    of_row[row] = groups.count;
    forEachStrong(row, [&](int neighbour, float) {
      if (of_row[neighbour] == kNone) of_row[neighbour] = groups.count;
    });
    ++groups.count;
  };
  // Whole neighbourhoods first.
  for (int i = 0; i < matrix.size(); ++i) {
    bool has_neighbours = false, all_free = of_row[i] == kNone;
    forEachStrong(i, [&](int neighbour, float) {
      has_neighbours = true;
      all_free = all_free && of_row[neighbour] == kNone;
    });
    if (has_neighbours && all_free) found(i);
  }
  // What is left between them goes to the group that it is coupled with most.
  const std::vector<int> before = of_row;
  for (int i = 0; i < matrix.size(); ++i) {
    if (before[i] != kNone) continue;
    float most = 0.0f;
    forEachStrong(i, [&](int neighbour, float strong) {
      if (before[neighbour] == kNone || strong <= most) return;
      most = strong;
      of_row[i] = before[neighbour];
    });
  }
  for (int i = 0; i < matrix.size(); ++i) {
    bool has_neighbours = false;
    forEachStrong(i, [&](int, float) { has_neighbours = true; });
    if (of_row[i] == kNone && has_neighbours) found(i);
  }
  return groups;
}

}  // namespace

Interpolation Interpolation::transposed() const {
  const int fine_size = static_cast<int>(begin.size()) - 1;
  Interpolation result{fine_size, std::vector<int>(coarse_size + 1, 0),
                       std::vector<int>(columns.size()), std::vector<float>(columns.size())};
  for (const int column : columns) ++result.begin[column + 1];
  for (int i = 0; i < coarse_size; ++i) result.begin[i + 1] += result.begin[i];
  std::vector<int> next(result.begin.begin(), result.begin.end() - 1);
  for (int i = 0; i < fine_size; ++i) {
    for (int k = begin[i]; k < begin[i + 1]; ++k) {
      const int place = next[columns[k]]++;
      result.columns[place] = i;
      result.weights[place] = weights[k];
    }
  }
  return result;
}

Interpolation smoothedAggregation(const BlockRows& matrix) {
  const std::vector<float> strength = strongCouplings(matrix);
  const Groups groups = group(matrix, strength);
  Interpolation result{groups.count, {0}, {}, {}};
  std::vector<std::pair<int, float>> terms;  // of a row
  const auto add = [&](int column, float weight) {
    const auto same = [&](const auto& term) { return term.first == column; };
    const auto found = std::find_if(terms.begin(), terms.end(), same);
    if (found == terms.end()) {
      terms.emplace_back(column, weight);
    } else {
      found->second += weight;
    }
  };
  for (int i = 0; i < matrix.size(); ++i) {
    float sum = 0.0f;
    for (int s = matrix.begin(i); s < matrix.begin(i + 1); ++s) sum += strength[s];
    terms.clear();
    if (sum > 0.0f) add(groups.of_row[i], 1.0f - kSmoothing);
    for (int s = matrix.begin(i); s < matrix.begin(i + 1); ++s) {
      const float share = strength[s] / sum;
      if (strength[s] > 0.0f) add(groups.of_row[matrix.column(s)], kSmoothing * share);
    }
    std::sort(terms.begin(), terms.end());
    for (const auto& [column, weight] : terms) {
      result.columns.push_back(column);
      result.weights.push_back(weight);
    }
    result.begin.push_back(static_cast<int>(result.columns.size()));
  }
  return result;
}

}  // namespace haptex::linear
