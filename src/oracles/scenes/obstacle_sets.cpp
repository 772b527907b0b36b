// Cloth that collides with itself, on and through obstacles.
#include "haptex/oracles/scenes/obstacle_sets.h"

#include <Eigen/Geometry>
#include <cmath>

#include "haptex/oracles/scenes/obstacle_scenes.h"

namespace haptex::oracles {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using mesh::Obstacle;
using Set = SelfCollidingCloth::Set;

Isometry3d turned(const Vector3d& place, double angle, const Vector3d& axis) {
  return placedAt(place) * Eigen::AngleAxisd(angle, axis);
}

/// Upright, with its tip at a place.
Obstacle needleAt(const std::string& name, const Vector3d& tip) {
  constexpr double kRadius = 5e-4, kLength = 0.08;
  return {name, mesh::ObstacleCapsule{kRadius, kLength},
          placedAt(tip - Vector3d(0.0, 0.0, kRadius + 0.5 * kLength))};
}

/// A box of which an edge along y is on top, at a place.
Obstacle edgeAt(const std::string& name, const Vector3d& top) {
  constexpr double kSide = 0.06;
  return {name, mesh::ObstacleBox{{kSide, 0.4, kSide}},
          turned(top - Vector3d(0.0, 0.0, kSide / std::sqrt(2.0)), M_PI / 4.0, Vector3d::UnitY())};
}

Set thrown(const std::string& name, const Obstacle& obstacle, int cells) {
  Set set;
  set.name = name;
  set.falls = true;
  set.mesh = flatSheet({0.2, 0.2}, 2 * cells, 2 * cells,
                       turned({0.003, 0.002, 0.02}, 0.1, Vector3d(1.0, 0.3, 0.0).normalized()));
  set.velocity = {0.0, 0.0, -2.0};
  set.obstacles = {obstacle};
  set.duration = 0.5;
  return set;
}

Set towelOnEdges(int cells) {
  Set set;
  set.name = "edges_and_needles";
  set.falls = true;
  set.mesh = flatSheet({0.3, 0.1}, 3 * cells, cells, placedAt({0.01, 0.0, 0.14}));
  set.obstacles = {floorAt(0.0), edgeAt("left edge", {-0.07, 0.0, 0.1}),
                   edgeAt("right edge", {0.08, 0.0, 0.1})};
  int count = 0;
  for (const double x : {-0.02, 0.015, 0.04}) {
    for (const double y : {-0.03, 0.02}) {
      set.obstacles.push_back(needleAt("needle " + std::to_string(++count), {x, y, 0.07}));
    }
  }
  return set;
}

/// An open surface that becomes narrower downwards, through which a sheet is drawn by its middle.
Set funnel(int cells) {
  constexpr double kUpper = 0.1, kLower = 0.03, kHeight = 0.08;  // m
  constexpr int kAround = 24;
  mesh::ObstacleMesh surface;
  for (int i = 0; i < kAround; ++i) {
    const double angle = 2.0 * M_PI * i / kAround;
    const Vector3d out(std::cos(angle), std::sin(angle), 0.0);
    surface.vertices.push_back(kUpper * out + Vector3d(0.0, 0.0, kHeight));
    surface.vertices.push_back(kLower * out);
    surface.vertices.push_back(kLower * out - Vector3d(0.0, 0.0, 0.5 * kHeight));
    const int a = 3 * i, b = 3 * ((i + 1) % kAround);
    for (const int ring : {0, 1}) {
      surface.triangles.push_back({a + ring, b + ring, b + ring + 1});
      surface.triangles.push_back({a + ring, b + ring + 1, a + ring + 1});
    }
  }
  Set set;
  set.name = "funnel";
  set.mesh = flatSheet({0.125, 0.125}, 5 * cells / 4, 5 * cells / 4,
                       placedAt({0.0, 0.0, kHeight + 0.005}));
  set.obstacles = {{"funnel", surface, Isometry3d::Identity()}};
  set.duration = 1.5;
  int middle = 0;
  const auto& start = set.mesh.initial_positions;
  for (std::size_t i = 0; i < start.size(); ++i) {
    if (start[i].head<2>().norm() < start[middle].head<2>().norm()) middle = static_cast<int>(i);
  }
  const Vector3d from = start[middle];
  set.move = [middle, from](cloth::Cloth& cloth, const cloth::ClothState& /*state*/, double end) {
    constexpr double kSpeed = 0.2;  // m/s
    cloth::AttachmentPath path;
    path.start = from - Vector3d(0.0, 0.0, kSpeed * end);
    cloth.attach(middle, path);
  };
  return set;
}

/// On a sphere that turns about a vertical axis and drags the sheet with it over the floor.
Set wound(int cells) {
  Set set;
  set.name = "rotating_sphere";
  set.mesh = flatSheet({0.2, 0.2}, 2 * cells, 2 * cells, placedAt({0.0, 0.0, 0.055}));
  Obstacle ball{"ball", mesh::ObstacleSphere{0.05}, Isometry3d::Identity()};
  ball.motion = mesh::ObstacleOrbit{Vector3d::Zero(), Vector3d::UnitZ(), 1.0};
  ball.friction = 0.8;
  set.obstacles = {ball, floorAt(-0.05)};
  set.duration = 1.5;
  return set;
}

}  // namespace

std::vector<Set> obstacleSets(int cells) {
  return {thrown("box_edge", edgeAt("edge", Vector3d::Zero()), cells),
          thrown("needle", needleAt("needle", Vector3d::Zero()), cells), towelOnEdges(cells),
          funnel(cells), wound(cells)};
}

}  // namespace haptex::oracles
