#include "haptex/nodes/rviz_plugin/cloth_surface.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "haptex/appearance/srgb.h"
#include "haptex/base/disjoint_sets.h"
#include "haptex/nodes/common/cloth_fabric.h"
#include "haptex/nodes/common/vector_messages.h"
#include "haptex/nodes/markers/colour_map.h"
#include "haptex/nodes/markers/marker_shapes.h"

namespace haptex::nodes {
namespace {

const Eigen::Vector3f kNeutralColour(0.62F, 0.62F, 0.62F);

// Of the direction to the eye out of the fabric's plane: flatter ones are those of facets that a
// smooth surface has not.
constexpr double kFlattest = 0.02;

bool isQuantity(ColourBy colour_by) {
  return colour_by == ColourBy::kStrain || colour_by == ColourBy::kStress ||
         colour_by == ColourBy::kContactForce;
}

bool needsElements(ColourBy colour_by) {
  return colour_by == ColourBy::kStrain || colour_by == ColourBy::kStress ||
         colour_by == ColourBy::kLook;
}

/// Rest coordinates of a triangle's corners, in its own panel.
std::array<Eigen::Vector2d, 3> cornersOf(const RestMesh& rest, std::size_t triangle) {
  if (!rest.corner_coordinates.empty()) return rest.corner_coordinates[triangle];
  const auto& [a, b, c] = rest.triangles[triangle];
  return {rest.rest_coordinates[a].head<2>(), rest.rest_coordinates[b].head<2>(),
          rest.rest_coordinates[c].head<2>()};
}

std::vector<cloth::RestTriangle> atRest(const RestMesh& rest) {
  std::vector<cloth::RestTriangle> triangles;
  triangles.reserve(rest.triangles.size());
  for (std::size_t t = 0; t < rest.triangles.size(); ++t) {
    triangles.push_back(cloth::restTriangle(cornersOf(rest, t)));
  }
  return triangles;
}

/// For each triangle the number of its part: triangles that share particles, from 0.
std::vector<int> partsOf(const std::vector<std::array<int, 3>>& triangles, std::size_t particles) {
  base::DisjointSets sets(particles);
  for (const auto& triangle : triangles) {
    sets.join(triangle[0], triangle[1]);
    sets.join(triangle[0], triangle[2]);
  }
  std::map<int, int> numbers;
  std::vector<int> parts;
  for (const auto& triangle : triangles) {
    const int next = static_cast<int>(numbers.size());
    parts.push_back(numbers.emplace(sets.root(triangle[0]), next).first->second);
  }
  return parts;
}

/// @param value 0 to 1; NaN gives 0
std::uint8_t byteOf(double value) {
  if (!(value > 0.0)) return 0;
  return static_cast<std::uint8_t>(255.0 * std::min(value, 1.0) + 0.5);  // to the nearest
}

VertexColour colourOf(const Eigen::Vector3f& colour, float brightness, double opacity) {
  return {byteOf(brightness * colour[0]), byteOf(brightness * colour[1]),
          byteOf(brightness * colour[2]), byteOf(opacity)};
}

/// Of a triangle with these edges from its first corner.
cloth::ElementFrame frameOf(const cloth::RestTriangle& rest, const Eigen::Vector3d& first,
                            const Eigen::Vector3d& second) {
  return {rest.weft_weights[1] * first + rest.weft_weights[2] * second,
          rest.warp_weights[1] * first + rest.warp_weights[2] * second};
}

/// NaN is not.
bool isDrawable(const Eigen::Vector3d& point) {
  constexpr double kFarthest = ClothSurface::kFarthest;
  return std::abs(point.x()) <= kFarthest && std::abs(point.y()) <= kFarthest &&
         std::abs(point.z()) <= kFarthest;
}

void requireCount(const std::string& field, std::size_t count, std::size_t allowed) {
  if (count == allowed) return;
  throw std::invalid_argument(field + " has " + std::to_string(count) + " elements: allowed are " +
                              std::to_string(allowed) + ", one per particle of cloth/mesh");
}

}  // namespace

ClothSurface::ClothSurface(const haptex::ClothMesh& mesh, ColourBy colour_by)
    : mesh_(mesh.mesh), colour_by_(colour_by), fabric_count_(mesh.fabrics.size()) {
  const RestMesh rest = restMesh(mesh);
  requireFabrics(mesh);
  triangles_ = rest.triangles;
  triangle_fabrics_.assign(mesh.triangle_fabrics.begin(), mesh.triangle_fabrics.end());
  if (!triangle_fabrics_.empty() && triangle_fabrics_.size() != triangles_.size()) {
    throw std::invalid_argument("triangle_fabrics has " + std::to_string(triangle_fabrics_.size()) +
                                " elements: allowed are none, or " +
                                std::to_string(triangles_.size()) + ", one per triangle");
  }
  for (const int fabric : triangle_fabrics_) {
    if (fabric >= static_cast<int>(mesh.fabrics.size())) {
      throw std::invalid_argument("triangle_fabrics names fabric " + std::to_string(fabric) +
                                  ": there are " + std::to_string(mesh.fabrics.size()));
    }
  }
  if (isQuantity(colour_by)) scale_ = scaleOf(colour_by);
  if (needsElements(colour_by)) at_rest_ = atRest(rest);
  if (colour_by == ColourBy::kStress) fabrics_ = fabricsOfCloth(mesh);
  const std::size_t particles = rest.rest_coordinates.size();
  points_.resize(particles);
  sums_.resize(particles);
  shareOutAreas();
  excluded_.assign(particles, 0);
  contact_forces_.assign(particles, 0.0);
  makeVertices(groupsOfTriangles(mesh, rest));
  findGrainLines(rest);
  positions_.resize(3 * particles_.size());
  colours_.resize(particles_.size());
}

/// Also names the groups.
std::vector<int> ClothSurface::groupsOfTriangles(const haptex::ClothMesh& mesh,
                                                 const RestMesh& rest) {
  std::vector<int> groups(triangles_.size(), 0);
  if (colour_by_ == ColourBy::kFabric) {
    groups_.assign(mesh.fabrics.begin(), mesh.fabrics.end());
    if (!triangle_fabrics_.empty()) groups = triangle_fabrics_;
  } else if (colour_by_ == ColourBy::kPanel) {
    groups = rest.panels.empty() ? partsOf(triangles_, points_.size()) : rest.panels;
    const int count = 1 + *std::max_element(groups.begin(), groups.end());
    for (int part = 0; part < count; ++part) groups_.push_back("panel " + std::to_string(part));
  } else if (colour_by_ == ColourBy::kLook) {
    // A panel's yarns run elsewhere than those of its neighbour. The fabric is what is left over.
    if (!rest.panels.empty()) groups = rest.panels;
    for (std::size_t t = 0; t < groups.size(); ++t) {
      groups[t] *= static_cast<int>(fabric_count_);
      if (!triangle_fabrics_.empty()) groups[t] += triangle_fabrics_[t];
    }
  }
  return groups;
}

void ClothSurface::makeVertices(const std::vector<int>& groups) {
  std::map<std::pair<int, int>, std::uint32_t> known;  // by particle and group
  first_vertices_.assign(points_.size(), 0);
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    for (const int particle : triangles_[t]) {
      const auto next = static_cast<std::uint32_t>(particles_.size());
      const auto [place, is_new] = known.emplace(std::make_pair(particle, groups[t]), next);
      if (is_new) {
        particles_.push_back(particle);
        vertex_groups_.push_back(groups[t]);
        first_vertices_[particle] = next;
      }
      triangle_vertices_.push_back(place->second);
    }
  }
}

void ClothSurface::findGrainLines(const RestMesh& rest) {
  constexpr double kAlong = 1e-6;  // of an edge's length, across the grain
  std::set<std::pair<int, int>> known;
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    const Triangle& triangle = triangles_[t];
    const std::array<Eigen::Vector2d, 3> corners = cornersOf(rest, t);
    for (int i = 0; i < 3; ++i) {
      const auto [first, second] = std::minmax(triangle[i], triangle[(i + 1) % 3]);
      const Eigen::Vector2d edge = (corners[(i + 1) % 3] - corners[i]).cwiseAbs();
      if (edge.minCoeff() > kAlong * edge.maxCoeff()) continue;
      if (!known.emplace(first, second).second) continue;
      grain_lines_.push_back(first_vertices_[first]);
      grain_lines_.push_back(first_vertices_[second]);
    }
  }
}

void ClothSurface::shareOutAreas() {
  areas_.assign(points_.size(), 0.0);
  for (std::size_t t = 0; t < at_rest_.size(); ++t) {
    for (const int particle : triangles_[t]) areas_[particle] += at_rest_[t].area;
  }
}

void ClothSurface::setFullScale(double full) {
  if (!isQuantity(colour_by_)) return;
  scale_ = scaleOf(colour_by_);
  if (full > 0.0) scale_.full = full;
}

void ClothSurface::setOpacity(double opacity) { opacity_ = opacity; }

void ClothSurface::setEye(const std::optional<Eigen::Vector3d>& eye) { eye_ = eye; }

void ClothSurface::setSelfShadow(bool wanted) { self_shadow_ = wanted; }

void ClothSurface::setLooks(std::vector<std::shared_ptr<const appearance::Brdf>> looks) {
  if (looks.size() != fabric_count_) {
    throw std::invalid_argument("there are " + std::to_string(looks.size()) + " looks of " +
                                std::to_string(fabric_count_) + " fabrics: allowed is one each");
  }
  if (colour_by_ != ColourBy::kLook) throw std::invalid_argument("the colours are of no look");
  looks_ = std::move(looks);
  wefts_.resize(particles_.size());
  warps_.resize(particles_.size());
}

void ClothSurface::seeFrom(const Eigen::Vector3d& eye) {
  if (!eye_) return;
  eye_ = eye;
  colourVertices();
}

void ClothSurface::take(const haptex::ContactForces& forces) {
  if (forces.mesh != mesh_) return;
  std::fill(contact_forces_.begin(), contact_forces_.end(), 0.0);
  const std::size_t points =
      std::min({forces.triangles.size(), forces.forces.size(), forces.barycentric.size() / 3});
  std::vector<Eigen::Vector3d> sums(contact_forces_.size(), Eigen::Vector3d::Zero());
  for (std::size_t i = 0; i < points; ++i) {
    if (forces.triangles[i] >= triangles_.size()) continue;
    const Eigen::Vector3d force = fromMessage(forces.forces[i]);
    for (int corner = 0; corner < 3; ++corner) {
      sums[triangles_[forces.triangles[i]][corner]] += forces.barycentric[3 * i + corner] * force;
    }
  }
  for (std::size_t i = 0; i < sums.size(); ++i) contact_forces_[i] = sums[i].norm();
}

void ClothSurface::take(const haptex::ClothState& state) {
  readPositions(state);
  sumTriangles();
  if (!looks_.empty()) sumAxes();
  const bool shadowed = self_shadow_ && eye_;
  if (shadowed && !sky_) {
    constexpr int kThreads = 2;
    sky_threads_.emplace(kThreads);
    sky_.emplace(triangles_, points_.size(), &*sky_threads_);
  }
  sky_shares_ = shadowed ? &sky_->compute(points_) : nullptr;
  markExcluded(state);
  colourVertices();
}

void ClothSurface::readPositions(const haptex::ClothState& state) {
  requireCount("positions", state.positions.size(), points_.size());
  for (std::size_t i = 0; i < points_.size(); ++i) {
    points_[i] = fromMessage(state.positions[i]);
    if (!isDrawable(points_[i])) {
      std::ostringstream message;
      message << "positions[" << i << "] = (" << points_[i].transpose()
              << "): allowed are finite numbers, at most " << kFarthest << " m";
      throw std::invalid_argument(message.str());
    }
  }
  low_ = high_ = points_.front().cast<float>();
  for (std::size_t vertex = 0; vertex < particles_.size(); ++vertex) {
    const Eigen::Vector3f place = points_[particles_[vertex]].cast<float>();
    std::copy_n(place.data(), 3, &positions_[3 * vertex]);
    low_ = low_.cwiseMin(place);
    high_ = high_.cwiseMax(place);
  }
}

/// One pass over the triangles, whose edges give both the normals and the strains.
void ClothSurface::sumTriangles() {
  std::fill(sums_.begin(), sums_.end(), Eigen::Vector4f::Zero());
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    const auto& [a, b, c] = triangles_[t];
    const Eigen::Vector3d first = points_[b] - points_[a];
    const Eigen::Vector3d second = points_[c] - points_[a];
    Eigen::Vector4f share = Eigen::Vector4f::Zero();
    share.head<3>() = first.cross(second).cast<float>();
    if (isQuantity(colour_by_) && !at_rest_.empty()) {
      const double value = valueOf(t, cloth::greenStrain(frameOf(at_rest_[t], first, second)));
      share[3] = static_cast<float>(at_rest_[t].area * value);
    }
    for (const int particle : triangles_[t]) sums_[particle] += share;
  }
}

/// Where the yarns around each vertex run.
void ClothSurface::sumAxes() {
  std::fill(wefts_.begin(), wefts_.end(), Eigen::Vector3f::Zero());
  std::fill(warps_.begin(), warps_.end(), Eigen::Vector3f::Zero());
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    const auto& [a, b, c] = triangles_[t];
    const cloth::ElementFrame frame =
        frameOf(at_rest_[t], points_[b] - points_[a], points_[c] - points_[a]);
    const Eigen::Vector3f weft = frame.weft.normalized().cast<float>();
    const Eigen::Vector3f warp = frame.warp.normalized().cast<float>();
    if (!weft.allFinite() || !warp.allFinite()) continue;  // it has no area at rest
    for (int corner = 0; corner < 3; ++corner) {
      wefts_[triangle_vertices_[3 * t + corner]] += weft;
      warps_[triangle_vertices_[3 * t + corner]] += warp;
    }
  }
}

double ClothSurface::valueOf(std::size_t triangle, const cloth::MembraneStrain& strain) const {
  if (colour_by_ == ColourBy::kStrain) return largestPrincipalStrain(strain);
  const material::Fabric& fabric =
      fabrics_[triangle_fabrics_.empty() ? 0 : triangle_fabrics_[triangle]];
  // Shear stress belongs to U.V: its tensor has it whole beside the diagonal.
  const Eigen::Vector3d stress(fabric.weft.elastic.evaluate(strain[0]).stress,
                               fabric.warp.elastic.evaluate(strain[1]).stress,
                               2.0 * fabric.shear.elastic.evaluate(strain[2]).stress);
  return largestPrincipalStrain(stress);
}

/// What its colour tells of a particle.
double ClothSurface::valueAt(int particle) const {
  if (colour_by_ == ColourBy::kContactForce) return contact_forces_[particle];
  return sums_[particle][3] / areas_[particle];
}

/// Of the side towards the eye.
double ClothSurface::skyShareAt(int particle) const {
  const Eigen::Vector3d normal = sums_[particle].head<3>().cast<double>();
  const proximity::SkyShare& share = (*sky_shares_)[particle];
  return normal.dot(*eye_ - points_[particle]) >= 0.0 ? share.front : share.back;
}

void ClothSurface::markExcluded(const haptex::ClothState& state) {
  std::fill(excluded_.begin(), excluded_.end(), 0);
  for (const std::uint32_t particle : state.excluded) {
    if (particle < excluded_.size()) excluded_[particle] = 1;
  }
}

void ClothSurface::colourVertices() {
  const bool by_quantity = isQuantity(colour_by_);
  const bool by_look = colour_by_ == ColourBy::kLook;
  for (std::size_t vertex = 0; vertex < particles_.size(); ++vertex) {
    const int particle = particles_[vertex];
    const bool excluded = excluded_[particle] != 0;
    const Eigen::Vector3d normal = sums_[particle].head<3>().cast<double>().normalized();
    const double sky = sky_shares_ != nullptr ? skyShareAt(particle) : 1.0;
    if (!excluded && by_look && eye_ && !looks_.empty()) {
      if (const auto& brdf = looks_[vertex_groups_[vertex] % static_cast<int>(fabric_count_)]) {
        colours_[vertex] = lookOf(vertex, *brdf, normal, sky);
        continue;
      }
    }
    const Eigen::Vector3f colour = excluded || by_look ? kNeutralColour
                                   : by_quantity       ? viridis(scale_.fraction(valueAt(particle)))
                                                       : distinctColour(vertex_groups_[vertex]);
    colours_[vertex] = colourOf(colour, shade(normal) * static_cast<float>(sky), opacity_);
  }
}

/// @param sky share of it that is seen
VertexColour ClothSurface::lookOf(std::size_t vertex, const appearance::Brdf& brdf,
                                  const Eigen::Vector3d& normal, double sky) const {
  const Eigen::Vector3d to_eye = (*eye_ - points_[particles_[vertex]]).normalized();
  // Both sides have the same yarns.
  Eigen::Matrix3d axes;  // rows: along weft, along warp, towards the eye
  axes.row(2) = normal.dot(to_eye) < 0.0 ? -normal : normal;
  const Eigen::Vector3d out = axes.row(2), weft = wefts_[vertex].cast<double>();
  axes.row(0) = (weft - weft.dot(out) * out).normalized();
  axes.row(1) = out.cross(Eigen::Vector3d(axes.row(0)));
  if (axes.row(1).dot(warps_[vertex].cast<double>()) < 0.0) axes.row(1) *= -1.0;
  Eigen::Vector3d view = axes * to_eye;
  view.z() = std::max(view.z(), kFlattest);
  const Eigen::Vector3f radiance =
      static_cast<float>(M_PI * (1.0 - kAmbient)) * brdf.radiance(view, axes * towardsSun()) +
      static_cast<float>(kAmbient * sky) * brdf.underSky(view);
  using appearance::srgbOfLinear;
  return {byteOf(srgbOfLinear(radiance[0])), byteOf(srgbOfLinear(radiance[1])),
          byteOf(srgbOfLinear(radiance[2])), byteOf(opacity_)};
}

std::vector<std::uint32_t> ClothSurface::attached(const haptex::ClothState& state) const {
  std::vector<std::uint32_t> vertices;
  for (const std::uint32_t particle : state.attached) {
    if (particle >= excluded_.size() || excluded_[particle] != 0) continue;
    vertices.push_back(first_vertices_[particle]);
  }
  return vertices;
}

}  // namespace haptex::nodes
