#include "haptex/cloth/dynamics/cloth_part.h"

#include <algorithm>
#include <array>
#include <map>
#include <stdexcept>
#include <utility>

#include "haptex/cloth/forces/bending/bending.h"
#include "haptex/cloth/forces/cells/triangle_pairs.h"

namespace haptex::cloth {
namespace {

/// What a hinge at an included particle is, follows from triangles up to three rings farther: its
/// corners lie in the first; the stiffness that is fitted around each of them depends on the
/// second, and on the triangles across its edges.
constexpr int kBendingRings = 3;

std::vector<char> touching(const mesh::ClothMesh& mesh, const std::vector<char>& particles) {
  std::vector<char> triangles(mesh.triangles.size(), 0);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const std::array<int, 3>& corners = mesh.triangles[t];
    triangles[t] = std::any_of(corners.begin(), corners.end(),
                               [&](int particle) { return particles[particle] != 0; });
  }
  return triangles;
}

bool isAt(const ClothPlace& place, const std::vector<char>& particles) {
  for (int i = 0; i < 3; ++i) {
    if (place.weights[i] != 0.0 && particles[place.particles[i]] != 0) return true;
  }
  return false;
}

/// The particles, and those that fasteners hold them to.
std::vector<char> withFastened(const Cloth& whole, const std::vector<char>& particles) {
  std::vector<char> all = particles;
  for (const Fastener& fastener : whole.effects().fasteners) {
    if (std::none_of(fastener.places.begin(), fastener.places.end(),
                     [&](const ClothPlace& place) { return isAt(place, particles); })) {
      continue;
    }
    for (const ClothPlace& place : fastener.places) {
      for (int i = 0; i < 3; ++i) {
        if (place.weights[i] != 0.0) all[place.particles[i]] = 1;
      }
    }
  }
  return all;
}

std::vector<char> cornersOf(const mesh::ClothMesh& mesh, const std::vector<char>& triangles) {
  std::vector<char> particles(mesh.rest_coordinates.size(), 0);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    if (triangles[t] == 0) continue;
    for (const int particle : mesh.triangles[t]) particles[particle] = 1;
  }
  return particles;
}

/// The longest side of a triangle is the diagonal of the rectangle that it is half of.
std::array<int, 2> diagonalOf(const mesh::ClothMesh& mesh, std::size_t triangle) {
  const std::array<int, 3>& corners = mesh.triangles[triangle];
  std::array<int, 2> diagonal{};
  double longest = 0.0;
  for (int i = 0; i < 3; ++i) {
    const auto [first, second] = std::minmax(corners[i], corners[(i + 1) % 3]);
    const double length =
        (mesh.rest_coordinates[first] - mesh.rest_coordinates[second]).squaredNorm();
    if (length <= longest) continue;
    longest = length;
    diagonal = {first, second};
  }
  return diagonal;
}

/// A lattice of springs knows whole rectangles.
void completeCells(const mesh::ClothMesh& mesh, std::vector<char>& triangles) {
  std::map<std::array<int, 2>, std::size_t> halves;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const auto [half, first] = halves.emplace(diagonalOf(mesh, t), t);
    if (first) continue;
    const char either = triangles[t] | triangles[half->second];
    triangles[t] = triangles[half->second] = either;
  }
}

std::vector<int> placesOf(const std::vector<char>& chosen) {
  std::vector<int> places;
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    if (chosen[i] != 0) places.push_back(static_cast<int>(i));
  }
  return places;
}

/// Of every member of the whole its place in the part, or -1.
std::vector<int> inverse(const std::vector<int>& of_whole, std::size_t count) {
  std::vector<int> places(count, -1);
  for (std::size_t i = 0; i < of_whole.size(); ++i) places[of_whole[i]] = static_cast<int>(i);
  return places;
}

std::vector<int> trianglesAround(const Cloth& whole, const std::vector<char>& included) {
  const mesh::ClothMesh& mesh = whole.mesh();
  if (included.size() != whole.particleCount()) {
    throw std::invalid_argument("included has " + std::to_string(included.size()) +
                                " entries; the cloth has " + std::to_string(whole.particleCount()) +
                                " particles");
  }
  if (std::all_of(included.begin(), included.end(), [](char one) { return one == 0; })) {
    throw std::invalid_argument("no particle is included: allowed is at least one");
  }
  if (!whole.ties().empty()) {
    throw std::invalid_argument(std::to_string(whole.ties().resolved().size()) +
                                " particles are tied, and a part would lose what they are tied "
                                "to: allowed is a cloth whose edges are merged");
  }
  if (whole.effects().self_collision) {
    throw std::invalid_argument(
        "self_collision is modelled, and the cloth would pass through what is excluded: allowed is "
        "one of both");
  }
  std::vector<char> triangles = touching(mesh, withFastened(whole, included));
  for (int ring = 0; whole.effects().bending && ring < kBendingRings; ++ring) {
    triangles = touching(mesh, cornersOf(mesh, triangles));
  }
  if (whole.effects().elasticity == Elasticity::kMassSpring) completeCells(mesh, triangles);
  const bool paired = whole.effects().elasticity == Elasticity::kBilinear;
  const int rings = paired ? 2 * kPairingRounds : 0;  // pairTriangles()
  for (int ring = 0; ring < rings; ++ring) triangles = touching(mesh, cornersOf(mesh, triangles));
  return placesOf(triangles);
}

std::vector<int> particlesOf(const mesh::ClothMesh& mesh, const std::vector<int>& triangles) {
  std::vector<char> chosen(mesh.triangles.size(), 0);
  for (const int t : triangles) chosen[t] = 1;
  return placesOf(cornersOf(mesh, chosen));
}

mesh::ClothMesh meshOf(const mesh::ClothMesh& whole, const std::vector<int>& triangles,
                       const std::vector<int>& particles, const std::vector<int>& particle_place,
                       const std::vector<int>& triangle_place) {
  mesh::ClothMesh part;
  part.panels = whole.panels;
  for (const int particle : particles) {
    part.rest_coordinates.push_back(whole.rest_coordinates[particle]);
    part.initial_positions.push_back(whole.initial_positions[particle]);
  }
  for (const int t : triangles) {
    const auto& [a, b, c] = whole.triangles[t];
    part.triangles.push_back({particle_place[a], particle_place[b], particle_place[c]});
    if (!whole.triangle_panels.empty()) part.triangle_panels.push_back(whole.triangle_panels[t]);
    if (!whole.triangle_fabrics.empty()) {
      part.triangle_fabrics.push_back(whole.triangle_fabrics[t]);
    }
    if (!whole.corner_coordinates.empty()) {
      part.corner_coordinates.push_back(whole.corner_coordinates[t]);
    }
  }
  for (mesh::SeamHinge hinge : whole.seam_hinges) {
    for (int& triangle : hinge.triangles) triangle = triangle_place[triangle];
    if (std::min(hinge.triangles[0], hinge.triangles[1]) >= 0) part.seam_hinges.push_back(hinge);
  }
  return part;
}

/// Those whose particles are all in the part.
std::vector<Fastener> fastenersOf(const Cloth& whole, const std::vector<int>& particle_place) {
  std::vector<Fastener> result;
  for (Fastener fastener : whole.effects().fasteners) {
    bool complete = true;
    for (ClothPlace& place : fastener.places) {
      for (int i = 0; i < 3; ++i) {
        if (place.weights[i] == 0.0) continue;
        place.particles[i] = particle_place[place.particles[i]];
        complete = complete && place.particles[i] >= 0;
      }
    }
    if (complete) result.push_back(std::move(fastener));
  }
  return result;
}

/// So that the part has the hinges that the whole has: those that are not exact may lie elsewhere.
ModelledEffects effectsOf(const Cloth& whole, const std::vector<int>& particle_place) {
  ModelledEffects effects = whole.effects();
  effects.fasteners = fastenersOf(whole, particle_place);
  const std::vector<const Bending*> all = whole.forces().findAll<Bending>();
  if (all.empty()) return effects;
  effects.bending_settings.model = all.front()->model();
  for (const Bending* bending : all) {
    if (bending->model() == effects.bending_settings.model) continue;
    throw std::invalid_argument(
        "panels of the cloth bend by different kinds of hinges, of which a part cannot be "
        "computed: allowed are meshes of one kind, regular or not");
  }
  return effects;
}

/// Where the whole remembers what the part does: the same particles, and as often before.
std::vector<int> memoryPlaces(const Cloth& whole, const Cloth& part,
                              const std::vector<int>& particles) {
  using Key = std::pair<std::vector<int>, int>;
  std::map<Key, int> places;
  std::map<std::vector<int>, int> seen;
  int place = 0;
  for (std::vector<int>& owners : whole.forces().memoryOwners()) {
    const int before = seen[owners]++;
    places[{std::move(owners), before}] = place++;
  }
  seen.clear();
  std::vector<int> result;
  for (std::vector<int>& owners : part.forces().memoryOwners()) {
    for (int& particle : owners) particle = particles[particle];
    const int before = seen[owners]++;
    const auto found = places.find({std::move(owners), before});
    result.push_back(found == places.end() ? -1 : found->second);  // -1: a hinge of the rim alone
  }
  return result;
}

}  // namespace

ClothPart::ClothPart(const Cloth& whole, const std::vector<char>& included)
    : ClothPart(whole, included, trianglesAround(whole, included)) {}

ClothPart::ClothPart(const Cloth& whole, const std::vector<char>& included,
                     const std::vector<int>& triangles)
    : particles_(particlesOf(whole.mesh(), triangles)),
      triangle_place_(inverse(triangles, whole.mesh().triangles.size())),
      particle_place_(inverse(particles_, whole.particleCount())),
      cloth_(meshOf(whole.mesh(), triangles, particles_, particle_place_, triangle_place_),
             whole.fabrics(), effectsOf(whole, particle_place_)),
      state_(cloth_.initialState()),
      memory_(memoryPlaces(whole, cloth_, particles_)) {
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    if (included[particles_[i]] != 0) moved_.push_back(static_cast<int>(i));
  }
  const RigidBodies& bodies = whole.bodies();
  if (!bodies.bodies.empty()) {
    cloth_.reserveBodies(bodies.bodies.size(), bodies.contacts.capacity());
  }
  if (const auto* constant = whole.forces().find<ConstantForces>()) {
    for (std::size_t i = 0; i < particles_.size(); ++i) {
      cloth_.setExternalForce(static_cast<int>(i), constant->userForces()[particles_[i]]);
    }
  }
  if (const auto* loads = whole.forces().find<PointLoads>()) {
    loads_.reserve(PointLoads::kMax);
    setPointLoads(loads->loads());
  }
}

ClothState& ClothPart::begin(const Cloth& whole, const ClothState& state) {
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    const int particle = particles_[i];
    state_.positions[i] = state.positions[particle];
    state_.velocities[i] = state.velocities[particle];
    const std::optional<AttachmentPath>& path = whole.attachments()[particle];
    if (path) {
      cloth_.attach(static_cast<int>(i), *path);
    } else if (cloth_.isAttached(static_cast<int>(i))) {
      cloth_.release(static_cast<int>(i));
    }
  }
  for (std::size_t i = 0; i < memory_.size(); ++i) {
    if (memory_[i] >= 0) state_.memory[i] = state.memory[memory_[i]];
  }
  state_.time = state.time;
  return state_;
}

void ClothPart::end(ClothState& state) const {
  for (const int i : moved_) {
    state.positions[particles_[i]] = state_.positions[i];
    state.velocities[particles_[i]] = state_.velocities[i];
  }
  for (std::size_t i = 0; i < memory_.size(); ++i) {
    if (memory_[i] >= 0) state.memory[memory_[i]] = state_.memory[i];
  }
  state.time = state_.time;
}

void ClothPart::setPointLoads(const std::vector<PointLoad>& loads) {
  loads_.clear();
  for (const PointLoad& load : loads) {
    if (triangle_place_[load.triangle] < 0) continue;
    loads_.push_back(load);
    loads_.back().triangle = triangle_place_[load.triangle];
  }
  cloth_.setPointLoads(loads_);
}

void ClothPart::setExternalForce(int particle, const Eigen::Vector3d& force) {
  if (particle_place_[particle] >= 0) cloth_.setExternalForce(particle_place_[particle], force);
}

}  // namespace haptex::cloth
