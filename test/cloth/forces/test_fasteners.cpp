#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <string>

#include "../../refusal.h"
#include "derivatives.h"
#include "fixtures.h"
#include "haptex/cloth/dynamics/integrator.h"
#include "haptex/cloth/forces/fasteners/fasteners.h"
#include "self_contact_fixtures.h"

namespace haptex::cloth::test_fasteners {
namespace {

using test::refusalOf;

using Eigen::Vector3d;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

ClothPlace particle(int index) { return {{index, -1, -1}, {1.0, 0.0, 0.0}}; }

/// Between opposite corners of square(4), 0.1 m wide.
Fastener elastic(const std::string& name, double length, double release_force = 10.0) {
  return {name, FastenerKind::kElastic, {particle(0), particle(24)}, 50.0, length, release_force};
}

/// Two sheets of 0.1 m, one 5 mm in front of the other, with a button from the middle of the first
/// to a place in a triangle of the second.
Fastener button(double stiffness = 1000.0, double release_force = 2.0) {
  return {"button",
          FastenerKind::kButton,
          {particle(12), {{25 + 12, 25 + 13, 25 + 18}, {0.5, 0.3, 0.2}}},
          stiffness,
          0.0,
          release_force};
}

/// Through an edge of square(4), a triangle and the other edge, and back to the start if closed.
Fastener drawstring(double length, double release_force = 10.0, bool closed = false) {
  Fastener cord{"cord",
                FastenerKind::kDrawstring,
                {particle(0), {{6, 7, 12}, {0.5, 0.3, 0.2}}, particle(14), particle(24)},
                50.0,
                length,
                release_force};
  if (closed) cord.places.push_back(cord.places.front());
  return cord;
}

Cloth twoSheets(const Fastener& fastener, const ModelledEffects& also = {}) {
  ModelledEffects effects = also;
  effects.fasteners = {fastener};
  mesh::ClothMesh mesh = layers(2, 0.1, 4);
  for (Vector3d& place : mesh.initial_positions) place.z() *= 0.005;
  return Cloth(std::move(mesh), linearFabric(), effects);
}

Cloth oneSheet(const std::vector<Fastener>& fasteners) {
  ModelledEffects effects;
  effects.fasteners = fasteners;
  return Cloth(square(4), linearFabric(), effects);
}

TEST(Fasteners, ForceIsTheGradientOfTheEnergyAndTheJacobianThatOfTheForce) {
  // Slack, stretched and pulled as hard as it holds, across the diagonal of 0.141 m.
  for (const Fastener& band : {elastic("slack", 0.2), elastic("stretched", 0.1),
                               elastic("saturated", 0.1, 0.5), elastic("without_length", 0.0)}) {
    const Cloth cloth = oneSheet({band});
    const ClothState state = randomState(cloth, 0.002, 0.0);
    SCOPED_TRACE(band.name);
    EXPECT_EQ(cloth.fasteners()->tension(0, state.positions) > 0.0, band.name != "slack");
    expectExactDerivatives(cloth, state, {0, 7, 24});
  }
  for (const Fastener& cord :
       {drawstring(0.5), drawstring(0.1), drawstring(0.1, 0.5), drawstring(0.1, 10.0, true)}) {
    const Cloth cloth = oneSheet({cord});
    const ClothState state = randomState(cloth, 0.002, 0.0);
    EXPECT_EQ(cloth.fasteners()->tension(0, state.positions) > 0.0, cord.length < 0.5);
    expectExactDerivatives(cloth, state, {0, 6, 7, 12, 14, 24});
  }
  const Cloth sewn = twoSheets(button());
  expectExactDerivatives(sewn, randomState(sewn, 0.0005, 0.0), {12, 37, 38, 43});
}

TEST(Fasteners, LinearisedStageHasTheExactJacobianWhichIsDefinite) {
  for (const Fastener& fastener : {button(), button(1000.0, 0.1), drawstring(0.1),
                                   drawstring(0.1, 0.5), drawstring(0.1, 10.0, true)}) {
    const Cloth cloth = twoSheets(fastener);
    const ClothState state = randomState(cloth, 0.0005, 0.1);
    std::vector<int> all;
    for (std::size_t i = 0; i < cloth.particleCount(); ++i) all.push_back(static_cast<int>(i));
    JacobianRows rows(all);
    cloth.fasteners()->addJacobian(state.ofForces(), rows);
    linear::SymmetricBlockMatrix matrix = cloth.pattern();
    linear::BlockVector rhs = linear::BlockVector::Zero(3, cloth.particleCount());
    constexpr double kA = 0.01;
    cloth.fasteners()->assembleLinearised(state.ofForces(), {kA, kA}, matrix, rhs);
    Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(3 * all.size(), 3 * all.size());
    for (const JacobianBlock& block : rows.blocks()) {
      jacobian.block<3, 3>(3 * block.row, 3 * block.column) = block.by_position;
    }
    EXPECT_GT(jacobian.norm(), 1.0);
    EXPECT_LT((dense(matrix) + kA * kA * jacobian).norm(), 1e-12 * jacobian.norm());
    const double least = jacobian.selfadjointView<Eigen::Lower>().eigenvalues().maxCoeff();
    EXPECT_LT(least, 1e-12 * jacobian.norm());
    std::vector<Vector3d> forces(cloth.particleCount(), Vector3d::Zero());
    cloth.fasteners()->addForces(state.ofForces(), forces);
    Eigen::VectorXd velocities(3 * all.size()), expected(3 * all.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
      velocities.segment<3>(3 * i) = state.velocities[i];
      expected.segment<3>(3 * i) = kA * forces[i];
    }
    expected += kA * kA * jacobian * velocities;
    EXPECT_LT((stacked(rhs) - expected).norm(), 1e-12 * expected.norm());
  }
}

TEST(Fasteners, PullOpposedAtBothPlacesAndWithoutTorque) {
  const Cloth cloth = twoSheets(button());
  const ClothState state = randomState(cloth, 0.0005, 0.0);
  std::vector<Vector3d> forces(cloth.particleCount(), Vector3d::Zero());
  cloth.fasteners()->addForces(state.ofForces(), forces);
  Vector3d sum = Vector3d::Zero(), torque = Vector3d::Zero();
  double pull = 0.0;
  for (std::size_t i = 0; i < forces.size(); ++i) {
    sum += forces[i];
    torque += state.positions[i].cross(forces[i]);
    pull += forces[i].norm();
  }
  EXPECT_NEAR(pull, 2.0 * cloth.fasteners()->tension(0, state.positions), 1e-12);
  EXPECT_LT(sum.norm(), 1e-12 * pull);
  EXPECT_LT(torque.norm(), 1e-12 * pull);
}

TEST(Fasteners, ADrawstringHasOneTensionFromEndToEnd) {
  const Cloth cloth = oneSheet({drawstring(0.1)});
  const ClothState state = randomState(cloth, 0.002, 0.0);
  std::vector<Vector3d> forces(cloth.particleCount(), Vector3d::Zero());
  cloth.fasteners()->addForces(state.ofForces(), forces);
  const double tension = cloth.fasteners()->tension(0, state.positions);
  EXPECT_GT(tension, 1.0);
  EXPECT_NEAR(forces[0].norm(), tension, 1e-4 * tension);  // of rounding
  EXPECT_NEAR(forces[24].norm(), tension, 1e-4 * tension);
  const auto& at = state.positions;
  const Vector3d before = 0.5 * at[6] + 0.3 * at[7] + 0.2 * at[12] - at[14];
  const Vector3d expected = tension * (before.normalized() + (at[24] - at[14]).normalized());
  EXPECT_LT((forces[14] - expected).norm(), 1e-4 * tension);
  EXPECT_NEAR(cloth.fasteners()->distance(0, at),
              (at[0] - 0.5 * at[6] - 0.3 * at[7] - 0.2 * at[12]).norm() + before.norm() +
                  (at[24] - at[14]).norm(),
              1e-6);
  Vector3d sum = Vector3d::Zero(), torque = Vector3d::Zero();
  for (std::size_t i = 0; i < forces.size(); ++i) {
    sum += forces[i];
    torque += at[i].cross(forces[i]);
  }
  EXPECT_LT(sum.norm(), 1e-12 * tension);
  EXPECT_LT(torque.norm(), 1e-12 * tension);
}

/// A ring on a cord slides to where both parts of it have the same angle, whatever it weighs.
TEST(Fasteners, ADrawstringSlidesThroughItsPlaces) {
  ModelledEffects effects;
  effects.gravity = Vector3d(0.0, 0.0, -9.81);
  effects.fasteners = {{"cord",
                        FastenerKind::kDrawstring,
                        {particle(0), particle(4), particle(8)},
                        500.0,
                        0.25,
                        1e3}};
  // Three squares: the ring is a corner of the one in the middle, which hangs on it.
  mesh::ClothMesh mesh;
  for (int square = 0; square < 3; ++square) {
    for (const Eigen::Vector2d& rest :
         {Eigen::Vector2d(0.0, 0.0), Eigen::Vector2d(0.01, 0.0), Eigen::Vector2d(0.01, -0.01),
          Eigen::Vector2d(0.0, -0.01)}) {
      mesh.rest_coordinates.push_back(rest + Eigen::Vector2d(0.05 * square, 0.0));
      mesh.initial_positions.emplace_back(0.0, rest.x() + 0.1 * square,
                                          rest.y() - (square == 1 ? 0.05 : 0.02 * square));
    }
    mesh.triangles.push_back({4 * square, 4 * square + 1, 4 * square + 2});
    mesh.triangles.push_back({4 * square, 4 * square + 2, 4 * square + 3});
  }
  Cloth cloth(std::move(mesh), linearFabric(), effects);
  for (const int i : {0, 1, 2, 3, 8, 9, 10, 11}) {
    cloth.attach(i, {cloth.mesh().initial_positions[i]});
  }
  ClothState state = cloth.initialState();
  StepSettings settings;
  settings.newton_iterations = 20;
  Integrator integrator(cloth, settings);
  for (int i = 0; i < 400; ++i) ASSERT_TRUE(integrator.step(cloth, state, 0.05).accepted);
  const Vector3d left = (state.positions[0] - state.positions[4]).normalized();
  const Vector3d right = (state.positions[8] - state.positions[4]).normalized();
  EXPECT_NEAR(left.y(), -right.y(), 1e-5);
  EXPECT_NEAR(left.z(), right.z(), 1e-5);
  const double weight =
      9.81 * (cloth.masses()[4] + cloth.masses()[5] + cloth.masses()[6] + cloth.masses()[7]);
  EXPECT_NEAR(cloth.fasteners()->tension(0, state.positions) * (left.z() + right.z()), weight,
              1e-5 * weight);
  EXPECT_TRUE(Fasteners::isFastened(0, state.memory.data()));
}

/// Where places meet the pull has no direction, but keeps its size.
TEST(Fasteners, ADrawstringBearsPlacesThatMeet) {
  const Cloth cloth = oneSheet({drawstring(0.01)});
  ClothState state = cloth.initialState();
  for (Vector3d& place : state.positions) place.setZero();
  std::vector<Vector3d> forces(cloth.particleCount(), Vector3d::Zero());
  cloth.fasteners()->addForces(state.ofForces(), forces);
  for (const Vector3d& force : forces) EXPECT_EQ(force, Vector3d::Zero());
  EXPECT_NEAR(cloth.fasteners()->distance(0, state.positions), 3.0 * Fasteners::kRounding, 1e-15);
}

TEST(Fasteners, OpenAtTheEndOfAStepThatPullsTooHardAndCarryNothingFromThenOn) {
  for (const auto& [release_force, opens] : {std::pair(50.0, false), std::pair(0.5, true)}) {
    Cloth cloth = twoSheets(button(1000.0, release_force));
    for (int i = 0; i < 50; ++i) cloth.attach(i, {cloth.mesh().initial_positions[i]});
    ClothState state = cloth.initialState();
    ASSERT_TRUE(Fasteners::isFastened(0, state.memory.data()));
    StepSettings settings;
    Integrator integrator(cloth, settings);
    ASSERT_TRUE(integrator.step(cloth, state, 0.01).accepted);
    EXPECT_EQ(Fasteners::isFastened(0, state.memory.data()), !opens);
    EXPECT_EQ(Fasteners::openedAt(0, state.memory.data()), opens ? release_force : 0.0);
    EXPECT_EQ(cloth.fasteners()->energy(state.ofForces()) > 0.0, !opens);
    std::vector<Vector3d> forces;
    cloth.computeForces(state, forces);
    const double pull = 1000.0 * cloth.fasteners()->distance(0, state.positions);
    EXPECT_GT(pull, 5.0) << "5 mm in front of each other";
    EXPECT_NEAR(forces[12].norm(), opens ? 0.0 : pull, 1e-9);
  }
}

TEST(Fasteners, StayAsTheyAreWhenTheFabricChangesOrIsForgotten) {
  Cloth cloth = oneSheet({elastic("first", 0.1), elastic("second", 0.1)});
  ClothState state = cloth.initialState();
  Fasteners::set(1, false, state.memory.data());
  material::Fabric other = linearFabric();
  other.areal_density = 0.3;
  cloth.setFabric(other);
  cloth.forget(state);
  EXPECT_TRUE(Fasteners::isFastened(0, state.memory.data()));
  EXPECT_FALSE(Fasteners::isFastened(1, state.memory.data()));
  EXPECT_TRUE(Fasteners::isFastened(1, cloth.initialState().memory.data()));
}

TEST(Fasteners, OpenOnesLeaveTheMotionAsWithoutThem) {
  Fastener open = elastic("open", 0.05);
  open.fastened = false;
  Cloth with = oneSheet({open}), without(square(4), linearFabric(), ModelledEffects());
  StepSettings settings;
  settings.solver = linear::LinearSolverMethod::kCholesky;
  Integrator of_with(with, settings), of_without(without, settings);
  ClothState a = randomState(with, 0.002, 0.1), b = randomState(without, 0.002, 0.1);
  for (int i = 0; i < 10; ++i) {
    of_with.step(with, a, 0.01);
    of_without.step(without, b, 0.01);
  }
  for (std::size_t i = 0; i < a.positions.size(); ++i) {
    EXPECT_LT((a.positions[i] - b.positions[i]).norm(), 1e-9);
  }
}

/// Every method opens what is torn apart and gains no energy by it, nor momentum.
TEST(Fasteners, MakeNeitherEnergyNorMomentumWhenTheyOpen) {
  for (const IntegrationMethod method :
       {IntegrationMethod::kBackwardEuler, IntegrationMethod::kBackwardMidpoint,
        IntegrationMethod::kBdf2, IntegrationMethod::kTrBdf2}) {
    SCOPED_TRACE(nameOf(method));
    Cloth cloth = twoSheets(button(1000.0, 0.05));
    ClothState state = cloth.initialState();
    for (std::size_t i = 0; i < state.positions.size(); ++i) {
      const bool front = i >= 25;
      state.positions[i].z() = front ? 1e-5 : 0.0;
      state.velocities[i] = {0.0, front ? 0.1 : 0.0, front ? 0.3 : -0.3};
    }
    const Vector3d before = cloth.momentum(state);
    double energy = cloth.potentialEnergy(state) + cloth.kineticEnergy(state);
    StepSettings settings;
    settings.method = method;
    settings.newton_iterations = 10;
    settings.tolerance = 1e-12;
    Integrator integrator(cloth, settings);
    bool opened = false;
    for (int i = 0; i < 100; ++i) {
      ASSERT_TRUE(integrator.step(cloth, state, 0.001).accepted);
      opened = opened || !Fasteners::isFastened(0, state.memory.data());
    }
    EXPECT_TRUE(opened);
    EXPECT_LT(cloth.potentialEnergy(state) + cloth.kineticEnergy(state), energy * (1.0 + 1e-9));
    EXPECT_LT((cloth.momentum(state) - before).norm(), 1e-9 * before.norm());
  }
}

/// Between layers that collide: slack as long as they lie on each other.
TEST(Fasteners, DoNotPressLayersThatCollide) {
  ModelledEffects effects;
  effects.self_collision = true;
  effects.fasteners = {button(5000.0, 20.0)};
  effects.fasteners[0].places[1] = particle(25 + 12);
  mesh::ClothMesh mesh = layers(2, 0.1, 4);
  const material::Fabric wool = fabricNamed("wool");
  const double thickness = LayerLaw(wool).thickness();
  for (Vector3d& place : mesh.initial_positions) place.z() *= 1.5 * thickness;
  Cloth cloth(std::move(mesh), wool, effects);
  EXPECT_EQ(cloth.fasteners()->slackLength(0), thickness);
  ClothState state = cloth.initialState();
  StepSettings settings;
  settings.newton_iterations = 20;
  Integrator integrator(cloth, settings);
  for (int i = 0; i < 100; ++i) ASSERT_TRUE(integrator.step(cloth, state, 0.02).accepted);
  EXPECT_TRUE(Fasteners::isFastened(0, state.memory.data()));
  EXPECT_LT(cloth.fasteners()->tension(0, state.positions), 1e-6);
  EXPECT_GT(cloth.fasteners()->distance(0, state.positions), 0.99 * thickness);
  for (const Vector3d& velocity : state.velocities) EXPECT_LT(velocity.norm(), 0.01);
}

TEST(Fasteners, RefuseWhatIsNotAllowed) {
  const auto refusal = [](const std::function<void(Fastener&)>& change) {
    Fastener fastener = elastic("band", 0.1);
    change(fastener);
    return refusalOf([&] { Fasteners({fastener}, 25, 0.0); });
  };
  EXPECT_EQ(refusal([](Fastener& it) { it.stiffness = 0.0; }),
            "fastener 'band': stiffness = 0 N/m; allowed are finite numbers > 0");
  EXPECT_EQ(refusal([](Fastener& it) { it.stiffness = kNaN; }),
            "fastener 'band': stiffness = nan N/m; allowed are finite numbers > 0");
  EXPECT_EQ(refusal([](Fastener& it) { it.length = -0.1; }),
            "fastener 'band': length = -0.1 m; allowed are finite numbers >= 0");
  EXPECT_EQ(refusal([](Fastener& it) { it.release_force = -1.0; }),
            "fastener 'band': release force = -1 N; allowed are finite numbers > 0");
  EXPECT_EQ(refusal([](Fastener& it) { it.places[1] = particle(25); }),
            "fastener 'band': particle 25 does not exist; allowed are 0 to 24");
  EXPECT_EQ(refusal([](Fastener& it) { it.places[1].weights[0] = 0.5; }),
            "fastener 'band': the weights of a place sum to 0.5; allowed is 1 within 1e-06");
  EXPECT_EQ(refusal([](Fastener& it) { it.places[1].weights[0] = kNaN; }),
            "fastener 'band': a weight is nan; allowed are finite numbers");
  EXPECT_EQ(refusal([](Fastener& it) { it.places[1] = particle(0); }),
            "fastener 'band': both places are the same; allowed are two that differ");
  EXPECT_EQ(refusal([](Fastener& it) { it.places.push_back(particle(3)); }),
            "fastener 'band' has 3 places; allowed are 2");
  EXPECT_EQ(refusal([](Fastener& it) {
              it.kind = FastenerKind::kDrawstring;
              it.places.resize(1);
            }),
            "fastener 'band' has 1 places; allowed are 2 to 32");
  EXPECT_EQ(
      refusal([](Fastener& it) {
        it.kind = FastenerKind::kDrawstring;
        it.places.push_back(it.places.back());
      }),
      "fastener 'band': two places in a row are the same; allowed are places that differ from "
      "the one before");
  EXPECT_EQ(refusalOf([] {
              Fasteners({elastic("band", 0.1), elastic("band", 0.2)}, 25, 0.0);
            }),
            "fastener 'band': there is another one of this name; allowed is each once");
}

}  // namespace
}  // namespace haptex::cloth::test_fasteners
