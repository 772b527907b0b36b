#include "haptex/appearance/relief_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "haptex/base/require.h"

namespace haptex::appearance {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// Texels on a ray's way. The flattest leaves a relief as high as a third of its length before.
constexpr int kMostSteps = 64 * ReliefSurface::kMaxTexels;

int wrapped(int index, int count) {
  const int rest = index % count;
  return rest < 0 ? rest + count : rest;
}

/// Weights of four neighbours at a share of the way from the second to the third.
std::array<double, 4> catmullRom(double t) {
  return {0.5 * t * (-1.0 + t * (2.0 - t)), 1.0 + 0.5 * t * t * (-5.0 + 3.0 * t),
          0.5 * t * (1.0 + t * (4.0 - 3.0 * t)), 0.5 * t * t * (t - 1.0)};
}

double resampled(const tactile::HeightField& field, double column, double row) {
  const int i = static_cast<int>(std::floor(column)), j = static_cast<int>(std::floor(row));
  const std::array<double, 4> along = catmullRom(column - i), across = catmullRom(row - j);
  double height = 0.0;
  for (int b = 0; b < 4; ++b) {
    for (int a = 0; a < 4; ++a) {
      height += along[a] * across[b] *
                field.at(wrapped(i + a - 1, field.columns), wrapped(j + b - 1, field.rows));
    }
  }
  return height;
}

void requireTexels(const char* name, int count) {
  if (count >= ReliefSurface::kMinTexels && count <= ReliefSurface::kMaxTexels) return;
  base::refuse("the relief has ", count, " ", name, " of texels: allowed are ",
               ReliefSurface::kMinTexels, " to ", ReliefSurface::kMaxTexels);
}

void requireCount(const char* name, std::size_t count, std::size_t needed) {
  if (count == needed) return;
  base::refuse("the relief has ", count, " ", name, ": it needs ", needed);
}

/// First t in [0, length] where c + b t + a t^2, negative before, is no longer negative.
std::optional<double> firstRoot(double a, double b, double c, double length) {
  // A ray that begins on the surface may lie below it by rounding: it is met only if it goes
  // deeper.
  if (c >= 0.0) return b > 0.0 ? std::optional<double>(0.0) : std::nullopt;
  const double discriminant = b * b - 4.0 * a * c;
  if (discriminant < 0.0) return std::nullopt;
  const double root = std::sqrt(discriminant);
  // Without cancellation: 2c/(-b - root) grows through zero, where it is positive it comes first.
  const double t = -2.0 * c / (b + root);
  if (b + root > 0.0 && t <= length) return t;
  return std::nullopt;
}

}  // namespace

ReliefSurface::ReliefSurface(const tactile::FaceRelief& relief, int columns, int rows)
    : columns_(columns), rows_(rows) {
  tactile::requireSound(relief.heights);
  requireTexels("columns", columns);
  requireTexels("rows", rows);
  const tactile::HeightField& field = relief.heights;
  requireCount("values of warp_on_top", relief.warp_on_top.size(), field.heights.size());
  size_ = {field.columns * field.weft_spacing, field.rows * field.warp_spacing};
  const double columns_each = static_cast<double>(field.columns) / columns;
  const double rows_each = static_cast<double>(field.rows) / rows;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      heights_.push_back(
          static_cast<float>(resampled(field, column * columns_each, row * rows_each)));
      const int i = wrapped(std::lround((column + 0.5) * columns_each), field.columns);
      const int j = wrapped(std::lround((row + 0.5) * rows_each), field.rows);
      warp_on_top_.push_back(relief.warp_on_top[static_cast<std::size_t>(field.columns) * j + i]);
    }
  }
  prepare();
}

ReliefSurface::ReliefSurface(int columns, int rows, const Vector2d& size,
                             std::vector<float> heights, std::vector<bool> warp_on_top)
    : columns_(columns),
      rows_(rows),
      size_(size),
      heights_(std::move(heights)),
      warp_on_top_(std::move(warp_on_top)) {
  requireTexels("columns", columns);
  requireTexels("rows", rows);
  for (const double length : size) {
    base::require(length > 0.0 && length <= 1.0, "relief", "size", length, "> 0 and <= 1 m");
  }
  requireCount("heights", heights_.size(), static_cast<std::size_t>(texels()));
  requireCount("values of warp_on_top", warp_on_top_.size(), static_cast<std::size_t>(texels()));
  for (const float height : heights_) {
    base::require(std::abs(height) <= 1.0, "relief", "height", height, "from -1 to 1 m");
  }
  prepare();
}

void ReliefSurface::prepare() {
  spacing_ = size_.cwiseQuotient(Vector2d(columns_, rows_));
  patches_.reserve(heights_.size());
  for (int row = 0; row < rows_; ++row) {
    const int above = columns_ * ((row + 1) % rows_), here = columns_ * row;
    for (int column = 0; column < columns_; ++column) {
      const int next = (column + 1) % columns_;
      const float h00 = heights_[here + column], h10 = heights_[here + next];
      const float h01 = heights_[above + column], h11 = heights_[above + next];
      patches_.push_back(
          {h00, h10 - h00, h01 - h00, h11 - h10 - h01 + h00, std::max({h00, h10, h01, h11})});
    }
  }
  const auto [low, high] = std::minmax_element(heights_.begin(), heights_.end());
  highest_ = *high;
  // Far less than a texel, far more than the rounding of heights.
  lift_ = 1e-6 * (*high - *low) + 1e-6 * spacing_.minCoeff();
}

ReliefSurface::Point ReliefSurface::pointIn(int texel, const Vector3d& place) const {
  const Patch& patch = patches_[texel];
  const auto within = [](double in_texels) { return in_texels - std::floor(in_texels); };
  const double x = within(place.x() / spacing_.x()), y = within(place.y() / spacing_.y());
  const Vector3d normal(-(patch.hx + y * patch.hxy) / spacing_.x(),
                        -(patch.hy + x * patch.hxy) / spacing_.y(), 1.0);
  return {texel, place, normal.normalized()};
}

ReliefSurface::Point ReliefSurface::centreOf(int texel) const {
  const Patch& patch = patches_[texel];
  const int column = texel % columns_, row = texel / columns_;
  return pointIn(texel, {(column + 0.5) * spacing_.x(), (row + 0.5) * spacing_.y(),
                         patch.h + 0.5 * (patch.hx + patch.hy) + 0.25 * patch.hxy});
}

std::optional<ReliefSurface::Meeting> ReliefSurface::meet(const Vector3d& origin,
                                                          const Vector3d& direction) const {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  std::array<int, 2> cell;
  std::array<int, 2> step;
  std::array<double, 2> at, per_distance, next, each;
  for (int axis = 0; axis < 2; ++axis) {
    at[axis] = origin[axis] / spacing_[axis];
    cell[axis] = static_cast<int>(std::floor(at[axis]));
    per_distance[axis] = direction[axis] / spacing_[axis];
    step[axis] = per_distance[axis] < 0.0 ? -1 : 1;
    if (std::abs(per_distance[axis]) < 1e-12) {
      next[axis] = each[axis] = kNever;
      continue;
    }
    each[axis] = 1.0 / std::abs(per_distance[axis]);
    next[axis] = (cell[axis] + (step[axis] > 0 ? 1 : 0) - at[axis]) / per_distance[axis];
  }
  std::array<int, 2> index{wrapped(cell[0], columns_), wrapped(cell[1], rows_)};
  const std::array<int, 2> counts{columns_, rows_};
  double begin = 0.0;
  for (int count = 0; count < kMostSteps; ++count) {
    const double end = std::min(next[0], next[1]);
    const double z = origin.z() + begin * direction.z();
    if (direction.z() > 0.0 && z > highest_) return std::nullopt;
    const double last_z =
        end == kNever ? (direction.z() > 0.0 ? kNever : -kNever) : origin.z() + end * direction.z();
    const Patch& patch = patches_[columns_ * index[1] + index[0]];
    if (std::min(z, last_z) <= patch.highest) {
      const double x = at[0] + begin * per_distance[0] - cell[0];
      const double y = at[1] + begin * per_distance[1] - cell[1];
      const auto root =
          firstRoot(patch.hxy * per_distance[0] * per_distance[1],
                    (patch.hx + y * patch.hxy) * per_distance[0] +
                        (patch.hy + x * patch.hxy) * per_distance[1] - direction.z(),
                    patch.h + x * patch.hx + y * patch.hy + x * y * patch.hxy - z, end - begin);
      if (root) return Meeting{columns_ * index[1] + index[0], begin + *root};
    }
    if (end == kNever) return std::nullopt;  // upright
    const int axis = next[0] < next[1] ? 0 : 1;
    begin = end;
    next[axis] += each[axis];
    cell[axis] += step[axis];
    index[axis] = wrapped(index[axis] + step[axis], counts[axis]);
  }
  return std::nullopt;
}

ReliefSurface::Point ReliefSurface::seenAt(const Vector2d& seen,
                                           const Vector3d& towards_eye) const {
  const Vector3d origin(seen.x(), seen.y(), highest_ + lift_);
  const auto met = meet(origin, -towards_eye);
  // A ray downwards meets a height field; by rounding at an edge it can slip through.
  if (!met)
    return centreOf(columns_ * wrapped(std::lround(seen.y() / spacing_.y()), rows_) +
                    wrapped(std::lround(seen.x() / spacing_.x()), columns_));
  return pointIn(met->texel, origin - met->distance * towards_eye);
}

std::optional<ReliefSurface::Point> ReliefSurface::met(const Point& from,
                                                       const Vector3d& direction) const {
  const Vector3d origin = from.place + lift_ * from.normal;
  const auto met = meet(origin, direction);
  if (!met) return std::nullopt;
  return pointIn(met->texel, origin + met->distance * direction);
}

}  // namespace haptex::appearance
