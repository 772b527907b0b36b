#include "haptex/studies/jobs/garment_starts.h"

#include <Eigen/Geometry>
#include <set>
#include <stdexcept>

#include "haptex/base/repeatable_random.h"
#include "haptex/garment/placement/overlaps.h"
#include "haptex/material/fabric_file.h"

namespace haptex::studies {

using Eigen::Vector3d;

namespace {

std::vector<std::set<int>> particlesOfPanels(const mesh::ClothMesh& mesh) {
  std::vector<std::set<int>> panels(mesh.panelCount());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    panels[mesh.panelOf(t)].insert(mesh.triangles[t].begin(), mesh.triangles[t].end());
  }
  return panels;
}

void movePanel(const std::set<int>& particles, const GarmentScene& scene,
               base::RepeatableRandom& random, std::vector<Vector3d>& positions) {
  const auto draw = [&](double most) {
    return Vector3d(random.uniform(-most, most), random.uniform(-most, most),
                    random.uniform(-most, most));
  };
  Vector3d middle = Vector3d::Zero();
  for (const int i : particles) middle += positions[i] / static_cast<double>(particles.size());
  const Vector3d shift = draw(scene.shift), turn = draw(scene.turn);
  const Eigen::AngleAxisd rotation(turn.norm(), turn.normalized());
  for (const int i : particles) {
    positions[i] = middle + shift + rotation * (positions[i] - middle);
  }
}

}  // namespace

const std::vector<GarmentScene>& garmentScenes() {
  static const std::vector<GarmentScene> scenes{
      {"shirt", "meshes/figure.obj", 0.01, 0.02, 0.02},
      {"fitted_shirt", "bodies/woman.yaml", 1.5e-3, 2e-3, 0.02},
      {"fitted_dress", "bodies/woman.yaml", 1.5e-3, 2e-3, 0.02},
      {"skirt", "bodies/figure.yaml", 1.5e-3, 2e-3, 0.02},
      {"trousers", "bodies/figure.yaml", 1.5e-3, 2e-3, 0.02},
      {"shirt_over_trousers", "bodies/figure.yaml", 1.5e-3, 2e-3, 0.03},
      {"shirt_in_trousers", "bodies/figure.yaml", 1.5e-3, 2e-3, 0.03},
      {"jacket", "bodies/figure.yaml", 1.5e-3, 2e-3, 0.03}};
  return scenes;
}

GarmentStart startOf(const GarmentScene& scene, const std::string& config) {
  const dressing::CoarseStart coarse = dressing::coarseStart(scene.edge);
  GarmentStart start;
  start.settings.halvings = coarse.halvings;
  start.laid = dressing::layGarment(config + "/garments/" + scene.garment + ".yaml",
                                    config + "/" + scene.body, coarse.edge_length);
  for (const std::string& name : start.laid.garment.fabrics) {
    start.fabrics.push_back(material::loadFabric(config + "/fabrics/" + name + ".yaml"));
  }
  return start;
}

void disturb(mesh::ClothMesh& mesh, const mesh::ObstacleMesh& body, const GarmentScene& scene,
             unsigned seed) {
  constexpr int kMostDraws = 100;
  base::RepeatableRandom random(seed);
  const std::vector<std::set<int>> panels = particlesOfPanels(mesh);
  const std::vector<Vector3d> laid = mesh.initial_positions;
  for (int draw = 0; draw < kMostDraws; ++draw) {
    mesh.initial_positions = laid;
    for (const std::set<int>& panel : panels) {
      movePanel(panel, scene, random, mesh.initial_positions);
    }
    if (garment::findOverlaps(mesh, body.vertices, body.triangles).empty()) return;
  }
  throw std::runtime_error(std::string("panels of ") + scene.garment + " intersect in all of " +
                           std::to_string(kMostDraws) + " draws");
}

}  // namespace haptex::studies
