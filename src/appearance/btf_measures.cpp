#include "haptex/appearance/btf_measures.h"

#include <algorithm>
#include <cmath>

#include "haptex/base/repeatable_random.h"

namespace haptex::appearance {
namespace {

using base::RepeatableRandom;
using Eigen::Vector2d;
using Eigen::Vector3d;

/// Uniform over the hemisphere, but for the last degree above the plane, in which a pair of
/// directions is taken as another one (kFlattest).
Vector3d upwards(RepeatableRandom& random) {
  Vector3d direction;
  do {
    direction = random.direction();
    direction.z() = std::abs(direction.z());
  } while (direction.z() < kFlattest);
  return direction;
}

}  // namespace

std::vector<Vector2d> placesOver(const Vector2d& size, int along_a_side, unsigned seed) {
  RepeatableRandom random(seed);
  std::vector<Vector2d> places;
  for (int row = 0; row < along_a_side; ++row) {
    for (int column = 0; column < along_a_side; ++column) {
      const Vector2d within = random.inSquare(0.0, 1.0);
      places.push_back(size.cwiseProduct(Vector2d(column, row) + within) / along_a_side);
    }
  }
  return places;
}

Vector3d meanRadiance(const Btf::Pair& pair, const std::vector<Vector2d>& places) {
  Vector3d sum = Vector3d::Zero();
  for (const Vector2d& place : places) sum += pair.at(place);
  return sum / static_cast<double>(places.size());
}

double furnaceError(const Btf& white, const MeasureSize& size) {
  RepeatableRandom random(size.seed);
  double worst = 0.0;
  for (int view = 0; view < size.furnace_views; ++view) {
    const Vector3d towards_eye = upwards(random);
    Vector3d sum = Vector3d::Zero();
    for (int i = 0; i < size.lights; ++i) {
      for (int j = 0; j < size.lights; ++j) {
        // Uniform in solid angle: radiance 1 is an irradiance of 2 pi/count from each.
        const double z = (i + random.uniform(0.0, 1.0)) / size.lights;
        const double turn = 2.0 * M_PI * (j + random.uniform(0.0, 1.0)) / size.lights;
        const double radius = std::sqrt(1.0 - z * z);
        const Vector3d light(radius * std::cos(turn), radius * std::sin(turn), std::max(z, 1e-9));
        // Other places for every light, or all would share their error.
        const auto places =
            placesOver(white.surface().size(), size.places, size.seed + 1 + size.lights * i + j);
        sum += meanRadiance(white.pair(towards_eye, light), places);
      }
    }
    const Vector3d sent = 2.0 * M_PI / (size.lights * size.lights) * sum;
    worst = std::max(worst, (sent.array() - 1.0).abs().maxCoeff());
  }
  return worst;
}

double reciprocityError(const Btf& btf, const MeasureSize& size) {
  RepeatableRandom random(size.seed);
  const auto places = placesOver(btf.surface().size(), size.places, size.seed);
  double differences = 0.0, squares = 0.0;
  for (int i = 0; i < size.pairs; ++i) {
    const Vector3d a = upwards(random), b = upwards(random);
    const Vector3d there = meanRadiance(btf.pair(a, b), places) / b.z();
    const Vector3d back = meanRadiance(btf.pair(b, a), places) / a.z();
    differences += (there - back).squaredNorm();
    squares += 0.5 * (there.squaredNorm() + back.squaredNorm());
  }
  return std::sqrt(differences / squares);
}

Difference unsampledError(const Btf& btf, const Interreflection& exact, const MeasureSize& size) {
  RepeatableRandom random(size.seed);
  const ReliefSurface& surface = btf.surface();
  const auto places = placesOver(surface.size(), size.places, size.seed);
  std::vector<Vector3d> views, lights;
  for (int i = 0; i < size.pairs; ++i) {
    views.push_back(upwards(random));
    lights.push_back(upwards(random));
  }
  double differences = 0.0, squares = 0.0, sum = 0.0;
  for (int i = 0; i < size.pairs; ++i) {
    const Btf::Pair pair = btf.pair(views[i], lights[i]);
    const Interreflection::Light light = exact.solve({lights[i]});
    for (const Vector2d& place : places) {
      const ReliefSurface::Point point = surface.seenAt(place, views[i]);
      const Vector3d right =
          directRadiance(surface, exact.reflectance(), point, views[i], lights[i]) +
          exact.send(point.texel, light, {views[i]}).row(0).transpose().cast<double>();
      differences += (pair.at(place) - right).squaredNorm();
      squares += right.squaredNorm();
      sum += right.sum();
    }
  }
  const double count = 3.0 * static_cast<double>(places.size()) * size.pairs;
  const double error = std::sqrt(differences / count);
  return {error * count / sum, error / std::sqrt(squares / count)};
}

}  // namespace haptex::appearance
