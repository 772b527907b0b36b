#include "haptex/garment/pattern/plane_predicates.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "haptex/proximity/exact_number.h"
#include "haptex/proximity/exact_orientation.h"

namespace haptex::garment {
namespace {

using Eigen::Vector2d;
using proximity::ExactNumber;

constexpr double kRounding = 0.5 * std::numeric_limits<double>::epsilon();
// Shewchuk 1997, figure 23: times the sum of the products' magnitudes.
constexpr double kCircleError = (10.0 + 96.0 * kRounding) * kRounding;

Eigen::Vector3d inSpace(const Vector2d& point) { return {point.x(), point.y(), 0.0}; }

int exactInCircle(const std::array<Vector2d, 3>& corners, const Vector2d& d) {
  std::array<ExactNumber, 3> x, y, square;
  for (int i = 0; i < 3; ++i) {
    x[i] = ExactNumber(corners[i].x()) - d.x();
    y[i] = ExactNumber(corners[i].y()) - d.y();
    square[i] = x[i] * x[i] + y[i] * y[i];
  }
  ExactNumber sum;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    sum = sum + square[i] * (x[j] * y[k] - x[k] * y[j]);
  }
  return sum.sign();
}

// Of a point on the line through a and b.
bool between(const Vector2d& a, const Vector2d& b, const Vector2d& point) {
  return std::min(a.x(), b.x()) <= point.x() && point.x() <= std::max(a.x(), b.x()) &&
         std::min(a.y(), b.y()) <= point.y() && point.y() <= std::max(a.y(), b.y());
}

}  // namespace

int turn(const Vector2d& a, const Vector2d& b, const Vector2d& c) {
  return proximity::projectedOrientation(inSpace(a), inSpace(b), inSpace(c), 2);
}

int inCircle(const Vector2d& a, const Vector2d& b, const Vector2d& c, const Vector2d& d) {
  const std::array<Vector2d, 3> corners = {a, b, c};
  double sum = 0.0, magnitude = 0.0;
  for (int i = 0; i < 3; ++i) {
    const Vector2d p = corners[i] - d, q = corners[(i + 1) % 3] - d, r = corners[(i + 2) % 3] - d;
    const double first = q.x() * r.y(), second = r.x() * q.y();
    sum += p.squaredNorm() * (first - second);
    magnitude += p.squaredNorm() * (std::abs(first) + std::abs(second));
  }
  if (std::abs(sum) > kCircleError * magnitude) return sum > 0.0 ? 1 : -1;
  return exactInCircle(corners, d);
}

bool touch(const Vector2d& a, const Vector2d& b, const Vector2d& c, const Vector2d& d) {
  const int abc = turn(a, b, c), abd = turn(a, b, d);
  const int cda = turn(c, d, a), cdb = turn(c, d, b);
  if (abc * abd < 0 && cda * cdb < 0) return true;
  return (abc == 0 && between(a, b, c)) || (abd == 0 && between(a, b, d)) ||
         (cda == 0 && between(c, d, a)) || (cdb == 0 && between(c, d, b));
}

}  // namespace haptex::garment
