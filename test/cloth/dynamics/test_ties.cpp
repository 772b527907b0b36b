// Particles that are sewn to others by exact constraints.
#include <gtest/gtest.h>

#include <cmath>
#include <tuple>

#include "../../refusal.h"
#include "haptex/cloth/dynamics/cloth_part.h"
#include "haptex/cloth/dynamics/integrator.h"
#include "seam_fixtures.h"

namespace haptex::cloth::test_ties {
namespace {

using test::refusalOf;

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

ModelledEffects viscousEffects() {
  ModelledEffects effects;
  effects.viscosity = true;
  effects.gravity = {1.0, 2.0, -9.8};
  effects.air = Air{};
  return effects;
}

material::Fabric bendingFabric() {
  material::Fabric fabric = stiffeningFabric();
  fabric.bending = {1e-5, 2e-5};
  return fabric;
}

VectorXd stacked(const std::vector<Vector3d>& vectors) {
  VectorXd all(3 * static_cast<Eigen::Index>(vectors.size()));
  for (std::size_t i = 0; i < vectors.size(); ++i) {
    all.segment<3>(3 * static_cast<Eigen::Index>(i)) = vectors[i];
  }
  return all;
}

TEST(Ties, SystemForcesAndJacobianAreThoseOfTheFreeParticles) {
  ModelledEffects effects = viscousEffects();
  effects.bending = true;
  effects.gravity.setZero();
  mesh::ClothMesh open_mesh = sewnHalves(4, 6);
  open_mesh.ties.clear();
  const Cloth open(open_mesh, bendingFabric(), effects);
  const Cloth sewn(sewnHalves(4, 6), bendingFabric(), effects);
  const ClothState state = randomSewnState(sewn, 0.002, 0.5);
  const MatrixXd ties = denseTies(sewn);
  std::vector<Vector3d> forces, open_forces;
  sewn.computeForces(state, forces);
  open.computeForces(state, open_forces);
  const VectorXd expected = ties.transpose() * stacked(open_forces);
  EXPECT_LT((stacked(forces) - expected).norm(), 1e-12 * expected.norm());

  const auto assemble = [&](const Cloth& cloth, linear::BlockVector& rhs) {
    linear::SymmetricBlockMatrix matrix = cloth.pattern();
    rhs.setZero(3, matrix.size());
    cloth.forces().assembleLinearised(state.ofForces(), {0.01, 0.01}, matrix, rhs);
    return dense(matrix);
  };
  linear::BlockVector rhs, open_rhs;
  MatrixXd matrix = assemble(sewn, rhs);
  const MatrixXd open_matrix = assemble(open, open_rhs);
  for (const mesh::ResolvedTie& tie : sewn.ties().resolved()) {
    EXPECT_TRUE((matrix.block<3, 3>(3 * tie.particle, 3 * tie.particle).isIdentity(0.0)));
    matrix.block<3, 3>(3 * tie.particle, 3 * tie.particle).setZero();
  }
  const MatrixXd expected_matrix = ties.transpose() * open_matrix * ties;
  EXPECT_LT((matrix - expected_matrix).norm(), 1e-12 * expected_matrix.norm());
  const VectorXd expected_rhs =
      ties.transpose() * Eigen::Map<const VectorXd>(open_rhs.data(), open_rhs.size());
  EXPECT_LT((Eigen::Map<const VectorXd>(rhs.data(), rhs.size()) - expected_rhs).norm(),
            1e-12 * expected_rhs.norm());

  std::vector<int> all(sewn.particleCount());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<int>(i);
  const auto jacobian = [&](const Cloth& cloth) {
    MatrixXd result = MatrixXd::Zero(matrix.rows(), matrix.cols());
    for (const JacobianBlock& block : cloth.jacobian(state, all)) {
      result.block<3, 3>(3 * block.row, 3 * block.column) += block.by_position + block.by_velocity;
    }
    return result;
  };
  const MatrixXd expected_jacobian = ties.transpose() * jacobian(open) * ties;
  EXPECT_LT((jacobian(sewn) - expected_jacobian).norm(), 1e-12 * expected_jacobian.norm());
}

TEST(Ties, MassGoesToTheFreeParticlesAndKeepsSumAndCentre) {
  const Cloth sewn(sewnHalves(6, 10), linearFabric(), {});
  double mass = 0.0;
  Vector3d centre = Vector3d::Zero();
  for (std::size_t i = 0; i < sewn.particleCount(); ++i) {
    mass += sewn.masses()[i];
    centre += sewn.masses()[i] * sewn.mesh().initial_positions[i];
    EXPECT_EQ(sewn.masses()[i] == 0.0, sewn.ties().isTied(static_cast<int>(i)));
  }
  EXPECT_NEAR(mass, 0.1 * 0.1 * 0.1, 1e-17);
  EXPECT_LT((centre / mass - Vector3d(0.05, 0.05, 0.0)).norm(), 1e-15);
}

class SewnSteps : public testing::TestWithParam<
                      std::tuple<NamedIntegrationMethod, linear::LinearSolverMethod, int>> {};

/// Ties of matched particles are a mesh in one piece: this one has the same triangles.
TEST_P(SewnSteps, OfMatchedEdgesAreThoseOfOneMesh) {
  const auto& [method, solver, newton_iterations] = GetParam();
  Halves made = halves(4, 4);
  const mesh::MergedMesh merged = mesh::merge(made.mesh, {made.seam});
  mesh::sew(made.mesh, {made.seam});
  const ModelledEffects effects = viscousEffects();
  Cloth sewn(made.mesh, stiffeningFabric(), effects);
  Cloth whole(merged.mesh, stiffeningFabric(), effects);
  ASSERT_EQ(whole.particleCount() + made.seam.first.size(), sewn.particleCount());
  StepSettings settings;
  settings.method = method.method;
  settings.solver = solver;
  settings.newton_iterations = newton_iterations;
  settings.tolerance = 1e-10;
  Integrator of_sewn(sewn, settings), of_whole(whole, settings);
  ClothState sewn_state = randomSewnState(sewn, 1e-4, 0.05);
  ClothState state = whole.initialState();
  for (std::size_t i = 0; i < sewn.particleCount(); ++i) {
    state.positions[merged.particles[i]] = sewn_state.positions[i];
    state.velocities[merged.particles[i]] = sewn_state.velocities[i];
  }
  for (const int i : {0, 3}) {
    AttachmentPath path{sewn_state.positions[made.seam.first[i]], {0.0, 0.0, 0.01}, 0.0, 0.05};
    sewn.attach(made.seam.first[i], path);
    whole.attach(merged.particles[made.seam.first[i]], path);
  }
  const double h = isImplicit(method.method) ? 5e-3 : 1e-5;
  for (int step = 0; step < 10; ++step) {
    ASSERT_TRUE(of_sewn.step(sewn, sewn_state, h).accepted);
    ASSERT_TRUE(of_whole.step(whole, state, h).accepted);
    EXPECT_LT(largestGap(sewn, sewn_state), 1e-16);
  }
  // What is left is the solver's tolerance; the step moves particles by millimetres.
  for (std::size_t i = 0; i < sewn.particleCount(); ++i) {
    EXPECT_LT((sewn_state.positions[i] - state.positions[merged.particles[i]]).norm(), 1e-10);
  }
}

std::vector<std::tuple<NamedIntegrationMethod, linear::LinearSolverMethod, int>> ways() {
  using linear::LinearSolverMethod;
  std::vector<std::tuple<NamedIntegrationMethod, LinearSolverMethod, int>> all;
  for (const NamedIntegrationMethod& method : kIntegrationMethods) {
    all.emplace_back(method, LinearSolverMethod::kAutomatic, 1);
    if (!isImplicit(method.method)) continue;
    all.emplace_back(method, LinearSolverMethod::kAutomatic, 5);
    all.emplace_back(method, LinearSolverMethod::kCholesky, 1);
    all.emplace_back(method, LinearSolverMethod::kConjugateGradient, 1);
  }
  return all;
}
INSTANTIATE_TEST_SUITE_P(Ways, SewnSteps, testing::ValuesIn(ways()));

TEST(Ties, AFreeSewnClothKeepsItsMomentum) {
  ModelledEffects effects;
  effects.viscosity = true;
  const Cloth cloth(sewnHalves(6, 10), stiffeningFabric(), effects);
  for (const NamedIntegrationMethod& method : kIntegrationMethods) {
    StepSettings settings;
    settings.method = method.method;
    settings.solver = linear::LinearSolverMethod::kCholesky;
    settings.tolerance = 1e-12;
    Integrator integrator(cloth, settings);
    ClothState state = randomSewnState(cloth, 1e-4, 0.05);
    const Vector3d before = cloth.momentum(state);
    double scale = 0.0;
    for (std::size_t i = 0; i < cloth.particleCount(); ++i) {
      scale += cloth.masses()[i] * state.velocities[i].norm();
    }
    for (int step = 0; step < 5; ++step) {
      const StepReport report =
          integrator.step(cloth, state, isImplicit(method.method) ? 2e-3 : 1e-5);
      ASSERT_TRUE(report.accepted);
      ASSERT_EQ(report.energy_taken, 0.0);
    }
    EXPECT_LT((cloth.momentum(state) - before).norm(), 1e-11 * scale) << method.name;
  }
}

TEST(Ties, ContactsOfFreeParticlesHoldASewnCloth) {
  ModelledEffects effects;
  effects.gravity = {0.0, 0.0, -9.8};
  effects.contacts = true;
  Cloth cloth(sewnHalves(4, 6), linearFabric(), effects);
  std::vector<ParticleContact> contacts;
  for (std::size_t i = 0; i < cloth.particleCount(); ++i) {
    contacts.push_back({static_cast<int>(i), Vector3d::UnitZ(), Vector3d::Zero(), 0.0,
                        Vector3d::Zero(), 0.3, 0.0});
  }
  Integrator integrator(cloth, {});
  ClothState state = cloth.initialState();
  for (int step = 0; step < 20; ++step) {
    for (ParticleContact& contact : contacts) {
      contact.place = {state.positions[contact.particle].x(), state.positions[contact.particle].y(),
                       0.0};
      contact.end = state.time + 0.01;
    }
    cloth.setContacts(contacts);
    ASSERT_TRUE(integrator.step(cloth, state, 0.01).accepted);
  }
  double load = 0.0;
  for (const ContactReaction& reaction : integrator.contactReactions()) load += reaction.force.z();
  EXPECT_NEAR(load, 9.8 * 1e-3, 1e-8);
  for (const Vector3d& position : state.positions) EXPECT_NEAR(position.z(), 0.0, 1e-8);
  EXPECT_LT(largestGap(cloth, state), 1e-16);
}

TEST(Ties, AnOpenSeamClosesAtTheSpeedThatIsAskedForAndHolds) {
  constexpr double kGap = 0.03, kSpeed = 0.2, kStep = 5e-3;
  for (const NamedIntegrationMethod& method : kIntegrationMethods) {
    if (!isImplicit(method.method)) continue;
    mesh::ClothMesh mesh = sewnHalves(4, 6);
    for (std::size_t i = 0; i < mesh.initial_positions.size(); ++i) {
      if (mesh.rest_coordinates[i].x() > 0.0501) mesh.initial_positions[i].x() += kGap;
    }
    for (const mesh::Tie& tie : mesh.ties) mesh.initial_positions[tie.particle].x() += kGap;
    Cloth cloth(mesh, linearFabric(0.5), {});
    ClothState state = cloth.initialState();
    EXPECT_LT(largestGap(cloth, state), 1e-16);
    state.positions = mesh.initial_positions;
    cloth.closeSeams(state, kSpeed);
    EXPECT_NEAR(cloth.seamGap(0.0), kGap, 1e-15);
    StepSettings settings;
    settings.method = method.method;
    Integrator integrator(cloth, settings);
    for (int step = 1; step <= 40; ++step) {
      ASSERT_TRUE(integrator.step(cloth, state, kStep).accepted) << method.name;
      EXPECT_NEAR(largestGap(cloth, state), std::max(0.0, kGap - kSpeed * step * kStep), 1e-14);
    }
    EXPECT_EQ(cloth.seamGap(state.time), 0.0);
    // 30 mm in 0.15 s: no particle was ever much faster than the seam.
    for (const Vector3d& velocity : state.velocities) EXPECT_LT(velocity.norm(), 2.0 * kSpeed);
  }
}

TEST(Ties, WhatCannotBeDoneWithThemIsRefused) {
  mesh::ClothMesh mesh = sewnHalves(2, 2);
  Cloth cloth(mesh, linearFabric(), {});
  const int tied = cloth.ties().resolved().front().particle;
  EXPECT_NE(refusalOf([&] { cloth.attach(tied, {}); }).find("is sewn to the edge"),
            std::string::npos);
  EXPECT_NE(refusalOf([&] { cloth.closeSeams(cloth.initialState(), 0.0); }).find("0 m/s"),
            std::string::npos);
  EXPECT_NE(refusalOf([&] { cloth.closeSeams(cloth.initialState(), std::nan("")); }).find("nan"),
            std::string::npos);
  const std::vector<char> all(cloth.particleCount(), 1);
  EXPECT_NE(refusalOf([&] { ClothPart(cloth, all); }).find("tied"), std::string::npos);
  mesh.ties[0].ends[0] = mesh.ties[0].particle;
  EXPECT_NE(refusalOf([&] { Cloth(mesh, linearFabric(), {}); }).find("tied to itself"),
            std::string::npos);
}

}  // namespace
}  // namespace haptex::cloth::test_ties
