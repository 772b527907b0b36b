#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "../../refusal.h"
#include "air_fixtures.h"
#include "fixtures.h"
#include "force_fixtures.h"

namespace haptex::cloth::test_aerodynamics {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

std::vector<Vector3d> forcesOf(const Cloth& cloth, const ClothState& state) {
  std::vector<Vector3d> forces;
  cloth.computeForces(state, forces);
  return forces;
}

Vector3d sumOf(const std::vector<Vector3d>& vectors) {
  Vector3d sum = Vector3d::Zero();
  for (const Vector3d& vector : vectors) sum += vector;
  return sum;
}

ClothState movingAs(const Cloth& cloth, const Vector3d& velocity) {
  ClothState state = cloth.initialState();
  for (Vector3d& each : state.velocities) each = velocity;
  return state;
}

TEST(Aerodynamics, AFlatPlateFeelsTheStatedCoefficientsAtEveryAngle) {
  // The sheet lies in the plane x = 0, 0.1 m square, turned to the wind by the angle.
  const Cloth cloth(square(3), limpFabric(), effectsOf(still(kWithLift)));
  constexpr double kSpeed = 3.0;
  const double pressure = 0.5 * 1.2 * kSpeed * kSpeed * 0.01;
  for (double angle = 0.0; angle <= 1.5708; angle += 0.1) {
    const double s = std::sin(angle), c = std::cos(angle);
    const Vector3d force = sumOf(forcesOf(cloth, movingAs(cloth, {kSpeed * s, kSpeed * c, 0.0})));
    // Drag against the motion and lift across it.
    const double drag = pressure * (1.17 * s * s * s + 0.3 * c * c * c);
    const double lift = pressure * (1.17 * s * s * c - 0.3 * c * c * s + 1.57 * s * c);
    EXPECT_NEAR(force.dot(Vector3d(s, c, 0.0)), -drag, 1e-14);
    EXPECT_NEAR(force.dot(Vector3d(-c, s, 0.0)), lift, 1e-14);
    EXPECT_NEAR(force.z(), 0.0, 1e-15);
  }
}

TEST(Aerodynamics, OnlyTheVelocityRelativeToTheAirCounts) {
  const Air windy = gusty(kWithLift);
  const Cloth in_wind(square(4), limpFabric(), effectsOf(windy));
  const Cloth in_still_air(square(4), limpFabric(), effectsOf(still(kWithLift)));
  ClothState state = randomState(in_wind, 5e-3, 1.0);
  state.time = 0.37;
  const std::vector<Vector3d> forces = forcesOf(in_wind, state);
  const Vector3d wind = windy.wind.mean +
                        std::sin(2.0 * M_PI * 3.0 * 0.37 + 0.4) * windy.wind.gusts[0].velocity +
                        std::sin(2.0 * M_PI * 0.7 * 0.37) * windy.wind.gusts[1].velocity;
  for (Vector3d& velocity : state.velocities) velocity -= wind;
  const std::vector<Vector3d> moved = forcesOf(in_still_air, state);
  for (std::size_t i = 0; i < forces.size(); ++i) {
    EXPECT_LT((forces[i] - moved[i]).norm(), 1e-15);  // of forces near 1e-3 N
  }
}

TEST(Aerodynamics, AirAtRestNeverFeedsEnergy) {
  for (const AirCoefficients& coefficients :
       {kWithLift, kWithoutLift, AirCoefficients{0.0, 0.0, 1.57}}) {
    const Cloth cloth(square(4), limpFabric(), effectsOf(still(coefficients)));
    for (unsigned seed = 1; seed <= 20; ++seed) {
      const ClothState state = randomState(cloth, 5e-3, 1.0, seed);
      const std::vector<Vector3d> forces = forcesOf(cloth, state);
      double power = 0.0, scale = 0.0;
      for (std::size_t i = 0; i < forces.size(); ++i) {
        power += forces[i].dot(state.velocities[i]);
        scale += std::abs(forces[i].dot(state.velocities[i]));
      }
      EXPECT_LE(power, 1e-14 * scale);
      if (coefficients.normal > 0.0) {
        EXPECT_LT(power, -0.1 * scale);
      }
      EXPECT_EQ(cloth.forces().drivingPower(state.ofForces()), 0.0);
    }
  }
}

TEST(Aerodynamics, NothingMovesNoForceAndNoAreaNoForce) {
  const Cloth cloth(square(3), limpFabric(), effectsOf(still(kWithLift)));
  EXPECT_EQ(sumOf(forcesOf(cloth, cloth.initialState())), Vector3d::Zero());
  ClothState collapsed = movingAs(cloth, {1.0, 2.0, 3.0});
  for (Vector3d& position : collapsed.positions) position.setZero();
  for (const Vector3d& force : forcesOf(cloth, collapsed)) EXPECT_EQ(force, Vector3d::Zero());
  for (const JacobianBlock& block : cloth.jacobian(collapsed, {0, 5})) {
    EXPECT_TRUE(block.by_position.isZero(0.0) && block.by_velocity.isZero(0.0));
  }
}

TEST(Aerodynamics, JacobianIsTheDerivativeOfTheForces) {
  const Cloth cloth(square(2), limpFabric(), effectsOf(gusty(kWithLift)));
  ClothState state = randomState(cloth, 5e-3, 1.0);
  state.time = 0.2;
  std::vector<int> particles;
  for (int i = 0; i < static_cast<int>(cloth.particleCount()); ++i) particles.push_back(i);
  const std::vector<JacobianBlock> blocks = cloth.jacobian(state, particles);
  double largest_by_position = 0.0, largest_by_velocity = 0.0;
  for (const JacobianBlock& block : blocks) {
    largest_by_position = std::max(largest_by_position, block.by_position.cwiseAbs().maxCoeff());
    largest_by_velocity = std::max(largest_by_velocity, block.by_velocity.cwiseAbs().maxCoeff());
  }
  const auto difference = [&](double& coordinate, double step) {
    const double middle = coordinate;
    coordinate = middle + step;
    std::vector<Vector3d> result = forcesOf(cloth, state);
    coordinate = middle - step;
    const std::vector<Vector3d> below = forcesOf(cloth, state);
    coordinate = middle;
    for (std::size_t i = 0; i < result.size(); ++i) {
      result[i] = (result[i] - below[i]) / (2.0 * step);
    }
    return result;
  };
  for (const JacobianBlock& block : blocks) {
    for (int axis = 0; axis < 3; ++axis) {
      // Steps of 1e-5 of the size of what changes: errors near 1e-10 of the largest.
      const auto by_position = difference(state.positions[block.column][axis], 1e-7);
      const auto by_velocity = difference(state.velocities[block.column][axis], 1e-5);
      EXPECT_LT((block.by_position.col(axis) - by_position[block.row]).norm(),
                1e-7 * largest_by_position);
      EXPECT_LT((block.by_velocity.col(axis) - by_velocity[block.row]).norm(),
                1e-7 * largest_by_velocity);
    }
  }
}

/// matrix += -a D of the air on a cloth of one triangle, and dF/dw of the whole triangle.
struct OneTriangle {
  explicit OneTriangle(const AirCoefficients& coefficients, unsigned seed)
      : cloth(mesh(), limpFabric(), effectsOf(gusty(coefficients))),
        matrix(cloth.pattern()),
        rhs(linear::BlockVector::Zero(3, 3)) {
    state = randomState(cloth, 0.05, 3.0, seed);
    matrix.setZero();
    cloth.forces().find<Aerodynamics>()->assembleLinearised(state.ofForces(), {kA, 0.0}, matrix,
                                                            rhs);
    by_velocity = 9.0 * cloth.jacobian(state, {0}).front().by_velocity;
  }
  static mesh::ClothMesh mesh() {
    return {{{0, 0}, {0.1, 0}, {0, 0.1}}, {{0, 0, 0}, {0.1, 0, 0}, {0, 0.1, 0}}, {{0, 1, 2}}};
  }

  static constexpr double kA = 0.01;
  Cloth cloth;
  ClothState state;
  linear::SymmetricBlockMatrix matrix;
  linear::BlockVector rhs;
  Matrix3d by_velocity;
};

TEST(Aerodynamics, TheStepTakesTheNearestDampingThatTakesEnergyOut) {
  int clamped = 0;
  for (unsigned seed = 1; seed <= 50; ++seed) {
    for (const AirCoefficients& coefficients : {kWithLift, kWithoutLift}) {
      const OneTriangle one(coefficients, seed);
      const Matrix3d damping = -0.5 * (one.by_velocity + one.by_velocity.transpose());
      const Eigen::SelfAdjointEigenSolver<Matrix3d> eigen(damping);
      const Matrix3d nearest = eigen.eigenvectors() *
                               eigen.eigenvalues().cwiseMax(0.0).asDiagonal() *
                               eigen.eigenvectors().transpose();
      clamped += eigen.eigenvalues().minCoeff() < -1e-6 * nearest.norm();
      if (coefficients.lift == 0.0) {
        EXPECT_LT((damping + one.by_velocity).norm(), 1e-15);  // of about 0.02 N.s/m
        EXPECT_LT((nearest - damping).norm(), 1e-15);
      }
      const Eigen::MatrixXd all = dense(one.matrix);
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
          const Matrix3d block = all.block<3, 3>(3 * i, 3 * j);
          EXPECT_LT((block - OneTriangle::kA / 9.0 * nearest).norm(), 1e-13 * block.norm());
        }
      }
      const std::vector<Vector3d> forces = forcesOf(one.cloth, one.state);
      for (int i = 0; i < 3; ++i) {
        EXPECT_LT((one.rhs.col(i) - OneTriangle::kA * forces[i]).norm(), 1e-17);
      }
    }
  }
  EXPECT_GT(clamped, 5);
}

TEST(Aerodynamics, ANewtonIterationDescendsThePotentialOfFixedNormals) {
  const Cloth cloth(square(2), limpFabric(), effectsOf(gusty(kWithLift)));
  const Aerodynamics& air = *cloth.forces().find<Aerodynamics>();
  const ClothState at = randomState(cloth, 5e-3, 1.0, 1);
  ClothState state = randomState(cloth, 5e-3, 1.0, 2);
  const std::vector<Vector3d> held = heldBefore(air, {at.positions, at.velocities, 0.3}, 1.0);
  constexpr double kA = 0.004;
  const auto gradient = [&](const Velocities& velocities, Eigen::MatrixXd* hessian) {
    linear::SymmetricBlockMatrix matrix = cloth.pattern();
    matrix.setZero();
    linear::BlockVector rhs = linear::BlockVector::Zero(3, cloth.particleCount());
    air.assembleNewton({state.positions, velocities}, held.data(), kA, Hessian::kExact, matrix,
                       rhs);
    if (hessian != nullptr) *hessian = dense(matrix);
    return Eigen::VectorXd(-stacked(rhs));
  };
  // By velocities: rhs is minus the gradient, the matrix the Hessian.
  Eigen::MatrixXd hessian;
  const Eigen::VectorXd exact = gradient(state.velocities, &hessian);
  constexpr double kStep = 1e-4;  // of 1 m/s
  for (int i = 0; i < exact.size(); ++i) {
    double& coordinate = state.velocities[i / 3][i % 3];
    const double middle = coordinate;
    coordinate = middle + kStep;
    const double above = air.incrementalPotential(state.ofForces(), held.data(), kA);
    const Eigen::VectorXd gradient_above = gradient(state.velocities, nullptr);
    coordinate = middle - kStep;
    const double below = air.incrementalPotential(state.ofForces(), held.data(), kA);
    const Eigen::VectorXd gradient_below = gradient(state.velocities, nullptr);
    coordinate = middle;
    EXPECT_NEAR((above - below) / (2.0 * kStep), exact[i], 1e-7 * exact.norm());
    EXPECT_LT(((gradient_above - gradient_below) / (2.0 * kStep) - hessian.col(i)).norm(),
              1e-7 * hessian.norm());
  }
  EXPECT_GE(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(hessian).eigenvalues().minCoeff(),
            -1e-15 * hessian.norm());
  // Where it was fixed the gradient is that of the forces.
  ClothState there = at;
  there.time = 0.3;
  const Eigen::VectorXd at_fixed = gradient(at.velocities, nullptr);
  const std::vector<Vector3d> forces = forcesOf(cloth, there);
  for (std::size_t i = 0; i < forces.size(); ++i) {
    EXPECT_LT((at_fixed.segment<3>(3 * i) + kA * forces[i]).norm(), 1e-17);
  }
}

TEST(Aerodynamics, RefusesWhatIsNotPhysical) {
  const auto refusal = [](const Air& air) -> std::string {
    return test::refusalOf([&] { Cloth(square(2), limpFabric(), effectsOf(air)); });
  };
  Air air;
  air.coefficients.normal = -1.0;
  EXPECT_EQ(refusal(air),
            "the normal coefficient of the air is -1; it must be finite and at least 0");
  air = Air();
  air.coefficients.lift = std::nan("");
  EXPECT_NE(refusal(air).find("lift coefficient"), std::string::npos);
  air = Air();
  air.wind.mean.x() = std::nan("");
  EXPECT_EQ(refusal(air), "the wind has a component that is not finite");
  air = Air();
  air.wind.gusts = {{}, {Vector3d::Zero(), -0.5, 0.0}};
  EXPECT_EQ(refusal(air),
            "gust 1 of the wind has the frequency -0.5 Hz; it must be finite and at least 0");
  air.wind.gusts[1] = {Vector3d::Zero(), 0.5, std::nan("")};
  EXPECT_EQ(refusal(air), "gust 1 of the wind has a number that is not finite");
}

}  // namespace
}  // namespace haptex::cloth::test_aerodynamics
