#include "haptex/contact/layers_between.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace haptex::contact {
namespace {

using base::Finger;
using base::kFingers;
using Eigen::Vector3d;

// In thicknesses: how far beyond the last layer the next one counts whole, and not at all.
constexpr double kWhole = 1.5, kNone = 2.5;
// In thicknesses: nearer than any other layer is, where elements beside its own pass the particle.
constexpr double kOwn = 0.1;
constexpr double kRounding = 1e-6;  // of a layer

/// Whether the line through the origin along `way` passes an edge on its left. Of both triangles of
/// an edge that is hit exactly one is crossed, because both ask the same question.
bool passesLeft(const Vector3d& way, const Vector3d& a, const Vector3d& b, bool swapped) {
  const double side = swapped ? way.dot(b.cross(a)) : way.dot(a.cross(b));
  return (side >= 0.0) != swapped;
}

}  // namespace

LayersBetween::LayersBetween(const mesh::ClothMesh& coarse, const RefinedCut& cut, double thickness,
                             std::vector<double> areas)
    : thickness_(thickness),
      free_count_(cut.free_count),
      areas_(std::move(areas)),
      weights_(cut.weights),
      shared_areas_(areas_) {
  std::vector<int> elements = cut.elements;
  std::sort(elements.begin(), elements.end());
  for (const int element : elements) {
    const auto& corners = coarse.triangles[element];
    vertices_.insert(vertices_.end(), corners.begin(), corners.end());
  }
  std::sort(vertices_.begin(), vertices_.end());
  vertices_.erase(std::unique(vertices_.begin(), vertices_.end()), vertices_.end());
  const auto index_of = [](const std::vector<int>& sorted, int value) {
    return static_cast<int>(std::lower_bound(sorted.begin(), sorted.end(), value) - sorted.begin());
  };
  for (const int element : elements) {
    Triangle triangle{element, {}};
    for (int c = 0; c < 3; ++c) {
      triangle.corners[c] = index_of(vertices_, coarse.triangles[element][c]);
    }
    triangles_.push_back(triangle);
  }
  for (const int owner : cut.owners) owners_.push_back(index_of(elements, owner));
  places_.assign(vertices_.size(), Vector3d::Zero());
  crossings_.reserve(triangles_.size());
  for (const Finger finger : kFingers) {
    before_[finger].assign(areas_.size(), 0.0);
    targets_[finger].assign(areas_.size(), 0.0);
  }
}

void LayersBetween::clear() {
  for (const Finger finger : kFingers) {
    std::fill(before_[finger].begin(), before_[finger].end(), 0.0);
    std::fill(targets_[finger].begin(), targets_[finger].end(), 0.0);
  }
  shared_areas_ = areas_;
  is_single_ = true;
  is_counted_ = false;
}

void LayersBetween::adopt(int particle, const LayersBetween& other, int other_particle) {
  if (other.is_single_) return;
  double layers = 1.0;
  for (const Finger finger : kFingers) {
    before_[finger][particle] = other.before_[finger][other_particle];
    targets_[finger][particle] = other.targets_[finger][other_particle];
    layers += before_[finger][particle];
  }
  shared_areas_[particle] = areas_[particle] / layers;
  is_single_ = false;
  is_counted_ = is_counted_ || other.is_counted_;
}

void LayersBetween::place(const LargeScaleMotion& motion) {
  for (std::size_t i = 0; i < vertices_.size(); ++i) places_[i] = motion.position(vertices_[i]);
}

/// Layers on the line from a particle to the centre of a fingertip.
double LayersBetween::count(int particle, const Vector3d& from, const Vector3d& centre) {
  const Vector3d way = centre - from;
  const double length = way.norm();
  const double farthest = std::min(length, kNone * kMost * thickness_);
  crossings_.clear();
  for (int t = 0; t < static_cast<int>(triangles_.size()); ++t) {
    if (t == owners_[particle]) continue;
    const auto& [i, j, k] = triangles_[t].corners;
    const Vector3d a = places_[i] - from, b = places_[j] - from, c = places_[k] - from;
    const bool left = passesLeft(way, a, b, i > j);
    if (passesLeft(way, b, c, j > k) != left || passesLeft(way, c, a, k > i) != left) continue;
    const Vector3d normal = (b - a).cross(c - a);
    const double distance = normal.dot(a) / normal.dot(way) * length;
    if (distance > kOwn * thickness_ && distance < farthest) crossings_.push_back(distance);
  }
  std::sort(crossings_.begin(), crossings_.end());
  double layers = 0.0, weight = 1.0, last = 0.0;
  for (const double distance : crossings_) {
    const double gap = (distance - last) / thickness_;
    weight *= std::clamp((kNone - gap) / (kNone - kWhole), 0.0, 1.0);
    layers += weight;
    last = distance;
  }
  return std::min(layers, kMost - 1.0);
}

/// Of a part of the particles that both fingertips may push, from opposite sides.
void LayersBetween::countAll(const base::PerFinger<const Fingertip*>& fingertips) {
  is_counted_ = true;
  for (int i = round_; i < free_count_; i += kRounds) {
    const auto& corners = triangles_[owners_[i]].corners;
    const Vector3d& weights = weights_[i];
    const Vector3d from = weights[0] * places_[corners[0]] + weights[1] * places_[corners[1]] +
                          weights[2] * places_[corners[2]];
    bool between = (fingertips[Finger::kIndex]->position - from)
                       .dot(fingertips[Finger::kThumb]->position - from) < 0.0;
    for (const Finger finger : kFingers) {
      const double reach = fingertips[finger]->radius + kMost * thickness_;
      between = between && (from - fingertips[finger]->position).squaredNorm() < reach * reach;
    }
    for (const Finger finger : kFingers) {
      targets_[finger][i] = between ? count(i, from, fingertips[finger]->position) : 0.0;
    }
  }
}

void LayersBetween::update(const LargeScaleMotion& motion,
                           const base::PerFinger<const Fingertip*>& fingertips, double h) {
  const Fingertip* const index = fingertips[Finger::kIndex];
  const Fingertip* const thumb = fingertips[Finger::kThumb];
  const bool pinches = index != nullptr && thumb != nullptr &&
                       (index->position - thumb->position).norm() <
                           index->radius + thumb->radius + kMost * thickness_;
  if (pinches) {
    place(motion);
    countAll(fingertips);
    round_ = (round_ + 1) % kRounds;
  } else if (is_counted_) {
    for (auto& targets : targets_.values) std::fill(targets.begin(), targets.end(), 0.0);
    is_counted_ = false;
  }
  if (is_single_ && !is_counted_) return;
  const double change = 1.0 - std::exp(-h / kFade);
  is_single_ = true;
  for (int i = 0; i < free_count_; ++i) {
    double layers = 1.0;
    for (const Finger finger : kFingers) {
      double& before = before_[finger][i];
      const double target = targets_[finger][i];
      before += change * (target - before);
      if (std::abs(target - before) < kRounding) before = target;
      layers += before;
    }
    shared_areas_[i] = areas_[i] / layers;
    is_single_ = is_single_ && layers == 1.0;
  }
}

}  // namespace haptex::contact
