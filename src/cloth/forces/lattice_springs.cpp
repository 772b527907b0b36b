#include "haptex/cloth/forces/lattice_springs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <stdexcept>
#include <string>

namespace haptex::cloth {
namespace {

using Eigen::Vector2d;
using Kind = LatticeSpring::Kind;
using Pair = std::array<int, 2>;  // ascending

constexpr double kTolerance = 1e-9;  // of a side

/// A rectangular cell by its corners: the smaller and larger coordinate along weft, then warp.
struct Cell {
  int low_low, high_low, low_high, high_high;
};

[[noreturn]] void refuseTriangle(std::size_t triangle) {
  throw std::invalid_argument(
      "a spring lattice needs a mesh of rectangles along weft and warp of two triangles each; "
      "triangle " +
      std::to_string(triangle) + " is not half of one");
}

Pair ascending(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

/// Which corner of a triangle is the right angle between its sides along weft and warp.
int rightCorner(const mesh::ClothMesh& mesh, std::size_t triangle) {
  const std::array<int, 3>& corners = mesh.triangles[triangle];
  for (int i = 0; i < 3; ++i) {
    const Vector2d& origin = mesh.rest_coordinates[corners[i]];
    const Vector2d p = mesh.rest_coordinates[corners[(i + 1) % 3]] - origin;
    const Vector2d q = mesh.rest_coordinates[corners[(i + 2) % 3]] - origin;
    const auto along = [](const Vector2d& side, int axis) {
      return std::abs(side[1 - axis]) <= kTolerance * std::abs(side[axis]);
    };
    if ((along(p, 0) && along(q, 1)) || (along(p, 1) && along(q, 0))) return i;
  }
  refuseTriangle(triangle);
}

/// The rectangle that two triangles with a common diagonal make.
Cell cellOf(const mesh::ClothMesh& mesh, std::size_t triangle, const Pair& right_corners,
            const Pair& diagonal) {
  const auto& rest = mesh.rest_coordinates;
  std::array<int, 4> corners = {right_corners[0], right_corners[1], diagonal[0], diagonal[1]};
  const Vector2d middle = 0.5 * (rest[diagonal[0]] + rest[diagonal[1]]);
  Cell cell{-1, -1, -1, -1};
  for (int corner : corners) {
    const bool right = rest[corner].x() > middle.x(), upper = rest[corner].y() > middle.y();
    int& place =
        right ? (upper ? cell.high_high : cell.high_low) : (upper ? cell.low_high : cell.low_low);
    if (place >= 0) refuseTriangle(triangle);  // both on one side of the diagonal
    place = corner;
  }
  return cell;
}

std::vector<Cell> findCells(const mesh::ClothMesh& mesh) {
  struct Half {
    std::size_t triangle;
    int right_corner;
  };
  std::map<Pair, Half> open;  // by diagonal
  std::vector<Cell> cells;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const int i = rightCorner(mesh, t);
    const std::array<int, 3>& corners = mesh.triangles[t];
    const Pair diagonal = ascending(corners[(i + 1) % 3], corners[(i + 2) % 3]);
    const auto other = open.find(diagonal);
    if (other == open.end()) {
      open[diagonal] = {t, corners[i]};
    } else {
      cells.push_back(cellOf(mesh, t, {other->second.right_corner, corners[i]}, diagonal));
      open.erase(other);
    }
  }
  if (!open.empty()) refuseTriangle(open.begin()->second.triangle);
  return cells;
}

/// The sides of the cells along one axis.
struct Side {
  double length;
  double area;  // of the structural spring
};
using Sides = std::map<Pair, Side>;

class Builder {
 public:
  explicit Builder(const mesh::ClothMesh& mesh) : mesh_(mesh) {}

  void add(const Cell& cell) {
    const auto& rest = mesh_.rest_coordinates;
    const double du = rest[cell.high_low].x() - rest[cell.low_low].x();
    const double dv = rest[cell.low_high].y() - rest[cell.low_low].y();
    const double half = 0.5 * du * dv;
    addSide(Kind::kWeft, cell.low_low, cell.high_low, du, half, du / dv);
    addSide(Kind::kWeft, cell.low_high, cell.high_high, du, half, du / dv);
    addSide(Kind::kWarp, cell.low_low, cell.low_high, dv, half, dv / du);
    addSide(Kind::kWarp, cell.high_low, cell.high_high, dv, half, dv / du);
    const double square = du * du + dv * dv;
    addSpring(Kind::kShear, ascending(cell.low_low, cell.high_high), half, square,
              square / (du * dv));
    addSpring(Kind::kShear, ascending(cell.high_low, cell.low_high), half, square,
              -square / (du * dv));
  }

  /// Over two sides in a row.
  void addBendSprings() {
    for (int axis : {0, 1}) {
      const Sides& sides = sides_[axis];
      std::vector<Pair> next(mesh_.rest_coordinates.size(), Pair{-1, -1});  // before, after
      for (const auto& side : sides) {
        const auto [a, b] = side.first;
        const bool forward = mesh_.rest_coordinates[a][axis] < mesh_.rest_coordinates[b][axis];
        next[forward ? a : b][1] = forward ? b : a;
        next[forward ? b : a][0] = forward ? a : b;
      }
      for (std::size_t i = 0; i < next.size(); ++i) {
        if (next[i][0] < 0 || next[i][1] < 0) continue;
        const Side& before = sides.at(ascending(next[i][0], static_cast<int>(i)));
        const Side& after = sides.at(ascending(next[i][1], static_cast<int>(i)));
        const double length = before.length + after.length;
        constexpr double kRightAngle = 64.0;  // SpringLattice
        addSpring(axis == 0 ? Kind::kWeftBend : Kind::kWarpBend, ascending(next[i][0], next[i][1]),
                  before.area + after.area, length * length, kRightAngle / (length * length));
      }
    }
  }

  std::vector<LatticeSpring> finish() {
    std::stable_sort(
        springs_.begin(), springs_.end(),
        [](const LatticeSpring& a, const LatticeSpring& b) { return a.kind < b.kind; });
    return std::move(springs_);
  }

 private:
  /// Two cells of the same shape share one spring.
  void addSide(Kind kind, int a, int b, double length, double area, double scale) {
    Sides& sides = sides_[kind == Kind::kWeft ? 0 : 1];
    const Pair pair = ascending(a, b);
    const auto [side, is_new] = sides.insert({pair, {length, area}});
    if (!is_new) {
      side->second.area += area;
      const auto same = same_.find(pair);
      LatticeSpring& spring = springs_[same->second];
      if (std::abs(spring.scale - scale) <= kTolerance * scale) {
        spring.area += area;
        return;
      }
    }
    same_[pair] = springs_.size();
    addSpring(kind, pair, area, length * length, scale);
  }

  void addSpring(Kind kind, const Pair& pair, double area, double square, double scale) {
    springs_.push_back({kind, pair[0], pair[1], area, 1.0 / square, scale});
  }

  const mesh::ClothMesh& mesh_;
  std::vector<LatticeSpring> springs_;
  std::array<Sides, 2> sides_;
  std::map<Pair, std::size_t> same_;  // springs along sides
};

}  // namespace

std::vector<LatticeSpring> findLatticeSprings(const mesh::ClothMesh& mesh, bool bend) {
  if (!mesh.corner_coordinates.empty()) {
    throw std::invalid_argument("springs know one panel, and not a mesh that has seams");
  }
  Builder builder(mesh);
  for (const Cell& cell : findCells(mesh)) builder.add(cell);
  if (bend) builder.addBendSprings();
  return builder.finish();
}

}  // namespace haptex::cloth
