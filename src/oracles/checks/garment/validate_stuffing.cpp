// Closed cloth with a stuffing: Laplace's law of a ball, and the balance of pressure and tension in
// a cushion, which wrinkles.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "haptex/base/workload.h"
#include "haptex/cloth/dynamics/cloth.h"
#include "haptex/cloth/dynamics/integrator.h"
#include "haptex/cloth/forces/element_assembly.h"
#include "haptex/material/linear_fabric.h"
#include "haptex/oracles/checks/garment_oracles.h"

namespace haptex::oracles {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kRadius = 0.1;              // m, at rest
constexpr double kModulus = 400.0;           // N/m
constexpr double kStuffingTolerance = 0.01;  // of Laplace's law

/// The triangles of an icosahedron, cut into four several times, on a sphere.
mesh::ClothMesh ball(int cuts) {
  const double g = 0.5 * (1.0 + std::sqrt(5.0));
  mesh::ClothMesh mesh;
  mesh.initial_positions = {{-1, g, 0}, {1, g, 0}, {-1, -g, 0}, {1, -g, 0},
                            {0, -1, g}, {0, 1, g}, {0, -1, -g}, {0, 1, -g},
                            {g, 0, -1}, {g, 0, 1}, {-g, 0, -1}, {-g, 0, 1}};
  mesh.triangles = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                    {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                    {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                    {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
  for (int cut = 0; cut < cuts; ++cut) {
    std::map<std::array<int, 2>, int> middles;
    const auto middle = [&](int a, int b) {
      const std::array<int, 2> edge = {std::min(a, b), std::max(a, b)};
      const auto known = middles.emplace(edge, static_cast<int>(mesh.initial_positions.size()));
      if (known.second) {
        mesh.initial_positions.push_back(mesh.initial_positions[a] + mesh.initial_positions[b]);
      }
      mesh.initial_positions[known.first->second].normalize();
      return known.first->second;
    };
    for (Vector3d& place : mesh.initial_positions) place.normalize();
    std::vector<std::array<int, 3>> finer;
    for (const auto& [a, b, c] : mesh.triangles) {
      const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    mesh.triangles = std::move(finer);
  }
  for (Vector3d& place : mesh.initial_positions) place *= kRadius / place.norm();
  mesh::cutAsInSpace(mesh);
  return mesh;
}

/// Two squares that are sewn together all around, and bulge by 0.15 of their side.
mesh::ClothMesh cushion(double side, int cells) {
  const mesh::ClothMesh square =
      mesh::makeRectangle(side, side, cells, cells, mesh::Triangulation::kAlternating);
  mesh::ClothMesh mesh;
  mesh.panels = {{}, {}};
  std::vector<int> lower(square.rest_coordinates.size());
  const auto add = [&](const Vector2d& rest, double height) {
    mesh.rest_coordinates.push_back(rest);
    mesh.initial_positions.emplace_back(rest.x(), rest.y(), height);
  };
  const auto height = [&](const Vector2d& rest) {
    const Vector2d from = 2.0 / side * rest - Vector2d::Ones();
    return 0.15 * side * (1.0 - from.x() * from.x()) * (1.0 - from.y() * from.y());
  };
  for (const Vector2d& rest : square.rest_coordinates) add(rest, height(rest));
  for (std::size_t i = 0; i < lower.size(); ++i) {
    const Vector2d& rest = square.rest_coordinates[i];
    const double bulge = height(rest);
    lower[i] =
        bulge > 1e-9 * side ? static_cast<int>(mesh.rest_coordinates.size()) : static_cast<int>(i);
    if (bulge > 1e-9 * side) add(rest, -bulge);
  }
  for (const int panel : {0, 1}) {
    for (const auto& [a, b, c] : square.triangles) {
      const auto& rest = square.rest_coordinates;
      if (panel == 0) {
        mesh.triangles.push_back({a, b, c});
        mesh.corner_coordinates.push_back({rest[a], rest[b], rest[c]});
      } else {
        const auto turned = [](const Vector2d& place) { return Vector2d(-place.x(), place.y()); };
        mesh.triangles.push_back({lower[a], lower[c], lower[b]});
        mesh.corner_coordinates.push_back({turned(rest[a]), turned(rest[c]), turned(rest[b])});
      }
      mesh.triangle_panels.push_back(panel);
    }
  }
  return mesh;
}

struct Inflated {
  double volume;    // m^3
  double pressure;  // Pa
  double work;      // J, of the tension if all lengths grow by their own length
  double area;      // m^2
};

/// At rest, by steps without velocity.
Inflated inflate(const mesh::ClothMesh& mesh, const cloth::StuffingMass& mass, int steps) {
  cloth::ModelledEffects effects;
  effects.stuffing = mass;
  const material::Fabric fabric = material::linearFabric(kModulus);
  cloth::Cloth cloth(mesh, fabric, effects);
  cloth::ClothState state = cloth.initialState();
  cloth::StepSettings settings;
  settings.newton_iterations = 10;
  cloth::Integrator integrator(cloth, settings);
  for (int i = 0; i < steps; ++i) {
    std::fill(state.velocities.begin(), state.velocities.end(), Vector3d::Zero());
    integrator.step(cloth, state, 0.05);
  }
  Inflated result{};
  result.volume = cloth::enclosedVolume(mesh.triangles, state.positions);
  result.pressure = cloth::pressureOf(mass, result.volume).pressure;
  for (const cloth::MembraneElement& element : cloth::restElements(mesh)) {
    Vector3d along = Vector3d::Zero(), across = Vector3d::Zero();
    for (int i = 0; i < 3; ++i) {
      along += element.weft_weights[i] * state.positions[element.particles[i]];
      across += element.warp_weights[i] * state.positions[element.particles[i]];
    }
    const double weft = 0.5 * (along.squaredNorm() - 1.0);
    const double warp = 0.5 * (across.squaredNorm() - 1.0), shear = along.dot(across);
    const double stress_weft = fabric.weft.elastic.evaluate(weft).stress;
    const double stress_warp = fabric.warp.elastic.evaluate(warp).stress;
    const double stress_shear = fabric.shear.elastic.evaluate(shear).stress;
    result.work += element.area * (stress_weft * along.squaredNorm() +
                                   stress_warp * across.squaredNorm() + 2.0 * stress_shear * shear);
    result.area += element.area * along.cross(across).norm();
  }
  return result;
}

/// m, of the ball that has a volume (m^3).
double radiusOf(double volume) { return std::cbrt(3.0 * volume / (4.0 * M_PI)); }

/// m, where the pressure of the stuffing is that of Laplace's law, p = 2 T / r: stretched by l all
/// around, the tension is the second Piola-Kirchhoff stress k (l^2 - 1) / 2.
/// @param rest m, the radius without pressure
double laplaceRadius(const cloth::StuffingMass& mass, double rest) {
  double low = rest, high = 2.0 * rest;
  for (int halving = 0; halving < 60; ++halving) {
    const double radius = 0.5 * (low + high), stretch = radius / rest;
    const double tension = 0.5 * kModulus * (stretch * stretch - 1.0);
    const double volume = 4.0 / 3.0 * M_PI * radius * radius * radius;
    const bool grows = cloth::pressureOf(mass, volume).pressure > 2.0 * tension / radius;
    (grows ? low : high) = radius;
  }
  return 0.5 * (low + high);
}

void validateBall(const Sink& sink) {
  const mesh::ClothMesh mesh = ball(base::unlessSanitized(3, 2));
  const double own = cloth::enclosedVolume(mesh.triangles, mesh.initial_positions);
  const double rest = radiusOf(own);
  for (const double share : {1.5, 3.0}) {
    const cloth::StuffingMass mass{share * own, 200.0};
    const Inflated ball_now = inflate(mesh, mass, 40);
    const double radius = radiusOf(ball_now.volume);
    const double exact = laplaceRadius(mass, rest);
    const double tension = ball_now.work / (2.0 * ball_now.area);
    const std::string name =
        std::string("garment/stuffing/ball_of_") + (share < 2.0 ? "1.5" : "3") + "_volumes";
    sink(base::relativeTo(exact - rest, name + "/growth_of_radius", exact - rest, radius - rest,
                          base::unlessSanitized(kStuffingTolerance, 0.05)));
    sink(base::relativeTo(0.5 * ball_now.pressure * radius, name + "/laplace_tension",
                          0.5 * ball_now.pressure * radius, tension,
                          base::unlessSanitized(kStuffingTolerance, 0.05)));
  }
}

/// All places times 1 + d: the pressure does the work 3 p V d and the tension as much.
void validateCushion(const Sink& sink) {
  constexpr double kSide = 0.4;  // m
  const cloth::StuffingMass mass{0.016, 50.0};
  const Inflated now =
      inflate(cushion(kSide, base::unlessSanitized(12, 6)), mass, base::unlessSanitized(200, 100));
  const double work = 3.0 * now.pressure * now.volume;
  sink(base::relativeTo(work, "garment/stuffing/cushion/virtual_work", work, now.work,
                        kStuffingTolerance));
}

}  // namespace

void validateStuffing(const Sink& sink) {
  validateBall(sink);
  validateCushion(sink);
}

}  // namespace haptex::oracles
