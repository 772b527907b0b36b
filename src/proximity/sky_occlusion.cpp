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
constexpr int kAlong = 1, kAgainst = 2;  // marks of what hides a particle

// Cells along the sides of the grid, in parts of those that give each particle one. A register
// takes what lies near along a row, so that few long rows with narrow cells are read least often.
constexpr double kRowShare = 0.5, kColumnShare = 2.0;

int cells(double share, std::size_t particles) {
  return std::max(1, static_cast<int>(share * std::sqrt(static_cast<double>(particles))));
}

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

SkyOcclusion::View::View(std::size_t particles, std::size_t cells)
    : places(particles),
      cell(particles),
      begin(cells + 1),
      order(particles),
      sorted_x(particles + kMostLanes, std::numeric_limits<float>::quiet_NaN()),
      sorted_y(sorted_x),
      sorted_z(sorted_x),
      hidden(particles + kMostLanes),
      total(particles),
      sums(particles) {}

SkyOcclusion::SkyOcclusion(std::vector<std::array<int, 3>> triangles, std::size_t particles,
                           linear::ThreadPool* pool, InstructionSet instruction_set)
    : instruction_set_(instruction_set),
      pool_(pool),
      triangles_(std::move(triangles)),
      points_(particles),
      normals_(particles),
      columns_(cells(kColumnShare, particles)),
      rows_(cells(kRowShare, particles)),
      views_(kViews, View(particles, static_cast<std::size_t>(columns_) * rows_)),
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

void SkyOcclusion::project(const Vector3f& direction, View& view) const {
  using Floats = Register<4>::Floats;  // x, y, z, unused
  const Vector3f across = direction.unitOrthogonal(), up = direction.cross(across);
  const Floats by_x{across.x(), up.x(), direction.x(), 0.0f};
  const Floats by_y{across.y(), up.y(), direction.y(), 0.0f};
  const Floats by_z{across.z(), up.z(), direction.z(), 0.0f};
  constexpr float kFar = std::numeric_limits<float>::infinity();
  Floats least{kFar, kFar, kFar, kFar}, most = -least;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const Vector3f& point = points_[i];
    const Floats place = by_x * point.x() + by_y * point.y() + by_z * point.z();
    std::memcpy(&view.places[i], &place, sizeof(place));
    least = place < least ? place : least;
    most = place > most ? place : most;
  }
  view.left = least[0];
  view.low = least[1];
  const float right = most[0], high = most[1];
  constexpr float kShorter = 1.0f - 1e-6f;  // the last place is in the last cell
  const float columns = kShorter * static_cast<float>(columns_);
  const float rows = kShorter * static_cast<float>(rows_);
  view.columns_per_metre = right > view.left ? columns / (right - view.left) : 0.0f;
  view.rows_per_metre = high > view.low ? rows / (high - view.low) : 0.0f;
}

/// By counting, so that the cells of a row lie one after the other.
void SkyOcclusion::sort(View& view) const {
  std::fill(view.begin.begin(), view.begin.end(), 0);
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const int column = static_cast<int>((view.places[i].x - view.left) * view.columns_per_metre);
    const int row = static_cast<int>((view.places[i].y - view.low) * view.rows_per_metre);
    view.cell[i] = row * columns_ + column;
    ++view.begin[view.cell[i] + 1];
  }
  int sum = 0;
  for (std::size_t cell = 1; cell < view.begin.size(); ++cell)
    view.begin[cell] = sum += view.begin[cell];
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const int place = view.begin[view.cell[i]]++;
    view.order[place] = static_cast<int>(i);
    view.sorted_x[place] = view.places[i].x;
    view.sorted_y[place] = view.places[i].y;
    view.sorted_z[place] = view.places[i].z;
  }
  // Each has moved on to the next one's.
  std::copy_backward(view.begin.begin(), view.begin.end() - 1, view.begin.end());
  view.begin[0] = 0;
}

/// Hardly a branch depends on what is found: with one for every hit half of the time went into
/// those that the processor had foretold wrongly.
template <int kLanes>
[[gnu::always_inline]] inline void SkyOcclusion::coverWith(const std::array<int, 3>& triangle,
                                                           View& view) const {
  using Floats = typename Register<kLanes>::Floats;
  using Integers = typename Register<kLanes>::Integers;
  using Corner = Register<4>::Floats;  // x, y, z, unused
  Corner a, b, c;
  load(&view.places[triangle[0]], a);
  load(&view.places[triangle[1]], b);
  load(&view.places[triangle[2]], c);
  const float xa = a[0], xb = b[0], xc = c[0], ya = a[1], yb = b[1], yc = c[1];
  const float area = (xb - xa) * (yc - ya) - (yb - ya) * (xc - xa);
  if (area == 0.0f) return;
  Corner least = a < b ? a : b, most = a < b ? b : a;
  least = c < least ? c : least;
  most = c > most ? c : most;
  const Corner origin{view.left, view.low, 0.0f, 0.0f};
  const Corner cells_per_metre{view.columns_per_metre, view.rows_per_metre, 0.0f, 0.0f};
  using Cell = Register<4>::Integers;  // column, row, unused
  const auto first = __builtin_convertvector((least - origin) * cells_per_metre, Cell);
  const auto last = __builtin_convertvector((most - origin) * cells_per_metre, Cell);
  // Twice the areas of the triangles that a place makes with the edges, counter-clockwise. They are
  // exactly 0 at the triangle's own corners, which it does not hide.
  const float sign = area > 0.0f ? 1.0f : -1.0f;
  const float abx = sign * (xb - xa), aby = sign * (yb - ya), bcx = sign * (xc - xb),
              bcy = sign * (yc - yb), cax = sign * (xa - xc), cay = sign * (ya - yc);
  const int width = last[0] - first[0] + 1;
  const int last_row = last[1] * columns_ + first[0];
  const int* const begin = view.begin.data();
  const float* const sorted_x = view.sorted_x.data();
  const float* const sorted_y = view.sorted_y.data();
  const float* const sorted_z = view.sorted_z.data();
  int* const hidden = view.hidden.data();
  for (int cell = first[1] * columns_ + first[0]; cell <= last_row; cell += columns_) {
    const int end = begin[cell + width];
    int i = begin[cell];
    // Those of other cells that a register holds besides are judged as well.
    do {
      Floats x, y, z;
      load(sorted_x + i, x);
      load(sorted_y + i, y);
      load(sorted_z + i, z);
      const Floats to_c = abx * (y - ya) - aby * (x - xa);
      const Floats to_a = bcx * (y - yb) - bcy * (x - xb);
      const Floats to_b = cax * (y - yc) - cay * (x - xc);
      const Integers inside = (to_c > 0.0f) & (to_a > 0.0f) & (to_b > 0.0f);
      const Floats weighted = to_a * a[2] + to_b * b[2] + to_c * c[2];
      const Floats level = (to_a + to_b + to_c) * z;
      const Integers side = (weighted > level) + kAgainst;  // a comparison is -1 where it holds
      mark(inside & side, hidden + i);
      i += kLanes;
    } while (i < end);
  }
}

void SkyOcclusion::cover(View& view) const {
  for (const auto& triangle : triangles_) coverWith<4>(triangle, view);
}

#if defined(__x86_64__)
[[gnu::target("avx2")]] void SkyOcclusion::coverWithAvx2(View& view) const {
  for (const auto& triangle : triangles_) coverWith<8>(triangle, view);
}
#else
void SkyOcclusion::coverWithAvx2(View& view) const { cover(view); }  // never the best
#endif

void SkyOcclusion::add(const Vector3f& direction, View& view) const {
  for (std::size_t place = 0; place < points_.size(); ++place) {
    const int particle = view.order[place];
    const float along = normals_[particle].dot(direction);
    const float cosine = std::abs(along) < kHorizon ? 0.0f : std::abs(along);
    const float seen_along = (view.hidden[place] & kAlong) != 0 ? 0.0f : cosine;
    const float seen_against = (view.hidden[place] & kAgainst) != 0 ? 0.0f : cosine;
    view.total[particle] += cosine;
    view.sums[particle].front += along > 0.0f ? seen_along : seen_against;
    view.sums[particle].back += along > 0.0f ? seen_against : seen_along;
  }
}

/// Along every kViews-th direction.
void SkyOcclusion::look(int number) {
  View& view = views_[number];
  std::fill(view.total.begin(), view.total.end(), 0.0f);
  std::fill(view.sums.begin(), view.sums.end(), SkyShare{0.0f, 0.0f});
  for (int i = number; i < kDirections; i += kViews) {
    project(directions_[i], view);
    sort(view);
    std::fill(view.hidden.begin(), view.hidden.end(), 0);
    if (instruction_set_ == InstructionSet::kAvx2) {
      coverWithAvx2(view);
    } else {
      cover(view);
    }
    add(directions_[i], view);
  }
}

const std::vector<SkyShare>& SkyOcclusion::compute(const std::vector<Vector3d>& positions) {
  readPositions(positions);
  sumNormals();
  linear::runTasks(pool_, kViews, [&](int view, int) { look(view); });
  for (std::size_t i = 0; i < shares_.size(); ++i) {
    float total = 0.0f;
    SkyShare sum{0.0f, 0.0f};
    for (const View& view : views_) {
      total += view.total[i];
      sum.front += view.sums[i].front;
      sum.back += view.sums[i].back;
    }
    shares_[i] = total > 0.0f ? SkyShare{sum.front / total, sum.back / total} : SkyShare{};
  }
  return shares_;
}

}  // namespace haptex::proximity
