#include "haptex/simulation/touch_cost.h"

#include <algorithm>
#include <optional>
#include <vector>

#include "haptex/contact/haptic_layer.h"
#include "haptex/simulation/step_cost.h"
#include "haptex/tactile/contactor_array.h"
#include "haptex/tactile/surface.h"

namespace haptex::simulation {
namespace {

using base::Finger;
using base::kFingers;
using contact::Fingertip;
using contact::Fingertips;
using Eigen::Vector3d;

constexpr double kRadius = 0.008;        // m, of the fingertips
constexpr double kDepth = 1e-3;          // m
constexpr double kStatePeriod = 0.0125;  // s
constexpr double kSpeed = 0.02;          // m/s, of the rubbing
constexpr double kForce = 0.5;           // N, likewise

std::array<Vector3d, 3> cornersOf(const mesh::ClothMesh& mesh, std::size_t triangle) {
  const std::array<int, 3>& corners = mesh.triangles[triangle];
  return {mesh.initial_positions[corners[0]], mesh.initial_positions[corners[1]],
          mesh.initial_positions[corners[2]]};
}

Vector3d middleOf(const std::array<Vector3d, 3>& corners) {
  return (corners[0] + corners[1] + corners[2]) / 3.0;
}

/// One that presses into the middle of a triangle.
Fingertip pressInto(const mesh::ClothMesh& mesh, std::size_t triangle) {
  const std::array<Vector3d, 3> corners = cornersOf(mesh, triangle);
  const Vector3d normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized();
  Fingertip fingertip;
  fingertip.radius = kRadius;
  fingertip.position = middleOf(corners) + (kRadius - kDepth) * normal;
  return fingertip;
}

/// The elements within the patch of a fingertip, the nearest first and not too many.
std::vector<int> elementsNear(const mesh::ClothMesh& mesh, const Fingertip& fingertip,
                              const contact::HapticSettings& settings) {
  std::vector<std::pair<double, int>> found;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const double distance = (middleOf(cornersOf(mesh, i)) - fingertip.position).norm();
    if (distance < fingertip.radius + settings.margin || found.empty()) {
      found.emplace_back(distance, static_cast<int>(i));
    }
  }
  std::sort(found.begin(), found.end());
  found.resize(std::min<std::size_t>(found.size(), settings.most_elements));
  std::vector<int> elements;
  for (const auto& [distance, element] : found) elements.push_back(element);
  return elements;
}

template <typename Work>
double medianSeconds(int times, const Work& work) {
  std::vector<double> seconds;
  for (int i = 0; i < times; ++i) {
    const double begin = threadSeconds();
    work(i);
    seconds.push_back(threadSeconds() - begin);
  }
  std::nth_element(seconds.begin(), seconds.begin() + times / 2, seconds.end());
  return seconds[times / 2];
}

}  // namespace

TouchCost measureTouch(const mesh::ClothMesh& mesh, const std::vector<material::Fabric>& fabrics,
                       const cloth::ModelledEffects& effects,
                       const contact::HapticSettings& settings, int milliseconds) {
  contact::HapticLayer layer(mesh, fabrics, effects, settings);
  const std::vector<Vector3d> still(mesh.initial_positions.size(), Vector3d::Zero());
  layer.receive(mesh.initial_positions, still, kStatePeriod);
  Fingertips near;
  std::vector<int> elements;
  for (const Finger finger : kFingers) {
    const std::size_t share = static_cast<std::size_t>(finger) + 1;
    near[finger] = pressInto(mesh, share * mesh.triangles.size() / (kFingers.size() + 1));
    const std::vector<int> found = elementsNear(mesh, *near[finger], settings);
    elements.insert(elements.end(), found.begin(), found.end());
  }
  Fingertips far = near;
  for (auto& fingertip : far.values) fingertip->position.x() += 10.0;
  const std::vector<char> attached(mesh.initial_positions.size(), 0);
  TouchCost cost;
  cost.far_seconds = medianSeconds(milliseconds, [&](int) { layer.step(far); });
  cost.far_particles = layer.particleCount();
  if (settings.layer == contact::HapticSettings::Layer::kPatch) {
    layer.exchange(layer.preparePatch(elements, attached));
  }
  cost.near_seconds = medianSeconds(milliseconds, [&](int) { layer.step(near); });
  cost.near_particles = layer.particleCount();
  return cost;
}

double measureTactile(const material::Fabric& fabric, int steps) {
  const tactile::Surface surface = tactile::buildSurface(fabric);
  tactile::TouchedFabric touched;
  touched.stroke = {{kSpeed, 0.0}, kForce};
  touched.forces.fill(kForce / touched.forces.size());
  double felt = 0.0;  // so that it has to be computed
  const double seconds = medianSeconds(steps, [&](int i) {
    for (const Finger finger : kFingers) {
      touched.placement.origin = {1e-4 * i, 0.01 * static_cast<int>(finger)};
      felt += tactile::arrayAmplitudes(surface, touched, {})[0][tactile::k40];
    }
  });
  return felt >= 0.0 ? seconds : -1.0;
}

}  // namespace haptex::simulation
