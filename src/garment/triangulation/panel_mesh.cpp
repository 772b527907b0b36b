#include "haptex/garment/triangulation/panel_mesh.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "haptex/base/require.h"
#include "haptex/garment/pattern/outline_crossing.h"
#include "haptex/garment/triangulation/delaunay.h"
#include "haptex/garment/triangulation/refinement.h"
#include "haptex/garment/triangulation/threads.h"

namespace haptex::garment {
namespace {

using Eigen::Vector2d;

constexpr int kFiner = 5;  // times that the tolerance is divided by four where outlines would cross
constexpr double kInnerCorner = M_PI / 9.0;  // of lines, from which on they are divided there
constexpr int kMostDivisions = 100000;       // of an edge

double distanceToLine(const Vector2d& point, const Vector2d& a, const Vector2d& b) {
  const Vector2d ab = b - a;
  const double square = ab.squaredNorm();
  const double t = square > 0.0 ? std::clamp((point - a).dot(ab) / square, 0.0, 1.0) : 0.0;
  return (point - a - t * ab).norm();
}

// Lengths that divide a piece of a curve evenly, its ends among them.
std::vector<double> divided(double from, double to, int count) {
  std::vector<double> lengths;
  for (int i = 0; i < count; ++i) lengths.push_back(from + (to - from) * i / count);
  lengths.push_back(to);
  return lengths;
}

bool within(const Curve& curve, const std::vector<double>& lengths, double tolerance) {
  constexpr int kLooks = 8;
  for (std::size_t i = 1; i < lengths.size(); ++i) {
    const double from = curve.parameterAt(lengths[i - 1]), to = curve.parameterAt(lengths[i]);
    const Vector2d a = curve.at(from), b = curve.at(to);
    for (int k = 1; k < kLooks; ++k) {
      const Vector2d point = curve.at(from + (to - from) * k / kLooks);
      if (distanceToLine(point, a, b) > tolerance) return false;
    }
  }
  return true;
}

// Lines are divided in their corners, too: even parts that come near enough to these would be
// small.
std::vector<double> divide(const Curve& curve, double edge_length, double tolerance) {
  const std::vector<double> corners = cornerLengths(curve);
  std::vector<double> all = {0.0};
  for (std::size_t i = 1; i < corners.size(); ++i) {
    const int parts = fewestParts(curve, corners[i - 1], corners[i], edge_length, tolerance);
    const std::vector<double> piece = divided(corners[i - 1], corners[i], parts);
    all.insert(all.end(), piece.begin() + 1, piece.end());
  }
  return all;
}

struct DividedOutlines {
  std::vector<std::vector<Vector2d>> loops;
  std::vector<std::vector<EdgeParticles>> edges;
  std::vector<OutlineLine> lines;
};

// In rest coordinates.
DividedOutlines divide(const Panel& panel, double edge_length, double tolerance,
                       const EdgeDivisions& given) {
  const Threads threads(panel);
  DividedOutlines all;
  int begin = 0;
  for (std::size_t k = 0; k < panel.outlines.size(); ++k) {
    std::vector<Vector2d>& loop = all.loops.emplace_back();
    std::vector<EdgeParticles>& edges = all.edges.emplace_back();
    const Outline& outline = panel.outlines[k];
    for (std::size_t e = 0; e < outline.size(); ++e) {
      const Curve& curve = outline[e].curve;
      EdgeParticles& edge = edges.emplace_back();
      const bool is_given = !given.empty() && !given[k][e].empty();
      edge.lengths = is_given ? given[k][e] : divide(curve, edge_length, tolerance);
      for (std::size_t i = 0; i < edge.lengths.size(); ++i) {
        edge.particles.push_back(begin + static_cast<int>(loop.size()));
        if (i + 1 == edge.lengths.size()) break;
        loop.push_back(threads.restOf(curve.at(curve.parameterAt(edge.lengths[i]))));
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

DividedOutlines divideWithoutCrossing(const Panel& panel, double edge_length, double tolerance,
                                      const EdgeDivisions& given) {
  for (int finer = 0;; ++finer) {
    DividedOutlines all = divide(panel, edge_length, tolerance, given);
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

std::vector<Vector2d> gridPoints(const std::vector<OutlineLine>& lines, double edge_length) {
  Vector2d low = lines.front().start, high = low;
  for (const OutlineLine& line : lines) {
    low = low.cwiseMin(line.start);
    high = high.cwiseMax(line.start);
  }
  const auto far = [&](const Vector2d& point) {
    return std::all_of(lines.begin(), lines.end(), [&](const OutlineLine& line) {
      return distanceToLine(point, line.start, line.end) >= 0.5 * edge_length;
    });
  };
  std::vector<Vector2d> points;
  for (double j = std::ceil(low.y() / edge_length); j * edge_length < high.y(); ++j) {
    for (double i = std::ceil(low.x() / edge_length); i * edge_length < high.x(); ++i) {
      const Vector2d point(i * edge_length, j * edge_length);
      bool inside = isInside(point, lines, 0) && far(point);
      for (int hole = 1; inside && hole <= lines.back().of.outline; ++hole) {
        inside = !isInside(point, lines, hole);
      }
      if (inside) points.push_back(point);
    }
  }
  return points;
}

mesh::ClothMesh makeMesh(const Panel& panel, const Delaunay& triangulation) {
  mesh::ClothMesh mesh;
  const Threads threads(panel);
  const auto* pose = std::get_if<Eigen::Isometry3d>(&panel.placement);
  mesh.rest_coordinates = triangulation.points();
  for (const Vector2d& rest : mesh.rest_coordinates) {
    const Vector2d point = threads.pointOf(rest);
    const Eigen::Vector3d flat(point.x(), point.y(), 0.0);
    mesh.initial_positions.push_back(pose != nullptr ? *pose * flat : flat);
  }
  for (const auto& triangle : triangulation.triangles()) mesh.triangles.push_back(triangle.corners);
  return mesh;
}

}  // namespace

std::vector<double> cornerLengths(const Curve& curve) {
  std::vector<double> lengths = {0.0};
  const std::vector<Vector2d>& points = curve.points();
  Vector2d in = Vector2d::Zero();
  double passed = 0.0;
  for (std::size_t i = 1; i < points.size() && curve.kind() == Curve::Kind::kLine; ++i) {
    const Vector2d out = points[i] - points[i - 1];
    if (out.isZero(0.0)) continue;
    if (!in.isZero(0.0) && in.dot(out) < std::cos(kInnerCorner) * in.norm() * out.norm()) {
      lengths.push_back(passed);
    }
    passed += out.norm();
    in = out;
  }
  lengths.push_back(curve.length());
  return lengths;
}

int fewestParts(const Curve& curve, double from, double to, double edge_length, double tolerance) {
  const double fewest = std::ceil((to - from) / edge_length * (1.0 - 1e-9));
  int count = static_cast<int>(std::clamp(fewest, 1.0, static_cast<double>(kMostDivisions)));
  const bool straight = curve.kind() == Curve::Kind::kLine && curve.points().size() == 2;
  while (!straight && count < kMostDivisions &&
         !within(curve, divided(from, to, count), tolerance)) {
    count += 1 + count / 8;
  }
  return count;
}

PanelMesh triangulate(const Panel& panel, double edge_length, double tolerance, Interior interior) {
  return triangulate(panel, edge_length, tolerance, interior, {});
}

PanelMesh triangulate(const Panel& panel, double edge_length, double tolerance, Interior interior,
                      const EdgeDivisions& divisions) {
  base::require(edge_length >= kShortestMeshEdge && edge_length <= kLargestCoordinate,
                "triangulate", "edge_length", edge_length, ">= 0.0005 m and <= 20 m");
  base::require(std::isfinite(tolerance) && tolerance > 0.0, "triangulate", "tolerance", tolerance,
                "finite and > 0");
  const double triangles = areaOf(panel) / (std::sqrt(3.0) / 4.0 * edge_length * edge_length);
  if (!(triangles <= kMostTriangles)) {
    base::refuse("panel '", panel.name, "': edges of ", edge_length, " m would make about ",
                 triangles, " triangles: allowed are ", kMostTriangles);
  }
  DividedOutlines outlines = divideWithoutCrossing(panel, edge_length, tolerance, divisions);
  const bool grid = interior == Interior::kGrid;
  Delaunay triangulation(outlines.loops,
                         grid ? gridPoints(outlines.lines, edge_length) : std::vector<Vector2d>());
  const auto halvings = refine(triangulation, edge_length, grid ? Filling::kGiven : Filling::kEven);
  PanelMesh result;
  result.edges = std::move(outlines.edges);
  insertBetween(result.edges, halvings);
  result.mesh = makeMesh(panel, triangulation);
  return result;
}

PanelMesh triangulate(const Panel& panel, double edge_length) {
  return triangulate(panel, edge_length, kCurveTolerance * edge_length);
}

std::vector<int> firstParticles(const std::vector<PanelMesh>& panels) {
  std::vector<int> first;
  int particles = 0;
  for (const PanelMesh& panel : panels) {
    first.push_back(particles);
    particles += static_cast<int>(panel.mesh.rest_coordinates.size());
  }
  return first;
}

mesh::ClothMesh joined(const std::vector<PanelMesh>& panels) {
  mesh::ClothMesh all;
  const auto add = [](const auto& from, auto& to) {
    to.insert(to.end(), from.begin(), from.end());
  };
  const std::vector<int> firsts = firstParticles(panels);
  for (std::size_t p = 0; p < panels.size(); ++p) {
    const mesh::ClothMesh& panel = panels[p].mesh;
    const int first = firsts[p];
    all.panels.push_back({0, 0.0});
    add(panel.rest_coordinates, all.rest_coordinates);
    add(panel.initial_positions, all.initial_positions);
    for (const auto& [a, b, c] : panel.triangles) {
      all.triangles.push_back({first + a, first + b, first + c});
      all.triangle_panels.push_back(static_cast<int>(p));
    }
  }
  return all;
}

}  // namespace haptex::garment
