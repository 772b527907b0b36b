// What drape_garment --scene writes is a scene.
#include <set>
#include <sstream>

#include "../dressing/dressing_fixtures.h"
#include "haptex/contact/haptic_settings.h"
#include "haptex/dressing/drape_garment.h"
#include "haptex/dressing/worn_scene.h"
#include "haptex/mesh/obj_writer.h"
#include "haptex/scene/scene_fabric.h"
#include "scene_fixtures.h"

namespace haptex::scene::test_worn_scene {
namespace {

class WornScene : public SceneFile {
 protected:
  /// A tube of wool and denim, sewn along one side and fastened along the other.
  static garment::Pattern fastenedTube() {
    garment::Pattern pattern = dressing::tube(0.15);
    pattern.panels[1].fabric = "denim";
    pattern.panels[1].warp = {0.6, 0.8};  // or both sides of the seam had the same rest coordinates
    pattern.seams.pop_back();
    for (const double y : {0.04, 0.16}) {
      pattern.fastenings.push_back({"hook" + std::to_string(pattern.fastenings.size()),
                                    {{{0, {-0.145, y}}, {1, {-0.145, y}}}}});
    }
    return pattern;
  }

  std::string written(const garment::Pattern& pattern, double edge_length) const {
    const std::vector<std::string> fabrics(pattern.panels.size(), "/fabrics/wool.yaml");
    std::ostringstream out;
    dressing::writeWornScene(
        {pattern, fabrics, (root_ / "scenes/worn.obj").string(), "/bodies/body.obj", edge_length},
        path(), out);
    return out.str();
  }
};

TEST_F(WornScene, IsLoadedWithWhatTheGarmentHas) {
  const std::string garment = (root_ / "tube.yaml").string(), body = (root_ / "body.yaml").string();
  const std::string out = (root_ / "tube.obj").string(), scene = (root_ / "worn.yaml").string();
  std::ofstream(garment) << garment::writePattern(fastenedTube());
  std::ofstream surface(root_ / "cone.obj");
  mesh::writeObj(dressing::cone(0.2, 0.04, 0.4, 20), surface);
  surface.close();
  std::ofstream(body) << "surface: cone.obj\n"
                         "segments:\n"
                         "  - {name: spine, start: [0, 0, 0], end: [0, 0, 0.4], radius: 0.1}\n";
  std::ostringstream printed, errors;
  ASSERT_EQ(
      dressing::drapeGarment({garment, out, "--body", body, "--edge", "0.06", "--scene", scene},
                             (kConfig / "fabrics").string(), printed, errors),
      0)
      << errors.str();
  const Scene worn = loadScene(scene);
  EXPECT_EQ(worn.mesh.panelCount(), 2);
  EXPECT_EQ(
      std::set<int>(worn.mesh.triangle_fabrics.begin(), worn.mesh.triangle_fabrics.end()).size(),
      2u);
  const std::vector<material::Fabric> fabrics = loadSceneFabrics(scene, worn);
  ASSERT_EQ(fabrics.size(), 2u);
  EXPECT_EQ(fabrics[0].name, "wool");
  EXPECT_EQ(fabrics[1].name, "denim");
  ASSERT_EQ(worn.effects.fasteners.size(), 2u);
  EXPECT_EQ(worn.effects.fasteners[1].name, "hook1");
  ASSERT_EQ(worn.obstacles.size(), 1u);
  EXPECT_EQ(worn.start_move.particles, 0) << "it was at rest outside of the body";
  EXPECT_NO_THROW(contact::loadHapticSettings(scene));
}

TEST_F(WornScene, NamesWhatLiesBesideItFromThere) {
  const std::string text = written(fastenedTube(), 0.03);
  EXPECT_NE(text.find("mesh: ./worn.obj\n"), std::string::npos) << text;
  EXPECT_NE(text.find("mesh: /bodies/body.obj"), std::string::npos) << text;
  EXPECT_EQ(text.find("regions"), std::string::npos) << text;
}

TEST_F(WornScene, HasFinerPatchesOfMoreElementsWhereTheyAreSmaller) {
  for (const auto& [edge, expected] :
       {std::pair(0.045, "{layer: patch, refinement: 3, most_elements: 8}"),
        {0.03, "{layer: patch, refinement: 3, most_elements: 8}"},
        {0.02, "{layer: patch, refinement: 2, most_elements: 18}"},
        {0.005, "{layer: patch, refinement: 0, most_elements: 288}"}}) {
    EXPECT_NE(written(fastenedTube(), edge).find(expected), std::string::npos)
        << written(fastenedTube(), edge);
  }
}

TEST_F(WornScene, GivesFastenersNamesThatScenesAllow) {
  garment::Pattern pattern = fastenedTube();
  pattern.fastenings[0].name = "shirt/top-button";
  pattern.fastenings[1].name = "2nd";
  const std::string text = written(pattern, 0.03);
  EXPECT_NE(text.find("name: shirt_top_button"), std::string::npos) << text;
  EXPECT_NE(text.find("name: fastener_2nd"), std::string::npos) << text;
}

}  // namespace
}  // namespace haptex::scene::test_worn_scene
