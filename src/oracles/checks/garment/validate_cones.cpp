// Discs with a sector cut out and sewn: cones.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "haptex/base/workload.h"
#include "haptex/cloth/dynamics/integrator.h"
#include "haptex/kes/equilibrium.h"
#include "haptex/material/linear_fabric.h"
#include "haptex/oracles/checks/garment_oracles.h"
#include "haptex/oracles/checks/random_checks.h"
#include "haptex/oracles/scenes/sewn_panels.h"

namespace haptex::oracles {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kTolerance = 5e-3;  // of the cone's angle
constexpr double kRadius = 0.1;      // m

struct CutDisc {
  double sector;        // rad, that is cut out
  int columns = 40;     // of triangles around the tip
  int rings = 8;        // along the first side of the cut
  int other_rings = 8;  // along the other one
};

struct Cone {
  mesh::ClothMesh mesh;
  mesh::Seam seam;
  std::vector<Vector2d> polar;  // m and rad, of every particle before sewing
};

/// Triangles between two rows of particles that run outwards from the tip.
void fillColumn(const std::vector<int>& first, const std::vector<int>& second,
                mesh::ClothMesh& mesh) {
  mesh.triangles.push_back({first[0], first[1], second[1]});
  std::size_t i = 1, j = 1;
  while (i + 1 < first.size() || j + 1 < second.size()) {
    const double next_first = static_cast<double>(i + 1) / static_cast<double>(first.size() - 1);
    const double next_second = static_cast<double>(j + 1) / static_cast<double>(second.size() - 1);
    if (i + 1 < first.size() && (j + 1 == second.size() || next_first <= next_second)) {
      mesh.triangles.push_back({first[i], first[i + 1], second[j]});
      ++i;
    } else {
      mesh.triangles.push_back({first[i], second[j + 1], second[j]});
      ++j;
    }
  }
}

Cone coneOf(const CutDisc& disc) {
  Cone cone;
  cone.polar.emplace_back(0.0, 0.0);
  std::vector<int> before;
  for (int column = 0; column <= disc.columns; ++column) {
    const int rings = column == disc.columns ? disc.other_rings : disc.rings;
    std::vector<int> particles = {0};
    for (int ring = 1; ring <= rings; ++ring) {
      particles.push_back(static_cast<int>(cone.polar.size()));
      cone.polar.emplace_back(kRadius * ring / rings,
                              (2.0 * M_PI - disc.sector) * column / disc.columns);
    }
    if (column == 0) cone.seam.first = particles;
    if (column > 0) fillColumn(before, particles, cone.mesh);
    before = particles;
  }
  cone.seam.second = before;
  cone.seam.first_places = evenPlaces(disc.rings + 1);
  cone.seam.second_places = evenPlaces(disc.other_rings + 1);
  // Half of the sector is closed already, as far as it goes without stretching.
  const double turned = (2.0 * M_PI - 0.5 * disc.sector) / (2.0 * M_PI - disc.sector);
  const double slope = std::sqrt(1.0 - 1.0 / (turned * turned));
  for (const Vector2d& at : cone.polar) {
    const double r = at.x(), angle = at.y();
    cone.mesh.rest_coordinates.emplace_back(r * std::cos(angle), r * std::sin(angle));
    cone.mesh.initial_positions.emplace_back(r / turned * std::cos(turned * angle),
                                             r / turned * std::sin(turned * angle), -r * slope);
  }
  mesh::sew(cone.mesh, {cone.seam});
  return cone;
}

/// rad, between the axis and the lines from the tip to the rim: the mean, because triangles make
/// the cone a little oval.
double halfAngle(const Cone& cone, const std::vector<Vector3d>& positions) {
  std::vector<Vector3d> directions;
  Vector3d axis = Vector3d::Zero();
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (cone.polar[i].x() < kRadius * (1.0 - 1e-9)) continue;
    directions.push_back((positions[i] - positions[0]).normalized());
    axis += directions.back();
  }
  double sum = 0.0;
  for (const Vector3d& direction : directions) {
    sum += std::acos(direction.dot(axis.normalized()));
  }
  return sum / static_cast<double>(directions.size());
}

/// The seam closes at 0.1 m/s, and the cone comes to rest.
void validateCone(const CutDisc& disc, const std::string& name, const Sink& sink) {
  const Cone cone = coneOf(disc);
  material::Fabric fabric = material::linearFabric(1000.0, 2.0);
  fabric.bending = {1e-5, 1e-5};
  cloth::ModelledEffects effects;
  effects.gravity.setZero();
  effects.viscosity = effects.bending = true;
  cloth::Cloth cloth(cone.mesh, fabric, effects);
  cloth.attach(0, {Vector3d::Zero()});
  cloth::ClothState state = cloth.initialState();
  state.positions = cone.mesh.initial_positions;
  cloth.closeSeams(state, 0.1);
  cloth::Integrator integrator(cloth, {});
  while (cloth.seamGap(state.time) > 0.0 || state.time < 1.0) {
    integrator.step(cloth, state, 0.01);
  }
  kes::Equilibrium(cloth).settle(cloth, state, 0.05);
  const double exact = std::asin(1.0 - disc.sector / (2.0 * M_PI));
  const double measured = halfAngle(cone, state.positions);
  sink(base::relativeTo(exact, name + "/half_angle_rad", exact, measured, kTolerance));
  const double gap = seamGap(cone.seam, state.positions);
  sink({name + "/gap_m", 0.0, gap, gap, 1e-9});
}

}  // namespace

void validateCones(const Sink& sink) {
  const int columns = base::unlessSanitized(40, 20);
  for (const double degrees : {30.0, 60.0, 120.0, 180.0}) {
    const CutDisc disc{degrees * M_PI / 180.0, columns};
    validateCone(disc, "garment/cone/sector_" + std::to_string(static_cast<int>(degrees)), sink);
  }
  validateCone({M_PI / 3.0, columns, 6, 10}, "garment/cone/unmatched", sink);
}

void randomCone(const std::string&, Random& random, const Sink& sink) {
  CutDisc disc{random.uniform(0.3, 3.2)};
  disc.columns = base::unlessSanitized(36, 20) + random.below(12);
  disc.rings = 6 + random.below(5);
  disc.other_rings = 6 + random.below(5);
  CaseName name("garment", "cone");
  name.with("sector", disc.sector).with("columns", disc.columns);
  name.with("rings", disc.rings).with("other", disc.other_rings);
  validateCone(disc, name.text(), sink);
}

}  // namespace haptex::oracles
