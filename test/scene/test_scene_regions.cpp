// Regions of other fabrics in scene files.
#include <gtest/gtest.h>

#include <algorithm>

#include "haptex/scene/scene_fabric.h"
#include "scene_fixtures.h"

namespace haptex::scene::test_scene_regions {
namespace {

namespace fs = std::filesystem;

/// kValid is of 3 x 2 cells of 100 mm.
std::string withRegions(const std::string& regions, const std::string& scene = kValid) {
  return replaced(scene, "fabric: silk\n", "fabric: silk\nregions: " + regions + "\n");
}

class SceneRegions : public SceneFile {
 protected:
  SceneRegions() {
    for (const char* name : {"denim", "wool"}) {
      const std::string file = std::string("fabrics/") + name + ".yaml";
      fs::copy_file(kConfig / file, root_ / file);
    }
  }
  std::string regionRefusal(const std::string& regions, const std::string& scene = kValid) const {
    const std::string refusal = refusalOf(withRegions(regions, scene));
    const std::string begin = path() + ": regions";
    EXPECT_EQ(refusal.substr(0, begin.size()), begin);
    return refusal.substr(std::min(refusal.size(), begin.size()));
  }
};

TEST_F(SceneRegions, HaveTheCellsWhoseMiddlesLieWithin) {
  const Scene scene = load(withRegions(
      "[{fabric: denim, from: [0, 0], to: [0.3, 0.06]}, {fabric: wool, from: [0.2, 0.1], to: [0.3, "
      "0.2]}]"));
  ASSERT_EQ(scene.region_fabric_paths.size(), 2u);
  EXPECT_EQ(fs::path(scene.region_fabric_paths[0]).filename(), "denim.yaml");
  EXPECT_EQ(scene.mesh.triangle_fabrics, (std::vector<int>{1, 1, 1, 1, 1, 1, 0, 0, 0, 0, 2, 2}));
  EXPECT_FALSE(scene.any_cells) << "other cells would move the borders";
  const std::vector<material::Fabric> fabrics = loadSceneFabrics(path(), scene);
  ASSERT_EQ(fabrics.size(), 3u);
  EXPECT_EQ(fabrics[1].name, "denim");
  EXPECT_EQ(fabrics[2].name, "wool");
}

TEST_F(SceneRegions, OfOneFabricShareIt) {
  const Scene scene = load(
      withRegions("[{fabric: denim, from: [0, 0], to: [0.1, 0.1]}, {fabric: denim, from: [0.2, "
                  "0.1], to: [0.3, 0.2]}]"));
  EXPECT_EQ(scene.region_fabric_paths.size(), 1u);
}

TEST_F(SceneRegions, CanBeGroupsOfAMesh) {
  std::ofstream(root_ / "meshes/corner.obj")
      << "v 0 0 0\nv 0 0.1 0\nv 0 0 -0.1\nv 0 0.1 -0.1\nvt 0 0.1\nvt 0.1 0.1\nvt 0 0\nvt 0.1 0\n"
      << "f 1/1 2/2 3/3\ng hem\nf 2/2 4/4 3/3\n";
  const Scene scene = load(withRegions("[{fabric: denim, group: hem}]", meshScene("corner")));
  EXPECT_EQ(scene.mesh.triangle_fabrics, (std::vector<int>{0, 1}));
  EXPECT_EQ(regionRefusal("[{fabric: denim, group: edge}]", meshScene("corner")),
            "[0].group: 'edge' must be a group ('g') of the mesh that has a face: hem");
  EXPECT_NE(regionRefusal("[{fabric: denim, from: [0, 0], to: [1, 1]}]", meshScene("corner"))
                .find("unknown key, allowed here: fabric, group"),
            std::string::npos);
}

TEST_F(SceneRegions, AreRefusedByNameWhereTheyAreWrong) {
  const std::string corner = "from: [0, 0], to: [0.1, 0.1]}";
  EXPECT_EQ(regionRefusal("[]"), ": has 0 regions: allowed are 1 to 255");
  EXPECT_NE(regionRefusal("[{fabric: velvet, " + corner + "]").find("denim, silk, wool"),
            std::string::npos);
  EXPECT_NE(regionRefusal("[{fabric: silk, " + corner + "]").find("a region must be of another"),
            std::string::npos);
  EXPECT_NE(regionRefusal("[{fabric: denim, group: hem}]").find("unknown key"), std::string::npos);
  EXPECT_EQ(regionRefusal("[{fabric: denim, from: [0, 0], to: [0.31, 0.1]}]"),
            "[0].to[0]: '0.31' must be from 0 to 0.3 m, which the sheet measures");
  EXPECT_EQ(regionRefusal("[{fabric: denim, from: [0.1, 0], to: [0.1, 0.1]}]"),
            "[0].to[0]: '0.1' must be > from");
  EXPECT_EQ(regionRefusal("[{fabric: denim, from: [0.06, 0], to: [0.14, 0.1]}]"),
            "[0]: has the middle of no cell within: it must be wider, or cells smaller");
  EXPECT_EQ(regionRefusal("[{fabric: denim, " + corner + ", {fabric: wool, " + corner + "]"),
            "[1]: has triangle 0, which region 0 has, too: regions must not overlap");
  EXPECT_NE(regionRefusal("[{fabric: denim, from: [.nan, 0], to: [0.1, 0.1]}]").find("number"),
            std::string::npos);
}

TEST_F(SceneRegions, AreRefusedByWhatKnowsOneFabric) {
  const std::string region = "[{fabric: denim, from: [0, 0], to: [0.1, 0.1]}]";
  const std::string knows = ", which knows one fabric";
  EXPECT_EQ(regionRefusal(
                region, replaced(kValid, "[gravity, viscosity]", "[bending, bending_hysteresis]")),
            ": is not allowed if model lists bending_hysteresis" + knows);
  EXPECT_EQ(regionRefusal(region, kValid + "elasticity: mass_spring\n"),
            ": is not allowed with the elasticity mass_spring" + knows);
}

TEST_F(SceneRegions, NeedWhatIsListedOfEveryFabric) {
  const std::string touched =
      replaced(kValid, "[gravity, viscosity]", "[bending, fingers, tactile]");
  const std::string wool = replaced(touched, "fabric: silk", "fabric: wool");
  const Scene scene =
      load(replaced(wool, "fabric: wool\n",
                    "fabric: wool\nregions: [{fabric: silk, from: [0, 0], to: [0.1, 0.1]}]\n"));
  try {
    loadSceneFabrics(path(), scene);
    ADD_FAILURE() << "not refused";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("lists tactile, but"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("linear"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace haptex::scene::test_scene_regions
