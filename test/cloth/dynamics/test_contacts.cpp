#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <string>

#include "fixtures.h"
#include "haptex/cloth/dynamics/integrator.h"

namespace haptex::cloth::test_contacts {
namespace {

using Eigen::Vector3d;

ModelledEffects withContacts(const Vector3d& gravity = Vector3d::Zero()) {
  ModelledEffects effects;
  effects.contacts = true;
  effects.gravity = gravity;
  return effects;
}

/// A contact that a particle at rest just touches.
ParticleContact touching(const ClothState& state, int particle, const Vector3d& normal,
                         double friction, double h) {
  return {particle, normal,        state.positions[particle], 0.0, Vector3d::Zero(),
          friction, state.time + h};
}

TEST(SymmetricBlockMatrix, ConfinesLikeTheDenseProjection) {
  const mesh::ClothMesh mesh = square(3);
  linear::SymmetricBlockMatrix matrix = randomDefinite(mesh, 10.0);
  const int size = matrix.size();
  linear::BlockVector rhs = linear::BlockVector::Random(3, size),
                      normals = linear::BlockVector::Random(3, size);
  linear::BlockVector values = linear::BlockVector::Zero(3, size);
  std::vector<char> confined(size, 0);
  Eigen::MatrixXd projection = Eigen::MatrixXd::Identity(3 * size, 3 * size);
  for (const int i : {0, 1, 5, 10}) {  // 0, 1 and 5 are neighbours of each other
    confined[i] = 1;
    normals.col(i).normalize();
    values.col(i) = 0.3 * (i + 1) * normals.col(i);
    projection.block<3, 3>(3 * i, 3 * i) -= normals.col(i) * normals.col(i).transpose();
  }
  const Eigen::MatrixXd before = dense(matrix);
  const Eigen::VectorXd right = stacked(rhs) - before * stacked(values);
  matrix.confine(confined, normals, values, rhs);
  const Eigen::VectorXd found = dense(matrix).ldlt().solve(stacked(rhs));
  // Minimum of the quadratic form over the subspace, by the pseudo-inverse.
  const Eigen::VectorXd exact = (projection * before * projection)
                                    .completeOrthogonalDecomposition()
                                    .solve(projection * right);
  EXPECT_LT((found - exact).norm(), 1e-12 * exact.norm());
}

struct BadContact {
  std::string part;
  std::function<void(ParticleContact&)> spoil;
};

TEST(Contacts, AreRefusedWithTheReasonAndNothingChanges) {
  Cloth cloth(square(2), linearFabric(), withContacts());
  const ParticleContact good = touching(cloth.initialState(), 4, Vector3d::UnitZ(), 0.2, 0.01);
  cloth.setContacts({good});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<BadContact> bad = {
      {"contact 1: particle 9 does not exist", [](auto& contact) { contact.particle = 9; }},
      {"contact 1: particle -1 does not exist", [](auto& contact) { contact.particle = -1; }},
      {"contact 1: particle 4 has another", [](auto& contact) { contact.particle = 4; }},
      {"contact 1: the normal has the length 2", [](auto& contact) { contact.normal *= 2.0; }},
      {"contact 1: friction is -1", [](auto& contact) { contact.friction = -1.0; }},
      {"contact 1: a number is not finite", [&](auto& contact) { contact.gap = nan; }},
      {"contact 1: a number is not finite", [&](auto& contact) { contact.friction = nan; }}};
  for (const BadContact& each : bad) {
    ParticleContact contact = good;
    contact.particle = 5;
    each.spoil(contact);
    try {
      cloth.setContacts({good, contact});
      ADD_FAILURE() << each.part;
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find(each.part), std::string::npos) << error.what();
    }
    EXPECT_EQ(cloth.contacts().size(), 1u);
  }
  Cloth without(square(2), linearFabric(), {});
  EXPECT_THROW(without.setContacts({}), std::invalid_argument);
}

class ImplicitContacts : public testing::TestWithParam<NamedIntegrationMethod> {
 protected:
  StepSettings settings(int newton_iterations) const {
    StepSettings settings;
    settings.method = GetParam().method;
    settings.newton_iterations = newton_iterations;
    settings.tolerance = 1e-10;
    return settings;
  }
};

// Signorini's conditions, for a sheet of which two particles are supported from below and one is
// held down from above, while gravity pulls all of it.
TEST_P(ImplicitContacts, PushButNeverPullAndAreNeverPassed) {
  for (const int newton_iterations : {1, 20}) {
    Cloth cloth(square(3), linearFabric(0.1), withContacts({0.0, 0.0, -9.81}));
    ClothState state = cloth.initialState();
    Integrator integrator(cloth, settings(newton_iterations));
    const ClothState start = state;
    for (int step = 0; step < 30; ++step) {
      const double h = 0.005;
      std::vector<ParticleContact> contacts;
      for (const int particle : {0, 3, 14}) {
        const Vector3d normal = particle == 14 ? Vector3d(0, 0, -1) : Vector3d(0, 0, 1);
        ParticleContact contact = touching(state, particle, normal, 0.0, h);
        contact.gap = normal.dot(state.positions[particle] - start.positions[particle]);
        contacts.push_back(contact);
      }
      cloth.setContacts(contacts);
      ASSERT_TRUE(integrator.step(cloth, state, h).accepted);
      for (std::size_t i = 0; i < contacts.size(); ++i) {
        const int particle = contacts[i].particle;
        const double gap =
            contacts[i].normal.dot(state.positions[particle] - start.positions[particle]);
        const ContactReaction& reaction = integrator.contactReactions()[i];
        // 1 nm is the penetration that the rounds let pass.
        EXPECT_GE(gap, -2e-9) << GetParam().name << ' ' << step;
        if (newton_iterations == 1) {
          EXPECT_GE(contacts[i].normal.dot(reaction.force), 0.0);
        }
        if (reaction.state == ContactReaction::State::kOpen) {
          EXPECT_EQ(reaction.force, Vector3d::Zero());
        } else {
          EXPECT_NEAR(gap, 0.0, 2e-9);
        }
      }
    }
  }
}

// Coulomb's law of a whole sheet on a level plane, drawn sideways by a force on every particle.
TEST_P(ImplicitContacts, StickBelowTheLimitAndSlipAsFastAsMechanicsSaysAboveIt) {
  constexpr double kFriction = 0.4;
  const double h = 0.01, g = 9.81;
  for (const double pull : {0.3, 0.6}) {  // of the weight
    Cloth cloth(square(3), linearFabric(0.1), withContacts({pull * g, 0.0, 0.0}));
    ClothState state = cloth.initialState();  // in the plane x = 0
    for (std::size_t i = 0; i < cloth.particleCount(); ++i) {
      cloth.setExternalForce(static_cast<int>(i), {0.0, 0.0, -cloth.masses()[i] * g});
    }
    Integrator integrator(cloth, settings(1));
    const ClothState start = state;
    for (int step = 0; step < 20; ++step) {
      std::vector<ParticleContact> contacts;
      for (std::size_t i = 0; i < cloth.particleCount(); ++i) {
        contacts.push_back(touching(state, static_cast<int>(i), Vector3d::UnitZ(), kFriction, h));
      }
      cloth.setContacts(contacts);
      ASSERT_TRUE(integrator.step(cloth, state, h).accepted);
    }
    const double speed = std::max(0.0, pull - kFriction) * g * 20 * h;
    for (std::size_t i = 0; i < cloth.particleCount(); ++i) {
      EXPECT_NEAR(state.velocities[i].x(), speed, 1e-6) << GetParam().name;
      EXPECT_NEAR(state.positions[i].z(), start.positions[i].z(), 1e-12);
      if (speed == 0.0) {
        EXPECT_NEAR(state.positions[i].x(), 0.0, 1e-15);
      }
    }
  }
}

// The particle's place is that of the body in every stage, so it is exactly there at the end.
TEST_P(ImplicitContacts, CarryWhatSticksWithTheBody) {
  const double h = 0.01;
  const Vector3d velocity(0.0, 0.2, 0.1);
  Cloth cloth(square(2), linearFabric(), withContacts({0.0, 0.0, -9.81}));
  ClothState state = cloth.initialState();
  Integrator integrator(cloth, settings(1));
  const Vector3d start = state.positions[4];
  for (int step = 1; step <= 10; ++step) {
    ParticleContact contact = touching(state, 4, Vector3d::UnitZ(), 1e3, h);
    contact.place += h * velocity;
    contact.velocity = velocity;
    cloth.setContacts({contact});
    ASSERT_TRUE(integrator.step(cloth, state, h).accepted);
    EXPECT_LT((state.positions[4] - start - step * h * velocity).norm(), 1e-14) << GetParam().name;
    EXPECT_LT((state.velocities[4] - velocity).norm(), 1e-12) << GetParam().name;
  }
}

INSTANTIATE_TEST_SUITE_P(Methods, ImplicitContacts,
                         testing::Values(kIntegrationMethods[0], kIntegrationMethods[1],
                                         kIntegrationMethods[2], kIntegrationMethods[3]),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace haptex::cloth::test_contacts
