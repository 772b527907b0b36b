#include "haptex/oracles/scenes/tangled_starts.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "haptex/base/constants.h"
#include "haptex/base/repeatable_random.h"
#include "haptex/material/fabric_file.h"
#include "haptex/oracles/scenes/obstacle_scenes.h"
#include "haptex/oracles/scenes/self_collision_scenes.h"
#include "haptex/proximity/intersections.h"

namespace haptex::oracles {
namespace {

using base::RepeatableRandom;
using Eigen::AngleAxisd;
using Eigen::Isometry3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using mesh::ClothMesh;

constexpr double kDegree = M_PI / 180.0;

struct Sheet {
  Vector2d size;      // m
  int across, along;  // cells
};

Sheet anySheet(RepeatableRandom& random) {
  const double cell = random.uniform(0.005, 0.010);
  const Vector2d size = random.inSquare(0.06, 0.10);
  return {size, static_cast<int>(std::lround(size.x() / cell)),
          static_cast<int>(std::lround(size.y() / cell))};
}

ClothMesh lay(const Sheet& sheet, const Isometry3d& pose) {
  return flatSheet(sheet.size, sheet.across, sheet.along, pose);
}

Isometry3d anyPose(RepeatableRandom& random, double tilt, double height) {
  const double direction = random.uniform(0.0, 2.0 * M_PI);
  Isometry3d pose = Isometry3d::Identity();
  const Vector2d beside = random.inSquare(-0.03, 0.03);
  pose.translate(Vector3d(beside.x(), beside.y(), height));
  pose.rotate(AngleAxisd(tilt, Vector3d(std::cos(direction), std::sin(direction), 0.0)));
  pose.rotate(AngleAxisd(random.uniform(0.0, 2.0 * M_PI), Vector3d::UnitZ()));
  return pose;
}

std::vector<ClothMesh> shoved(RepeatableRandom& random) {
  const ClothMesh lower = lay(anySheet(random), placedAt({0.0, 0.0, 0.0}));
  const double tilt = random.uniform(2.0, 10.0) * kDegree;
  const double height = random.uniform(-0.003, 0.003);
  return {lower, lay(anySheet(random), anyPose(random, tilt, height))};
}

/// What lies beyond an oblique line goes on around a half circle, and from there down.
std::vector<ClothMesh> flap(RepeatableRandom& random) {
  ClothMesh sheet = lay(anySheet(random), placedAt({0.0, 0.0, 0.0}));
  const double direction = random.uniform(-40.0, 40.0) * kDegree;
  const Vector3d out(std::cos(direction), std::sin(direction), 0.0);
  const double line = random.uniform(-0.01, 0.01), radius = random.uniform(0.002, 0.004);
  const double slope = random.uniform(12.0, 30.0) * kDegree;
  const double turn = M_PI + slope;
  for (Vector3d& place : sheet.initial_positions) {
    const double beyond = out.dot(place) - line;
    if (beyond <= 0.0) continue;
    const double angle = std::min(beyond / radius, turn);
    const double straight = beyond - radius * angle;
    const double along = radius * std::sin(angle) + straight * std::cos(angle);
    const double up = radius * (1.0 - std::cos(angle)) + straight * std::sin(angle);
    place += (along - beyond) * out + up * Vector3d::UnitZ();
  }
  return {sheet};
}

std::vector<ClothMesh> bump(RepeatableRandom& random) {
  const ClothMesh lower = lay(anySheet(random), placedAt({0.0, 0.0, 0.0}));
  const double gap = random.uniform(0.0015, 0.003);
  ClothMesh upper = lay(anySheet(random), anyPose(random, 0.0, gap));
  const Vector2d beside = random.inSquare(-0.02, 0.02);
  const Vector3d middle(beside.x(), beside.y(), gap);
  const double radius = random.uniform(0.015, 0.03);
  const double depth = gap + random.uniform(0.002, 0.006);
  for (Vector3d& place : upper.initial_positions) {
    const double from_middle = (place - middle).norm() / radius;
    if (from_middle >= 1.0) continue;
    place.z() -= depth * 0.5 * (1.0 + std::cos(M_PI * from_middle));
  }
  return {lower, upper};
}

std::vector<ClothMesh> waves(RepeatableRandom& random) {
  const ClothMesh lower = lay(anySheet(random), placedAt({0.0, 0.0, 0.0}));
  ClothMesh upper = lay(anySheet(random), anyPose(random, 0.0, 0.002));
  const double height = random.uniform(0.003, 0.006);
  const double first = 2.0 * M_PI / random.uniform(0.03, 0.06), of_first = random.uniform(0.0, 6.0);
  const double second = 2.0 * M_PI / random.uniform(0.03, 0.06);
  const double of_second = random.uniform(0.0, 6.0);
  for (Vector3d& place : upper.initial_positions) {
    place.z() +=
        height * std::sin(first * place.x() + of_first) * std::sin(second * place.y() + of_second);
  }
  return {lower, upper};
}

void hold(SelfCollidingCloth::Set& set, const ClothMesh& sheet,
          const std::vector<mesh::Side>& sides) {
  std::vector<int> held;
  for (const mesh::Side side : sides) {
    for (const int particle : mesh::sideParticles(sheet, side)) held.push_back(particle);
  }
  const cloth::Positions places = sheet.initial_positions;
  set.move = [held, places](cloth::Cloth& cloth, const cloth::ClothState& /*state*/, double) {
    for (const int particle : held) {
      cloth::AttachmentPath path;
      path.start = places[particle];
      cloth.attach(particle, path);
    }
  };
}

}  // namespace

TangledStart tangledStart(int index) {
  using mesh::Side;
  RepeatableRandom random(static_cast<std::uint64_t>(index));
  const char* const names[] = {"shoved", "flap", "bump", "waves"};
  std::vector<ClothMesh> (*const kinds[])(RepeatableRandom&) = {shoved, flap, bump, waves};
  const int kind = index % 4;
  TangledStart start;
  std::vector<ClothMesh> sheets;
  do {
    sheets = kinds[kind](random);
    start.set.mesh = asOneMesh(sheets);
  } while (proximity::countIntersections(start.set.mesh.initial_positions,
                                         start.set.mesh.triangles) == 0);
  start.set.name = names[kind];
  start.fabric = index / 4 % 2 == 0 ? "linear" : "wool";
  const bool hangs = index / 8 % 2 == 1;
  start.set.gravity = hangs ? base::kStandardGravity : 0.0;
  // The lower sheet comes first; no flap reaches the left side.
  if (hangs && sheets.size() == 1) hold(start.set, sheets[0], {Side::kLeft});
  if (hangs && sheets.size() > 1) {
    hold(start.set, sheets[0], {Side::kLeft, Side::kRight, Side::kBottom, Side::kTop});
  }
  return start;
}

Untangled untangle(const TangledStart& start, const material::Fabric& fabric, int steps) {
  cloth::StepSettings settings;
  settings.newton_iterations = 5;
  SelfCollidingCloth scene(start.set, {fabric}, settings);
  Untangled result{0, 0, 0.0, 0.0};
  // Energies of the start are with contact in the tangle; a step of no length leaves that out.
  scene.step(1e-9);
  const double first = scene.energy();
  double added = 0.0, highest = first, lowest = first;
  for (int i = 0; i < steps; ++i) {
    const cloth::TangleReport report = scene.step(0.0125).tangle;
    added += report.energy;
    result.left = scene.intersections();
    result.misreported += static_cast<std::size_t>(report.pairs) != result.left;
    const double energy = scene.energy();
    highest = std::max(highest, energy);
    lowest = std::min(lowest, energy);
    result.energy_growth = std::max(result.energy_growth, energy - first - added);
  }
  result.energy_range = highest - lowest;
  return result;
}

UntangledStarts untangleStarts(int count, int steps, const std::string& config_directory) {
  UntangledStarts result;
  int free = 0;
  for (int i = 0; i < count; ++i) {
    const TangledStart start = tangledStart(i);
    const material::Fabric fabric =
        material::loadFabric(config_directory + "/fabrics/" + start.fabric + ".yaml");
    const Untangled end = untangle(start, fabric, steps);
    free += end.left == 0;
    result.left += end.left;
    result.misreported += end.misreported;
    result.energy_growth = std::max(result.energy_growth, end.energy_growth / end.energy_range);
  }
  result.free_share = static_cast<double>(free) / count;
  return result;
}

}  // namespace haptex::oracles
