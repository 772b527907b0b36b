#include "haptex/studies/jobs/garment_starts.h"

#include <Eigen/Geometry>
#include <set>

#include "haptex/base/repeatable_random.h"
#include "haptex/material/fabric_file.h"

namespace haptex::studies {

using Eigen::Vector3d;

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

void disturb(mesh::ClothMesh& mesh, const GarmentScene& scene, unsigned seed) {
  base::RepeatableRandom random(seed);
  const auto draw = [&](double most) {
    return Vector3d(random.uniform(-most, most), random.uniform(-most, most),
                    random.uniform(-most, most));
  };
  for (int p = 0; p < mesh.panelCount(); ++p) {
    std::set<int> particles;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      if (mesh.panelOf(t) == p)
        particles.insert(mesh.triangles[t].begin(), mesh.triangles[t].end());
    }
    Vector3d middle = Vector3d::Zero();
    for (const int i : particles) {
      middle += mesh.initial_positions[i] / static_cast<double>(particles.size());
    }
    const Vector3d shift = draw(scene.shift), turn = draw(scene.turn);
    const Eigen::AngleAxisd rotation(turn.norm(), turn.normalized());
    for (const int i : particles) {
      Vector3d& place = mesh.initial_positions[i];
      place = middle + shift + rotation * (place - middle);
    }
  }
}

}  // namespace haptex::studies
