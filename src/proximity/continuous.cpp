#include "haptex/proximity/continuous.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace haptex::proximity {
namespace {

using Eigen::Vector3d;
using Places = std::array<Vector3d, 4>;

// Bounds the error of n . ((1 - t) a + t b), with a and b rounded differences, as a part of the sum
// of the products' magnitudes: eight roundings, and a reserve.
constexpr double kRounding = 16.0 * std::numeric_limits<double>::epsilon();

class ContactSearch {
 public:
  ContactSearch(ElementPairKind kind, const Places& begin, const Places& end, double least_distance)
      : kind_(kind), begin_(begin), end_(end), least_distance_(least_distance) {
    const int first_end = kind == ElementPairKind::kVertexTriangle ? 1 : 2;
    for (int i = 0; i < first_end; ++i) {
      for (int j = first_end; j < 4; ++j) {
        from_[offsets_] = begin[j] - begin[i];
        to_[offsets_] = end[j] - end[i];
        largest_ = largest_.cwiseMax(from_[offsets_].cwiseAbs()).cwiseMax(to_[offsets_].cwiseAbs());
        ++offsets_;
      }
    }
  }

  /// Depth first through the halves of the time, the earlier one first. The directions tried
  /// are those at begin and end of the interval.
  /// @param nearest weights of the nearest points at the beginning
  std::optional<double> run(const Eigen::Vector4d& nearest) {
    // The whole way first: mostly one direction will do.
    Vector3d at_begin = directionOf(begin_, nearest);
    if (separate(at_begin, 0.0, 1.0)) return {};
    double time = 0.0, length = 1.0;
    Vector3d at_end = directionAt(time + length);
    for (int tested = 0; tested < kMostIntervals; ++tested) {
      const double end = time + length;
      if (separate(at_begin, time, end) || separate(at_end, time, end)) {
        if (end >= 1.0) return {};
        time = end;
        // A second half ends the interval above, too.
        while (std::fmod(time, 2.0 * length) == 0.0) length *= 2.0;
        at_begin = at_end;
        at_end = directionAt(time + length);
        continue;
      }
      length *= 0.5;
      if (length < kShortestInterval) return time;
      at_end = directionAt(time + length);
    }
    return time;
  }

 private:
  Vector3d directionAt(double time) const {
    Places places;
    for (int i = 0; i < 4; ++i) places[i] = begin_[i] + time * (end_[i] - begin_[i]);
    return directionOf(places, distanceOf(kind_, places).weights);
  }

  /// Between the nearest points, or normal to both elements where they touch. Any direction is
  /// right, this one is good.
  Vector3d directionOf(const Places& places, const Eigen::Vector4d& w) const {
    const bool is_face = kind_ == ElementPairKind::kVertexTriangle;
    Vector3d direction =
        is_face
            ? Vector3d(w[1] * places[1] + w[2] * places[2] + w[3] * places[3] - places[0])
            : Vector3d(w[2] * places[2] + w[3] * places[3] - w[0] * places[0] - w[1] * places[1]);
    if (direction.cwiseAbs().maxCoeff() < 1e-12 * largest_.maxCoeff()) {
      direction = is_face ? (places[2] - places[1]).cross(places[3] - places[1])
                          : (places[1] - places[0]).cross(places[3] - places[2]);
    }
    return direction.normalized();
  }

  bool separate(const Vector3d& direction, double begin, double end) const {
    const double magnitude = direction.cwiseAbs().dot(largest_);
    const double wanted = least_distance_ * direction.norm() * (1.0 + kRounding) +
                          kRounding * magnitude + std::numeric_limits<double>::min();
    double least = std::numeric_limits<double>::infinity(), most = -least;
    for (int k = 0; k < offsets_; ++k) {
      const double from = direction.dot(from_[k]), to = direction.dot(to_[k]);
      for (double time : {begin, end}) {
        const double along = (1.0 - time) * from + time * to;
        least = std::min(least, along);
        most = std::max(most, along);
      }
    }
    return least > wanted || most < -wanted;
  }

  ElementPairKind kind_;
  const Places& begin_;
  const Places& end_;
  double least_distance_;
  int offsets_ = 0;
  std::array<Vector3d, 4> from_, to_;  // from each vertex of the first to each of the second, m
  Vector3d largest_ = Vector3d::Zero();
};

}  // namespace

std::optional<double> earliestContact(ElementPairKind kind, const Places& begin, const Places& end,
                                      double least_distance) {
  return earliestContact(kind, begin, end, least_distance, distanceOf(kind, begin).weights);
}

std::optional<double> earliestContact(ElementPairKind kind, const Places& begin, const Places& end,
                                      double least_distance, const Eigen::Vector4d& nearest) {
  return ContactSearch(kind, begin, end, least_distance).run(nearest);
}

}  // namespace haptex::proximity
