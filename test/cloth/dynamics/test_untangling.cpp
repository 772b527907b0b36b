// Cloth that intersects itself is reported and pulled apart.
#include <gtest/gtest.h>

#include <cmath>

#include "haptex/base/workload.h"
#include "haptex/cloth/dynamics/integrator.h"
#include "haptex/cloth/dynamics/untangling/contours.h"
#include "haptex/cloth/dynamics/untangling/regions.h"
#include "haptex/proximity/intersections.h"
#include "self_contact_fixtures.h"

namespace haptex::cloth::test_untangling {
namespace {

using Eigen::Vector3d;

constexpr double kStep = 0.0125;  // s

std::vector<proximity::TrianglePair> intersectionsOf(const Cloth& cloth,
                                                     const Positions& positions) {
  return proximity::intersectingTriangles(positions, cloth.mesh().triangles);
}

/// Layers of 60 mm: the second one is tilted, and its lower part is below the first. All others are
/// above, 10 mm apart.
ClothState tilted(const Cloth& cloth, int count) {
  ClothState state = cloth.initialState();
  const std::size_t of_layer = state.positions.size() / count;
  for (std::size_t i = 0; i < state.positions.size(); ++i) {
    const auto layer = static_cast<int>(i / of_layer);
    Vector3d& place = state.positions[i];
    place.z() = 0.01 * layer;
    if (layer == 1)
      place = Vector3d(place.x() + 0.003, place.y() + 0.002, 0.15 * (place.x() - 0.02));
  }
  return state;
}

/// A triangle in the plane z = 0 and another one, one edge of which goes through the first.
struct TwoTriangles {
  explicit TwoTriangles(const Vector3d& along)
      : positions{{-1.0, -1.0, 0.0}, {2.0, -1.0, 0.0}, {-1.0, 2.0, 0.0}, -along, along,
                  {2.0, 0.0, -0.1}} {}

  std::vector<std::array<int, 3>> triangles = {{0, 1, 2}, {3, 4, 5}};
  Positions positions;
};

TEST(Contours, GetShorterByTheGradientOfVolinoAndMagnenatThalmann) {
  const double angle = 0.4;
  const TwoTriangles mesh(Vector3d(std::sin(angle), 0.0, std::cos(angle)));
  const MeshTopology topology(mesh.triangles, mesh.positions.size());
  IntersectionContours contours(topology);
  contours.find(mesh.positions, {{0, 1}});
  ASSERT_EQ(contours.count(), 1);
  const Crossing* through_origin = nullptr;
  for (const Crossing& crossing : contours.crossings()) {
    if (topology.elements.edges[crossing.edge] == proximity::Edge{3, 4}) through_origin = &crossing;
  }
  ASSERT_NE(through_origin, nullptr);
  EXPECT_EQ(through_origin->triangle, 0);
  EXPECT_FALSE(through_origin->on_first);
  const Vector3d expected(1.0, 0.0, -2.0 * std::tan(angle));
  EXPECT_LT((through_origin->shorter - expected).norm(), 1e-12);
}

TEST(Contours, OneSurfaceIsOnOneSideAlongAllOfAContour) {
  const Cloth cloth(layers(2, 0.06, 7), fabricNamed("wool"), selfCollision());
  const ClothState state = tilted(cloth, 2);
  const auto pairs = intersectionsOf(cloth, state.positions);
  ASSERT_GT(pairs.size(), 5u);
  const MeshTopology topology(cloth.mesh().triangles, cloth.particleCount());
  IntersectionContours contours(topology);
  contours.find(state.positions, pairs);
  EXPECT_EQ(contours.count(), 1);
  const int of_layer = static_cast<int>(cloth.particleCount() / 2);
  for (const Crossing& crossing : contours.crossings()) {
    EXPECT_EQ(crossing.on_first, topology.elements.edges[crossing.edge][0] < of_layer);
  }
}

TEST(TangleRegions, TheSmallerPartGoesBack) {
  const Cloth cloth(layers(2, 0.06, 7), fabricNamed("wool"), selfCollision());
  ClothState state = tilted(cloth, 2);
  // The contour parts the second layer, and ends inside of the first.
  for (std::size_t i = cloth.particleCount() / 2; i < cloth.particleCount(); ++i) {
    state.positions[i].y() = 0.002 + 0.9 * state.positions[i].y();
  }
  const auto pairs = intersectionsOf(cloth, state.positions);
  const MeshTopology topology(cloth.mesh().triangles, cloth.particleCount());
  IntersectionContours contours(topology);
  contours.find(state.positions, pairs);
  TangleRegions regions(topology, cloth.particleCount());
  regions.find(state.positions, pairs, contours);
  // Less than half of the second layer is below the first.
  const int of_layer = static_cast<int>(cloth.particleCount() / 2);
  for (std::size_t c = 0; c < contours.crossings().size(); ++c) {
    const bool is_upper = topology.elements.edges[contours.crossings()[c].edge][0] >= of_layer;
    EXPECT_GT(regions.wayOut(c).z() * (is_upper ? 1.0 : -1.0), 0.9);
  }
}

TEST(Untangling, PullsApartWithoutMomentumAndCountsTheEnergyThatItAdds) {
  ModelledEffects effects = selfCollision();
  effects.bending = true;
  for (const char* fabric : {"wool", "linear"}) {
    const Cloth cloth(layers(2, 0.06, 7), fabricNamed(fabric), effects);
    StepSettings settings;
    settings.newton_iterations = 30;
    settings.tolerance = 1e-10;
    settings.newton_tolerance = 1e-13;
    Integrator integrator(cloth, settings);
    ClothState state = tilted(cloth, 2);
    // Energies of the start are with contact in the tangle; a step of no length leaves that out.
    ASSERT_GT(integrator.step(cloth, state, 1e-9).tangle.pairs, 0);
    const double start = cloth.potentialEnergy(state) + cloth.kineticEnergy(state);
    double added = 0.0, scale = 0.0;
    int step = 0;
    for (; step < 40; ++step) {
      const StepReport report = integrator.step(cloth, state, kStep);
      ASSERT_TRUE(report.accepted);
      added += report.tangle.energy;
      for (std::size_t i = 0; i < cloth.particleCount(); ++i) {
        scale += cloth.masses()[i] * state.velocities[i].norm();
      }
      EXPECT_LT(cloth.momentum(state).norm(), 1e-9 * scale + 1e-15);
      const double energy = cloth.potentialEnergy(state) + cloth.kineticEnergy(state);
      EXPECT_LE(energy, start + added + 1e-9 * (start + std::abs(added))) << fabric << ' ' << step;
      if (report.tangle.pairs == 0) break;
    }
    EXPECT_LT(step, 40) << fabric;
    EXPECT_TRUE(intersectionsOf(cloth, state.positions).empty());
  }
}

TEST(Untangling, SaysHowManyPairsAreLeftAndTheFirst) {
  const Cloth cloth(layers(2, 0.06, 7), fabricNamed("wool"), selfCollision());
  Integrator integrator(cloth, {});
  ClothState state = tilted(cloth, 2);
  int tangled = 0;
  for (int i = 0; i < 20; ++i) {
    const TangleReport report = integrator.step(cloth, state, kStep).tangle;
    const auto judged = intersectionsOf(cloth, state.positions);
    ASSERT_EQ(report.pairs, static_cast<int>(judged.size()));
    if (judged.empty()) {
      EXPECT_EQ(report.first, (std::array<int, 2>{-1, -1}));
      continue;
    }
    ++tangled;
    EXPECT_EQ(report.first, judged.front());
  }
  EXPECT_GT(tangled, 0);
}

TEST(Untangling, AllElseOfTheClothIsKeptFromPassingThrough) {
  const Cloth cloth(layers(4, 0.06, 7), fabricNamed("wool"), selfCollision());
  StepSettings settings;
  settings.newton_iterations = 5;
  Integrator integrator(cloth, settings);
  ClothState state = tilted(cloth, 4);
  const std::size_t of_layer = state.positions.size() / 4;
  for (std::size_t i = 3 * of_layer; i < state.positions.size(); ++i) {
    state.velocities[i] = Vector3d(0.1, 0.0, -3.0);
  }
  std::size_t touching = 0;
  for (int i = 0; i < 30; ++i) {
    const StepReport report = integrator.step(cloth, state, kStep);
    ASSERT_TRUE(report.accepted);
    touching = std::max(touching, cloth.selfContact()->touching(state.positions).size());
    if (base::kSanitized && i % 5 != 0) continue;
    for (const proximity::TrianglePair& pair : intersectionsOf(cloth, state.positions)) {
      const std::size_t of_layers[2] = {pair[0] / (2u * 49u), pair[1] / (2u * 49u)};
      ASSERT_EQ(of_layers[0], 0u) << i;
      ASSERT_EQ(of_layers[1], 1u) << i;
    }
  }
  EXPECT_GT(touching, 0u);
  EXPECT_TRUE(intersectionsOf(cloth, state.positions).empty());
}

TEST(Untangling, AStateThatIsSetMayIntersect) {
  const Cloth cloth(layers(2, 0.06, 7), fabricNamed("wool"), selfCollision());
  Integrator integrator(cloth, {});
  ClothState state = cloth.initialState();
  EXPECT_EQ(integrator.step(cloth, state, kStep).tangle.pairs, 0);
  state.positions = tilted(cloth, 2).positions;
  EXPECT_GT(integrator.step(cloth, state, kStep).tangle.pairs, 0);
  for (int i = 0; i < 40; ++i) integrator.step(cloth, state, kStep);
  EXPECT_TRUE(intersectionsOf(cloth, state.positions).empty());
  // Contact is with all of the cloth again.
  state.positions = tilted(cloth, 2).positions;
  const std::size_t half = state.positions.size() / 2;
  for (std::size_t i = half; i < 2 * half; ++i) state.positions[i].z() = 3e-4;
  EXPECT_EQ(integrator.step(cloth, state, kStep).tangle.pairs, 0);
  EXPECT_FALSE(cloth.selfContact()->touching(state.positions).empty());
}

TEST(Untangling, LayersInOnePlaneComeApart) {
  const Cloth cloth(layers(2, 0.06, 7), fabricNamed("wool"), selfCollision());
  Integrator integrator(cloth, {});
  ClothState state = cloth.initialState();
  for (std::size_t i = 0; i < state.positions.size(); ++i) state.positions[i].z() = 0.0;
  int step = 0;
  while (step < 80 && integrator.step(cloth, state, kStep).tangle.pairs > 0) ++step;
  EXPECT_LT(step, 80);
  EXPECT_TRUE(intersectionsOf(cloth, state.positions).empty());
}

}  // namespace
}  // namespace haptex::cloth::test_untangling
