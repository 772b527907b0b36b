#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <iostream>

#include "emulator_fixtures.h"
#include "haptex/exoskeleton/emulator/emulated_finger.h"

namespace haptex::exoskeleton::test_emulated_finger {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kPeriod = 1.0 / 8000.0;  // s

FingerMechanics withoutFriction() {
  FingerMechanics mechanics;
  mechanics.coulomb_friction = mechanics.viscous_friction = 0.0;
  return mechanics;
}

FingerMechanics withoutLosses() {
  FingerMechanics mechanics = withoutFriction();
  mechanics.stop_damping = mechanics.pulp_damping = 0.0;
  mechanics.fingertip_damping = mechanics.relaxed_damping = 0.0;
  return mechanics;
}

void run(EmulatedFinger& finger, const MotorVector& torques, double duration,
         double period = kPeriod) {
  const int steps = static_cast<int>(std::lround(duration / period));
  for (int i = 0; i < steps; ++i) finger.step(torques, period);
}

class EmulatedFingerOf : public testing::TestWithParam<Finger> {
 protected:
  EmulatedFinger finger(const FingerMechanics& mechanics) const {
    return EmulatedFinger(shippedUrdf(), GetParam(), mechanics);
  }

  std::mt19937 generator_{1};
};

// How far the energy strays after a kick, relative to the energy of the kick.
double energyError(EmulatedFinger&& finger, double period) {
  const double rest = finger.energy();
  run(finger, finger.motorJacobian().transpose() * Vector3d(0.5, 2.0, 1.0), 0.01, period);
  const double kicked = finger.energy();
  double error = 0.0;
  for (double time = 0.0; time < 1.0; time += period) {
    finger.step(MotorVector::Zero(), period);
    error = std::max(error, std::abs(finger.energy() - kicked));
  }
  return error / (kicked - rest);
}

TEST_P(EmulatedFingerOf, ConservesEnergyButForTheIntegratorsErrorOfFirstOrder) {
  const double coarse = energyError(finger(withoutLosses()), kPeriod);
  EXPECT_LT(coarse, 0.05);
  EXPECT_LT(energyError(finger(withoutLosses()), kPeriod / 8.0), coarse / 6.0);
}

TEST_P(EmulatedFingerOf, LosesEnergyToFriction) {
  EmulatedFinger finger = this->finger({});
  run(finger, finger.motorJacobian().transpose() * Vector3d(0.5, 2.0, 1.0), 0.01);
  double before = finger.energy();
  const double kicked = before;
  for (int i = 0; i < 100; ++i) {
    run(finger, MotorVector::Zero(), 0.001);
    EXPECT_LT(finger.energy(), before + 1e-4 * std::abs(kicked)) << i << " ms";
    before = finger.energy();
  }
  EXPECT_LT(before, kicked);
}

TEST_P(EmulatedFingerOf, RestsWhereTheTorquesAreTheJacobianTimesTheForce) {
  FingerMechanics mechanics = withoutFriction();
  mechanics.gravity.setZero();
  EmulatedFinger finger = this->finger(mechanics);
  for (int trial = 0; trial < 10; ++trial) {
    finger.place(randomAngles(finger, generator_, 0.4));
    const MotorVector torques =
        0.3 * finger.motorJacobian().transpose() * randomDirection(generator_);
    run(finger, torques, 3.0);
    const Vector3d expected = finger.motorJacobian().transpose().inverse() * torques;
    EXPECT_LT((finger.contactForce() - expected).norm(), 1e-6);
    EXPECT_LT((finger.forceOf(torques) - expected).norm(), 1e-9);
  }
}

TEST_P(EmulatedFingerOf, WeighsOnThePersonsFinger) {
  EmulatedFinger finger = this->finger(withoutFriction());
  EmulatedLinkage linkage(shippedUrdf(), GetParam());
  FingerKinematics kinematics(shippedUrdf(), GetParam());
  run(finger, MotorVector::Zero(), 2.0);
  // By virtual work on the driven joints: the change of potential energy per motor angle.
  const double h = 1e-4;
  MotorVector weight;
  for (int i = 0; i < kMotors; ++i) {
    linkage.setAngles(kinematics.jointAngles(finger.motorAngles() + h * MotorVector::Unit(i)));
    const double above = linkage.potentialEnergy(FingerMechanics().gravity);
    linkage.setAngles(kinematics.jointAngles(finger.motorAngles() - h * MotorVector::Unit(i)));
    weight[i] = (above - linkage.potentialEnergy(FingerMechanics().gravity)) / (2.0 * h);
  }
  const Vector3d expected = -(finger.motorJacobian().transpose().inverse() * weight);
  EXPECT_GT(expected.norm(), 0.02);
  EXPECT_LT((finger.contactForce() - expected).norm(), 1e-6);
}

TEST_P(EmulatedFingerOf, SticksForEverBelowTheCoulombFriction) {
  FingerMechanics mechanics;
  mechanics.gravity.setZero();
  EmulatedFinger finger = this->finger(mechanics);
  finger.relax(true);  // nothing but friction holds the device
  const MotorVector start = finger.motorAngles();
  const double give = mechanics.coulomb_friction / mechanics.presliding_stiffness;
  // A load that swings between nine and one tenth of the friction, under which LuGre's bristles
  // creep.
  double farthest = 0.0;
  for (int i = 0; i < 80000; ++i) {
    const double share = 0.5 - 0.4 * std::cos(2.0 * 3.14159265 * 5.0 * i * kPeriod);
    finger.step(MotorVector::Constant(share * mechanics.coulomb_friction), kPeriod);
    farthest = std::max(farthest, (finger.motorAngles() - start).cwiseAbs().maxCoeff());
  }
  EXPECT_LT(farthest, give);
  run(finger, MotorVector::Zero(), 1.0);
  EXPECT_LT((finger.motorAngles() - start).norm(), 1e-2 * give) << "it has crept";

  for (int motor = 0; motor < kMotors; ++motor) {
    finger.place(start);
    finger.relax(true);
    run(finger, 1.5 * mechanics.coulomb_friction * MotorVector::Unit(motor), 0.2);
    EXPECT_GT(finger.motorAngles()[motor] - start[motor], 10.0 * give) << "motor " << motor;
  }
}

TEST_P(EmulatedFingerOf, IsHeldByItsStops) {
  const FingerMechanics mechanics;
  EmulatedFinger finger = this->finger(mechanics);
  const double torque = 0.03;  // N m, as much as forces of 5 N need
  for (const double sign : {-1.0, 1.0}) {
    finger.relax(true);
    double farthest = 0.0;
    for (int i = 0; i < 8000; ++i) {
      finger.step(MotorVector::Constant(sign * torque), kPeriod);
      const MotorVector beyond = (finger.lowest() - finger.motorAngles())
                                     .cwiseMax(finger.motorAngles() - finger.highest());
      farthest = std::max(farthest, beyond.maxCoeff());
    }
    const MotorVector stops = sign < 0.0 ? finger.lowest() : finger.highest();
    const MotorVector into = sign * (finger.motorAngles() - stops);
    // At rest the stop carries the torque but for friction and weight; the impact of a device that
    // is thrown at it takes it further in.
    EXPECT_LT((into.array() - torque / mechanics.stop_stiffness).abs().maxCoeff(), 0.004);
    EXPECT_LT(finger.motorVelocities().norm(), 1e-6);
    EXPECT_LT(farthest / kReduction, 0.05);
  }
}

TEST_P(EmulatedFingerOf, LetsItselfBeMovedWhileItIsRelaxedAndComesBackSmoothly) {
  FingerMechanics mechanics;
  mechanics.gravity.setZero();
  EmulatedFinger finger = this->finger(mechanics);
  const Vector3d wanted = finger.fingertip();
  finger.relax(true);
  double largest = 0.0;
  const auto observe = [&](const MotorVector& torques, double duration) {
    for (double time = 0.0; time < duration; time += kPeriod) {
      finger.step(torques, kPeriod);
      largest = std::max(largest, finger.contactForce().norm());
    }
  };
  const MotorVector pull = finger.motorJacobian().transpose() * Vector3d(0.0, 0.0, -0.2);
  observe(pull, 0.15);
  EXPECT_GT((finger.fingertip() - wanted).norm(), 0.01);
  EXPECT_LT(largest, 0.3);
  largest = 0.0;
  finger.relax(false);
  observe(MotorVector::Zero(), EmulatedFinger::kReturn);
  EXPECT_LT(largest, 1.5);  // it stops the device first
  observe(MotorVector::Zero(), 0.2);
  EXPECT_LT((finger.fingertip() - wanted).norm(), 0.001);
}

TEST_P(EmulatedFingerOf, NeverMovesItsTargetFasterThanAPersonDoes) {
  EmulatedFinger finger = this->finger({});
  run(finger, MotorVector::Zero(), 0.5);
  finger.place(finger.lowest() + 0.3 * (finger.highest() - finger.lowest()));
  const Vector3d start = finger.fingertip();
  EmulatedFinger there = this->finger({});
  there.place(finger.lowest() + 0.7 * (finger.highest() - finger.lowest()));
  const Vector3d target = there.fingertip();
  finger.setTarget(target);
  double largest = 0.0, fastest = 0.0;
  Vector3d before = start;
  for (int i = 0; i < 8000; ++i) {
    finger.step(MotorVector::Zero(), kPeriod);
    largest = std::max(largest, finger.contactForce().norm());
    fastest = std::max(fastest, (finger.fingertip() - before).norm() / kPeriod);
    before = finger.fingertip();
  }
  EXPECT_LT((finger.fingertip() - target).norm(), 0.001);
  EXPECT_LT(fastest, 1.5 * EmulatedFinger::kTargetSpeed);
  EXPECT_LT(largest, 2.0);
}

TEST_P(EmulatedFingerOf, StaysFiniteUnderAnyTorques) {
  EmulatedFinger finger = this->finger({});
  std::uniform_real_distribution<double> torque(-0.06, 0.06);
  double largest = 0.0;
  for (int i = 0; i < 400; ++i) {
    const MotorVector torques(torque(generator_), torque(generator_), torque(generator_));
    finger.relax(i % 7 == 0);
    run(finger, torques, 0.025);
    ASSERT_TRUE(finger.contactForce().allFinite());
    largest = std::max(largest, finger.contactForce().norm());
  }
  // The largest torque at the shortest lever, and the blows against stops and pulp.
  EXPECT_LT(largest, 120.0);
}

// kg along the principal directions, ascending: Khatib's operational space inertia.
Vector3d apparentMasses(const EmulatedFinger& finger) {
  const Matrix3d& jacobian = finger.motorJacobian();
  const Matrix3d mobility = jacobian * finger.massMatrix().inverse() * jacobian.transpose();
  return Eigen::SelfAdjointEigenSolver<Matrix3d>(mobility).eigenvalues().cwiseInverse().reverse();
}

TEST_P(EmulatedFingerOf, AddsLittleMassToTheFingertip) {
  EmulatedFinger finger = this->finger({});
  double sum = 0.0;
  constexpr int kTrials = 200;
  for (int trial = 0; trial < kTrials; ++trial) {
    finger.place(randomAngles(finger, generator_, 0.15));
    sum += apparentMasses(finger)[1];
  }
  finger.place(0.5 * (finger.lowest() + finger.highest()));
  std::cout << name(GetParam()) << ": apparent masses at the fingertip, middle of the limits: "
            << 1e3 * apparentMasses(finger).transpose()
            << " g; mean of the middle one of all poses " << 1e3 * sum / kTrials << " g\n";
  EXPECT_LT(sum / kTrials, 0.03);
  EXPECT_LT(apparentMasses(finger)[0], 0.015);
}

INSTANTIATE_TEST_SUITE_P(Both, EmulatedFingerOf, testing::ValuesIn(kFingers),
                         [](const auto& info) { return std::string(name(info.param)); });

}  // namespace
}  // namespace haptex::exoskeleton::test_emulated_finger
