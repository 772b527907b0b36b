#include <algorithm>
#include <map>
#include <utility>

#include "haptex/garment/garment_mesh.h"
#include "haptex/garment/triangulation/threads.h"

namespace haptex::garment {
namespace {

using Eigen::Vector2d;

constexpr double kLeastShare = 0.5;  // of a quarter of a triangle's area, that a part of it has

/// (m^2) of rest coordinates, positive counter-clockwise.
double areaOf(const mesh::ClothMesh& mesh, const std::array<int, 3>& triangle) {
  const Vector2d& a = mesh.rest_coordinates[triangle[0]];
  const Vector2d ab = mesh.rest_coordinates[triangle[1]] - a;
  const Vector2d ac = mesh.rest_coordinates[triangle[2]] - a;
  return 0.5 * (ab.x() * ac.y() - ab.y() * ac.x());
}

/// Puts particles into the middles of edges.
class Middles {
 public:
  explicit Middles(mesh::ClothMesh& mesh) : mesh_(mesh) {}

  int of(int a, int b) {
    const int next = static_cast<int>(mesh_.rest_coordinates.size());
    const auto [found, is_new] = middles_.try_emplace({std::min(a, b), std::max(a, b)}, next);
    if (is_new) {
      mesh_.rest_coordinates.push_back(restOf(a, b));
      mesh_.initial_positions.push_back(0.5 *
                                        (mesh_.initial_positions[a] + mesh_.initial_positions[b]));
    }
    return found->second;
  }

  Vector2d restOf(int a, int b) const {
    return 0.5 * (mesh_.rest_coordinates[a] + mesh_.rest_coordinates[b]);
  }

 private:
  mesh::ClothMesh& mesh_;
  std::map<std::array<int, 2>, int> middles_;
};

void halveSide(std::vector<int>& particles, std::vector<double>& places, Middles& middles) {
  std::vector<int> all = {particles[0]};
  std::vector<double> all_places = {places[0]};
  for (std::size_t i = 1; i < particles.size(); ++i) {
    all.insert(all.end(), {middles.of(particles[i - 1], particles[i]), particles[i]});
    all_places.insert(all_places.end(), {0.5 * (places[i - 1] + places[i]), places[i]});
  }
  particles = std::move(all);
  places = std::move(all_places);
}

/// Where a particle would be without its curve.
using StraightPlaces = std::map<int, Vector2d>;

StraightPlaces halveOutlines(GarmentMesh& garment, Middles& middles) {
  StraightPlaces straight;
  for (std::size_t p = 0; p < garment.edges.size(); ++p) {
    const Panel& panel = garment.pattern.panels[p];
    const Threads threads(panel);
    for (std::size_t k = 0; k < garment.edges[p].size(); ++k) {
      for (std::size_t e = 0; e < garment.edges[p][k].size(); ++e) {
        const Curve& curve = panel.outlines[k][e].curve;
        EdgeParticles& edge = garment.edges[p][k][e];
        halveSide(edge.particles, edge.lengths, middles);
        for (std::size_t i = 1; i < edge.particles.size(); i += 2) {
          Vector2d& rest = garment.mesh.rest_coordinates[edge.particles[i]];
          straight[edge.particles[i]] = rest;
          rest = threads.restOf(curve.at(curve.parameterAt(edge.lengths[i])));
        }
      }
    }
  }
  return straight;
}

/// @param areas m^2, that triangles have with straight edges
void straightenWhereNarrow(mesh::ClothMesh& mesh, const std::vector<double>& areas,
                           StraightPlaces& straight) {
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      if (areaOf(mesh, mesh.triangles[t]) >= kLeastShare * areas[t]) continue;
      for (const int corner : mesh.triangles[t]) {
        const auto found = straight.find(corner);
        if (found == straight.end()) continue;
        mesh.rest_coordinates[corner] = found->second;
        straight.erase(found);
        changed = true;
      }
    }
  }
}

}  // namespace

GarmentMesh halved(const GarmentMesh& garment) {
  GarmentMesh half = garment;
  mesh::ClothMesh& mesh = half.mesh;
  Middles middles(mesh);
  mesh.triangles.clear();
  mesh.triangle_panels.clear();
  std::vector<double> areas;
  for (std::size_t t = 0; t < garment.mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = garment.mesh.triangles[t];
    const int ab = middles.of(a, b), bc = middles.of(b, c), ca = middles.of(c, a);
    mesh.triangles.insert(mesh.triangles.end(),
                          {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    mesh.triangle_panels.insert(mesh.triangle_panels.end(), 4, garment.mesh.panelOf(t));
    areas.insert(areas.end(), 4, 0.25 * areaOf(garment.mesh, garment.mesh.triangles[t]));
  }
  StraightPlaces straight = halveOutlines(half, middles);
  straightenWhereNarrow(mesh, areas, straight);
  for (mesh::Seam& seam : half.seams) {
    halveSide(seam.first, seam.first_places, middles);
    halveSide(seam.second, seam.second_places, middles);
  }
  return half;
}

}  // namespace haptex::garment
