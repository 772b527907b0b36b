#include "haptex/appearance/interreflection.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>

namespace haptex::appearance {
namespace {

using Eigen::Vector3d;
using Matrix = Interreflection::Matrix;

// Rays from a texel: the square of as many strata. What few rays meet of a highlight is the noisier
// the more light it has and the narrower it is.
constexpr int kFewestStrata = 10, kMostStrata = 20;
constexpr double kStrataOfGloss = 20.0;  // by gloss over width

int strataFor(const material::Look& look) {
  const double strata = std::round(kStrataOfGloss * look.gloss / look.width);
  return static_cast<int>(std::clamp<double>(strata, kFewestStrata, kMostStrata));
}

constexpr int kMostReflections = 200;
constexpr float kSmallest = 1e-5f;  // of an irradiance of 1: what later reflections would add

constexpr auto kByPi = static_cast<float>(1.0 / M_PI);

/// The three channels once for every light.
Eigen::Array<float, 1, Eigen::Dynamic> repeated(const Vector3d& channels, std::size_t lights) {
  return channels.cast<float>().transpose().replicate(1, lights).array();
}

/// Directions by the cosine to z, one in the middle of each of strata^2 parts of equal weight.
std::vector<Vector3d> cosineRays(int strata) {
  std::vector<Vector3d> rays;
  for (int i = 0; i < strata; ++i) {
    for (int j = 0; j < strata; ++j) {
      const double square = (i + 0.5) / strata, radius = std::sqrt(square);
      // Each ring is turned against the one before, or rays of all would lie one above the other.
      const double turn = 2.0 * M_PI * (j + 0.618034 * i) / strata;
      rays.push_back({radius * std::cos(turn), radius * std::sin(turn), std::sqrt(1.0 - square)});
    }
  }
  return rays;
}

/// A turn of its own for every texel, so that errors of neighbours differ and average out.
double turnOf(int texel) {
  auto bits = static_cast<std::uint32_t>(texel) * 2654435761u;
  bits ^= bits >> 15;
  bits *= 2246822519u;
  bits ^= bits >> 13;
  return 2.0 * M_PI * bits / 4294967296.0;
}

/// The view, raised to the plane of the surface where it lies below: between views from which a
/// texel is seen and others something has to stand.
Vector3d raised(const Vector3d& view, const Vector3d& normal) {
  constexpr double kLeast = 0.02;
  const double cosine = normal.dot(view);
  if (cosine >= kLeast) return view;
  return (view + (kLeast - cosine) * normal).normalized();
}

}  // namespace

Interreflection::Interreflection(const ReliefSurface& surface, const material::Look& look)
    : surface_(surface), reflectance_(look), rays_(cosineRays(strataFor(look))) {
  for (int texel = 0; texel < surface_.texels(); ++texel) {
    centres_.push_back(surface_.centreOf(texel));
  }
  met_.reserve(static_cast<std::size_t>(surface_.texels()) * rays());
  for (int texel = 0; texel < surface_.texels(); ++texel) {
    for (int ray = 0; ray < rays(); ++ray) {
      const auto met = surface_.met(centres_[texel], rayOf(texel, ray));
      met_.push_back(met ? met->texel : -1);
    }
  }
}

Vector3d Interreflection::rayOf(int texel, int ray) const {
  const double turn = turnOf(texel), cosine = std::cos(turn), sine = std::sin(turn);
  const Vector3d& normal = centres_[texel].normal;
  // z > 0 of a normal, so it is never along x.
  const Vector3d across = normal.cross(Vector3d::UnitX()).normalized();
  const Vector3d along = across.cross(normal);
  const Vector3d& local = rays_[ray];
  return (cosine * local.x() - sine * local.y()) * along +
         (sine * local.x() + cosine * local.y()) * across + local.z() * normal;
}

double Interreflection::openShare(int texel) const {
  const auto first = met_.begin() + static_cast<std::ptrdiff_t>(texel) * rays();
  return static_cast<double>(std::count(first, first + rays(), -1)) / rays();
}

Matrix Interreflection::arriving(const std::vector<Vector3d>& directions) const {
  Matrix arriving(surface_.texels(), directions.size());
  for (int texel = 0; texel < surface_.texels(); ++texel) {
    for (std::size_t i = 0; i < directions.size(); ++i) {
      const double cosine = centres_[texel].normal.dot(directions[i]);
      const bool lit = cosine > 0.0 && !surface_.met(centres_[texel], directions[i]);
      arriving(texel, i) = lit ? static_cast<float>(cosine) : 0.0f;
    }
  }
  return arriving;
}

Interreflection::Light Interreflection::solve(const std::vector<Vector3d>& directions) const {
  Light light{directions, arriving(directions), {}};
  // Reflection by reflection: what the last one sent, gathered.
  const auto columns = static_cast<Eigen::Index>(3 * directions.size());
  Matrix sent(surface_.texels(), columns), gathered(surface_.texels(), columns);
  const auto reflect = [&](Matrix& arriving) {
    for (int texel = 0; texel < surface_.texels(); ++texel) {
      arriving.row(texel).array() *=
          repeated(reflectance_.albedo(surface_.warpOnTop()[texel]), directions.size());
    }
  };
  for (Eigen::Index i = 0; i < columns; ++i) sent.col(i) = light.arriving.col(i / 3);
  reflect(sent);
  light.radiosity = sent;
  for (int i = 0; i < kMostReflections && columns > 0 && sent.maxCoeff() > kSmallest; ++i) {
    for (int texel = 0; texel < surface_.texels(); ++texel) {
      const int* const met = met_.data() + static_cast<std::ptrdiff_t>(texel) * rays();
      auto row = gathered.row(texel);
      row.setZero();
      for (int ray = 0; ray < rays(); ++ray) {
        if (met[ray] >= 0) row += sent.row(met[ray]);
      }
      row /= static_cast<float>(rays());
    }
    reflect(gathered);
    light.radiosity += gathered;
    sent.swap(gathered);
  }
  return light;
}

/// Radiance that comes along rays from the texels that they meet: diffuse, but for the highlights
/// of what arrived there directly.
Matrix Interreflection::radianceMet(const Light& light, const std::vector<int>& met,
                                    const std::vector<Vector3d>& rays) const {
  const auto gloss = static_cast<float>(reflectance_.look().gloss);
  Matrix radiance(met.size(), light.radiosity.cols());
  for (std::size_t i = 0; i < met.size(); ++i) {
    radiance.row(i) = light.radiosity.row(met[i]) * kByPi;
    if (!(gloss > 0.0f)) continue;
    const Vector3d& normal = centres_[met[i]].normal;
    for (std::size_t j = 0; j < light.directions.size(); ++j) {
      const float arrived = light.arriving(met[i], j);
      if (!(arrived > 0.0f)) continue;
      const auto highlight =
          static_cast<float>(reflectance_.highlight(normal, light.directions[j], -rays[i]));
      radiance.block<1, 3>(i, 3 * j).array() += gloss * arrived * (highlight - kByPi);
    }
  }
  return radiance;
}

Matrix Interreflection::send(int texel, const Light& light,
                             const std::vector<Vector3d>& views) const {
  std::vector<int> met;
  std::vector<Vector3d> leaving, meeting;
  for (int ray = 0; ray < rays(); ++ray) {
    const int other = met_[static_cast<std::size_t>(texel) * rays() + ray];
    (other < 0 ? leaving : meeting).push_back(rayOf(texel, ray));
    if (other >= 0) met.push_back(other);
  }
  if (met.empty()) return Matrix::Zero(views.size(), light.radiosity.cols());
  const Matrix radiance = radianceMet(light, met, meeting);
  // The diffuse part is the same for all views.
  const material::Look& look = reflectance_.look();
  const auto& colour = surface_.warpOnTop()[texel] ? look.warp : look.weft;
  const Vector3d diffuse = (1.0 - look.gloss) / rays() * Vector3d(colour[0], colour[1], colour[2]);
  const Eigen::RowVectorXf even =
      (radiance.colwise().sum().array() * repeated(diffuse, light.directions.size())).matrix();
  Matrix sent = even.replicate(views.size(), 1);
  if (!(look.gloss > 0.0)) return sent;
  // The highlight, its weights over all rays of sum 1: none of it is lost between the few rays.
  const Vector3d& normal = centres_[texel].normal;
  Matrix weights(views.size(), met.size());
  for (std::size_t view = 0; view < views.size(); ++view) {
    const Vector3d seen = raised(views[view], normal);
    double all = 0.0;
    for (const Vector3d& ray : leaving) all += reflectance_.highlight(normal, ray, seen);
    for (std::size_t i = 0; i < met.size(); ++i) {
      const double weight = reflectance_.highlight(normal, meeting[i], seen);
      weights(view, i) = static_cast<float>(weight);
      all += weight;
    }
    weights.row(view) *= static_cast<float>(look.gloss / all);
  }
  sent.noalias() += weights * radiance;
  return sent;
}

}  // namespace haptex::appearance
