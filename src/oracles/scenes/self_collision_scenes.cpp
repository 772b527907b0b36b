#include "haptex/oracles/scenes/self_collision_scenes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "haptex/base/constants.h"
#include "haptex/oracles/scenes/obstacle_scenes.h"
#include "haptex/oracles/scenes/obstacle_sets.h"

namespace haptex::oracles {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using mesh::ClothMesh;
using Set = SelfCollidingCloth::Set;

/// Puts a particle to a place at a time; it is attached there.
void put(cloth::Cloth& cloth, int particle, const Vector3d& place) {
  cloth::AttachmentPath path;
  path.start = place;
  cloth.attach(particle, path);
}

/// From 0 to 1 between two times, smoothly.
double smoothly(double time, double begin, double end) {
  const double s = std::clamp((time - begin) / (end - begin), 0.0, 1.0);
  return s * s * (3.0 - 2.0 * s);
}

/// Lays one side of a sheet on the other over a half circle, and then the half of this.
Set folded(int cells) {
  Set set;
  set.name = "folded";
  set.mesh = flatSheet({0.2, 0.2}, 2 * cells, 2 * cells, placedAt({0.0, 0.0, 0.003}));
  set.obstacles = {floorAt(0.0)};
  set.duration = 2.5;
  const ClothMesh mesh = set.mesh;
  const auto lifted = std::make_shared<cloth::Positions>();
  set.move = [mesh, lifted](cloth::Cloth& cloth, const cloth::ClothState& state, double end) {
    constexpr double kFirst = 1.0, kSecond = 1.2, kLast = 2.2;  // s
    cloth.releaseAll();
    if (end <= kFirst) {
      const double angle = 0.97 * M_PI * smoothly(end, 0.0, kFirst);
      for (const int particle : mesh::sideParticles(mesh, mesh::Side::kRight)) {
        const Vector3d start = mesh.initial_positions[particle];
        put(cloth, particle,
            {start.x() * std::cos(angle), start.y(), start.z() + start.x() * std::sin(angle)});
      }
    } else if (end > kSecond && end <= kLast) {
      // Both layers, from where they are.
      const std::vector<int> edge = mesh::sideParticles(mesh, mesh::Side::kTop);
      if (state.time <= kSecond + 1e-9) *lifted = state.positions;
      const double angle = 0.95 * M_PI * smoothly(end, kSecond, kLast);
      for (const int particle : edge) {
        const Vector3d start = (*lifted)[particle];
        put(cloth, particle,
            {start.x(), start.y() * std::cos(angle), start.z() + start.y() * std::sin(angle)});
      }
    }
  };
  return set;
}

Set heaped(int cells) {
  Set set;
  set.name = "heaped";
  set.falls = true;
  // Not quite upright, and bent, so that it does not stand.
  set.mesh = flatSheet({0.2, 0.2}, 2 * cells, 2 * cells, placedAt({0.0, 0.0, 0.0}));
  for (Vector3d& place : set.mesh.initial_positions) {
    const double height = place.y() + 0.11;
    place = Vector3d(place.x(), 0.004 * std::sin(40.0 * height + 9.0 * place.x()), height);
  }
  set.obstacles = {floorAt(0.0)};
  return set;
}

Set gathered(int cells) {
  Set set;
  set.name = "gathered";
  set.mesh = flatSheet({0.2, 0.2}, 2 * cells, 2 * cells, placedAt({0.0, 0.0, 0.0}));
  for (Vector3d& place : set.mesh.initial_positions) {
    place = Vector3d(place.x(), 1e-3 * std::sin(120.0 * place.x()), place.y());
  }
  const ClothMesh mesh = set.mesh;
  const int apart = std::max(1, cells / 4);
  set.move = [mesh, apart](cloth::Cloth& cloth, const cloth::ClothState& /*state*/, double end) {
    const double narrower = 1.0 - 0.9 * smoothly(end, 0.0, 0.8);
    const std::vector<int> edge = mesh::sideParticles(mesh, mesh::Side::kTop);
    for (std::size_t i = 0; i < edge.size(); i += apart) {
      const Vector3d start = mesh.initial_positions[edge[i]];
      put(cloth, edge[i], {narrower * start.x(), start.y(), start.z()});
    }
  };
  return set;
}

Set towel(int cells) {
  Set set;
  set.name = "towel";
  set.falls = true;
  set.mesh = flatSheet({0.4, 0.1}, 4 * cells, cells, placedAt({0.02, 0.0, 0.28}));
  mesh::Obstacle pole{"pole", mesh::ObstacleCapsule{0.01, 0.4},
                      Isometry3d(Eigen::AngleAxisd(0.5 * M_PI, Vector3d::UnitX()))};
  pole.pose.translation().z() = 0.23;
  set.obstacles = {floorAt(0.0), pole};
  return set;
}

Set ribbons(int cells) {
  Set set;
  set.name = "ribbons";
  const int across = std::max(2, cells / 4);
  set.mesh = asOneMesh({flatSheet({0.2, 0.02}, 2 * cells, across, placedAt({0.0, 0.0, 0.002})),
                        flatSheet({0.02, 0.2}, across, 2 * cells, placedAt({0.0, 0.0, -0.002}))});
  set.gravity = 0.0;
  const ClothMesh mesh = set.mesh;
  set.move = [mesh](cloth::Cloth& cloth, const cloth::ClothState& /*state*/, double end) {
    // The ends of the upper one go down and those of the lower one up, farther than they reach.
    const double share = smoothly(end, 0.0, 0.9);
    for (std::size_t i = 0; i < mesh.initial_positions.size(); ++i) {
      const Vector3d start = mesh.initial_positions[i];
      if (start.head<2>().cwiseAbs().maxCoeff() < 0.1 - 1e-9) continue;
      const double up = start.z() > 0.0 ? -1.0 : 1.0;
      put(cloth, static_cast<int>(i), start + share * Vector3d(0.0, 0.0, 0.035 * up));
    }
  };
  return set;
}

Set twisted(int cells) {
  Set set;
  set.name = "twisted";
  set.mesh = flatSheet({0.2, 0.1}, 2 * cells, cells, placedAt({0.0, 0.0, 0.0}));
  set.gravity = 0.0;
  set.duration = 1.5;
  const ClothMesh mesh = set.mesh;
  set.move = [mesh](cloth::Cloth& cloth, const cloth::ClothState& /*state*/, double end) {
    const double share = smoothly(end, 0.0, 1.4);
    for (const auto side : {mesh::Side::kLeft, mesh::Side::kRight}) {
      const double sign = side == mesh::Side::kLeft ? -1.0 : 1.0;
      const Eigen::AngleAxisd turn(M_PI * sign * share, Vector3d::UnitX());
      for (const int particle : mesh::sideParticles(mesh, side)) {
        put(cloth, particle,
            turn * mesh.initial_positions[particle] - Vector3d(0.03 * sign * share, 0.0, 0.0));
      }
    }
  };
  return set;
}

}  // namespace

ClothMesh asOneMesh(const std::vector<ClothMesh>& sheets, int fabrics) {
  ClothMesh all;
  int fabric = 0;
  double width = 0.0;
  for (const ClothMesh& sheet : sheets) {
    double most = 0.0;
    for (const Vector2d& rest : sheet.rest_coordinates) most = std::max(most, rest.x());
    const int first = static_cast<int>(all.rest_coordinates.size());
    for (const Vector2d& rest : sheet.rest_coordinates) {
      all.rest_coordinates.push_back(rest + Vector2d(width, 0.0));
    }
    all.initial_positions.insert(all.initial_positions.end(), sheet.initial_positions.begin(),
                                 sheet.initial_positions.end());
    for (const auto& [a, b, c] : sheet.triangles) {
      all.triangles.push_back({a + first, b + first, c + first});
      if (fabrics > 1) all.triangle_fabrics.push_back(fabric);
    }
    fabric = (fabric + 1) % fabrics;
    width += 2.0 * most;
  }
  return all;
}

std::vector<Set> selfCollisionScenes(int cells) {
  std::vector<Set> all = {folded(cells), heaped(cells),  gathered(cells),
                          towel(cells),  ribbons(cells), twisted(cells)};
  for (Set& set : obstacleSets(cells)) all.push_back(std::move(set));
  return all;
}

double thicknessAt(const material::Compression& compression, double pressure) {
  double low = 0.0, high = 1.0;
  for (int halving = 0; halving < 60; ++halving) {
    const double strain = 0.5 * (low + high);
    (compression.pressure.evaluate(strain).stress < pressure ? low : high) = strain;
  }
  return compression.thickness * (1.0 - high);
}

LayerStack restingStack(const std::vector<material::Fabric>& fabrics, int layers, int steps) {
  constexpr double kSide = 0.03, kStep = 0.0125;  // m, s
  LayerStack result{0.0, 0.0};
  std::vector<ClothMesh> sheets;
  const auto fabric_of = [&](int layer) { return fabrics[layer % fabrics.size()]; };
  for (int layer = 0; layer < layers; ++layer) {
    sheets.push_back(flatSheet({kSide, kSide}, 3, 3, placedAt({0.0, 0.0, 1.005 * result.exact})));
    double above = 0.0;  // Pa
    for (int i = layer + 1; i < layers; ++i) {
      above += fabric_of(i).areal_density * base::kStandardGravity;
    }
    for (int i = layer; i <= layer + 1 && layer + 1 < layers; ++i) {
      result.exact += 0.5 * thicknessAt(*fabric_of(i).compression, above);
    }
  }
  cloth::StepSettings settings;
  settings.newton_iterations = 20;
  SelfCollidingCloth stack(
      {asOneMesh(sheets, static_cast<int>(fabrics.size())), base::kStandardGravity}, fabrics,
      settings);
  const std::size_t of_layer = sheets[0].initial_positions.size();
  for (std::size_t i = 0; i < of_layer; ++i) {
    put(stack.cloth, static_cast<int>(i), stack.state.positions[i]);
  }
  for (int i = 0; i < steps; ++i) stack.step(kStep);
  for (std::size_t i = stack.state.positions.size() - of_layer; i < stack.state.positions.size();
       ++i) {
    result.height += stack.state.positions[i].z() / static_cast<double>(of_layer);
  }
  return result;
}

}  // namespace haptex::oracles
