#include "haptex/appearance/brdf.h"

#include <cmath>

#include "haptex/base/repeatable_random.h"

namespace haptex::appearance {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

Vector3f interpolated(const Brdf::Table& table, const DirectionWeights& views,
                      const DirectionWeights& lights) {
  Vector3f sum = Vector3f::Zero();
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      const auto weight = static_cast<float>(views.weight[i] * lights.weight[j]);
      sum += weight * table.col(kDirections * views.index[i] + lights.index[j]);
    }
  }
  return sum;
}

}  // namespace

Brdf::Brdf(const Table& reflectance) : reflectance_(reflectance) {
  // Lights by the cosine: evenly over the circle below them.
  constexpr int kRadii = 16, kTurns = 32;
  Eigen::Matrix<float, kDirections, 1> weights = Eigen::Matrix<float, kDirections, 1>::Zero();
  for (int radius = 0; radius < kRadii; ++radius) {
    const double across = std::sqrt((radius + 0.5) / kRadii);
    for (int turn = 0; turn < kTurns; ++turn) {
      const double azimuth = 2.0 * M_PI * (turn + 0.5) / kTurns;
      const DirectionWeights lights =
          weightsOf({across * std::cos(azimuth), across * std::sin(azimuth),
                     std::sqrt(1.0 - across * across)});
      for (int i = 0; i < 4; ++i) {
        weights[lights.index[i]] += static_cast<float>(M_PI / (kRadii * kTurns) * lights.weight[i]);
      }
    }
  }
  for (int view = 0; view < kDirections; ++view) {
    under_sky_.col(view) = reflectance_.middleCols<kDirections>(kDirections * view) * weights;
  }
}

Vector3f Brdf::radiance(const Vector3d& view, const Vector3d& light) const {
  if (!(light.z() > 0.0)) return Vector3f::Zero();
  return static_cast<float>(light.z() / light.norm()) *
         interpolated(reflectance_, weightsOf(view), weightsOf(light));
}

Vector3f Brdf::underSky(const Vector3d& view) const {
  const DirectionWeights views = weightsOf(view);
  Vector3f sum = Vector3f::Zero();
  for (int i = 0; i < 4; ++i) {
    sum += static_cast<float>(views.weight[i]) * under_sky_.col(views.index[i]);
  }
  return sum;
}

Brdf meanOverRepeat(const Btf& btf) {
  constexpr int kAlongASide = 16;
  Brdf::Table reflectance;
  for (int view = 0; view < kDirections; ++view) {
    for (int light = 0; light < kDirections; ++light) {
      const int column = kDirections * view + light;
      const Vector3d& towards_light = sampledDirections()[light];
      // Other places for every pair, or all would share their error.
      const auto places =
          placesOver(btf.surface().size(), kAlongASide, static_cast<unsigned>(column));
      reflectance.col(column) =
          (meanRadiance(btf.pair(sampledDirections()[view], towards_light), places) /
           towards_light.z())
              .cast<float>();
    }
  }
  return Brdf(reflectance);
}

double meanError(const Btf& btf, const Brdf& brdf, const MeasureSize& size) {
  base::RepeatableRandom random(size.seed);
  const double least_height = std::cos(75.0 / 180.0 * M_PI);
  const auto draw = [&random, least_height] {
    Vector3d direction;
    do {
      direction = random.direction();
    } while (direction.z() < least_height);
    return direction;
  };
  double differences = 0.0, squares = 0.0;
  for (int i = 0; i < size.pairs; ++i) {
    const Vector3d view = draw(), light = draw();
    const auto places = placesOver(btf.surface().size(), size.places, size.seed + 1 + i);
    const Vector3d mean = meanRadiance(btf.pair(view, light), places);
    differences += (brdf.radiance(view, light).cast<double>() - mean).squaredNorm();
    squares += mean.squaredNorm();
  }
  return std::sqrt(differences / squares);
}

}  // namespace haptex::appearance
