#include "haptex/proximity/exact_orientation.h"

#include <cmath>
#include <limits>

#include "haptex/proximity/exact_number.h"

namespace haptex::proximity {
namespace {

using Eigen::Vector3d;

constexpr double kRounding = 0.5 * std::numeric_limits<double>::epsilon();
// Shewchuk 1997, figures 20 and 21: times the sum of the products' magnitudes. With fused products
// the errors are smaller.
constexpr double kVolumeError = (7.0 + 56.0 * kRounding) * kRounding;
constexpr double kAreaError = (3.0 + 16.0 * kRounding) * kRounding;

int signOf(double value) { return (value > 0.0) - (value < 0.0); }

struct ExactVector {
  ExactVector(const Vector3d& from, const Vector3d& to) {
    for (int k = 0; k < 3; ++k) at[k] = ExactNumber(to[k]) - from[k];
  }
  ExactNumber at[3];
};

ExactNumber area(const ExactVector& a, const ExactVector& b, int axis) {
  const int x = (axis + 1) % 3, y = (axis + 2) % 3;
  return a.at[x] * b.at[y] - a.at[y] * b.at[x];
}

}  // namespace

int orientation(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& d) {
  const Vector3d u = b - a, v = c - a, w = d - a;
  double volume = 0.0, magnitude = 0.0;
  for (int k = 0; k < 3; ++k) {
    const int x = (k + 1) % 3, y = (k + 2) % 3;
    const double first = v[x] * w[y], second = v[y] * w[x];
    volume += u[k] * (first - second);
    magnitude += std::abs(u[k]) * (std::abs(first) + std::abs(second));
  }
  if (std::abs(volume) > kVolumeError * magnitude) return signOf(volume);
  if (u.isZero(0.0) || v.isZero(0.0) || w.isZero(0.0)) return 0;
  const ExactVector exact_u(a, b), exact_v(a, c), exact_w(a, d);
  ExactNumber sum;
  for (int k = 0; k < 3; ++k) sum = sum + exact_u.at[k] * area(exact_v, exact_w, k);
  return sum.sign();
}

int projectedOrientation(const Vector3d& a, const Vector3d& b, const Vector3d& c, int axis) {
  const int x = (axis + 1) % 3, y = (axis + 2) % 3;
  const double first = (b[x] - a[x]) * (c[y] - a[y]);
  const double second = (b[y] - a[y]) * (c[x] - a[x]);
  const double twice_area = first - second;
  if (std::abs(twice_area) > kAreaError * (std::abs(first) + std::abs(second))) {
    return signOf(twice_area);
  }
  return area(ExactVector(a, b), ExactVector(a, c), axis).sign();
}

}  // namespace haptex::proximity
