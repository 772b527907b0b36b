#include "haptex/cloth/forces/cells/triangle_pairs.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

namespace haptex::cloth {
namespace {

using Eigen::Vector2d;

constexpr double kLeastSine = 0.3;    // of a corner of a cell
constexpr double kRounding = 1e-9;    // of a sine: partners that differ by less are alike
constexpr double kSamePlace = 1e-12;  // m

/// A side of a triangle: the corners after and before the opposite one.
struct Side {
  int triangle;
  int opposite;  // 0 to 2
};

int cornerOf(const mesh::ClothMesh& mesh, int triangle, int particle) {
  const std::array<int, 3>& corners = mesh.triangles[triangle];
  return static_cast<int>(std::find(corners.begin(), corners.end(), particle) - corners.begin());
}

/// The sine of the angle at b, positive if a, b, c turn to the left.
double sineAt(const Vector2d& a, const Vector2d& b, const Vector2d& c) {
  const Vector2d in = b - a, out = c - b;
  return (in.x() * out.y() - in.y() * out.x()) / (in.norm() * out.norm());
}

/// The smallest sine of the corners of a quadrilateral; negative if it is not convex.
double sharpestCorner(const TrianglePair& pair) {
  const auto& [a, b, c, d] = pair.rest;  // around: a, d, b, c or the other way
  std::array<double, 4> sines = {sineAt(c, a, d), sineAt(a, d, b), sineAt(d, b, c),
                                 sineAt(b, c, a)};
  if (sines[0] < 0.0) {
    for (double& sine : sines) sine = -sine;
  }
  return *std::min_element(sines.begin(), sines.end());
}

/// Nothing if the panel is not in one piece there, as along a dart that was sewn.
std::optional<TrianglePair> pairOf(const mesh::ClothMesh& mesh, const Side& one,
                                   const Side& other) {
  const std::array<int, 3>& corners = mesh.triangles[one.triangle];
  const int from = corners[(one.opposite + 1) % 3], to = corners[(one.opposite + 2) % 3];
  const std::array<Vector2d, 3> rest = mesh.restCorners(one.triangle);
  const std::array<Vector2d, 3> beyond = mesh.restCorners(other.triangle);
  TrianglePair pair{
      {one.triangle, other.triangle},
      {from, to, corners[one.opposite], mesh.triangles[other.triangle][other.opposite]},
      {rest[(one.opposite + 1) % 3], rest[(one.opposite + 2) % 3], rest[one.opposite],
       beyond[other.opposite]}};
  for (const int i : {0, 1}) {
    const Vector2d& there = beyond[cornerOf(mesh, other.triangle, pair.particles[i])];
    if ((there - pair.rest[i]).norm() > kSamePlace) return std::nullopt;
  }
  return pair;
}

/// Every side with its triangles of one fabric.
std::map<std::array<int, 2>, std::vector<Side>> sidesOf(const mesh::ClothMesh& mesh, int fabric) {
  std::map<std::array<int, 2>, std::vector<Side>> sides;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (mesh.fabricOf(t) != fabric) continue;
    for (int i = 0; i < 3; ++i) {
      const auto [first, second] =
          std::minmax(mesh.triangles[t][(i + 1) % 3], mesh.triangles[t][(i + 2) % 3]);
      sides[{first, second}].push_back({static_cast<int>(t), i});
    }
  }
  return sides;
}

struct Candidate {
  TrianglePair pair;
  double sine;
};

/// In the order of the sides.
std::vector<Candidate> candidatesOf(const mesh::ClothMesh& mesh, int fabric) {
  std::vector<Candidate> candidates;
  for (const auto& [ends, around] : sidesOf(mesh, fabric)) {
    if (around.size() != 2) continue;
    if (mesh.panelOf(around[0].triangle) != mesh.panelOf(around[1].triangle)) continue;
    const std::optional<TrianglePair> pair = pairOf(mesh, around[0], around[1]);
    if (!pair) continue;
    const double sine = sharpestCorner(*pair);
    if (sine >= kLeastSine) candidates.push_back({*pair, sine});
  }
  return candidates;
}

/// Of every triangle its best candidate with another that is free, or -1.
std::vector<int> bestOf(const std::vector<Candidate>& candidates, const std::vector<char>& taken) {
  std::vector<int> best(taken.size(), -1);
  for (std::size_t c = 0; c < candidates.size(); ++c) {
    const std::array<int, 2>& triangles = candidates[c].pair.triangles;
    if (taken[triangles[0]] + taken[triangles[1]] > 0) continue;
    for (const int triangle : triangles) {
      int& found = best[triangle];
      if (found >= 0 && candidates[c].sine <= candidates[found].sine + kRounding) continue;
      found = static_cast<int>(c);
    }
  }
  return best;
}

}  // namespace

PairedTriangles pairTriangles(const mesh::ClothMesh& mesh, int fabric) {
  const std::vector<Candidate> candidates = candidatesOf(mesh, fabric);
  std::vector<char> taken(mesh.triangles.size(), 0);
  PairedTriangles result;
  for (int round = 0; round < kPairingRounds; ++round) {
    const std::vector<int> best = bestOf(candidates, taken);
    for (std::size_t c = 0; c < candidates.size(); ++c) {
      const auto [one, other] = candidates[c].pair.triangles;
      if (best[one] != static_cast<int>(c) || best[other] != static_cast<int>(c)) continue;
      result.pairs.push_back(candidates[c].pair);
      taken[one] = taken[other] = 1;
    }
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (mesh.fabricOf(t) == fabric && taken[t] == 0) result.single.push_back(static_cast<int>(t));
  }
  return result;
}

}  // namespace haptex::cloth
