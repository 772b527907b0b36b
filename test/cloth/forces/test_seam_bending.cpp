// Bending over seams, against sheets in one piece.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "../../refusal.h"
#include "haptex/cloth/forces/bending/bending.h"
#include "haptex/cloth/forces/bending/seam_bending.h"
#include "seam_fixtures.h"

namespace haptex::cloth::test_seam_bending {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

material::Fabric softFabric(double weft, double warp) {
  material::Fabric fabric = linearFabric();
  fabric.bending = {weft, warp};
  return fabric;
}

ModelledEffects bendingAlone() {
  ModelledEffects effects;
  effects.bending = true;
  effects.gravity.setZero();
  return effects;
}

/// Isometrically on a cylinder around the warp, of the curvature (1/m) towards +z.
std::vector<Vector3d> rolled(const std::vector<Vector2d>& rest, double curvature) {
  std::vector<Vector3d> positions;
  for (const Vector2d& place : rest) {
    const double angle = curvature * (place.x() - 0.05);
    positions.emplace_back(std::sin(angle) / curvature, place.y(),
                           (1.0 - std::cos(angle)) / curvature);
  }
  return positions;
}

double bendingEnergy(const Cloth& cloth, const std::vector<Vector3d>& positions) {
  double energy = 0.0;
  const std::vector<Vector3d> still(positions.size(), Vector3d::Zero());
  const auto add = [&](const auto& forces) {
    for (const auto* force : forces) energy += force->energy({positions, still});
  };
  add(cloth.forces().findAll<Bending>());
  add(cloth.forces().findAll<SeamBending>());
  return energy;
}

TEST(SeamBending, OfMatchedEdgesHoldsWhatTheSheetInOnePieceHolds) {
  const material::Fabric fabric = softFabric(2e-5, 1e-5);
  const Cloth whole(square(8), fabric, bendingAlone());
  const Halves made = halves(8, 8);
  mesh::ClothMesh tied = made.mesh;
  mesh::sew(tied, {made.seam});
  for (const mesh::ClothMesh& mesh : {tied, mesh::merge(made.mesh, {made.seam}).mesh}) {
    const Cloth sewn(mesh, fabric, bendingAlone());
    for (const double curvature : {1.0, 10.0}) {
      const double expected =
          bendingEnergy(whole, rolled(whole.mesh().rest_coordinates, curvature));
      const double energy = bendingEnergy(sewn, rolled(mesh.rest_coordinates, curvature));
      // A hinge's angle is that of chords: exact for small curvature times height, here 0.125.
      EXPECT_NEAR(energy / expected, 1.0, 1e-2 * curvature * curvature / 100.0 + 1e-9) << curvature;
    }
  }
}

TEST(SeamBending, OfUnmatchedEdgesHoldsTheSameTowardsSmallCurvature) {
  const material::Fabric fabric = softFabric(2e-5, 1e-5);
  const double curvature = 0.1;
  // Of the area but for half of a cell at the two free sides.
  for (const auto& [left, right] : {std::pair(6, 10), std::pair(10, 6), std::pair(8, 4)}) {
    const Cloth sewn(sewnHalves(left, right), fabric, bendingAlone());
    const double width = 0.1 - 0.5 * 0.05 / (left / 2) - 0.5 * 0.05 / (right / 2);
    const double expected = 0.5 * 2e-5 * curvature * curvature * width * 0.1;
    EXPECT_NEAR(bendingEnergy(sewn, rolled(sewn.mesh().rest_coordinates, curvature)), expected,
                1e-5 * expected);
  }
}

TEST(SeamBending, OfTwoFabricsIsThatOfBothInSeries) {
  Halves made = halves(2, 2);
  made.mesh.panels[1].fabric = 1;
  mesh::sew(made.mesh, {made.seam});
  const double first = 2e-5, second = 6e-5, height = 0.05;
  const SeamBending seam(made.mesh, {{first, 1e-5}, {second, 1e-5}});
  // Folded by a small angle along the seam.
  std::vector<Vector3d> positions;
  const double angle = 1e-4;
  for (const Vector2d& rest : made.mesh.rest_coordinates) {
    const double across = rest.x() - 0.05;
    positions.emplace_back(across, rest.y(), across > 0.0 ? angle * across : 0.0);
  }
  const std::vector<Vector3d> still(positions.size(), Vector3d::Zero());
  const double moment = angle / (0.5 * height / first + 0.5 * height / second);
  EXPECT_NEAR(seam.energy({positions, still}), 0.5 * 0.1 * moment * angle,
              1e-8 * 0.05 * moment * angle);
}

TEST(SeamBending, RestsAtItsAngleOnTheSideThatIsAskedFor) {
  for (const double angle : {0.5 * M_PI, -0.3}) {
    Halves made = halves(4, 6);
    made.seam.angle = angle;
    mesh::sew(made.mesh, {made.seam});
    const SeamBending seam(made.mesh, {{2e-5, 2e-5}});
    const auto folded = [&](double by) {
      std::vector<Vector3d> positions;
      for (const Vector2d& rest : made.mesh.rest_coordinates) {
        const double across = rest.x() - 0.05;
        const double turn = across > 0.0 ? by : 0.0;
        positions.emplace_back(across * std::cos(turn), rest.y(), across * std::sin(turn));
      }
      return positions;
    };
    const std::vector<Vector3d> still(made.mesh.rest_coordinates.size(), Vector3d::Zero());
    const double flat = seam.energy({folded(0.0), still});
    EXPECT_GT(flat, 0.0);
    EXPECT_LT(std::abs(seam.energy({folded(angle), still})), 1e-12 * flat);
    EXPECT_GT(seam.energy({folded(-angle), still}), 2.0 * flat);
    std::vector<Vector3d> forces(still.size(), Vector3d::Zero());
    seam.addForces({folded(angle), still}, forces);
    for (const Vector3d& force : forces) EXPECT_LT(force.norm(), 1e-10 * flat / 0.01);
  }
}

TEST(SeamBending, ForcesAndJacobianAreTheDerivativesOfTheEnergy) {
  ModelledEffects effects = bendingAlone();
  Halves made = halves(2, 4);
  made.seam.angle = 0.4;
  mesh::sew(made.mesh, {made.seam});
  const Cloth cloth(made.mesh, softFabric(2e-3, 1e-3), effects);
  const ClothState state = randomSewnState(cloth, 0.003, 0.0);
  const SeamBending& seam = *cloth.forces().find<SeamBending>();
  std::vector<Vector3d> forces(state.positions.size(), Vector3d::Zero());
  seam.addForces(state.ofForces(), forces);
  const double step = 1e-6;
  double scale = 0.0;
  for (const Vector3d& force : forces) scale = std::max(scale, force.norm());
  std::vector<int> all(forces.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<int>(i);
  JacobianRows rows(all);
  seam.addJacobian(state.ofForces(), rows);
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(3 * forces.size(), 3 * forces.size());
  for (const JacobianBlock& block : rows.blocks()) {
    jacobian.block<3, 3>(3 * block.row, 3 * block.column) = block.by_position;
  }
  for (std::size_t i = 0; i < forces.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      ClothState ahead = state, back = state;
      ahead.positions[i][axis] += step;
      back.positions[i][axis] -= step;
      const double slope =
          (seam.energy(ahead.ofForces()) - seam.energy(back.ofForces())) / (2.0 * step);
      EXPECT_NEAR(-slope, forces[i][axis], 1e-6 * scale);
      std::vector<Vector3d> plus(forces.size(), Vector3d::Zero()), minus = plus;
      seam.addForces(ahead.ofForces(), plus);
      seam.addForces(back.ofForces(), minus);
      for (std::size_t j = 0; j < forces.size(); ++j) {
        const Vector3d by = (plus[j] - minus[j]) / (2.0 * step);
        const auto row = static_cast<Eigen::Index>(3 * j);
        const auto column = static_cast<Eigen::Index>(3 * i) + axis;
        EXPECT_LT((jacobian.block<3, 1>(row, column) - by).norm(), 1e-6 * jacobian.norm());
      }
    }
  }
}

TEST(SeamBending, RefusesHingesThatAreNone) {
  Halves made = halves(2, 2);
  mesh::sew(made.mesh, {made.seam});
  const auto refusal = [&](const mesh::ClothMesh& mesh, double rigidity) -> std::string {
    return test::refusalOf([&] { SeamBending(mesh, {{rigidity, 1e-5}}); });
  };
  EXPECT_EQ(refusal(made.mesh, 1e-5), test::kNotRefused);
  EXPECT_NE(refusal(made.mesh, -1e-5).find("-1e-05 N.m; it must be finite and at least 0"),
            std::string::npos);
  mesh::ClothMesh mesh = made.mesh;
  mesh.seam_hinges[0].triangles[1] = 99;
  EXPECT_NE(refusal(mesh, 1e-5).find("99; the mesh has triangles 0 to 7"), std::string::npos);
  mesh = made.mesh;
  mesh.seam_hinges[0].angle = std::nan("");
  EXPECT_NE(refusal(mesh, 1e-5).find("the angle nan rad"), std::string::npos);
}

}  // namespace
}  // namespace haptex::cloth::test_seam_bending
