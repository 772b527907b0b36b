#include "haptex/cloth/dynamics/recent_motion.h"

namespace haptex::cloth {

RecentMotion::RecentMotion(const Cloth& cloth)
    : last_(cloth.initialState().positions), predicted_(last_) {
  positions_.fill(last_);
}

void RecentMotion::takeBdf2(const ClothState& before, double first, const Positions& middle,
                            double of_before, double a) {
  positions_[0] = middle;
  positions_[1] = before.positions;
  times_ = {before.time + first, before.time};
  weights_ = {1.0 + of_before, -of_before};
  count_ = 2;
  a_ = a;
}

void RecentMotion::startAnew(const ClothState& end) {
  positions_[0] = end.positions;
  times_[0] = end.time;
  weights_[0] = 1.0;
  count_ = 1;
  a_ = 1.0;
}

void RecentMotion::end(const ClothState& state) {
  last_ = state.positions;
  time_ = state.time;
}

StrainPast RecentMotion::strains() const {
  StrainPast past{a_};
  for (int k = 0; k < count_; ++k) past.add(positions_[k], weights_[k]);
  return past;
}

StrainPast RecentMotion::strainsAfter(const ClothState& begin, double a) const {
  StrainPast past{a};
  past.add(begin.positions, 1.0 + a / a_);
  for (int k = 0; k < count_; ++k) past.add(positions_[k], -a / a_ * weights_[k]);
  return past;
}

/// By Lagrange's polynomial through three instants.
const Positions* RecentMotion::predictAfter(const ClothState& begin, double ahead) {
  if (count_ < 2) return nullptr;
  const double t0 = times_[0] - begin.time, t1 = times_[1] - begin.time;
  const double of_begin = (ahead - t0) * (ahead - t1) / (t0 * t1);
  const double of_0 = ahead * (ahead - t1) / (t0 * (t0 - t1));
  const double of_1 = ahead * (ahead - t0) / (t1 * (t1 - t0));
  for (std::size_t i = 0; i < predicted_.size(); ++i) {
    predicted_[i] =
        of_begin * begin.positions[i] + of_0 * positions_[0][i] + of_1 * positions_[1][i];
  }
  return &predicted_;
}

const Positions* RecentMotion::predict(const ClothState& before, const Positions& middle,
                                       double first, double second) {
  const double share = 1.0 + second / first;
  for (std::size_t i = 0; i < predicted_.size(); ++i) {
    const Eigen::Vector3d straight = first * before.velocities[i];
    predicted_[i] = before.positions[i] + share * straight +
                    share * share * (middle[i] - before.positions[i] - straight);
  }
  return &predicted_;
}

}  // namespace haptex::cloth
