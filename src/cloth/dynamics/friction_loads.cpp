#include "haptex/cloth/dynamics/friction_loads.h"

#include <algorithm>

namespace haptex::cloth {

FrictionLoads::FrictionLoads(int most_contacts, int solution_size)
    : residual_(Eigen::VectorXd::Zero(most_contacts)),
      steps_(most_contacts, kMaxDirections),
      images_(most_contacts, kMaxDirections),
      solutions_(solution_size, kMaxDirections) {}

void FrictionLoads::begin(const Eigen::VectorXd& loads, const Eigen::VectorXd& results) {
  directions_ = 0;
  stalled_ = false;
  residual_ = results - loads;
  loads_norm_ = std::max(loads.norm(), results.norm());
}

bool FrictionLoads::wantsDirection(double tolerance) const {
  return !stalled_ && directions_ < kMaxDirections && residual_.norm() > tolerance * loads_norm_;
}

void FrictionLoads::add(const Eigen::VectorXd& results, Eigen::Ref<Eigen::VectorXd> change,
                        Eigen::VectorXd& loads, Eigen::Ref<Eigen::VectorXd> solution) {
  constexpr double kStalled = 0.99;  // of the residual before
  constexpr int kSlow = 4;           // directions after which alone it may stall
  const int k = directions_++;
  auto step = steps_.col(k);
  auto image = images_.col(k);
  step = residual_;
  image = results - residual_;
  for (int j = 0; j < k; ++j) {
    const double share = images_.col(j).dot(image);
    image -= share * images_.col(j);
    step -= share * steps_.col(j);
    change -= share * solutions_.col(j);
  }
  const double length = image.norm();
  const double before = residual_.norm();
  if (!(length > 1e-12 * before)) {
    stalled_ = true;
    return;
  }
  image /= length;
  step /= length;
  solutions_.col(k) = change / length;
  const double share = -image.dot(residual_);
  loads += share * step;
  solution += share * solutions_.col(k);
  residual_ += share * image;
  stalled_ = k >= kSlow && residual_.norm() > kStalled * before;
}

}  // namespace haptex::cloth
