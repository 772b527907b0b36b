// Uniform stress across seams, gaps, mass and momentum.
#include <Eigen/Dense>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>

#include "haptex/base/repeatable_random.h"
#include "haptex/cloth/dynamics/integrator.h"
#include "haptex/kes/equilibrium.h"
#include "haptex/material/linear_fabric.h"
#include "haptex/oracles/checks/garment_oracles.h"
#include "haptex/oracles/checks/random_checks.h"
#include "haptex/oracles/scenes/sewn_panels.h"

namespace haptex::oracles {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kModulus = 100.0;  // N/m, isotropic
constexpr double kSolved = 1e-9;    // relative, of what an equilibrium is found to
constexpr double kMerged = 1e-6;
constexpr double kGap = 1e-9;  // m
// Of even particles that do not match, largest of any triangle: a tied particle hands its force on
// as if it acted at the two beside it, which is right for sum and moment and not for each of them.
constexpr double kUnmatched = 0.05;

/// A stretch and shear of the plane, and the plane's pose.
using Deformation = Eigen::Matrix<double, 3, 2>;
Deformation stretched() {
  Deformation pose;
  pose << 0.6, 0.0, 0.0, 1.0, 0.8, 0.0;
  Matrix2d stretch;
  stretch << 1.08, 0.05, 0.02, 1.04;
  return pose * stretch;
}

/// Second Piola-Kirchhoff stress (N/m) of the isotropic fabric in the axes of the flat state.
Matrix2d stressOf(const Deformation& gradient) {
  return 0.5 * kModulus * (gradient.transpose() * gradient - Matrix2d::Identity());
}

/// Panels that are sewn one way or the other, with the flat places of all particles.
struct SewnPatch {
  mesh::ClothMesh mesh;
  std::vector<Vector2d> flat;
  std::vector<int> border;
  mesh::Seam seam;
};

SewnPatch tied(const SewnPanels& panels) {
  SewnPatch patch{panels.mesh, panels.flat, panels.border, panels.seam};
  mesh::sew(patch.mesh, {panels.seam});
  return patch;
}

SewnPatch merged(const SewnPanels& panels) {
  mesh::MergedMesh made = mesh::merge(panels.mesh, {panels.seam});
  SewnPatch patch{std::move(made.mesh), {}, panels.border, panels.seam};
  for (auto* particles : {&patch.border, &patch.seam.first, &patch.seam.second}) {
    for (int& particle : *particles) particle = made.particles[particle];
  }
  // A particle that the merging made has become one with one of the other panel.
  patch.flat.resize(patch.mesh.rest_coordinates.size());
  for (std::size_t i = 0; i < panels.flat.size(); ++i) {
    patch.flat[made.particles[i]] = panels.flat[i];
  }
  return patch;
}

std::vector<Vector3d> deformed(const SewnPatch& patch, const Deformation& gradient) {
  std::vector<Vector3d> positions;
  for (const Vector2d& place : patch.flat) positions.emplace_back(gradient * place);
  return positions;
}

/// The largest difference of any triangle's stress from that of the deformation, relative.
double stressError(const SewnPatch& patch, const std::vector<Vector3d>& positions) {
  const Matrix2d exact = stressOf(stretched());
  double largest = 0.0;
  for (const auto& [a, b, c] : patch.mesh.triangles) {
    Matrix2d flat;
    flat << patch.flat[b] - patch.flat[a], patch.flat[c] - patch.flat[a];
    Deformation edges;
    edges << positions[b] - positions[a], positions[c] - positions[a];
    const double error = (stressOf(edges * flat.inverse()) - exact).norm() / exact.norm();
    largest = base::largerOrNaN(largest, error);
  }
  return largest;
}

void sinkError(const std::string& name, double error, double tolerance, const Sink& sink) {
  sink({name, 0.0, error, error, tolerance});
}

/// The border is held in the deformed place; what is inside finds its equilibrium from a disturbed
/// start.
void validateEquilibrium(const std::string& name, const SewnPatch& patch, double tolerance,
                         const Sink& sink) {
  constexpr double kDisturbance = 3e-4;  // m
  constexpr int kRepetitions = 3;        // the last ones to rounding
  cloth::ModelledEffects effects;
  effects.gravity.setZero();
  cloth::Cloth cloth(patch.mesh, material::linearFabric(kModulus), effects);
  const std::vector<Vector3d> exact = deformed(patch, stretched());
  cloth::ClothState state = cloth.initialState();
  base::RepeatableRandom random(7);
  for (std::size_t i = 0; i < exact.size(); ++i) {
    state.positions[i] = exact[i] + kDisturbance * random.direction();
  }
  for (const int particle : patch.border) {
    if (!cloth.ties().isTied(particle)) cloth.attach(particle, {exact[particle]});
    state.positions[particle] = exact[particle];
  }
  cloth.ties().place(0.0, state.positions);
  kes::Equilibrium equilibrium(cloth);
  for (int i = 0; i < kRepetitions; ++i) equilibrium.settle(cloth, state, 1.0);
  sinkError(name + "/stress", stressError(patch, state.positions), tolerance, sink);
  sinkError(name + "/gap_m", seamGap(patch.seam, state.positions), kGap, sink);
}

void validateMass(const std::string& name, const SewnPatch& patch, const Sink& sink) {
  const cloth::Cloth cloth(patch.mesh, material::linearFabric(kModulus), {});
  const double mass = std::accumulate(cloth.masses().begin(), cloth.masses().end(), 0.0);
  double area = 0.0;
  for (const auto& [a, b, c] : patch.mesh.triangles) {
    const Vector2d ab = patch.flat[b] - patch.flat[a], ac = patch.flat[c] - patch.flat[a];
    area += 0.5 * std::abs(ab.x() * ac.y() - ab.y() * ac.x());
  }
  const double exact = 0.1 * area;
  sink(base::relativeTo(exact, name + "/mass_kg", exact, mass, kRounding));
}

/// What goes through the seam in uniform stress: the tied side's forces and moment on the other
/// side's particles, against P n times the length of the seam.
void validateResultant(const std::string& name, const SewnPanels& panels, const Sink& sink) {
  const SewnPatch patch = tied(panels);
  cloth::ModelledEffects effects;
  effects.gravity.setZero();
  // The right panel alone, without its ties.
  mesh::ClothMesh right = panels.mesh;
  right.triangles.erase(right.triangles.begin(), right.triangles.begin() + panels.left_triangles);
  cloth::ForceSum forces;
  cloth::addFabricForces(right, {material::linearFabric(kModulus)}, effects, forces);
  std::vector<Vector3d> positions = deformed(patch, stretched());
  std::vector<Vector3d> sums(positions.size(), Vector3d::Zero());
  const std::vector<Vector3d> still = sums;
  forces.addForces({positions, still}, sums);
  cloth::Ties(patch.mesh).gather(sums);
  // Of the right panel's border what pulls at the seam's ends is half of an edge beside each.
  const Matrix2d stress = stressOf(stretched());
  const auto pull = [&](const Vector2d& from, const Vector2d& to) -> Vector3d {
    const Vector2d way = to - from;  // outwards of it is on the right
    return -stretched() * (stress * Vector2d(way.y(), -way.x()));
  };
  Vector3d exact = Vector3d::Zero(), exact_moment = Vector3d::Zero();
  const auto add = [&](const Vector2d& at, const Vector3d& force) {
    exact += force;
    exact_moment += (stretched() * at).cross(force);
  };
  const std::vector<int>& edge = panels.seam.second;
  for (std::size_t i = 1; i < edge.size(); ++i) {
    const Vector2d from = panels.flat[edge[i]], to = panels.flat[edge[i - 1]];
    add(0.5 * (from + to), pull(from, to));
  }
  const Vector2d bottom = panels.flat[edge.front()], top = panels.flat[edge.back()];
  add(bottom, 0.5 * pull(bottom, panels.flat[panels.beside_ends[0]]));
  add(top, 0.5 * pull(panels.flat[panels.beside_ends[1]], top));
  Vector3d sum = Vector3d::Zero(), moment = Vector3d::Zero();
  for (const int particle : panels.seam.first) {
    sum += sums[particle];
    moment += positions[particle].cross(sums[particle]);
  }
  sinkError(name + "/force", (sum - exact).norm() / exact.norm(), kSolved, sink);
  sinkError(name + "/moment", (moment - exact_moment).norm() / exact_moment.norm(), kSolved, sink);
}

/// Momentum and moment of momentum of a free cloth that is stretched and let go, over the sum of
/// the particles' own.
void validateMomentum(const SewnPanels& panels, cloth::IntegrationMethod method, const Sink& sink) {
  cloth::ModelledEffects effects;
  effects.gravity.setZero();
  effects.viscosity = true;
  const SewnPatch patch = tied(panels);
  const cloth::Cloth cloth(patch.mesh, material::linearFabric(kModulus, 0.1), effects);
  cloth::StepSettings settings = kes::solvedSettings(1e-12);
  settings.method = method;
  settings.tolerance = 1e-13;
  cloth::Integrator integrator(cloth, settings);
  cloth::ClothState state = cloth.initialState();
  state.positions = deformed(patch, stretched());
  cloth.ties().place(0.0, state.positions);
  double largest = 0.0;
  const double step = isImplicit(method) ? 1e-3 : 2e-5;
  for (int i = 0; i < 50; ++i) {
    integrator.step(cloth, state, step);
    double scale = 0.0;
    for (std::size_t i = 0; i < cloth.particleCount(); ++i) {
      scale += cloth.masses()[i] * state.velocities[i].norm();
    }
    largest = base::largerOrNaN(largest, cloth.momentum(state).norm() / scale);
  }
  sinkError(std::string("garment/momentum/") + nameOf(method), largest, 1e-10, sink);
  // The forces turn the cloth as little: about any point, here the origin.
  std::vector<Vector3d> forces;
  cloth.computeForces(state, forces);
  Vector3d moment = Vector3d::Zero();
  double scale = 0.0;
  for (std::size_t i = 0; i < forces.size(); ++i) {
    moment += state.positions[i].cross(forces[i]);
    scale += state.positions[i].norm() * forces[i].norm();
  }
  sinkError(std::string("garment/moment_of_forces/") + nameOf(method), moment.norm() / scale,
            kRounding, sink);
}

}  // namespace

void validateSeams(const Sink& sink) {
  const std::vector<double> left = evenPlaces(7);
  for (const auto& [shape, name] :
       {std::pair(SeamShape::kStraight, "straight"), std::pair(SeamShape::kCurved, "curved"),
        std::pair(SeamShape::kDart, "dart")}) {
    const std::string start = std::string("garment/patch/") + name;
    const SewnPanels nested = sewnPanels(shape, left, nestedPlaces(7, 4), 1);
    validateEquilibrium(start + "/tied", tied(nested), kSolved, sink);
    validateEquilibrium(start + "/merged", merged(nested), kMerged, sink);
    validateMass(start + "/tied", tied(nested), sink);
    validateMass(start + "/merged", merged(nested), sink);
    const SewnPanels even = sewnPanels(shape, left, evenPlaces(11), 2);
    validateResultant(start + "/tied_even", even, sink);
    validateMass(start + "/tied_even", tied(even), sink);
    validateEquilibrium(start + "/tied_even", tied(even), kUnmatched, sink);
    if (shape == SeamShape::kCurved) continue;  // its edges are two polylines
    validateEquilibrium(start + "/merged_even", merged(even), kMerged, sink);
  }
  const SewnPanels even = sewnPanels(SeamShape::kCurved, left, evenPlaces(11), 3);
  for (const cloth::IntegrationMethod method :
       {cloth::IntegrationMethod::kBackwardEuler, cloth::IntegrationMethod::kBackwardMidpoint,
        cloth::IntegrationMethod::kTrBdf2, cloth::IntegrationMethod::kRungeKutta4}) {
    validateMomentum(even, method, sink);
  }
}

void randomPatch(const std::string&, Random& random, const Sink& sink) {
  const int count = 4 + random.below(7), more = random.below(count);
  const int shape = random.below(3);
  const SewnPanels panels = sewnPanels(static_cast<SeamShape>(shape), evenPlaces(count),
                                       nestedPlaces(count, more), random.below(1000));
  CaseName name("garment", "patch");
  name.with(shape == 0 ? "straight" : (shape == 1 ? "curved" : "dart"));
  name.with("left", count).with("right", count + more);
  CaseName of_merged = name;
  validateEquilibrium(name.with("tied").text(), tied(panels), kSolved, sink);
  validateMass(name.text(), tied(panels), sink);
  validateEquilibrium(of_merged.with("merged").text(), merged(panels), kMerged, sink);
}

}  // namespace haptex::oracles
