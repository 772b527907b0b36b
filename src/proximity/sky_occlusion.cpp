#include "haptex/proximity/sky_occlusion.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <utility>

#include "haptex/base/require.h"
#include "haptex/proximity/cursor.h"

namespace haptex::proximity {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr int kMostLanes = 8;

// Of a register: four numbers with the baseline, eight with AVX2. The results are the same: none of
// the instruction sets fuses a multiplication with a sum here.
template <int kLanes>
struct Register;
template <>
struct Register<4> {
  typedef float Floats __attribute__((vector_size(16)));
  typedef int Integers __attribute__((vector_size(16)));
};
template <>
struct Register<8> {
  typedef float Floats __attribute__((vector_size(32)));
  typedef int Integers __attribute__((vector_size(32)));
};

// By reference: a function that returned a wide register would have another ABI without AVX.
template <typename Lanes, typename Number>
[[gnu::always_inline]] inline void load(const Number* from, Lanes& to) {
  std::memcpy(&to, from, sizeof(to));
}

template <typename Integers>
[[gnu::always_inline]] inline void mark(const Integers& which, int* marks) {
  Integers both;
  load(marks, both);
  both |= which;
  std::memcpy(marks, &both, sizeof(both));
}

}  // namespace

SkyOcclusion::SkyOcclusion(std::vector<std::array<int, 3>> triangles, std::size_t particles,
                           InstructionSet instruction_set)
    : instruction_set_(instruction_set),
      triangles_(std::move(triangles)),
      points_(particles),
      normals_(particles),
      side_(std::max(1, static_cast<int>(std::sqrt(static_cast<double>(particles))))),
      x_(particles),
      y_(particles),
      z_(particles),
      column_(particles),
      row_(particles),
      begin_(static_cast<std::size_t>(side_) * side_ + 1),
      order_(particles + kMostLanes - 1),
      sorted_x_(particles + kMostLanes - 1, std::numeric_limits<float>::quiet_NaN()),
      sorted_y_(sorted_x_),
      sorted_z_(sorted_x_),
      hidden_along_(particles + kMostLanes - 1),
      hidden_against_(particles + kMostLanes - 1),
      total_(particles),
      sums_(particles),
      shares_(particles) {
  kernels::choose(1, instruction_set);  // refuses it if the processor lacks it
  for (std::size_t i = 0; i < triangles_.size(); ++i) {
    for (const int vertex : triangles_[i]) {
      if (vertex >= 0 && static_cast<std::size_t>(vertex) < particles) continue;
      base::refuse("triangle ", i, " has vertex ", vertex, ": there are ", particles, " particles");
    }
  }
  // Half of a Fibonacci spiral (Gonzalez 2010, Mathematical Geosciences 42:49) about an axis along
  // which no edge of a cloth is likely to run.
  const Eigen::Matrix3d turn =
      (Eigen::AngleAxisd(0.41, Vector3d::UnitX()) * Eigen::AngleAxisd(0.67, Vector3d::UnitY()))
          .toRotationMatrix();
  const double golden = M_PI * (3.0 - std::sqrt(5.0));
  for (int i = 0; i < kDirections; ++i) {
    const double z = 1.0 - (i + 0.5) / kDirections, r = std::sqrt(1.0 - z * z);
    const Vector3d at(r * std::cos(golden * i), r * std::sin(golden * i), z);
    directions_.push_back((turn * at).cast<float>());
  }
}

void SkyOcclusion::readPositions(const std::vector<Vector3d>& positions) {
  if (positions.size() != points_.size()) {
    base::refuse(positions.size(), " positions for a sky over ", points_.size(), " particles");
  }
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (!isPlace(positions[i])) requirePlace(positions[i], "position " + std::to_string(i));
  }
  for (std::size_t i = 0; i < positions.size(); ++i) {
    points_[i] = (positions[i] - positions[0]).cast<float>();
  }
}

void SkyOcclusion::sumNormals() {
  std::fill(normals_.begin(), normals_.end(), Vector3f::Zero());
  for (const auto& triangle : triangles_) {
    const auto& [a, b, c] = triangle;
    const Vector3f normal = (points_[b] - points_[a]).cross(points_[c] - points_[a]);
    for (const int particle : triangle) normals_[particle] += normal;
  }
  for (Vector3f& normal : normals_) {
    const float length = normal.norm();
    if (length > 0.0f) normal /= length;
  }
}

void SkyOcclusion::project(const Vector3f& direction) {
  const Vector3f across = direction.unitOrthogonal(), up = direction.cross(across);
  float right = -std::numeric_limits<float>::infinity(), high = right;
  left_ = low_ = std::numeric_limits<float>::infinity();
  for (std::size_t i = 0; i < points_.size(); ++i) {
    x_[i] = across.dot(points_[i]);
    y_[i] = up.dot(points_[i]);
    z_[i] = direction.dot(points_[i]);
    left_ = std::min(left_, x_[i]);
    right = std::max(right, x_[i]);
    low_ = std::min(low_, y_[i]);
    high = std::max(high, y_[i]);
  }
  const float cells = static_cast<float>(side_) * (1.0f - 1e-6f);  // the last place is in the last
  columns_per_metre_ = right > left_ ? cells / (right - left_) : 0.0f;
  rows_per_metre_ = high > low_ ? cells / (high - low_) : 0.0f;
}

/// By counting, so that the cells of a row lie one after the other.
void SkyOcclusion::sort() {
  std::fill(begin_.begin(), begin_.end(), 0);
  for (std::size_t i = 0; i < points_.size(); ++i) {
    column_[i] = static_cast<int>((x_[i] - left_) * columns_per_metre_);
    row_[i] = static_cast<int>((y_[i] - low_) * rows_per_metre_);
    ++begin_[row_[i] * side_ + column_[i] + 1];
  }
  for (std::size_t cell = 1; cell < begin_.size(); ++cell) begin_[cell] += begin_[cell - 1];
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const int place = begin_[row_[i] * side_ + column_[i]]++;
    order_[place] = static_cast<int>(i);
    sorted_x_[place] = x_[i];
    sorted_y_[place] = y_[i];
    sorted_z_[place] = z_[i];
  }
  // Each has moved on to the next one's.
  std::copy_backward(begin_.begin(), begin_.end() - 1, begin_.end());
  begin_[0] = 0;
}

template <int kLanes>
[[gnu::always_inline]] inline void SkyOcclusion::coverWith(const std::array<int, 3>& triangle) {
  using Floats = typename Register<kLanes>::Floats;
  using Integers = typename Register<kLanes>::Integers;
  const auto [a, b, c] = triangle;
  const float xa = x_[a], xb = x_[b], xc = x_[c], ya = y_[a], yb = y_[b], yc = y_[c];
  const float area = (xb - xa) * (yc - ya) - (yb - ya) * (xc - xa);
  if (area == 0.0f) return;
  const auto [first_column, last_column] = std::minmax({column_[a], column_[b], column_[c]});
  const auto [first_row, last_row] = std::minmax({row_[a], row_[b], row_[c]});
  // Twice the areas of the triangles that a place makes with the edges, counter-clockwise.
  const float sign = area > 0.0f ? 1.0f : -1.0f;
  const float abx = sign * (xb - xa), aby = sign * (yb - ya), bcx = sign * (xc - xb),
              bcy = sign * (yc - yb), cax = sign * (xa - xc), cay = sign * (ya - yc);
  for (int row = first_row; row <= last_row; ++row) {
    const int end = begin_[row * side_ + last_column + 1];
    // Those of other cells that a register holds besides are judged as well.
    for (int i = begin_[row * side_ + first_column]; i < end; i += kLanes) {
      Floats x, y, z;
      load(&sorted_x_[i], x);
      load(&sorted_y_[i], y);
      const Floats to_c = abx * (y - ya) - aby * (x - xa);
      const Floats to_a = bcx * (y - yb) - bcy * (x - xb);
      const Floats to_b = cax * (y - yc) - cay * (x - xc);
      const Integers inside = (to_c > 0.0f) & (to_a > 0.0f) & (to_b > 0.0f);
      std::int64_t bits[kLanes / 2], any = 0;
      std::memcpy(bits, &inside, sizeof(bits));
      for (const std::int64_t pair : bits) any |= pair;
      if (any == 0) continue;
      Integers particle;
      load(&order_[i], particle);
      load(&sorted_z_[i], z);
      const Integers other = inside & (particle != a) & (particle != b) & (particle != c);
      const Floats weighted = to_a * z_[a] + to_b * z_[b] + to_c * z_[c];
      const Floats level = (to_a + to_b + to_c) * z;
      mark(other & (weighted > level), &hidden_along_[i]);
      mark(other & (weighted <= level), &hidden_against_[i]);
    }
  }
}

void SkyOcclusion::cover() {
  for (const auto& triangle : triangles_) coverWith<4>(triangle);
}

#if defined(__x86_64__)
[[gnu::target("avx2")]] void SkyOcclusion::coverWithAvx2() {
  for (const auto& triangle : triangles_) coverWith<8>(triangle);
}
#else
void SkyOcclusion::coverWithAvx2() { cover(); }  // never the best
#endif

void SkyOcclusion::add(const Vector3f& direction) {
  for (std::size_t place = 0; place < points_.size(); ++place) {
    const int particle = order_[place];
    const float along = normals_[particle].dot(direction), cosine = std::abs(along);
    if (cosine < kHorizon) continue;
    const float seen_along = hidden_along_[place] != 0 ? 0.0f : cosine;
    const float seen_against = hidden_against_[place] != 0 ? 0.0f : cosine;
    total_[particle] += cosine;
    sums_[particle].front += along > 0.0f ? seen_along : seen_against;
    sums_[particle].back += along > 0.0f ? seen_against : seen_along;
  }
}

const std::vector<SkyShare>& SkyOcclusion::compute(const std::vector<Vector3d>& positions) {
  readPositions(positions);
  sumNormals();
  std::fill(total_.begin(), total_.end(), 0.0f);
  std::fill(sums_.begin(), sums_.end(), SkyShare{0.0f, 0.0f});
  for (const Vector3f& direction : directions_) {
    project(direction);
    sort();
    std::fill(hidden_along_.begin(), hidden_along_.end(), 0);
    std::fill(hidden_against_.begin(), hidden_against_.end(), 0);
    if (instruction_set_ == InstructionSet::kAvx2) {
      coverWithAvx2();
    } else {
      cover();
    }
    add(direction);
  }
  for (std::size_t i = 0; i < shares_.size(); ++i) {
    const bool has_normal = total_[i] > 0.0f;
    shares_[i] =
        has_normal ? SkyShare{sums_[i].front / total_[i], sums_[i].back / total_[i]} : SkyShare{};
  }
  return shares_;
}

}  // namespace haptex::proximity
