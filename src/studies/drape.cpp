#include "haptex/studies/drape.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

#include "haptex/base/constants.h"
#include "haptex/cloth/dynamics/cloth.h"
#include "haptex/cloth/dynamics/integrator.h"

namespace haptex::studies {
namespace {

using cloth::Cloth;
using cloth::ClothState;
using Eigen::Vector3d;
using mesh::ClothMesh;

constexpr double kDisturbance = 1e-4;  // m
constexpr double kProminence = 2e-3;   // m, of a fold in the shadow's edge
constexpr int kAngles = 720;

double fastest(const ClothState& state) {
  double largest = 0.0;
  for (const Vector3d& velocity : state.velocities) largest = std::max(largest, velocity.norm());
  return largest;
}

}  // namespace

DrapeOutcome drape(const material::Fabric& fabric, const DrapeTest& test, unsigned seed) {
  cloth::ModelledEffects effects;
  effects.gravity = {0.0, 0.0, -base::kStandardGravity};
  effects.bending = effects.viscosity = true;
  effects.bending_hysteresis = fabric.bending_hysteresis.has_value();
  Cloth cloth(mesh::makeDisc(test.fabric_radius, test.rings), fabric, effects);
  ClothState state = cloth.initialState();
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  for (std::size_t i = 0; i < cloth.particleCount(); ++i) {
    if (state.positions[i].norm() <= test.support_radius * (1.0 + 1e-9)) {
      cloth.attach(static_cast<int>(i), {state.positions[i], Vector3d::Zero(), 0.0, 0.0});
    } else {
      state.positions[i].z() += kDisturbance * normal(random);
    }
  }
  cloth::StepSettings settings;
  settings.newton_iterations = 2;
  settings.tolerance = 1e-4;
  cloth::Integrator integrator(cloth, settings);
  constexpr double kMinTime = 0.5;  // s, before which it cannot be at rest
  while (state.time < test.most_time &&
         (state.time < kMinTime || fastest(state) > test.rest_speed)) {
    if (!integrator.step(cloth, state, test.time_step).accepted) {
      throw std::runtime_error("a step of the drape test was not finite");
    }
  }
  DrapeOutcome outcome{0.0, 0, state.time, fastest(state), 0, cloth.mesh()};
  outcome.shape.initial_positions = state.positions;
  const std::vector<double> radii = shadowRadii(outcome.shape, kAngles);
  outcome.coefficient = drapeCoefficient(radii, test);
  outcome.nodes = countNodes(radii, kProminence);
  for (const Vector3d& place : state.positions) {
    if (place.z() < -1e-3 && place.head<2>().norm() < 0.999 * test.support_radius) {
      ++outcome.inside_support;
    }
  }
  return outcome;
}

std::vector<double> shadowRadii(const ClothMesh& mesh, int count) {
  std::vector<double> radii(count, 0.0);
  const double step = 2.0 * M_PI / count;
  for (const auto& triangle : mesh.triangles) {
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector2d p = mesh.initial_positions[triangle[i]].head<2>();
      const Eigen::Vector2d q = mesh.initial_positions[triangle[(i + 1) % 3]].head<2>();
      const double begin = std::atan2(p.y(), p.x());
      // The shorter way round; edges through the origin are not at the shadow's edge.
      const double sweep = std::remainder(std::atan2(q.y(), q.x()) - begin, 2.0 * M_PI);
      const double low = std::min(begin, begin + sweep), high = std::max(begin, begin + sweep);
      for (int k = static_cast<int>(std::ceil(low / step)); k <= std::floor(high / step); ++k) {
        const Eigen::Vector2d ray(std::cos(k * step), std::sin(k * step));
        const Eigen::Vector2d across(-ray.y(), ray.x());
        const double a = across.dot(p), b = across.dot(q);
        const double share = a == b ? 0.0 : std::min(1.0, std::max(0.0, a / (a - b)));
        double& radius = radii[((k % count) + count) % count];
        radius = std::max(radius, ray.dot(p + share * (q - p)));
      }
    }
  }
  return radii;
}

double drapeCoefficient(const std::vector<double>& radii, const DrapeTest& test) {
  double squares = 0.0;
  for (double radius : radii) squares += radius * radius / static_cast<double>(radii.size());
  const double support = test.support_radius * test.support_radius;
  return (squares - support) / (test.fabric_radius * test.fabric_radius - support);
}

int countNodes(const std::vector<double>& radii, double prominence) {
  if (radii.empty()) return 0;
  const int count = static_cast<int>(radii.size());
  const int start = static_cast<int>(std::min_element(radii.begin(), radii.end()) - radii.begin());
  int nodes = 0;
  double low = radii[start], high = low;  // since the last maximum and minimum
  bool rising = true;                     // looks for the next maximum
  for (int i = 1; i <= count; ++i) {
    const double radius = radii[(start + i) % count];
    if (rising) {
      low = std::min(low, radius);
      if (radius > low + prominence) rising = false, ++nodes, high = radius;
    } else {
      high = std::max(high, radius);
      if (radius < high - prominence) rising = true, low = radius;
    }
  }
  return nodes;
}

}  // namespace haptex::studies
