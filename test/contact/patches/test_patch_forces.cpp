#include <gtest/gtest.h>

#include <numeric>

#include "../fixtures.h"
#include "haptex/contact/patch_forces.h"

namespace haptex::contact::test_patch_forces {
namespace {

using Eigen::Vector3d;

constexpr double kCurvature = 2.0;  // 1/m

/// All of the small sample, but for elements along its border; some in the middle refined.
class PatchForcesTest : public testing::Test {
 protected:
  RefinedCut cut(double refined) const {
    const std::vector<int> all = trianglesAround(mesh_, {0.02, 0.02}, 0.015);
    std::vector<int> inner, around;
    for (const int triangle : all) {
      bool is_inner = true;
      for (const int p : mesh_.triangles[triangle]) {
        const Eigen::Vector2d off = mesh_.rest_coordinates[p] - Eigen::Vector2d(0.02, 0.02);
        is_inner = is_inner && off.lpNorm<Eigen::Infinity>() < refined + 1e-9;
      }
      (is_inner ? inner : around).push_back(triangle);
    }
    return cutAndRefine(mesh_, topology_, inner, nothingAttached(mesh_), 2, around);
  }
  double energyBentAlongWeft(const RefinedCut& cut) const {
    PatchForces forces = forcesOn(mesh_, cut, fabrics_, {});
    const linear::SymmetricBlockMatrix matrix(static_cast<int>(cut.supports.size()),
                                              cut.mesh.triangles, forces.pairs);
    forces.sum.bind(matrix);
    // An arc, along which the fabric is as long as at rest.
    std::vector<Vector3d> positions;
    for (const Eigen::Vector2d& rest : cut.mesh.rest_coordinates) {
      const double angle = kCurvature * (rest.x() - 0.02);
      positions.emplace_back((1.0 - std::cos(angle)) / kCurvature, std::sin(angle) / kCurvature,
                             rest.y());
    }
    const std::vector<Vector3d> at_rest(positions.size(), Vector3d::Zero());
    return forces.sum.energy({positions, at_rest});
  }

  const mesh::ClothMesh mesh_ = smallSample();
  const MeshTopology topology_{mesh_};
  const std::vector<material::Fabric> fabrics_ = {wool()};
};

// Refined and coarse elements bend alike, but for half of a coarse cell along the line between them
// that nothing resists: 2.5 mm on either side of a square of 10 to 20 mm, where the cut's own
// border leaves 25 x 30 mm^2.
TEST_F(PatchForcesTest, PartsOfBothFinenessesBendAsOnePlate) {
  const double even = energyBentAlongWeft(cut(0.015));
  const double graded = energyBentAlongWeft(cut(0.005));
  EXPECT_GT(even, 0.0);
  EXPECT_LE(graded, 1.001 * even);
  EXPECT_GE(graded, (1.0 - 2.0 * 2.5 * 20.0 / (25.0 * 30.0) - 0.02) * even);
}

TEST_F(PatchForcesTest, HingesHaveFourParticlesOnCellsThatAreRectangles) {
  const RefinedCut graded = cut(0.005);
  const PatchForces forces = forcesOn(mesh_, graded, fabrics_, {});
  // Besides its neighbours in triangles a particle is coupled with those beyond its six edges, and
  // with corners of coarse elements at most.
  EXPECT_LT(forces.pairs.size(), 5 * graded.supports.size());
}

}  // namespace
}  // namespace haptex::contact::test_patch_forces
