// Batches of elements in parts that threads share.
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "haptex/linear/thread_pool.h"

namespace haptex::cloth::kernels {

/// Parts of a row of elements.
struct Part {
  int first, count;
  int lowest, highest;  ///< of their particles
};

constexpr int kMostParts = 64;
constexpr int kLeastPart = 1024;  // batches

/// Parts in phases, and where each phase ends: parts of one phase have no particle in common. As
/// many phases as there are parts where the particles' numbers are in no order.
struct Phases {
  std::vector<Part> parts;
  std::vector<int> ends;
};
Phases phasesOf(const std::vector<Part>& parts);

/// The batches of elements. Many are cut into parts, the same for any number of threads, and what
/// parts add is added in the same order: no sum depends on the threads.
/// @tparam Batch with particles[which][lane]
template <typename Batch>
class BatchList {
 public:
  /// Allocates.
  void assign(std::vector<Batch> batches) {
    batches_ = std::move(batches);
    const int count = size();
    const int most = std::max(kLeastPart, (count + kMostParts - 1) / kMostParts);
    parts_.clear();
    for (int first = 0; first < count; first += most) {
      parts_.push_back(partOf(first, std::min(most, count - first)));
    }
    phases_ = phasesOf(parts_);
  }

  int size() const { return static_cast<int>(batches_.size()); }

  /// Calls function(batches, first, count) for all parts. What runs side by side has no particle in
  /// common. @param pool may be null
  template <typename Function>
  void forEachPart(linear::ThreadPool* pool, const Function& function) const {
    int begin = 0;
    for (const int end : phases_.ends) {
      linear::runTasks(pool, end - begin,
                       [&](int task, int) { call(function, phases_.parts[begin + task]); });
      begin = end;
    }
  }

  /// The sum of function(batches, first, count) over all parts, in their order.
  template <typename Function>
  double sumOfParts(linear::ThreadPool* pool, const Function& function) const {
    std::array<double, kMostParts> sums;
    const int count = static_cast<int>(parts_.size());
    linear::runTasks(pool, count,
                     [&](int task, int) { sums[task] = call(function, parts_[task]); });
    double sum = 0.0;
    for (int part = 0; part < count; ++part) sum += sums[part];
    return sum;
  }

 private:
  template <typename Function>
  auto call(const Function& function, const Part& part) const {
    return function(batches_.data() + part.first, part.first, part.count);
  }
  Part partOf(int first, int count) const {
    Part part{first, count, batches_[first].particles[0][0], 0};
    for (int b = first; b < first + count; ++b) {
      for (const auto& of_lanes : batches_[b].particles) {
        const auto [least, most] = std::minmax_element(std::begin(of_lanes), std::end(of_lanes));
        part.lowest = std::min(part.lowest, *least);
        part.highest = std::max(part.highest, *most);
      }
    }
    return part;
  }

  std::vector<Batch> batches_;
  std::vector<Part> parts_;  // in the order of the batches
  Phases phases_;
};

}  // namespace haptex::cloth::kernels
