#include "haptex/garment/panel_mesh.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "haptex/base/require.h"
#include "haptex/garment/delaunay.h"
#include "haptex/garment/outline_crossing.h"
#include "haptex/garment/refinement.h"

namespace haptex::garment {
namespace {

using Eigen::Vector2d;

constexpr int kFiner = 5;  // times that the tolerance is divided by four where outlines would cross
constexpr int kMostDivisions = 100000;  // of an edge

double distanceToLine(const Vector2d& point, const Vector2d& a, const Vector2d& b) {
  const Vector2d ab = b - a;
  const double square = ab.squaredNorm();
  const double t = square > 0.0 ? std::clamp((point - a).dot(ab) / square, 0.0, 1.0) : 0.0;
  return (point - a - t * ab).norm();
}

// Parameters that divide the length of a curve evenly.
std::vector<double> divided(const Curve& curve, int count) {
  std::vector<double> parameters;
  for (int i = 0; i <= count; ++i) {
    parameters.push_back(curve.parameterAt(curve.length() * i / count));
  }
  parameters.back() = 1.0;
  return parameters;
}

bool within(const Curve& curve, const std::vector<double>& parameters, double tolerance) {
  constexpr int kLooks = 8;
  for (std::size_t i = 1; i < parameters.size(); ++i) {
    const double from = parameters[i - 1], to = parameters[i];
    const Vector2d a = curve.at(from), b = curve.at(to);
    for (int k = 1; k < kLooks; ++k) {
      const Vector2d point = curve.at(from + (to - from) * k / kLooks);
      if (distanceToLine(point, a, b) > tolerance) return false;
    }
  }
  return true;
}

// As few parts as keep to both; lines with corners inside are looked at like curves.
std::vector<double> divide(const Curve& curve, double edge_length, double tolerance) {
  const double fewest = std::ceil(curve.length() / edge_length * (1.0 - 1e-9));
  int count = static_cast<int>(std::clamp(fewest, 1.0, static_cast<double>(kMostDivisions)));
  std::vector<double> parameters = divided(curve, count);
  const bool straight = curve.kind() == Curve::Kind::kLine && curve.points().size() == 2;
  while (!straight && count < kMostDivisions && !within(curve, parameters, tolerance)) {
    count += 1 + count / 8;
    parameters = divided(curve, count);
  }
  return parameters;
}

struct DividedOutlines {
  std::vector<std::vector<Vector2d>> loops;
  std::vector<std::vector<EdgeParticles>> edges;
  std::vector<OutlineLine> lines;
};

// Mirrored if the fabric is turned over.
DividedOutlines divide(const Panel& panel, double edge_length, double tolerance, bool turned_over) {
  DividedOutlines all;
  int begin = 0;
  for (std::size_t k = 0; k < panel.outlines.size(); ++k) {
    std::vector<Vector2d>& loop = all.loops.emplace_back();
    std::vector<EdgeParticles>& edges = all.edges.emplace_back();
    const Outline& outline = panel.outlines[k];
    for (std::size_t e = 0; e < outline.size(); ++e) {
      const Curve& curve = outline[e].curve;
      EdgeParticles& edge = edges.emplace_back();
      const std::vector<double> parameters = divide(curve, edge_length, tolerance);
      const double count = static_cast<double>(parameters.size() - 1);
      for (std::size_t i = 0; i < parameters.size(); ++i) {
        edge.particles.push_back(begin + static_cast<int>(loop.size()));
        edge.lengths.push_back(curve.length() * static_cast<double>(i) / count);
        if (i + 1 == parameters.size()) break;
        const Vector2d point = curve.at(parameters[i]);
        loop.emplace_back(turned_over ? -point.x() : point.x(), point.y());
      }
    }
    edges.back().particles.back() = begin;
    for (std::size_t e = 0; e < edges.size(); ++e) {
      for (std::size_t i = 0; i + 1 < edges[e].particles.size(); ++i) {
        const auto at = static_cast<std::size_t>(edges[e].particles[i] - begin);
        all.lines.push_back(
            {loop[at], loop[(at + 1) % loop.size()], {static_cast<int>(k), static_cast<int>(e)}});
      }
    }
    begin += static_cast<int>(loop.size());
  }
  return all;
}

DividedOutlines divideWithoutCrossing(const Panel& panel, double edge_length, double tolerance) {
  const bool turned_over = isTurnedOver(panel);
  for (int finer = 0;; ++finer) {
    DividedOutlines all = divide(panel, edge_length, tolerance, turned_over);
    const bool polygons = std::all_of(all.loops.begin(), all.loops.end(),
                                      [](const auto& loop) { return loop.size() >= 3; });
    const auto crossing = polygons ? findCrossing(all.lines) : std::nullopt;
    if (polygons && !crossing && findHoleOutside(all.lines) < 0) return all;
    if (finer == kFiner) {
      base::refuse(
          "panel '", panel.name, "': divided into edges of ", edge_length,
          " m its outline crosses itself", crossing ? " at " : "",
          crossing ? describeEdge(panel, crossing->first.outline, crossing->first.edge) : "",
          ": allowed are shorter ones");
    }
    tolerance /= 4.0;
  }
}

// Between two that follow each other along an edge.
void insertBetween(std::vector<std::vector<EdgeParticles>>& outlines,
                   const std::vector<std::array<int, 3>>& halvings) {
  std::map<std::array<int, 2>, EdgeParticles*> edge_of;
  for (auto& edges : outlines) {
    for (EdgeParticles& edge : edges) {
      for (std::size_t i = 1; i < edge.particles.size(); ++i) {
        edge_of[{edge.particles[i - 1], edge.particles[i]}] = &edge;
      }
    }
  }
  for (const auto& [added, a, b] : halvings) {
    const bool forward = edge_of.count({a, b}) > 0;
    const int first = forward ? a : b, second = forward ? b : a;
    EdgeParticles& edge = *edge_of.at({first, second});
    // An edge may begin and end at one particle.
    std::size_t i = 1;
    while (edge.particles[i - 1] != first || edge.particles[i] != second) ++i;
    const double length = 0.5 * (edge.lengths[i - 1] + edge.lengths[i]);
    const auto at = static_cast<std::ptrdiff_t>(i);
    edge.particles.insert(edge.particles.begin() + at, added);
    edge.lengths.insert(edge.lengths.begin() + at, length);
    edge_of[{first, added}] = edge_of[{added, second}] = &edge;
  }
}

mesh::ClothMesh makeMesh(const Panel& panel, const Delaunay& triangulation) {
  mesh::ClothMesh mesh;
  const bool turned_over = isTurnedOver(panel);
  Vector2d warp = panel.warp;
  if (turned_over) warp.x() = -warp.x();
  const Vector2d weft(warp.y(), -warp.x());
  const auto* pose = std::get_if<Eigen::Isometry3d>(&panel.placement);
  for (const Vector2d& point : triangulation.points()) {
    mesh.rest_coordinates.emplace_back(weft.dot(point), warp.dot(point));
    const Eigen::Vector3d flat(turned_over ? -point.x() : point.x(), point.y(), 0.0);
    mesh.initial_positions.push_back(pose != nullptr ? *pose * flat : flat);
  }
  for (const auto& triangle : triangulation.triangles()) mesh.triangles.push_back(triangle.corners);
  return mesh;
}

}  // namespace

PanelMesh triangulate(const Panel& panel, double edge_length, double tolerance) {
  base::require(edge_length >= kShortestMeshEdge && edge_length <= kLargestCoordinate,
                "triangulate", "edge_length", edge_length, ">= 0.0005 m and <= 20 m");
  base::require(std::isfinite(tolerance) && tolerance > 0.0, "triangulate", "tolerance", tolerance,
                "finite and > 0");
  const double triangles = areaOf(panel) / (std::sqrt(3.0) / 4.0 * edge_length * edge_length);
  if (!(triangles <= kMostTriangles)) {
    base::refuse("panel '", panel.name, "': edges of ", edge_length, " m would make about ",
                 triangles, " triangles: allowed are ", kMostTriangles);
  }
  DividedOutlines outlines = divideWithoutCrossing(panel, edge_length, tolerance);
  Delaunay triangulation(outlines.loops);
  const auto halvings = refine(triangulation, edge_length);
  PanelMesh result;
  result.edges = std::move(outlines.edges);
  insertBetween(result.edges, halvings);
  result.mesh = makeMesh(panel, triangulation);
  return result;
}

PanelMesh triangulate(const Panel& panel, double edge_length) {
  return triangulate(panel, edge_length, edge_length / 20.0);
}

}  // namespace haptex::garment
