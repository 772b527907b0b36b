#include "haptex/oracles/scenes/deformed_sheets.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <random>
#include <stdexcept>
#include <utility>

#include "haptex/base/quoted.h"

namespace haptex::oracles {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Map = std::function<Vector3d(const Vector2d&)>;  // from rest coordinates, m

/// Folded over at u = length / 2, the second layer `gap` above the first.
Vector3d fold(const Vector2d& rest, double length, double gap) {
  const bool upper = rest.x() > 0.5 * length;
  return {upper ? length - rest.x() : rest.x(), rest.y(), upper ? gap : 0.0};
}

/// Rolled up along u into a spiral that grows by `pitch` with each turn.
Vector3d roll(const Vector2d& rest, double radius, double pitch) {
  const double angle = rest.x() / radius;
  const double r = radius + pitch * angle / (2.0 * M_PI);
  return {r * std::cos(angle), rest.y(), r * std::sin(angle)};
}

/// A sum of waves of random direction, length and phase displaces every particle.
Map crumple(double amplitude, double shortest_wave, unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  struct Wave {
    Vector2d number;
    Vector3d displacement;
    double phase;
  };
  std::vector<Wave> waves;
  for (int i = 0; i < 12; ++i) {
    const double number = 2.0 * M_PI / (shortest_wave * (1.5 + 2.0 * std::abs(uniform(generator))));
    const double angle = M_PI * uniform(generator);
    Vector3d displacement;
    for (double& component : displacement) component = amplitude * uniform(generator);
    waves.push_back({number * Vector2d(std::cos(angle), std::sin(angle)), displacement,
                     M_PI * uniform(generator)});
  }
  return [waves](const Vector2d& rest) {
    Vector3d position(rest.x(), rest.y(), 0.0);
    for (const Wave& wave : waves) {
      position += wave.displacement * std::sin(wave.number.dot(rest) + wave.phase);
    }
    return position;
  };
}

/// Every particle displaced on its own.
Map noise(double amplitude, unsigned seed) {
  auto generator = std::make_shared<std::mt19937>(seed);
  return [=](const Vector2d& rest) {
    std::uniform_real_distribution<double> uniform(-amplitude, amplitude);
    const double x = uniform(*generator), y = uniform(*generator), z = uniform(*generator);
    return Vector3d(rest.x() + x, rest.y() + y, z);
  };
}

}  // namespace

std::vector<DeformedSheet> deformedSheets(const mesh::ClothMesh& mesh) {
  double length = 0.0;  // along u
  for (const Vector2d& rest : mesh.rest_coordinates) length = std::max(length, rest.x());
  const double cell = length / std::sqrt(0.5 * static_cast<double>(mesh.triangles.size()));
  std::vector<DeformedSheet> sheets;
  const auto add = [&](const std::string& name, const Map& map) {
    sheets.push_back({name, {}});
    for (const Vector2d& rest : mesh.rest_coordinates) sheets.back().positions.push_back(map(rest));
  };
  add("flat", [](const Vector2d& p) { return Vector3d(p.x(), p.y(), 0.0); });
  add("hanging", [](const Vector2d& p) { return Vector3d(0.0, p.x(), p.y()); });
  add("stretched", [](const Vector2d& p) { return Vector3d(1.7 * p.x(), p.y(), 0.0); });
  add("sheared", [](const Vector2d& p) { return Vector3d(p.x() + 0.8 * p.y(), p.y(), 0.1); });
  add("folded", [=](const Vector2d& p) { return fold(p, length, 0.2 * cell); });
  add("folded_without_gap", [=](const Vector2d& p) { return fold(p, length, 0.0); });
  add("folded_twice", [=](const Vector2d& p) {
    const Vector3d once = fold(p, length, 0.2 * cell);
    const Vector3d twice = fold({once.y(), once.x()}, length, 0.5 * cell);
    return Vector3d(twice.y(), twice.x(), once.z() + twice.z());
  });
  add("rolled", [=](const Vector2d& p) { return roll(p, 0.05 * length, 0.3 * cell); });
  add("pleated", [=](const Vector2d& p) {
    const double wave = std::abs(std::remainder(p.x(), 0.2 * length));
    return Vector3d(0.2 * p.x(), p.y(), wave);
  });
  add("waved", [=](const Vector2d& p) {
    return Vector3d(p.x(), p.y(), 0.05 * length * std::sin(30.0 * (p.x() + p.y()) / length));
  });
  add("twisted", [=](const Vector2d& p) {
    const double angle = 6.0 * p.y() / length, r = p.x() - 0.5 * length;
    return Vector3d(r * std::cos(angle), p.y(), r * std::sin(angle));
  });
  add("draped", [=](const Vector2d& p) {
    const double r = (p - Vector2d(0.5, 0.5) * length).norm();
    const double radius = 0.2 * length;
    const double top = r < radius ? std::sqrt(radius * radius - r * r) : radius - r;
    return Vector3d(p.x(), p.y(), top);
  });
  for (unsigned seed = 1; seed <= 4; ++seed) {
    add("crumpled_" + std::to_string(seed), crumple(0.06 * length, 0.15 * length * seed, seed));
  }
  add("crumpled_to_a_ball", crumple(0.3 * length, 0.05 * length, 5));
  add("noise_of_a_tenth_of_a_cell", noise(0.1 * cell, 6));
  add("noise_of_a_cell", noise(cell, 7));
  add("scrambled", noise(length, 8));
  add("mirrored", [=](const Vector2d& p) { return Vector3d(length - p.x(), p.y(), 0.0); });
  add("tiny", [](const Vector2d& p) { return Vector3d(1e-6 * p.x(), 1e-6 * p.y(), 0.0); });
  add("huge", [](const Vector2d& p) { return Vector3d(1e4 * p.x(), 1e4 * p.y(), 5.0); });
  add("far_away", [](const Vector2d& p) { return Vector3d(p.x() + 1e3, p.y() - 5e3, 1e3); });
  add("on_a_line", [](const Vector2d& p) { return Vector3d(p.x(), 0.5 * p.x(), 0.0); });
  add("on_a_point", [](const Vector2d&) { return Vector3d(0.1, 0.1, 0.1); });
  return sheets;
}

std::vector<Vector3d> deformedSheet(const mesh::ClothMesh& mesh, const std::string& name) {
  for (DeformedSheet& sheet : deformedSheets(mesh)) {
    if (sheet.name == name) return std::move(sheet.positions);
  }
  throw std::invalid_argument("there is no deformed sheet " + base::quoted(name));
}

}  // namespace haptex::oracles
