// What scene files may say of obstacles with mass, and of penalty.
#include <gtest/gtest.h>

#include <string>

#include "scene_fixtures.h"

namespace haptex::scene::test_scene_bodies {
namespace {

const std::string kBall =
    "{name: ball, sphere: 0.05, position: [1, 0, 0], body: {mass: 0.4, friction: 0.5, velocity: "
    "[-3, 0, 1], angular_velocity: [0, 20, 0]}}";
const std::string kWithBall =
    replaced(kValid, "viscosity]", "viscosity, obstacles]") + "obstacles: [" + kBall + "]\n";

using SceneBodies = SceneFile;

TEST_F(SceneBodies, HaveWhatTheFileSays) {
  const Scene scene = load(kWithBall);
  ASSERT_EQ(scene.obstacles.size(), 1u);
  ASSERT_TRUE(scene.obstacles[0].body);
  const mesh::ObstacleBody& body = *scene.obstacles[0].body;
  EXPECT_EQ(body.mass, 0.4);
  EXPECT_EQ(body.friction, 0.5);
  EXPECT_EQ(body.velocity, Eigen::Vector3d(-3.0, 0.0, 1.0));
  EXPECT_EQ(body.angular_velocity, Eigen::Vector3d(0.0, 20.0, 0.0));
  EXPECT_TRUE(scene.obstacles[0].moves());
  EXPECT_FALSE(scene.penalty);
  const Scene penalty = load(kWithBall + "integrator: runge_kutta_4\npenalty: 30\n");
  EXPECT_EQ(penalty.penalty.value(), 30.0);
}

class SceneBodiesRefuse : public RefusedScene {};

TEST_P(SceneBodiesRefuse, NamingFileKeyValueAndWhatIsAllowed) { expectRefusal(kWithBall); }

INSTANTIATE_TEST_SUITE_P(
    Bodies, SceneBodiesRefuse,
    testing::Values(
        Refusal{"NoMass", "mass: 0.4", "mass: 0",
                "obstacles[0].body.mass: '0' must be from 1e-6 to 1e6 kg"},
        Refusal{"NegativeMass", "mass: 0.4", "mass: -1",
                "obstacles[0].body.mass: '-1' must be from 1e-6 to 1e6 kg"},
        Refusal{"InfiniteMass", "mass: 0.4", "mass: .inf",
                "obstacles[0].body.mass: '.inf' must be a finite number"},
        Refusal{"MissingMass", "mass: 0.4, ", "",
                "obstacles[0].body: the key 'mass' is missing, required here: mass, friction"},
        Refusal{"NegativeFriction", "friction: 0.5", "friction: -0.5",
                "obstacles[0].body.friction: '-0.5' must be >= 0"},
        Refusal{"TooFast", "velocity: [-3", "velocity: [-3000",
                "obstacles[0].body.velocity[0]: '-3000' must be from -1000 to 1000 m/s"},
        Refusal{"TurningTooFast", "[0, 20, 0]", "[0, 20000, 0]",
                "obstacles[0].body.angular_velocity[1]: '20000' must be from -10000 to 10000 "
                "rad/s"},
        Refusal{"Capsule", "sphere: 0.05", "capsule: {radius: 0.05, length: 0.1}",
                "obstacles[0].body: is not allowed with capsule, only with sphere or box"},
        Refusal{"OfItsOwnMotion", "position:", "velocity: [1, 0, 0], position:",
                "obstacles[0].body: is not allowed with velocity: a body goes as it is pushed, "
                "from body.velocity on"},
        Refusal{"NotListed", "viscosity, obstacles]", "viscosity]",
                "obstacles: has a body, which is allowed only if model lists obstacles"},
        Refusal{"WithSelfCollision", "viscosity, obstacles]", "self_collision, obstacles]",
                "obstacles: has a body, which is not allowed if model lists self_collision"},
        Refusal{"OtherIntegrators", "obstacles: [", "integrator: bdf2\nobstacles: [",
                "integrator: 'bdf2' is not allowed with a body among the obstacles: "
                "backward_euler and the explicit ones are"},
        Refusal{"PenaltyOfImplicitSteps", "obstacles: [", "penalty: 10\nobstacles: [",
                "penalty: is allowed only with an explicit integrator, and if model lists "
                "obstacles"},
        Refusal{"NegativePenalty", "obstacles: [",
                "integrator: midpoint\npenalty: -10\nobstacles: [",
                "penalty: '-10' must be > 0 N/m"}),
    [](const testing::TestParamInfo<Refusal>& info) { return info.param.name; });

TEST_F(SceneBodies, AreSixteenAtMost) {
  std::string balls;
  for (int i = 0; i < 17; ++i) {
    balls += (i > 0 ? ", " : "") + replaced(kBall, "name: ball", "name: ball" + std::to_string(i));
  }
  EXPECT_EQ(refusalOf(replaced(kWithBall, kBall, balls)),
            path() + ": obstacles: has 17 obstacles with body, at most 16 are allowed");
}

}  // namespace
}  // namespace haptex::scene::test_scene_bodies
