// Strips with a seam across: length under their weight, period, and energy of bending.
#include <cmath>
#include <string>
#include <vector>

#include "haptex/cloth/dynamics/integrator.h"
#include "haptex/kes/equilibrium.h"
#include "haptex/material/linear_fabric.h"
#include "haptex/mesh/seam.h"
#include "haptex/oracles/checks/garment_oracles.h"
#include "haptex/oracles/experiments/hanging_strip.h"

namespace haptex::oracles {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kLength = 0.4, kWidth = 0.1;  // m, along u and v
constexpr int kCellsAlong = 20;                // of each half
constexpr double kTolerance = 5e-3;

/// Two halves, sewn at u = kLength / 2.
mesh::ClothMesh sewnStrip(int cells_across, int other_cells_across, bool merged) {
  mesh::ClothMesh strip;
  mesh::Seam seam;
  for (int side = 0; side < 2; ++side) {
    const mesh::ClothMesh half = mesh::makeRectangle(0.5 * kLength, kWidth, kCellsAlong,
                                                     side == 0 ? cells_across : other_cells_across,
                                                     mesh::Triangulation::kAlternating);
    const int before = static_cast<int>(strip.rest_coordinates.size());
    for (const Vector2d& rest : half.rest_coordinates) {
      strip.rest_coordinates.emplace_back(rest.x() + 0.5 * kLength * side, rest.y());
    }
    for (const auto& [a, b, c] : half.triangles) {
      strip.triangles.push_back({a + before, b + before, c + before});
      strip.triangle_panels.push_back(side);
    }
    std::vector<int>& edge = side == 0 ? seam.first : seam.second;
    for (const int particle :
         mesh::sideParticles(half, side == 0 ? mesh::Side::kRight : mesh::Side::kLeft)) {
      edge.push_back(particle + before);
    }
  }
  strip.panels = {{0, 0.0}, {0, 0.0}};
  strip.initial_positions = mesh::flatPositions(strip);
  if (merged) return mesh::merge(strip, {seam}).mesh;
  mesh::sew(strip, {seam});
  return strip;
}

/// m, of the strip's far end from the attached one.
double lengthOf(const mesh::ClothMesh& mesh, const std::vector<Vector3d>& positions) {
  double sum = 0.0;
  const std::vector<int> end = mesh::sideParticles(mesh, mesh::Side::kRight);
  for (const int particle : end) sum += positions[particle].x();
  return sum / static_cast<double>(end.size());
}

void attachEnd(cloth::Cloth& cloth, const cloth::ClothState& state) {
  for (const int particle : mesh::sideParticles(cloth.mesh(), mesh::Side::kLeft)) {
    cloth.attach(particle, {state.positions[particle]});
  }
}

double elongationOf(const mesh::ClothMesh& mesh, const HangingStrip& strip) {
  cloth::ModelledEffects effects;
  effects.gravity = {strip.gravity, 0.0, 0.0};
  material::Fabric fabric = material::linearFabric(strip.modulus);
  fabric.areal_density = strip.areal_density;
  cloth::Cloth cloth(mesh, fabric, effects);
  cloth::ClothState state = cloth.initialState();
  attachEnd(cloth, state);
  kes::Equilibrium(cloth).settle(cloth, state, 0.1);
  return lengthOf(mesh, state.positions) / kLength - 1.0;
}

/// s, of the slowest vibration along the strip: four times the time until it is as long as at rest.
double periodOf(const mesh::ClothMesh& mesh, double modulus, double exact) {
  constexpr double kAmplitude = 1e-5;  // of the length
  cloth::ModelledEffects effects;
  effects.gravity.setZero();
  cloth::Cloth cloth(mesh, material::linearFabric(modulus), effects);
  cloth::ClothState state = cloth.initialState();
  attachEnd(cloth, state);
  for (Vector3d& position : state.positions) {
    position.x() += kAmplitude * kLength * std::sin(0.5 * M_PI * position.x() / kLength);
  }
  cloth.ties().place(0.0, state.positions);
  cloth::StepSettings settings = kes::solvedSettings(1e-10);
  settings.method = cloth::IntegrationMethod::kTrBdf2;
  cloth::Integrator integrator(cloth, settings);
  const double step = exact / 400.0;
  double before = kAmplitude * kLength;
  while (state.time < exact) {
    integrator.step(cloth, state, step);
    const double beyond = lengthOf(mesh, state.positions) - kLength;
    if (beyond <= 0.0) return 4.0 * (state.time - step * beyond / (beyond - before));
    before = beyond;
  }
  return std::nan("");
}

/// J, of the strip on a cylinder whose axis is parallel to the seam.
double rolledEnergy(const mesh::ClothMesh& mesh, double rigidity, double curvature) {
  material::Fabric fabric;  // limp but for its bending
  fabric.name = "strip";
  fabric.areal_density = 0.1;
  fabric.bending = {rigidity, rigidity};
  cloth::ModelledEffects effects;
  effects.bending = true;
  effects.gravity.setZero();
  const cloth::Cloth cloth(mesh, fabric, effects);
  cloth::ClothState state = cloth.initialState();
  for (Vector3d& position : state.positions) {
    const double angle = curvature * position.x();
    position = {std::sin(angle) / curvature, position.y(), (1.0 - std::cos(angle)) / curvature};
  }
  cloth.ties().place(0.0, state.positions);
  return cloth.potentialEnergy(state);
}

void validateStrip(const std::string& name, const mesh::ClothMesh& mesh, const Sink& sink) {
  const HangingStrip strip{kLength, 10.0, 0.1, 9.81};
  const double elongation = exactElongation(strip);
  sink(base::relativeTo(elongation, name + "/elongation", elongation, elongationOf(mesh, strip),
                        kTolerance));
  constexpr double kModulus = 100.0;
  const double period = 4.0 * kLength * std::sqrt(0.1 / kModulus);
  sink(base::relativeTo(period, name + "/period_s", period, periodOf(mesh, kModulus, period),
                        kTolerance));
  // But for half of a cell at either end, which is free.
  constexpr double kRigidity = 1e-5, kCurvature = 0.1;
  const double bent = kLength - 0.5 * kLength / kCellsAlong;
  const double energy = 0.5 * kRigidity * kCurvature * kCurvature * kWidth * bent;
  sink(base::relativeTo(energy, name + "/rolled_J", energy,
                        rolledEnergy(mesh, kRigidity, kCurvature), 1e-5));
}

}  // namespace

void validateSewnStrips(const Sink& sink) {
  mesh::ClothMesh whole =
      mesh::makeRectangle(kLength, kWidth, 2 * kCellsAlong, 10, mesh::Triangulation::kAlternating);
  whole.initial_positions = mesh::flatPositions(whole);
  validateStrip("garment/strip/whole", whole, sink);
  validateStrip("garment/strip/matched", sewnStrip(10, 10, false), sink);
  validateStrip("garment/strip/unmatched", sewnStrip(6, 10, false), sink);
  validateStrip("garment/strip/merged", sewnStrip(6, 10, true), sink);
}

}  // namespace haptex::oracles
