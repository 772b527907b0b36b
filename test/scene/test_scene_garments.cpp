// Scenes whose cloth is sewn of panels.
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "haptex/base/workload.h"
#include "scene_fixtures.h"

namespace haptex::scene::test_scene_garments {
namespace {

TEST(ShippedGarments, AreSewnOfPanelsAndStartAtRestOnTheFigureWithoutIntersections) {
  struct Garment {
    const char* name;
    int panels;
    std::size_t triangles, seam_hinges;  // at least so many hinges
  };
  for (const Garment& garment :
       {Garment{"tshirt", 8, 1714, 100}, Garment{"skirt", 2, 1442, 30},
        Garment{"trousers_and_shirt", 12, 4624, 200}, Garment{"shirt_in_trousers", 12, 4624, 200},
        Garment{"jacket", 14, 2340, 100}}) {
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

/// How far a ray goes until it leaves the last triangle of a fabric (m); 0 if it meets none.
double farthest(const Scene& scene, int fabric, const Eigen::Vector3d& from,
                const Eigen::Vector3d& along) {
  const auto& places = scene.mesh.initial_positions;
  double far = 0.0;
  for (std::size_t t = 0; t < scene.mesh.triangles.size(); ++t) {
    if (scene.mesh.fabricOf(t) != fabric) continue;
    const auto& [a, b, c] = scene.mesh.triangles[t];
    Eigen::Matrix3d sides;
    sides << places[b] - places[a], places[c] - places[a], -along;
    const Eigen::Vector3d at = sides.fullPivLu().solve(from - places[a]);
    if (at.head<2>().minCoeff() >= 0.0 && at[0] + at[1] <= 1.0) far = std::max(far, at[2]);
  }
  return far;
}

TEST(ShippedGarments, AreWornOneOverTheOtherInTheirOrderOfDressing) {
  constexpr int kShirt = 0, kTrousers = 1, kRays = base::unlessSanitized(36, 12);
  for (const bool is_over : {true, false}) {
    const char* const name = is_over ? "trousers_and_shirt" : "shirt_in_trousers";
    const Scene scene = loadScene((kConfig / "scenes" / (std::string(name) + ".yaml")).string());
    int both = 0;
    for (double z = 0.88; z < 0.99; z += 0.02) {  // m, from the hem of the shirt to the waist
      for (int i = 0; i < kRays; ++i) {
        const double angle = 2.0 * M_PI * i / kRays;
        const Eigen::Vector3d from(0.05, 0.0, z), along(std::cos(angle), std::sin(angle), 0.0);
        const double shirt = farthest(scene, kShirt, from, along);
        const double trousers = farthest(scene, kTrousers, from, along);
        if (shirt == 0.0 || trousers == 0.0) continue;
        ++both;
        EXPECT_EQ(shirt > trousers, is_over) << name << ", " << z << " m high, " << angle << " rad";
      }
    }
    EXPECT_GT(both, 5 * kRays / 2) << name;
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
