// Contact between layers and regions of different fabrics.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "derivatives.h"
#include "haptex/cloth/dynamics/integrator.h"
#include "self_contact_fixtures.h"

namespace haptex::cloth::test_layers_of_fabrics {
namespace {

using Eigen::Vector3d;

std::vector<material::Fabric> woolAndDenim() { return {fabricNamed("wool"), fabricNamed("denim")}; }

/// Two layers, of which the second is of fabric 1.
mesh::ClothMesh twoLayers(double side, int cells) {
  mesh::ClothMesh mesh = layers(2, side, cells);
  const std::size_t count = mesh.triangles.size();
  for (std::size_t t = 0; t < count; ++t) mesh.triangle_fabrics.push_back(2 * t < count ? 0 : 1);
  return mesh;
}

/// The second layer over the first, at a distance and moving.
ClothState lyingOn(const Cloth& cloth, double distance, const Vector3d& velocity) {
  ClothState state = cloth.initialState();
  const std::size_t half = cloth.particleCount() / 2;
  for (std::size_t i = 0; i < half; ++i) {
    state.positions[half + i] = state.positions[i] + Vector3d(0.0, 0.0, distance);
    state.velocities[half + i] = velocity;
  }
  return state;
}

Vector3d onSecond(const Cloth& cloth, const ClothState& state) {
  const std::vector<Vector3d> forces = contactForces(cloth, state);
  Vector3d sum = Vector3d::Zero();
  for (std::size_t i = forces.size() / 2; i < forces.size(); ++i) sum += forces[i];
  return sum;
}

TEST(LayerPair, HasTheSamePressureInHalfOfBothThicknesses) {
  const FabricLayers both(woolAndDenim());
  const LayerPair pair = both.pair(0, 1);
  const LayerLaw &wool = both.law(0), &denim = both.law(1);
  EXPECT_DOUBLE_EQ(pair.thickness(), 0.5 * (wool.thickness() + denim.thickness()));
  for (const double share : {0.05, 0.3, 0.9, 1.2, 1.6}) {  // of its least distance in wool
    const double in_wool = share * wool.leastDistance();
    const double pressure = wool.at(in_wool).pressure;
    if (pressure == 0.0) continue;
    double low = 0.0, high = denim.thickness();
    for (int halving = 0; halving < 80; ++halving) {
      const double middle = 0.5 * (low + high);
      (denim.at(middle).pressure > pressure ? low : high) = middle;
    }
    const double distance = 0.5 * (in_wool + low);
    EXPECT_NEAR(pair.at(distance).pressure, pressure, 1e-9 * pressure) << share;
    EXPECT_NEAR(both.pair(1, 0).at(distance).pressure, pressure, 1e-9 * pressure);
  }
  EXPECT_EQ(pair.at(pair.thickness()).pressure, 0.0);
  EXPECT_EQ(pair.at(0.0).pressure, 0.0);
  EXPECT_TRUE(std::isfinite(pair.at(0.0).energy));
}

TEST(LayerPair, PressureIsTheDerivativeOfItsEnergyAndSlopeThatOfThePressure) {
  const FabricLayers both(woolAndDenim());
  const LayerPair pair = both.pair(0, 1);
  constexpr double kStep = 1e-10;  // m
  for (const double share : {0.02, 0.3, 0.9, 1.1, 1.3}) {
    const double d = share * pair.leastDistance();
    const LayerPressure above = pair.at(d + kStep), below = pair.at(d - kStep), middle = pair.at(d);
    EXPECT_NEAR(middle.pressure, (below.energy - above.energy) / (2.0 * kStep),
                1e-4 * middle.pressure);
    EXPECT_NEAR(middle.slope, (below.pressure - above.pressure) / (2.0 * kStep),
                1e-3 * middle.slope);
  }
}

TEST(LayerPair, OfOneFabricIsItsLaw) {
  const FabricLayers one({fabricNamed("wool")});
  const double d = 0.8 * one.thickness();
  EXPECT_EQ(one.pair(0, 0).at(d).pressure, LayerLaw(fabricNamed("wool")).at(d).pressure);
  EXPECT_EQ(one.pair(0, 0).guardAt(1e-4).slope, LayerLaw(fabricNamed("wool")).guardAt(1e-4).slope);
  // Two files of the same fabric are as one.
  const FabricLayers twice({fabricNamed("wool"), fabricNamed("wool")});
  EXPECT_NEAR(twice.pair(0, 1).at(d).pressure, one.pair(0, 0).at(d).pressure,
              1e-9 * one.pair(0, 0).at(d).pressure);
}

TEST(LayersOfFabrics, HaveThePressureOfBothAndTheGeometricMeanOfTheirFriction) {
  const std::vector<material::Fabric> fabrics = woolAndDenim();
  const double side = 0.08;
  const Cloth cloth(twoLayers(side, 8), fabrics, selfCollision());
  const LayerPair pair = cloth.selfContact()->layers().pair(0, 1);
  const double distance = 0.9 * pair.thickness();
  const Vector3d force =
      onSecond(cloth, lyingOn(cloth, distance, {10.0 * SelfContact::kSlipSpeed, 0.0, 0.0}));
  EXPECT_NEAR(force.z(), pair.at(distance).pressure * side * side, 1e-9 * force.z());
  const double mean = std::sqrt(*fabrics[0].friction * *fabrics[1].friction);
  EXPECT_NEAR(-force.x() / force.z(), mean, 1e-9);
}

TEST(LayersOfFabrics, HaveNoFrictionOnWhatHasNone) {
  std::vector<material::Fabric> fabrics = woolAndDenim();
  fabrics[1].friction = 0.0;
  const Cloth cloth(twoLayers(0.04, 4), fabrics, selfCollision());
  const double distance = 0.9 * cloth.selfContact()->layers().pair(0, 1).thickness();
  const Vector3d force = onSecond(cloth, lyingOn(cloth, distance, {0.01, 0.0, 0.0}));
  EXPECT_GT(force.z(), 0.0);
  EXPECT_EQ(force.x(), 0.0);
}

/// A layer on a larger one, which is held. Gravity is turned instead of the slope.
double accelerationOnSlope(const std::vector<material::Fabric>& fabrics, double angle) {
  constexpr int kCells = 12;
  mesh::ClothMesh mesh;
  const auto add = [&](double side, int cells, double height, int fabric) {
    const mesh::ClothMesh one =
        mesh::makeRectangle(side, side, cells, cells, mesh::Triangulation::kAlternating);
    const int first = static_cast<int>(mesh.rest_coordinates.size());
    for (const Eigen::Vector2d& rest : one.rest_coordinates) {
      mesh.rest_coordinates.push_back(rest + Eigen::Vector2d(0.3 * fabric, 0.0));
      mesh.initial_positions.emplace_back(rest.x() - 0.5 * side, rest.y() - 0.5 * side, height);
    }
    for (const auto& [a, b, c] : one.triangles) {
      mesh.triangles.push_back({a + first, b + first, c + first});
      mesh.triangle_fabrics.push_back(fabric);
    }
  };
  add(0.12, kCells, 0.0, 0);
  add(0.057, kCells / 2, FabricLayers(fabrics).pair(0, 1).thickness(), 1);
  ModelledEffects effects = selfCollision();
  effects.bending = true;
  effects.gravity = 9.81 * Vector3d(std::sin(angle), 0.0, -std::cos(angle));
  Cloth cloth(mesh, fabrics, effects);
  const std::size_t held = (kCells + 1) * (kCells + 1);
  for (std::size_t i = 0; i < held; ++i) {
    AttachmentPath path;
    path.start = mesh.initial_positions[i];
    cloth.attach(static_cast<int>(i), path);
  }
  ClothState state = cloth.initialState();
  StepSettings settings;
  settings.newton_iterations = 20;
  Integrator integrator(cloth, settings);
  const auto speed = [&] {
    double sum = 0.0;
    for (std::size_t i = held; i < state.velocities.size(); ++i) sum += state.velocities[i].x();
    return sum / static_cast<double>(state.velocities.size() - held);
  };
  constexpr double kStep = 0.0025;  // s
  constexpr int kSteps = 40;
  for (int i = 0; i < kSteps; ++i) integrator.step(cloth, state, kStep);
  const double before = speed();
  for (int i = 0; i < kSteps; ++i) integrator.step(cloth, state, kStep);
  return (speed() - before) / (kSteps * kStep);
}

TEST(LayersOfFabrics, StickOnASlopeBelowTheAngleOfTheirFrictionAndSlideAboveIt) {
  std::vector<material::Fabric> fabrics(2, fabricNamed("wool"));
  fabrics[0].friction = 0.1;
  fabrics[1].friction = 0.4;
  const double angle = std::atan(0.2);
  EXPECT_LT(std::abs(accelerationOnSlope(fabrics, angle - 0.05)), 0.01);
  const double steep = accelerationOnSlope(fabrics, angle + 0.1);
  EXPECT_GT(steep, 0.5);
  // As one fabric with the geometric mean.
  fabrics[0].friction = fabrics[1].friction = 0.2;
  EXPECT_NEAR(accelerationOnSlope(fabrics, angle + 0.1), steep, 1e-6 * steep);
}

/// Chess boards of both fabrics, crumpled on each other: all kinds of pairs, between all kinds of
/// regions.
TEST(LayersOfFabrics, ForcesAreTheGradientOfTheEnergyWhereRegionsMeet) {
  mesh::ClothMesh mesh = layers(2, 0.03, 4);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    mesh.triangle_fabrics.push_back(t % 3 == 0 ? 1 : 0);
  }
  const Cloth cloth(mesh, woolAndDenim(), selfCollision());
  const double thickness = cloth.selfContact()->layers().thickness();
  for (unsigned seed = 1; seed <= 3; ++seed) {
    ClothState state = cloth.initialState();
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> any(-1.0, 1.0);
    const std::size_t half = cloth.particleCount() / 2;
    for (std::size_t i = 0; i < half; ++i) {
      state.positions[i] += 1e-3 * Vector3d(any(random), any(random), any(random));
      state.positions[half + i] =
          state.positions[i] + Vector3d(2e-3 * any(random), 2e-3 * any(random),
                                        0.1 * thickness + 1e-3 + 1e-3 * any(random));
    }
    expectContactGradient(cloth, state, 2e-4);
  }
}

TEST(LayersOfFabrics, AVertexThatGoesFromOneFabricToAnotherIsPushedWithoutAJump) {
  mesh::ClothMesh mesh = layers(2, 0.02, 2);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    double middle = 0.0;
    for (const int particle : mesh.triangles[t]) {
      middle += mesh.initial_positions[particle].x() / 3.0;
    }
    mesh.triangle_fabrics.push_back(2 * t < mesh.triangles.size() && middle > 0.01 ? 1 : 0);
  }
  const Cloth cloth(mesh, woolAndDenim(), selfCollision());
  const FabricLayers& laws = cloth.selfContact()->layers();
  const double distance = 0.7 * std::min(laws.law(0).thickness(), laws.law(1).thickness());
  const std::size_t half = cloth.particleCount() / 2;
  Vector3d last = Vector3d::Zero();
  double largest = 0.0;
  std::vector<double> up;
  constexpr int kSteps = 2000;
  for (int step = 0; step <= kSteps; ++step) {
    ClothState state = cloth.initialState();
    const Vector3d corner(0.005 + 0.01 * step / kSteps, 0.0113, distance);
    for (std::size_t i = 0; i < half; ++i) {
      const Eigen::Vector2d rest = mesh.rest_coordinates[i];
      state.positions[half + i] =
          corner + Vector3d(0.3 * rest.x(), 0.2 * rest.y(), 2.0 * rest.sum());
    }
    const Vector3d force = contactForces(cloth, state)[half];
    if (step > 0) largest = std::max(largest, (force - last).norm());
    last = force;
    up.push_back(force.z());
  }
  ASSERT_GT(up.front(), 0.0);
  // That of either fabric away from the border.
  const double ratio = laws.pair(0, 1).at(distance).pressure / laws.law(0).at(distance).pressure;
  EXPECT_NEAR(up.back() / up.front(), ratio, 0.02 * ratio);
  EXPECT_LT(largest, 0.05 * std::max(up.front(), up.back()));
}

TEST(LayersOfFabrics, MotionsStopBeforeTheyTouchByWhatEitherSideHas) {
  const Cloth cloth(twoLayers(0.04, 4), woolAndDenim(), selfCollision());
  const SelfContact& contact = *cloth.selfContact();
  const std::vector<double> margins = contact.particleMargins();
  ASSERT_EQ(margins.size(), cloth.particleCount());
  EXPECT_EQ(margins.front(), 0.5 * contact.layers().law(0).margin());
  EXPECT_EQ(margins.back(), 0.5 * contact.layers().law(1).margin());
  EXPECT_EQ(contact.margin(),
            std::max(contact.layers().law(0).margin(), contact.layers().law(1).margin()));
  const Cloth alone(layers(2, 0.04, 4), fabricNamed("wool"), selfCollision());
  EXPECT_TRUE(alone.selfContact()->particleMargins().empty());
}

TEST(LayersOfFabrics, NeedCompressionAndFrictionOfEach) {
  for (const bool friction : {true, false}) {
    std::vector<material::Fabric> fabrics = woolAndDenim();
    if (friction) {
      fabrics[1].friction.reset();
    } else {
      fabrics[1].compression.reset();
    }
    try {
      Cloth(twoLayers(0.04, 4), fabrics, selfCollision());
      ADD_FAILURE() << "not refused";
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find("'denim'"), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace haptex::cloth::test_layers_of_fabrics
