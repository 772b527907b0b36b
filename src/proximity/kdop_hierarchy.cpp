#include "haptex/proximity/kdop_hierarchy.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>

namespace haptex::proximity {
namespace {

using Eigen::Vector3d;

constexpr double kMargin = kSinglePrecisionMargin;

void requireTriangles(const std::vector<std::array<int, 3>>& triangles, std::size_t vertices) {
  if (triangles.empty()) throw std::invalid_argument("a hierarchy needs at least one triangle");
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    for (int vertex : triangles[i]) {
      if (vertex >= 0 && static_cast<std::size_t>(vertex) < vertices) continue;
      throw std::invalid_argument("triangle " + std::to_string(i) + " has vertex " +
                                  std::to_string(vertex) + ": must be from 0 to " +
                                  std::to_string(static_cast<long long>(vertices) - 1));
    }
  }
}

void requirePositions(const std::vector<Vector3d>& positions) {
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (!isPlace(positions[i])) requirePlace(positions[i], "position " + std::to_string(i));
  }
}

/// Enough levels for leaves of at most so many triangles.
int countLevels(std::size_t triangles, int per_leaf) {
  if (per_leaf < 1) {
    throw std::invalid_argument("triangles_per_leaf " + std::to_string(per_leaf) +
                                ": must be >= 1");
  }
  int levels = 1;
  while ((static_cast<std::size_t>(per_leaf) << (levels - 1)) < triangles) ++levels;
  return levels;
}

class CursorBody : public Body {
 public:
  explicit CursorBody(const Cursor& cursor) : cursor_(cursor) {}

  int parts() const override { return static_cast<int>(cursor_.parts().size()); }
  double least(int part, const Vector3d& normal) const override {
    const TaperedCapsule& capsule = cursor_.parts()[part];
    const double length = normal.norm();
    return std::min(normal.dot(capsule.begin.centre) - length * capsule.begin.radius,
                    normal.dot(capsule.end.centre) - length * capsule.end.radius);
  }
  NearElement near(int index, const Triangle& triangle) const override {
    return nearElement(index, triangle, cursor_);
  }

 private:
  const Cursor& cursor_;
};

}  // namespace

KdopHierarchy::KdopHierarchy(std::vector<std::array<int, 3>> triangles,
                             const std::vector<Vector3d>& positions,
                             const HierarchySettings& settings)
    : triangles_(std::move(triangles)),
      kind_(settings.kind),
      groups_(kernels::groupsOf(settings.kind)),
      kernels_(&kernels::choose(groups_, settings.instruction_set)),
      levels_(countLevels(triangles_.size(), settings.triangles_per_leaf)),
      first_leaf_((1 << (levels_ - 1)) - 1) {
  requireTriangles(triangles_, positions.size());
  requirePositions(positions);
  const auto& axes = kdopAxes(kind_);
  const std::size_t padded = static_cast<std::size_t>(groups_) * kernels::kGroup;
  axes_.assign(3 * padded, 0.0f);
  inverse_lengths_.assign(2 * padded, 1.0f);
  for (std::size_t i = 0; i < axes.size(); ++i) {
    for (int k = 0; k < 3; ++k) axes_[k * padded + i] = static_cast<float>(axes[i][k]);
    inverse_lengths_[i] = inverse_lengths_[padded + i] = static_cast<float>(1.0 / axes[i].norm());
  }
  build(positions);
  listLeafParticles();
  positions_.resize(positions.size());
  particles_.resize(4 * positions.size());
  heights_.resize((2 * static_cast<std::size_t>(first_leaf_) + 1) * 2 * padded);
  refit(positions);
}

int KdopHierarchy::leafBegin(int leaf) const {
  return static_cast<int>(static_cast<long long>(leaf) * static_cast<long long>(triangles_.size()) /
                          leaves());
}

/// Halves the triangles of every volume by their centres along the longest side of the box around
/// them.
void KdopHierarchy::build(const std::vector<Vector3d>& positions) {
  std::vector<Vector3d> centres(triangles_.size());
  for (std::size_t i = 0; i < triangles_.size(); ++i) {
    const auto& t = triangles_[i];
    centres[i] = (positions[t[0]] + positions[t[1]] + positions[t[2]]) / 3.0;
  }
  order_.resize(triangles_.size());
  std::iota(order_.begin(), order_.end(), 0);
  for (int level = 0; level + 1 < levels_; ++level) {
    const int wide = 1 << (levels_ - 1 - level);  // leaves below a volume
    for (int leaf = 0; leaf < leaves(); leaf += wide) {
      const auto begin = order_.begin() + leafBegin(leaf);
      const auto middle = order_.begin() + leafBegin(leaf + wide / 2);
      const auto end = order_.begin() + leafBegin(leaf + wide);
      if (middle == end) continue;
      Eigen::AlignedBox3d box;
      for (auto i = begin; i != end; ++i) box.extend(centres[*i]);
      int axis;
      box.sizes().maxCoeff(&axis);
      std::nth_element(begin, middle, end, [&](int a, int b) {
        return std::make_pair(centres[a][axis], a) < std::make_pair(centres[b][axis], b);
      });
    }
  }
}

void KdopHierarchy::listLeafParticles() {
  leaf_begin_.assign(1, 0);
  for (int leaf = 0; leaf < leaves(); ++leaf) {
    std::vector<int> particles;
    for (int i = leafBegin(leaf); i < leafBegin(leaf + 1); ++i) {
      const auto& corners = triangles_[order_[i]];
      particles.insert(particles.end(), corners.begin(), corners.end());
    }
    std::sort(particles.begin(), particles.end());
    particles.erase(std::unique(particles.begin(), particles.end()), particles.end());
    leaf_particles_.insert(leaf_particles_.end(), particles.begin(), particles.end());
    leaf_begin_.push_back(static_cast<int>(leaf_particles_.size()));
  }
}

void KdopHierarchy::refit(const std::vector<Vector3d>& positions) {
  if (positions.size() != positions_.size()) {
    throw std::invalid_argument(std::to_string(positions.size()) +
                                " positions for a hierarchy over " +
                                std::to_string(positions_.size()) + " vertices");
  }
  requirePositions(positions);
  origin_ = positions[triangles_[0][0]];
  extent_ = 0.0;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    positions_[i] = positions[i];
    const Vector3d relative = positions[i] - origin_;
    extent_ = std::max(extent_, relative.cwiseAbs().maxCoeff());
    for (int k = 0; k < 3; ++k) particles_[4 * i + k] = static_cast<float>(relative[k]);
  }
  kernels_->refit({axes_.data(), particles_.data(), leaf_begin_.data(), leaf_particles_.data(),
                   heights_.data(), first_leaf_});
}

/// Hands the triangles of the visited leaves to the body, and keeps the near ones.
class KdopHierarchy::Search {
 public:
  Search(const KdopHierarchy& hierarchy, const Body& body, const Range& range,
         std::vector<NearElement>& found)
      : hierarchy_(hierarchy), body_(body), range_(range), found_(found), limit_(range.distance) {
    updateReach();
  }

  static void visitAll(void* search, int leaf) { static_cast<Search*>(search)->visit(leaf, false); }
  static void visitNearest(void* search, int leaf) {
    static_cast<Search*>(search)->visit(leaf, true);
  }

  const float* reach() const { return &reach_; }
  std::int64_t triangles() const { return triangles_; }

 private:
  void visit(int leaf, bool narrow) {
    const int end = hierarchy_.leafBegin(leaf + 1);
    for (int i = hierarchy_.leafBegin(leaf); i < end; ++i) {
      const int index = hierarchy_.order_[i];
      const NearElement element = body_.near(index, hierarchy_.triangle(index));
      ++triangles_;
      if (!(element.distance <= limit_)) continue;
      if (narrow) {
        keepNearest(element);
      } else {
        found_.push_back(element);
      }
    }
  }

  /// The found ones are a heap with the farthest on top.
  void keepNearest(const NearElement& element) {
    if (found_.size() == range_.count) {
      if (!isNearer(element, found_.front())) return;
      std::pop_heap(found_.begin(), found_.end(), isNearer);
      found_.back() = element;
    } else {
      found_.push_back(element);
    }
    std::push_heap(found_.begin(), found_.end(), isNearer);
    if (found_.size() < range_.count) return;
    limit_ = found_.front().distance;
    updateReach();
  }

  void updateReach() { reach_ = static_cast<float>(limit_ + kMargin * std::abs(limit_)); }

  const KdopHierarchy& hierarchy_;
  const Body& body_;
  const Range& range_;
  std::vector<NearElement>& found_;
  double limit_;  // m, beyond which nothing is wanted
  float reach_;   // m, the same with a margin
  std::int64_t triangles_ = 0;
};

/// Heights below which a volume is farther than `distance` from each part.
void KdopHierarchy::computeLeast(const Body& body, double distance,
                                 std::vector<float>& least) const {
  const auto& axes = kdopAxes(kind_);
  const std::size_t padded = static_cast<std::size_t>(groups_) * kernels::kGroup;
  least.assign(2 * padded * static_cast<std::size_t>(body.parts()),
               -std::numeric_limits<float>::infinity());
  for (int part = 0; part < body.parts(); ++part) {
    float* of_part = least.data() + 2 * padded * static_cast<std::size_t>(part);
    for (std::size_t i = 0; i < 2 * axes.size(); ++i) {
      const bool opposite = i >= axes.size();
      const std::size_t axis = opposite ? i - axes.size() : i;
      const Vector3d normal = opposite ? Vector3d(-axes[axis]) : axes[axis];
      const double length = normal.norm();
      const double height = body.least(part, normal) - normal.dot(origin_);
      const double margin =
          kMargin * (3.0 * extent_ + std::abs(height) + normal.cwiseAbs().dot(origin_.cwiseAbs()));
      of_part[opposite ? padded + axis : axis] =
          static_cast<float>(height - length * distance - margin - kMargin * length * distance);
    }
  }
}

void KdopHierarchy::computePairLimits(double distance, std::vector<float>& limits) const {
  const std::size_t padded = static_cast<std::size_t>(groups_) * kernels::kGroup;
  limits.assign(2 * padded, -std::numeric_limits<float>::infinity());
  const auto& axes = kdopAxes(kind_);
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const double length = axes[i].norm();
    limits[i] = limits[padded + i] =
        static_cast<float>(-(1.0 + kMargin) * length * distance - 6.0 * kMargin * extent_);
  }
}

void KdopHierarchy::query(const Body& body, const Range& range, std::vector<NearElement>& found,
                          QueryCost* cost) const {
  requireValid(range);
  found.clear();
  if (range.count == 0) return;
  const kernels::VolumeTree tree{heights_.data(), first_leaf_};
  thread_local std::vector<float> least;
  Search search(*this, body, range, found);
  int volumes;
  if (range.count >= triangles_.size()) {
    computeLeast(body, range.distance, least);
    volumes = kernels_->visit(tree, {least.data(), body.parts()}, {Search::visitAll, &search});
  } else {
    computeLeast(body, 0.0, least);
    volumes = kernels_->visitNearest(
        tree, {{least.data(), body.parts()}, inverse_lengths_.data(), search.reach()},
        {Search::visitNearest, &search});
  }
  std::sort(found.begin(), found.end(), isNearer);
  if (cost == nullptr) return;
  cost->volumes += volumes;
  cost->triangles += search.triangles();
}

void KdopHierarchy::query(const Cursor& cursor, const Range& range, std::vector<NearElement>& found,
                          QueryCost* cost) const {
  query(CursorBody(cursor), range, found, cost);
}

/// How far a volume is at least from the nearest body, in lengths of the normals, below 0 unless it
/// is apart; as the kernels compute it.
/// @param least as computeLeast() has it
float KdopHierarchy::gapOf(int volume, const std::vector<float>& least) const {
  const std::size_t heights = 2 * static_cast<std::size_t>(groups_) * kernels::kGroup;
  const float* of_volume = heights_.data() + static_cast<std::size_t>(volume) * heights;
  float smallest = std::numeric_limits<float>::infinity();
  for (std::size_t body = 0; body < least.size(); body += heights) {
    float widest = -std::numeric_limits<float>::infinity();
    for (std::size_t h = 0; h < heights; ++h) {
      widest = std::max(widest, (least[body + h] - of_volume[h]) * inverse_lengths_[h]);
    }
    smallest = std::min(smallest, widest);
  }
  return smallest;
}

std::vector<VolumeIndex> KdopHierarchy::tested(const Body& body, const Range& range) const {
  requireValid(range);
  std::vector<VolumeIndex> result;
  if (range.count == 0) return result;
  std::vector<float> least;
  std::vector<NearElement> found;
  Search search(*this, body, range, found);
  const bool all = range.count >= triangles_.size();
  computeLeast(body, all ? range.distance : 0.0, least);
  const auto test = [&](int volume) {
    int level = 0;
    while (volume + 1 >= 2 << level) ++level;
    result.push_back({level, volume + 1 - (1 << level)});
    return std::pair(gapOf(volume, least), volume);
  };
  std::vector<std::pair<float, int>> waiting = {test(0)};
  while (!waiting.empty()) {
    const auto [gap, volume] = waiting.back();
    waiting.pop_back();
    if (gap > (all ? 0.0F : *search.reach())) continue;
    if (volume >= first_leaf_) {
      if (!all) Search::visitNearest(&search, volume - first_leaf_);
      continue;
    }
    auto nearer = test(2 * volume + 1), farther = test(2 * volume + 2);
    if (farther.first < nearer.first) std::swap(nearer, farther);
    waiting.push_back(farther);
    waiting.push_back(nearer);
  }
  return result;
}

std::vector<VolumeIndex> KdopHierarchy::tested(const Cursor& cursor, const Range& range) const {
  return tested(CursorBody(cursor), range);
}

Triangle KdopHierarchy::triangle(int index) const {
  const auto& corners = triangles_[index];
  return {positions_[corners[0]], positions_[corners[1]], positions_[corners[2]]};
}

Kdop KdopHierarchy::volume(int level, int index) const {
  if (level < 0 || level >= levels_ || index < 0 || index >= 1 << level) {
    throw std::out_of_range("volume " + std::to_string(index) + " of level " +
                            std::to_string(level) + ": there are levels 0 to " +
                            std::to_string(levels_ - 1) + " of 2^level volumes");
  }
  const auto& axes = kdopAxes(kind_);
  const std::size_t padded = static_cast<std::size_t>(groups_) * kernels::kGroup;
  const float* heights =
      heights_.data() +
      ((std::size_t{1} << level) - 1 + static_cast<std::size_t>(index)) * 2 * padded;
  Kdop kdop;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const double shift = axes[i].dot(origin_);
    kdop.push_back({axes[i], heights[i] + shift});
    kdop.push_back({-axes[i], heights[padded + i] - shift});
  }
  return kdop;
}

}  // namespace haptex::proximity
