// What tells co-rotational elements from the membrane; what both promise is in test_elasticity.cpp.
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "elasticity_fixtures.h"
#include "haptex/cloth/dynamics/cloth.h"

namespace haptex::cloth::test_corotational {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

Cloth corotationalCloth(const mesh::ClothMesh& mesh, const material::Fabric& fabric) {
  return Cloth(mesh, fabric, effectsOf(Elasticity::kCorotational));
}

TEST(Corotational, SmallStrainsAreThoseOfTheMembraneToTheFirstOrder) {
  const Cloth corotational = corotationalCloth(square(4), stiffeningFabric());
  const Cloth membrane(square(4), stiffeningFabric(), {});
  const auto difference = [&](double displacement) {
    const ClothState state = randomState(membrane, displacement, 0.0);
    const std::vector<Vector3d> a = forcesOf(corotational, state), b = forcesOf(membrane, state);
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]).squaredNorm();
    return std::sqrt(sum) / largest(b);
  };
  // What is left is of the first order relative to the forces: half of it at half the strain.
  const double coarse = difference(1e-6), fine = difference(5e-7);
  EXPECT_LT(coarse, 0.01);
  EXPECT_NEAR(coarse / fine, 2.0, 0.05);
}

TEST(Corotational, UniaxialForceIsTheModulusTimesTheEngineeringStrain) {
  const material::Fabric fabric = stiffeningFabric();
  const Cloth cloth = corotationalCloth(square(1), fabric);
  for (int axis : {1, 2}) {  // weft along y, warp along z
    const auto& curve = axis == 1 ? fabric.weft.elastic : fabric.warp.elastic;
    const double modulus = curve.evaluate(0.0).slope;
    for (double stretch : {0.7, 1.08, 2.0}) {
      ClothState state = cloth.initialState();
      for (Vector3d& position : state.positions) position[axis] *= stretch;
      double pull = 0.0;
      for (const Vector3d& force : forcesOf(cloth, state)) pull += 0.5 * std::abs(force[axis]);
      const double exact = 0.1 * modulus * std::abs(stretch - 1.0);
      EXPECT_NEAR(pull, exact, 1e-12 * exact);
    }
  }
}

TEST(Corotational, AffineDeformationHasNoInteriorForces) {
  mesh::ClothMesh mesh = square(4);
  for (int particle : {6, 7, 8, 11, 12, 13, 16, 17, 18}) {
    const Vector2d shift = 0.007 * Vector2d(std::sin(particle), std::cos(2.0 * particle));
    mesh.rest_coordinates[particle] += shift;
  }
  const Cloth cloth = corotationalCloth(mesh, stiffeningFabric());
  ClothState state = cloth.initialState();
  Eigen::Matrix<double, 3, 2> gradient;
  gradient << 0.2, -0.3, 1.2, 0.3, 0.1, 0.8;
  for (std::size_t i = 0; i < cloth.particleCount(); ++i) {
    state.positions[i] = gradient * cloth.mesh().rest_coordinates[i];
  }
  const std::vector<Vector3d> forces = forcesOf(cloth, state);
  for (int particle : {6, 7, 8, 11, 12, 13, 16, 17, 18}) {
    EXPECT_LT(forces[particle].norm(), 1e-13 * largest(forces));
  }
}

}  // namespace
}  // namespace haptex::cloth::test_corotational
