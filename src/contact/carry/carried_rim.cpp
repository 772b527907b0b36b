#include "haptex/contact/carry/carried_rim.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "haptex/contact/patch_forces.h"

namespace haptex::contact {
namespace {

constexpr double kReach = 0.03;  // m, of the cloth that goes along

double sumOf(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

}  // namespace

CarriedRim::CarriedRim(const RefinedCut& cut, const linear::SymmetricBlockMatrix& pattern,
                       double mass)
    : first_(cut.free_count), mass_(mass) {
  for (int i = first_; i < pattern.size(); ++i) {
    for (int s = pattern.rowBegin(i); s < pattern.rowBegin(i + 1); ++s) {
      const int column = pattern.column(s);
      if (column >= first_) {
        inner_.push_back(s);
      } else if (i > first_) {
        folds_.push_back({s, pattern.slot(first_, column)});
      }
    }
  }
}

std::vector<std::array<int, 2>> CarriedRim::pairs(const RefinedCut& cut,
                                                  const linear::SymmetricBlockMatrix& pattern) {
  std::vector<std::array<int, 2>> pairs;
  for (int i = cut.free_count + 1; i < pattern.size(); ++i) {
    for (int s = pattern.rowBegin(i); s < pattern.rowBegin(i + 1); ++s) {
      if (pattern.column(s) < cut.free_count) pairs.push_back({pattern.column(s), cut.free_count});
    }
  }
  return pairs;
}

void CarriedRim::start(const Eigen::Vector3d& cloth_velocity) {
  offset_.setZero();
  velocity_.setZero();
  cloth_velocity_ = cloth_velocity;
}

void CarriedRim::goOnFrom(const CarriedRim& other) {
  offset_ = other.offset_;
  velocity_ = other.velocity_;
  rate_ = other.rate_;
  rest_ = other.rest_;
  cloth_velocity_ = other.cloth_velocity_;
}

void CarriedRim::setClothVelocity(const Eigen::Vector3d& velocity) {
  velocity_ -= velocity - cloth_velocity_;
  cloth_velocity_ = velocity;
}

void CarriedRim::addTo(linear::SymmetricBlockMatrix& matrix, linear::BlockVector& rhs,
                       const Eigen::Vector3d& outer_force, double h) const {
  for (const Fold& fold : folds_) matrix.lower(fold.to) += matrix.lower(fold.from);
  Eigen::Matrix3d& diagonal = matrix.diagonal(first_);
  for (int i = first_ + 1; i < matrix.size(); ++i) {
    diagonal += matrix.diagonal(i);
    rhs.col(first_) += rhs.col(i);
  }
  for (const int slot : inner_) diagonal += matrix.lower(slot) + matrix.lower(slot).transpose();
  const double stiffness = mass_ * rate_ * rate_, damping = 2.0 * mass_ * rate_;
  diagonal.diagonal().array() += mass_ + h * damping + h * h * stiffness;
  rhs.col(first_) -=
      h * (outer_force + stiffness * (offset_ + h * velocity_) + damping * velocity_);
}

void CarriedRim::advance(const Eigen::Vector3d& change, double h) {
  velocity_ += change;
  offset_ += h * velocity_;
}

void CarriedRim::follow(double speed, double h) {
  rest_ = speed > kSpeed ? 0.0 : rest_ + h;
  if (rest_ == 0.0) rate_ = kRate;
  if (rest_ > kRest) rate_ = std::min(kMostRate, rate_ * std::exp(h / kStiffening));
}

double massAround(const mesh::ClothMesh& coarse, const RefinedCut& cut,
                  const std::vector<material::Fabric>& fabrics) {
  const double patch = sumOf(massesOf(cut.mesh, fabrics));
  const double density = patch / sumOf(areasOf(cut.mesh));
  const double all = sumOf(massesOf(coarse, fabrics));
  return std::min(density * M_PI * kReach * kReach, all - patch);
}

bool canBeCarried(const RefinedCut& cut, const std::vector<char>& attached) {
  const bool is_held =
      std::any_of(cut.supports.begin(), cut.supports.end(), [&](const Support& support) {
        return std::any_of(support.particles.begin(), support.particles.end(),
                           [&](int particle) { return particle >= 0 && attached[particle]; });
      });
  return !is_held && cut.free_count < static_cast<int>(cut.supports.size());
}

}  // namespace haptex::contact
