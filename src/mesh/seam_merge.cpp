// Sewing by refining and merging.
#include <algorithm>
#include <numeric>

#include "haptex/base/require.h"
#include "haptex/mesh/seam.h"
#include "haptex/mesh/seam_edges.h"

namespace haptex::mesh {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// Cuts triangles along edges.
class Refinement {
 public:
  explicit Refinement(ClothMesh mesh) : mesh_(std::move(mesh)) {
    if (mesh_.corner_coordinates.empty()) {
      for (const auto& [a, b, c] : mesh_.triangles) {
        mesh_.corner_coordinates.push_back(
            {mesh_.rest_coordinates[a], mesh_.rest_coordinates[b], mesh_.rest_coordinates[c]});
      }
    }
    triangles_ = borderTriangles(mesh_);
  }

  ClothMesh& mesh() { return mesh_; }
  const BorderTriangles& triangles() const { return triangles_; }

  /// Puts particles where the other edge has some and this one has none.
  void refine(SeamEdge& edge, const std::vector<double>& places) {
    for (const double place : places) {
      const auto next = std::upper_bound(edge.places.begin(), edge.places.end(), place);
      const bool at_next = next != edge.places.end() && *next - place < kSamePlace;
      if (at_next || (next != edge.places.begin() && place - *(next - 1) < kSamePlace)) continue;
      const auto at = next - edge.places.begin();
      const double share = (place - *(next - 1)) / (*next - *(next - 1));
      const int added = split(edge.particles[at - 1], edge.particles[at], share);
      edge.places.insert(edge.places.begin() + at, place);
      edge.particles.insert(edge.particles.begin() + at, added);
    }
  }

 private:
  /// @returns the new particle, at (1 - share) a + share b
  int split(int a, int b, double share) {
    const int old = borderTriangle(triangles_, a, b);
    const int added = static_cast<int>(mesh_.rest_coordinates.size());
    const auto between = [&](const auto& x, const auto& y) {
      return ((1.0 - share) * x + share * y).eval();
    };
    std::array<int, 3>& corners = mesh_.triangles[old];
    std::array<Vector2d, 3>& places = mesh_.corner_coordinates[old];
    const auto place_of = [&](int particle) {
      return std::find(corners.begin(), corners.end(), particle) - corners.begin();
    };
    const auto at_a = place_of(a), at_b = place_of(b), at_c = 3 - at_a - at_b;
    const int c = corners[at_c];
    mesh_.initial_positions.push_back(
        between(mesh_.initial_positions[a], mesh_.initial_positions[b]));
    const Vector2d place = between(places[at_a], places[at_b]);
    mesh_.rest_coordinates.push_back(place);
    std::array<int, 3> half = corners;
    std::array<Vector2d, 3> half_places = places;
    corners[at_b] = added;
    places[at_b] = place;
    half[at_a] = added;
    half_places[at_a] = place;
    const int created = static_cast<int>(mesh_.triangles.size());
    mesh_.triangles.push_back(half);
    mesh_.corner_coordinates.push_back(half_places);
    const auto repeat = [&](std::vector<int>& of_triangles) {
      if (!of_triangles.empty()) of_triangles.push_back(of_triangles[old]);
    };
    repeat(mesh_.triangle_panels);
    repeat(mesh_.triangle_fabrics);
    triangles_.erase(sorted(a, b));
    triangles_[sorted(a, added)] = old;
    triangles_[sorted(added, b)] = created;
    triangles_[sorted(added, c)] = -1;
    int& beside = triangles_[sorted(b, c)];
    if (beside == old) beside = created;
    return added;
  }

  static std::array<int, 2> sorted(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

  ClothMesh mesh_;
  BorderTriangles triangles_;
};

/// Groups of particles that become one; each is named by its least.
class Groups {
 public:
  explicit Groups(std::size_t count) : parents_(count) {
    std::iota(parents_.begin(), parents_.end(), 0);
  }
  int find(int particle) const {
    while (parents_[particle] != particle) particle = parents_[particle];
    return particle;
  }
  void join(int a, int b) {
    const auto [least, other] = std::minmax({find(a), find(b)});
    parents_[other] = least;
  }

 private:
  std::vector<int> parents_;
};

/// @param names per particle, that which it becomes; ascending from 0
void renumber(const std::vector<int>& names, int count, ClothMesh& mesh) {
  std::vector<Vector2d> rest(count, Vector2d::Zero());
  std::vector<Vector3d> positions(count, Vector3d::Zero());
  std::vector<int> members(count, 0);
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (members[names[i]]++ == 0) rest[names[i]] = mesh.rest_coordinates[i];
    positions[names[i]] += mesh.initial_positions[i];
  }
  for (int i = 0; i < count; ++i) positions[i] /= members[i];
  mesh.rest_coordinates = std::move(rest);
  mesh.initial_positions = std::move(positions);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::array<int, 3> before = mesh.triangles[t];
    std::array<int, 3>& corners = mesh.triangles[t];
    for (int& particle : corners) particle = names[particle];
    const auto& [a, b, c] = corners;
    if (a != b && b != c && c != a) continue;
    base::refuse("two of the particles ", before[0], ", ", before[1], " and ", before[2],
                 " of a triangle are sewn to each other; a seam may not close a triangle");
  }
}

}  // namespace

MergedMesh merge(const ClothMesh& mesh, const std::vector<Seam>& seams) {
  if (!mesh.ties.empty() || !mesh.seam_hinges.empty()) {
    base::refuse("the mesh has ", mesh.ties.size(), " ties and ", mesh.seam_hinges.size(),
                 " hinges of seams; a mesh is merged first, and sewn by ties then");
  }
  Refinement refinement(mesh);
  // Later seams may cut the triangles of earlier ones, and put particles into their edges.
  std::vector<std::array<SeamEdge, 2>> edges;
  for (const Seam& seam : seams) {
    requireSeamAngle(seam.angle);
    const auto edge = [&](const char* name, const std::vector<int>& particles, const auto& places) {
      return seamEdge(refinement.mesh(), refinement.triangles(), name, particles, places);
    };
    auto& [first, second] = edges.emplace_back(
        std::array<SeamEdge, 2>{edge("first", seam.first, seam.first_places),
                                edge("second", seam.second, seam.second_places)});
    const std::vector<double> places = first.places;
    refinement.refine(first, second.places);
    refinement.refine(second, places);
  }
  Groups groups(refinement.mesh().rest_coordinates.size());
  for (const auto& [first, second] : edges) {
    for (std::size_t i = 0; i < first.particles.size(); ++i) {
      groups.join(first.particles[i], second.particles[i]);
    }
  }
  MergedMesh merged{std::move(refinement.mesh()), {}};
  int count = 0;
  std::vector<int> names(merged.mesh.rest_coordinates.size());
  for (std::size_t i = 0; i < names.size(); ++i) {
    const int least = groups.find(static_cast<int>(i));
    names[i] = least == static_cast<int>(i) ? count++ : names[least];
  }
  for (std::size_t s = 0; s < seams.size(); ++s) {
    SeamEdge& first = edges[s][0];
    SeamEdge& second = edges[s][1];
    first = seamEdge(merged.mesh, refinement.triangles(), "first", first.particles, first.places);
    second =
        seamEdge(merged.mesh, refinement.triangles(), "second", second.particles, second.places);
    addSeamHinges(first, second, seams[s].angle, merged.mesh);
  }
  renumber(names, count, merged.mesh);
  merged.particles.assign(
      names.begin(), names.begin() + static_cast<std::ptrdiff_t>(mesh.rest_coordinates.size()));
  return merged;
}

}  // namespace haptex::mesh
