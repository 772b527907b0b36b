#include "haptex/oracles/exact/light_paths.h"

#include <Eigen/Geometry>
#include <cmath>

#include "haptex/appearance/btf.h"

namespace haptex::oracles {
namespace {

using appearance::Reflectance;
using appearance::ReliefSurface;
using base::RepeatableRandom;
using Eigen::Vector2d;
using Eigen::Vector3d;

// What arrives after so many reflections on a relief that sees a third of itself is below 1e-9.
constexpr int kMostReflections = 20;

/// By the cosine to the normal.
Vector3d cosineDirection(const Vector3d& normal, RepeatableRandom& random) {
  const Vector3d sum = normal + random.direction();
  return sum.norm() > 1e-6 ? sum.normalized().eval() : normal;
}

Vector3d alongPath(const ReliefSurface& surface, const Reflectance& reflectance,
                   ReliefSurface::Point point, Vector3d view, const Vector3d& light,
                   RepeatableRandom& random) {
  Vector3d sum = Vector3d::Zero(), share = Vector3d::Ones();
  for (int i = 0; i < kMostReflections; ++i) {
    sum += share.cwiseProduct(appearance::directRadiance(surface, reflectance, point, view, light));
    const Vector3d from = cosineDirection(point.normal, random);
    const auto met = surface.met(point, from);
    if (!met) break;
    share = M_PI * share.cwiseProduct(
                       reflectance.of(surface.warpOnTop()[point.texel], point.normal, from, view));
    point = *met;
    view = -from;
  }
  return sum;
}

}  // namespace

Vector3d radianceByPaths(const ReliefSurface& surface, const Reflectance& reflectance,
                         const Vector3d& view, const Vector3d& light, int paths,
                         RepeatableRandom& random) {
  Vector3d sum = Vector3d::Zero();
  for (int row = 0; row < paths; ++row) {
    for (int column = 0; column < paths; ++column) {
      const Vector2d within = random.inSquare(0.0, 1.0);
      const Vector2d seen = surface.size().cwiseProduct(Vector2d(column, row) + within) / paths;
      sum += alongPath(surface, reflectance, surface.seenAt(seen, view), view, light, random);
    }
  }
  return sum / (paths * paths);
}

}  // namespace haptex::oracles
