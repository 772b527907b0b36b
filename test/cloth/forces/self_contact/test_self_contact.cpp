// Contact of a cloth with itself as a force: pressure, derivatives, momentum.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "derivatives.h"
#include "haptex/cloth/dynamics/cloth.h"
#include "haptex/linear/block_cholesky.h"
#include "self_contact_fixtures.h"

namespace haptex::cloth::test_self_contact {
namespace {

using Eigen::Vector3d;

TEST(LayerLaw, FollowsTheCompressionCurveAndDivergesWhereItEnds) {
  const material::Fabric fabric = fabricNamed("wool");
  const LayerLaw law(fabric);
  EXPECT_EQ(law.at(law.thickness()).pressure, 0.0);
  const double half_way = 0.5 * (law.thickness() + law.leastDistance());
  const double strain = 1.0 - half_way / law.thickness();
  EXPECT_NEAR(law.at(half_way).pressure, fabric.compression->pressure.evaluate(strain).stress,
              1e-9 * law.at(half_way).pressure);
  EXPECT_EQ(law.guardAt(law.leastDistance()).pressure, 0.0);
  EXPECT_GT(law.at(1e-9).pressure, 1e3 * law.at(law.leastDistance()).pressure);
}

TEST(LayerLaw, PressureIsTheDerivativeOfItsEnergyAndSlopeThatOfThePressure) {
  const LayerLaw law(fabricNamed("wool"));
  constexpr double kStep = 1e-10;  // m
  for (double share : {0.02, 0.3, 0.9, 1.1, 1.3}) {
    const double d = share * law.leastDistance();
    for (const bool guard : {false, true}) {
      const auto at = [&](double distance) {
        return guard ? law.guardAt(distance) : law.at(distance);
      };
      const LayerPressure above = at(d + kStep), below = at(d - kStep), middle = at(d);
      EXPECT_NEAR(middle.pressure, (below.energy - above.energy) / (2.0 * kStep),
                  1e-4 * middle.pressure);
      EXPECT_NEAR(middle.slope, (below.pressure - above.pressure) / (2.0 * kStep),
                  1e-3 * middle.slope);
    }
  }
}

TEST(LayerLaw, WhatTouchesHasAFiniteEnergyAndNoPressure) {
  const LayerLaw law(fabricNamed("wool"));
  for (double distance : {0.0, 0.5 * LayerLaw::kTouching}) {
    for (const LayerPressure& touching : {law.at(distance), law.guardAt(distance)}) {
      EXPECT_EQ(touching.pressure, 0.0);
      EXPECT_EQ(touching.slope, 0.0);
    }
    EXPECT_EQ(law.at(distance).energy, law.at(LayerLaw::kTouching).energy);
    EXPECT_EQ(law.guardAt(distance).energy, law.guardAt(LayerLaw::kTouching).energy);
  }
  EXPECT_GT(law.at(LayerLaw::kTouching).pressure, 0.0);
  EXPECT_TRUE(std::isfinite(law.at(LayerLaw::kTouching).energy));
}

TEST(SelfContact, FlatLayersHaveTheCurvesPressureOnTheirAreaHoweverTheyLie) {
  const material::Fabric fabric = fabricNamed("wool");
  const double side = 0.08;
  const Cloth cloth(layers(2, side, 8), fabric, selfCollision());
  ClothState state = cloth.initialState();
  const double distance = 0.8 * fabric.compression->thickness;
  const double pressure = LayerLaw(fabric).at(distance).pressure;
  const std::size_t half = cloth.particleCount() / 2;
  // Turned and shifted within the other layer, whose border has no other layer beyond it.
  for (const double angle : {0.0, 0.3}) {
    const double small = angle == 0.0 ? 1.0 : 0.5;
    for (std::size_t i = 0; i < half; ++i) {
      const Vector3d place = state.positions[i];
      const double x = small * (place.x() - 0.5 * side), y = small * (place.y() - 0.5 * side);
      state.positions[half + i] =
          Vector3d(0.5 * side + x * std::cos(angle) - y * std::sin(angle),
                   0.5 * side + x * std::sin(angle) + y * std::cos(angle), distance);
    }
    double up = 0.0, area = side * side;
    const std::vector<Vector3d> forces = contactForces(cloth, state);
    for (std::size_t i = half; i < forces.size(); ++i) up += forces[i].z();
    if (angle == 0.0) {
      EXPECT_NEAR(up, pressure * area, 1e-9 * up);
    } else {
      // The half of the shrunk layer's vertices counts its rest area; that of the other those
      // vertices that it covers.
      EXPECT_NEAR(up, 0.5 * pressure * area * (1.0 + small * small), 0.05 * up);
    }
  }
}

/// Two layers of which one is crumpled: places where all kinds of pairs touch.
ClothState crumpled(const Cloth& cloth, double depth, unsigned seed) {
  ClothState state = cloth.initialState();
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  const std::size_t half = cloth.particleCount() / 2;
  const double thickness = cloth.selfContact()->layers().law(0).thickness();
  for (std::size_t i = 0; i < half; ++i) {
    state.positions[i] += 1e-3 * Vector3d(any(random), any(random), any(random));
    state.positions[half + i] =
        state.positions[i] +
        Vector3d(2e-3 * any(random), 2e-3 * any(random), depth * thickness + 1e-3);
    state.positions[half + i].z() += 1e-3 * any(random);
    state.velocities[i] = Vector3d(any(random), any(random), any(random)) * 1e-3;
  }
  return state;
}

TEST(SelfContact, ForcesAreTheGradientOfTheEnergyWhereverItTouches) {
  const Cloth cloth(layers(2, 0.03, 4), fabricNamed("wool"), selfCollision());
  for (unsigned seed = 1; seed <= 4; ++seed) {
    ClothState state = crumpled(cloth, 0.1, seed);
    for (Vector3d& velocity : state.velocities) velocity.setZero();
    expectContactGradient(cloth, state, 2e-4);
  }
}

TEST(SelfContact, ForcesSumUpToNothingAndTurnNothing) {
  const material::Fabric fabric = fabricNamed("wool");
  const Cloth cloth(layers(2, 0.03, 4), fabric, selfCollision());
  const double thickness = cloth.selfContact()->layers().law(0).thickness();
  ClothState state = crumpled(cloth, 0.1, 7);
  for (const bool rubbing : {true, false}) {
    if (!rubbing) std::fill(state.velocities.begin(), state.velocities.end(), Vector3d::Zero());
    Vector3d sum = Vector3d::Zero(), moment = Vector3d::Zero();
    double scale = 0.0;
    const std::vector<Vector3d> forces = contactForces(cloth, state);
    for (std::size_t i = 0; i < forces.size(); ++i) {
      sum += forces[i];
      moment += state.positions[i].cross(forces[i]);
      scale += forces[i].norm();
    }
    EXPECT_LT(sum.norm(), 1e-13 * scale);
    // The friction of a pair acts at its two elements, which are a thickness apart at most.
    const double arm = rubbing ? *fabric.friction * thickness : 1e-13 * 0.03;
    EXPECT_LT(moment.norm(), arm * scale);
  }
}

TEST(SelfContact, ForcesAreContinuousOnWaysAcrossARidgeAndAValley) {
  // A vertex of the second layer over the edge between two triangles that are folded up or down.
  const material::Fabric fabric = fabricNamed("wool");
  const Cloth cloth(layers(2, 0.02, 2), fabric, selfCollision());
  const double thickness = fabric.compression->thickness;
  for (const double fold : {-0.3, 0.0, 0.3}) {
    ClothState state = cloth.initialState();
    const std::size_t half = cloth.particleCount() / 2;
    for (std::size_t i = 0; i < half; ++i) {
      state.positions[i].z() = fold * std::abs(state.positions[i].x() - 0.01);
    }
    Vector3d last = Vector3d::Zero();
    double largest = 0.0, most = 0.0;
    constexpr int kSteps = 4000;
    for (int step = 0; step <= kSteps; ++step) {
      // Only a corner of the second layer is near.
      const double x = 0.008 + 0.004 * step / kSteps;
      const Vector3d corner(x, 0.0113, 0.9 * thickness + fold * std::abs(x - 0.01));
      for (std::size_t i = 0; i < half; ++i) {
        const Eigen::Vector2d rest = cloth.mesh().rest_coordinates[i];
        state.positions[half + i] =
            corner + Vector3d(0.3 * rest.x(), 0.2 * rest.y(), 2.0 * rest.sum());
      }
      const Vector3d force = contactForces(cloth, state)[half];
      if (step > 0) largest = std::max(largest, (force - last).norm());
      most = std::max(most, force.norm());
      last = force;
    }
    ASSERT_GT(most, 0.0);
    EXPECT_LT(largest, 0.02 * most) << fold;
  }
}

TEST(SelfContact, WhatSlipsHasTheFabricsFrictionAndWhatCreepsLess) {
  const material::Fabric fabric = fabricNamed("wool");
  const Cloth cloth(layers(2, 0.04, 4), fabric, selfCollision());
  ClothState state = cloth.initialState();
  const std::size_t half = cloth.particleCount() / 2;
  for (const double speed : {10.0, 1.0, 0.5, 0.1}) {  // of the slip speed
    for (std::size_t i = 0; i < half; ++i) {
      state.positions[half + i] =
          state.positions[i] + Vector3d(0.0, 0.0, 0.9 * fabric.compression->thickness);
      state.velocities[half + i].x() = speed * SelfContact::kSlipSpeed;
    }
    Vector3d sum = Vector3d::Zero();
    const std::vector<Vector3d> forces = contactForces(cloth, state);
    for (std::size_t i = half; i < forces.size(); ++i) sum += forces[i];
    const double share = speed < 1.0 ? speed * (2.0 - speed) : 1.0;
    EXPECT_NEAR(-sum.x(), share * *fabric.friction * sum.z(), 1e-9 * sum.z());
    EXPECT_NEAR(sum.y(), 0.0, 1e-12 * sum.z());
  }
}

TEST(SelfContact, JacobianIsThatOfTheForces) {
  const Cloth cloth(layers(2, 0.03, 3), fabricNamed("wool"), selfCollision());
  ClothState state = crumpled(cloth, 0.4, 3);
  for (Vector3d& velocity : state.velocities) velocity.setZero();
  std::vector<int> all(cloth.particleCount());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<int>(i);
  JacobianRows rows(all);
  cloth.selfContact()->addJacobian(state.ofForces(), rows);
  const std::vector<JacobianBlock> blocks = rows.blocks();
  ASSERT_FALSE(blocks.empty());
  double stiffest = 0.0;
  for (const JacobianBlock& block : blocks) stiffest = std::max(stiffest, block.by_position.norm());
  const auto transposed = [&](const JacobianBlock& block) {
    for (const JacobianBlock& other : blocks) {
      if (other.row == block.column && other.column == block.row) return other.by_position;
    }
    return Eigen::Matrix3d(Eigen::Matrix3d::Zero());
  };
  for (const JacobianBlock& block : blocks) {
    EXPECT_LT((block.by_position - transposed(block).transpose()).norm(), 1e-5 * stiffest);
  }
}

/// A sheet crumpled into a few thicknesses: what touches is partly coupled by its own triangles.
TEST(SelfContact, LeavesToFactorsAMatrixThatIsPositiveDefinite) {
  const Cloth cloth(mesh::makeRectangle(0.06, 0.06, 6, 6, mesh::Triangulation::kAlternating),
                    fabricNamed("wool"), selfCollision());
  ClothState state = cloth.initialState();
  std::mt19937 random(1);
  std::uniform_real_distribution<double> place(0.0, 3e-3);
  for (Vector3d& position : state.positions)
    position = {place(random), place(random), place(random)};
  linear::SymmetricBlockMatrix matrix = cloth.pattern();
  matrix.setZero();
  linear::BlockVector rhs = linear::BlockVector::Zero(3, matrix.size());
  cloth.selfContact()->assembleLinearised(state.ofForces(), {1e-2, 0.0}, matrix, rhs);
  ASSERT_GT(matrix.couplingCount(), 0);
  double largest = 0.0;
  for (int i = 0; i < matrix.size(); ++i) largest = std::max(largest, matrix.diagonal(i).norm());
  for (int i = 0; i < matrix.size(); ++i) {
    matrix.diagonal(i) += 1e-9 * largest * Eigen::Matrix3d::Identity();
  }
  EXPECT_TRUE(linear::BlockCholesky(matrix).factorise(matrix));
}

TEST(SelfContact, RefusesWhatItCannotDo) {
  material::Fabric fabric = fabricNamed("wool");
  fabric.compression.reset();
  EXPECT_THROW(Cloth(layers(1, 0.03, 2), fabric, selfCollision()), std::invalid_argument);
  fabric = fabricNamed("wool");
  fabric.friction.reset();
  EXPECT_THROW(Cloth(layers(1, 0.03, 2), fabric, selfCollision()), std::invalid_argument);
}

}  // namespace
}  // namespace haptex::cloth::test_self_contact
