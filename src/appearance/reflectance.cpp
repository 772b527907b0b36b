#include "haptex/appearance/reflectance.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "haptex/base/require.h"

namespace haptex::appearance {
namespace {

using Eigen::Vector3d;

constexpr double kLeastWidth = 0.05;
constexpr double kLeastLost = 1e-6;  // of which nothing needs to be added
constexpr int kSteps = 96;           // of the integral over facets, each way

Vector3d vectorOf(const material::Colour& colour) { return {colour[0], colour[1], colour[2]}; }

/// Smith's Lambda of GGX.
double lambda(double alpha_squared, double cosine) {
  const double square = cosine * cosine;
  return 0.5 * (std::sqrt(1.0 + alpha_squared * (1.0 - square) / square) - 1.0);
}

/// Mean of G2/G1 over the normals that are seen, which is what single reflections return
/// (Heitz, Sampling the GGX distribution of visible normals, 2018).
double returnedAt(double alpha, double cosine) {
  const double alpha_squared = alpha * alpha;
  const Vector3d view(std::sqrt(1.0 - cosine * cosine), 0.0, cosine);
  const Vector3d stretched = Vector3d(alpha * view.x(), 0.0, view.z()).normalized();
  const Vector3d first =
      stretched.z() > 1.0 - 1e-12 ? Vector3d(Vector3d::UnitX()) : Vector3d(0.0, 1.0, 0.0);
  const Vector3d second = stretched.cross(first);
  const double of_view = 1.0 + lambda(alpha_squared, cosine);
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    for (int j = 0; j < kSteps; ++j) {
      const double radius = std::sqrt((i + 0.5) / kSteps), turn = 2.0 * M_PI * (j + 0.5) / kSteps;
      const double x = radius * std::cos(turn);
      const double s = 0.5 * (1.0 + stretched.z());
      const double y = (1.0 - s) * std::sqrt(1.0 - x * x) + s * radius * std::sin(turn);
      const Vector3d in_disc =
          x * first + y * second + std::sqrt(std::max(0.0, 1.0 - x * x - y * y)) * stretched;
      const Vector3d facet =
          Vector3d(alpha * in_disc.x(), alpha * in_disc.y(), std::max(1e-9, in_disc.z()))
              .normalized();
      const double light_cosine = 2.0 * view.dot(facet) * facet.z() - view.z();
      if (light_cosine <= 0.0) continue;
      sum += of_view / (of_view + lambda(alpha_squared, light_cosine));
    }
  }
  return sum / (kSteps * kSteps);
}

}  // namespace

Reflectance::Reflectance(const material::Look& look) : look_(look) {
  base::require(look.gloss >= 0.0 && look.gloss <= 1.0, "look", "gloss", look.gloss, "from 0 to 1");
  base::require(look.width > 0.0 && look.width <= 1.0, "look", "width", look.width, "> 0 and <= 1");
  for (const auto& [name, colour] : {std::pair("warp", look.warp), {"weft", look.weft}}) {
    for (const double share : colour) {
      base::require(share >= 0.0 && share <= 1.0, "look", name, share, "from 0 to 1");
    }
  }
  const double alpha = std::max(kLeastWidth, look.width);
  alpha_squared_ = alpha * alpha;
  double mean = 0.0;
  for (int i = 0; i < kCosines; ++i) {
    const double cosine = static_cast<double>(i) / (kCosines - 1);
    returned_[i] = returnedAt(alpha, std::clamp(cosine, 1e-4, 1.0 - 1e-9));
    // Of linear pieces between the cosines: 2 c E(c) dc, by Simpson's rule in each piece.
    if (i == 0) continue;
    const double width = 1.0 / (kCosines - 1), before = cosine - width;
    const double middle = 0.5 * (before + cosine) * 0.5 * (returned_[i - 1] + returned_[i]);
    mean += 2.0 * width / 6.0 * (before * returned_[i - 1] + 4.0 * middle + cosine * returned_[i]);
  }
  lost_ = 1.0 - mean;
}

double Reflectance::returned(double cosine) const {
  const double place = std::min(cosine, 1.0) * (kCosines - 1);
  const int before = std::min(static_cast<int>(place), kCosines - 2);
  return returned_[before] + (place - before) * (returned_[before + 1] - returned_[before]);
}

double Reflectance::single(double light_cosine, double view_cosine, double half_cosine) const {
  const double slope = half_cosine * half_cosine * (alpha_squared_ - 1.0) + 1.0;
  const double facets = alpha_squared_ / (M_PI * slope * slope);
  const double masking =
      1.0 / (1.0 + lambda(alpha_squared_, light_cosine) + lambda(alpha_squared_, view_cosine));
  return facets * masking / (4.0 * light_cosine * view_cosine);
}

double Reflectance::highlight(const Vector3d& normal, const Vector3d& light,
                              const Vector3d& view) const {
  const double light_cosine = normal.dot(light), view_cosine = normal.dot(view);
  if (!(light_cosine > 0.0 && view_cosine > 0.0)) return 0.0;
  double sum = single(light_cosine, view_cosine, normal.dot((light + view).normalized()));
  if (lost_ > kLeastLost) {
    sum += (1.0 - returned(light_cosine)) * (1.0 - returned(view_cosine)) / (M_PI * lost_);
  }
  return sum;
}

Vector3d Reflectance::of(bool warp, const Vector3d& normal, const Vector3d& light,
                         const Vector3d& view) const {
  if (!(normal.dot(light) > 0.0 && normal.dot(view) > 0.0)) return Vector3d::Zero();
  Vector3d sum = (1.0 - look_.gloss) / M_PI * vectorOf(warp ? look_.warp : look_.weft);
  if (look_.gloss > 0.0) sum.array() += look_.gloss * highlight(normal, light, view);
  return sum;
}

Vector3d Reflectance::albedo(bool warp) const {
  return (1.0 - look_.gloss) * vectorOf(warp ? look_.warp : look_.weft) +
         Vector3d::Constant(look_.gloss);
}

}  // namespace haptex::appearance
