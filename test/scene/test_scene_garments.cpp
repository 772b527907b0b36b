// Scenes whose cloth is sewn of panels.
#include "scene_fixtures.h"

namespace haptex::scene::test_scene_garments {
namespace {

TEST(ShippedGarments, AreSewnOfPanelsAndStartAtRestOnTheFigureWithoutIntersections) {
  struct Garment {
    const char* name;
    int panels;
    std::size_t triangles, seam_hinges;  // at least so many hinges
  };
  for (const Garment& garment : {Garment{"tshirt", 8, 1714, 100}, Garment{"skirt", 2, 1442, 30}}) {
    const Scene scene =
        loadScene((kConfig / "scenes" / (garment.name + std::string(".yaml"))).string());
    EXPECT_EQ(scene.mesh.panelCount(), garment.panels) << garment.name;
    EXPECT_EQ(scene.mesh.triangles.size(), garment.triangles) << garment.name;
    EXPECT_GT(scene.mesh.seam_hinges.size(), garment.seam_hinges) << garment.name;
    EXPECT_TRUE(scene.attached_particles.empty());
    EXPECT_TRUE(scene.start_velocities.empty());
    EXPECT_EQ(scene.start_move.particles, 0) << garment.name << ": the start was moved";
    ASSERT_EQ(scene.obstacles.size(), 1u);
  }
}

TEST_F(SceneFile, OfSewnPanelsRefusesSidesSpringsAndFacesOfNoPanel) {
  const std::string points =
      "v 0 0 0\nv 0 0.1 0\nv 0 0.1 0.1\nv 0 0 0.1\n"
      "vt 0 0\nvt 0.1 0\nvt 0.1 0.1\nvt 0 0.1\nvt 5 0\nvt 5.1 0.1\n";
  const std::string sewn = points + "g one\nf 1/1 2/2 3/3\ng two\nf 1/5 3/6 4/4\n";
  const auto scene = [](const std::string& attach, const std::string& more) {
    return "fabric: silk\nmesh: ./sewn.obj\nattach: " + attach +
           "\nmodel: [gravity]\ntime_step: 0.01\n" + more;
  };
  std::ofstream(root_ / "scenes/sewn.obj") << sewn;
  EXPECT_EQ(load(scene("[]", "")).mesh.panelCount(), 2);
  EXPECT_EQ(load(scene("[{particles: [0]}]", "")).attached_particles.size(), 1u);
  EXPECT_NE(refusalOf(scene("[top]", "")).find("the mesh has seams"), std::string::npos);
  EXPECT_NE(refusalOf(scene("[]", "elasticity: mass_spring\n")).find("a mesh that has seams"),
            std::string::npos);
  std::ofstream(root_ / "scenes/sewn.obj") << points + "f 1/1 2/2 3/3\ng two\nf 1/5 3/6 4/4\n";
  EXPECT_NE(refusalOf(scene("[]", "")).find("line 11: a face is in 0 groups"), std::string::npos);
}

}  // namespace
}  // namespace haptex::scene::test_scene_garments
