#include "haptex/mesh/seam_edges.h"

#include <algorithm>
#include <cmath>

#include "haptex/base/require.h"

namespace haptex::mesh {

using Eigen::Vector2d;

namespace {

std::array<int, 2> sorted(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

/// Where the seam at a place is in the rest coordinates of the triangle of a piece, on or beyond
/// the piece itself.
Vector2d pointOf(const ClothMesh& mesh, const SeamEdge& edge, int piece, double place) {
  const Vector2d begin = restCorner(mesh, edge.triangles[piece], edge.particles[piece]);
  const Vector2d end = restCorner(mesh, edge.triangles[piece], edge.particles[piece + 1]);
  const double from = edge.places[piece], to = edge.places[piece + 1];
  return begin + (place - from) / (to - from) * (end - begin);
}

/// The chord between two places. @param piece that it lies beside
Vector2d chord(const ClothMesh& mesh, const SeamEdge& edge, int piece, double from, double to) {
  const auto point_at = [&](double place) {
    const auto next = std::upper_bound(edge.places.begin() + 1, edge.places.end() - 1, place);
    const int at = static_cast<int>(next - edge.places.begin()) - 1;
    const bool same = mesh.panelOf(edge.triangles[at]) == mesh.panelOf(edge.triangles[piece]);
    return pointOf(mesh, edge, same ? at : piece, place);
  };
  return point_at(to) - point_at(from);
}

/// Across the seam, into the triangle.
Vector2d inwardOf(const ClothMesh& mesh, int triangle, const Vector2d& along,
                  const std::array<int, 2>& border) {
  const std::array<Vector2d, 3> corners = mesh.restCorners(triangle);
  const Vector2d middle = (corners[0] + corners[1] + corners[2]) / 3.0;
  const Vector2d on_border =
      0.5 * (restCorner(mesh, triangle, border[0]) + restCorner(mesh, triangle, border[1]));
  const Vector2d across(-along.y(), along.x());
  return across.dot(middle - on_border) > 0.0 ? across : Vector2d(-across);
}

/// @throws std::invalid_argument unless they ascend from 0 to 1, one per particle
void requirePlaces(const char* name, const std::vector<int>& particles,
                   const std::vector<double>& places) {
  if (places.size() != particles.size()) {
    base::refuse("the ", name, " edge of a seam has ", places.size(), " places for ",
                 particles.size(), " particles; they must be as many");
  }
  bool ascend = places.front() == 0.0 && places.back() == 1.0;
  for (std::size_t i = 1; i < places.size(); ++i) {
    ascend = ascend && places[i] - places[i - 1] > kSamePlace;
  }
  if (ascend) return;
  base::refuse("the places of the ", name, " edge of a seam from particle ", particles.front(),
               " to ", particles.back(), " must ascend from 0 to 1, by more than ", kSamePlace,
               " each");
}

std::vector<double> placesByLength(const std::vector<double>& lengths, double length) {
  std::vector<double> places = {0.0};
  double sum = 0.0;
  for (const double piece : lengths) places.push_back((sum += piece) / length);
  places.back() = 1.0;
  return places;
}

}  // namespace

BorderTriangles borderTriangles(const ClothMesh& mesh) {
  BorderTriangles triangles;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (int i = 0; i < 3; ++i) {
      const auto edge = sorted(mesh.triangles[t][i], mesh.triangles[t][(i + 1) % 3]);
      const auto [found, first] = triangles.emplace(edge, static_cast<int>(t));
      if (!first) found->second = -1;
    }
  }
  return triangles;
}

int borderTriangle(const BorderTriangles& triangles, int a, int b) {
  const auto found = triangles.find(sorted(a, b));
  if (found != triangles.end() && found->second >= 0) return found->second;
  base::refuse("a seam goes from particle ", a, " to ", b, ", between which there is ",
               found == triangles.end() ? "no edge of a triangle" : "an edge of two triangles",
               "; allowed are edges on the border");
}

Vector2d restCorner(const ClothMesh& mesh, int triangle, int particle) {
  const std::array<int, 3>& corners = mesh.triangles[triangle];
  const auto corner = std::find(corners.begin(), corners.end(), particle) - corners.begin();
  return mesh.restCorners(triangle)[corner];
}

SeamEdge seamEdge(const ClothMesh& mesh, const BorderTriangles& triangles, const char* name,
                  const std::vector<int>& particles, const std::vector<double>& places) {
  if (particles.size() < 2) {
    base::refuse("the ", name, " edge of a seam has ", particles.size(),
                 " particles; it must have at least 2");
  }
  SeamEdge edge{particles, places, {}, 0.0};
  std::vector<double> lengths;
  for (std::size_t i = 1; i < particles.size(); ++i) {
    const int a = particles[i - 1], b = particles[i];
    const int triangle = edge.triangles.emplace_back(borderTriangle(triangles, a, b));
    lengths.push_back((restCorner(mesh, triangle, b) - restCorner(mesh, triangle, a)).norm());
    edge.length += lengths.back();
  }
  if (edge.places.empty()) edge.places = placesByLength(lengths, edge.length);
  requirePlaces(name, particles, edge.places);
  return edge;
}

void addSeamHinges(const SeamEdge& first, const SeamEdge& second, double angle, ClothMesh& mesh) {
  const double length = 0.5 * (first.length + second.length);
  // Chords of the edge that is tied are those of the other one, too: flat cloth is without bend.
  const bool first_is_finer = first.particles.size() > second.particles.size();
  const SeamEdge& finer = first_is_finer ? first : second;
  for (int i = 0, j = 0; i < first.pieceCount() && j < second.pieceCount();) {
    const double from = std::max(first.places[i], second.places[j]);
    const double to = std::min(first.places[i + 1], second.places[j + 1]);
    if (to - from > kSamePlace && first.triangles[i] != second.triangles[j]) {
      const int fine = first_is_finer ? i : j;
      const double begin = finer.places[fine], end = finer.places[fine + 1];
      SeamHinge hinge;
      hinge.triangles = {first.triangles[i], second.triangles[j]};
      hinge.along = {chord(mesh, first, i, begin, end).normalized(),
                     chord(mesh, second, j, begin, end).normalized()};
      hinge.inward = {inwardOf(mesh, first.triangles[i], hinge.along[0],
                               {first.particles[i], first.particles[i + 1]}),
                      inwardOf(mesh, second.triangles[j], hinge.along[1],
                               {second.particles[j], second.particles[j + 1]})};
      hinge.length = (to - from) * length;
      hinge.angle = angle;
      mesh.seam_hinges.push_back(hinge);
    }
    const bool ends_first = first.places[i + 1] <= second.places[j + 1] + kSamePlace;
    const bool ends_second = second.places[j + 1] <= first.places[i + 1] + kSamePlace;
    i += ends_first;
    j += ends_second;
  }
}

void requireSeamAngle(double angle) {
  if (std::isfinite(angle) && std::abs(angle) < M_PI) return;
  base::refuse("the angle of a seam is ", angle, " rad; it must lie above -pi and below pi");
}

}  // namespace haptex::mesh
