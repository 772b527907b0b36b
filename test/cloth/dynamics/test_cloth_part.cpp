#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "fixtures.h"
#include "haptex/cloth/dynamics/cloth_part.h"
#include "haptex/cloth/dynamics/integrator.h"
#include "self_contact_fixtures.h"

namespace haptex::cloth::test_cloth_part {
namespace {

using Eigen::Vector3d;
using material::Fabric;

/// 12 x 10 cells of 10 mm; irregular: inner particles of one half moved by up to a quarter of a
/// cell.
mesh::ClothMesh sheet(mesh::Triangulation triangulation, bool irregular = false) {
  mesh::ClothMesh mesh = mesh::makeRectangle(0.12, 0.1, 12, 10, triangulation);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> moved(-0.0025, 0.0025);
  for (Eigen::Vector2d& rest : mesh.rest_coordinates) {
    if (!irregular || rest.x() > 0.06 || rest.x() < 1e-6) continue;
    if (rest.y() < 1e-6 || rest.y() > 0.0999) continue;
    rest += Eigen::Vector2d(moved(random), moved(random));
  }
  return mesh;
}

Fabric fabricWithAll() {
  Fabric fabric = stiffeningFabric();
  fabric.bending = {2e-5, 1e-5};
  fabric.bending_hysteresis = {2e-4, 1e-4};
  fabric.resilience = {0.6, 0.7};
  fabric.shear_hysteresis = {0.02, 0.05};
  return fabric;
}

struct Case {
  const char* name;
  mesh::ClothMesh mesh;
  ModelledEffects effects;
  std::vector<Fabric> fabrics = {fabricWithAll()};
};

/// With a stripe of another fabric along one side and in the middle.
Case regions(ModelledEffects effects) {
  effects.bending_hysteresis = false;  // knows no borders of fabrics
  Case with{"regions",
            sheet(mesh::Triangulation::kAlternating),
            effects,
            {fabricWithAll(), linearFabric(0.2)}};
  Fabric& other = with.fabrics.back();
  other.bending = {1e-4, 3e-4};
  other.resilience = {0.5, 0.5};
  other.shear_hysteresis = {0.01, 0.01};
  for (const auto& triangle : with.mesh.triangles) {
    const double weft = with.mesh.rest_coordinates[triangle[0]].x();
    with.mesh.triangle_fabrics.push_back(weft < 0.035 || (weft > 0.055 && weft < 0.085) ? 1 : 0);
  }
  return with;
}

std::vector<Case> cases() {
  ModelledEffects plain;
  plain.gravity = {0.0, 1.0, -9.80665};
  plain.point_loads = true;
  plain.air = Air{};
  plain.air->wind.mean = {2.0, 1.0, 0.5};
  plain.viscosity = true;
  ModelledEffects bending = plain;
  bending.bending = bending.bending_hysteresis = bending.membrane_hysteresis = true;
  ModelledEffects corotational = plain;
  corotational.elasticity = Elasticity::kCorotational;
  ModelledEffects cells = plain;
  cells.elasticity = Elasticity::kBilinear;
  cells.bending = cells.bending_hysteresis = true;
  ModelledEffects unbent_cells = cells;
  unbent_cells.bending = unbent_cells.bending_hysteresis = false;
  ModelledEffects springs = plain;
  springs.elasticity = Elasticity::kMassSpring;
  springs.bending = true;
  ModelledEffects curved = bending;
  curved.bending_settings.rest_curvature = {10.0, -5.0};
  using mesh::Triangulation;
  return {{"plain", sheet(Triangulation::kOneWay), plain},
          {"bending", sheet(Triangulation::kOneWay), bending},
          {"alternating", sheet(Triangulation::kAlternating), bending},
          {"irregular", sheet(Triangulation::kAlternating, true), bending},
          {"curved", sheet(Triangulation::kAlternating), curved},
          {"corotational", sheet(Triangulation::kOneWay), corotational},
          {"cells", sheet(Triangulation::kOneWay), cells},
          {"irregular_cells", sheet(Triangulation::kAlternating, true), unbent_cells},
          {"springs", sheet(Triangulation::kAlternating), springs},
          regions(bending)};
}

/// The right third, where an irregular sheet is regular, and a particle by itself in the left one.
std::vector<char> rightThird(const Cloth& whole) {
  std::vector<char> included;
  for (const Eigen::Vector2d& rest : whole.mesh().rest_coordinates) {
    included.push_back(rest.x() > 0.075 ? 1 : 0);
  }
  included[5 * 13 + 2] = 1;
  return included;
}

/// What acts on the included particles, in their order.
std::vector<Vector3d> forcesOn(const std::vector<char>& included, const Cloth& cloth,
                               const ClothState& state) {
  std::vector<Vector3d> all, result;
  cloth.computeForces(state, all);
  for (std::size_t i = 0; i < included.size(); ++i) {
    if (included[i] != 0) result.push_back(all[i]);
  }
  return result;
}

/// Of the particles of a part, which are in their order.
std::vector<char> includedOf(ClothPart& part, const Cloth& whole,
                             const std::vector<char>& included) {
  std::vector<char> result;
  std::size_t i = 0;
  for (const Eigen::Vector2d& rest : part.cloth().mesh().rest_coordinates) {
    while (whole.mesh().rest_coordinates[i] != rest) ++i;
    result.push_back(included[i++]);
  }
  return result;
}

void expectForcesOfTheWhole(const Cloth& whole, const std::vector<char>& included) {
  ClothPart part(whole, included);
  ClothState state = randomState(whole, 1e-3, 0.1);
  ClothState other = randomState(whole, 1e-3, 0.1, 2);
  whole.forget(other);
  state.memory = other.memory;  // so that friction acts
  const std::vector<Vector3d> expected = forcesOn(included, whole, state);
  const std::vector<Vector3d> found =
      forcesOn(includedOf(part, whole, included), part.cloth(), part.begin(whole, state));
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_LT((found[i] - expected[i]).norm(), 1e-11 * (1.0 + expected[i].norm())) << i;
  }
}

TEST(ClothPart, ActsOnItsParticlesAsTheWholeDoes) {
  std::mt19937 random(7);
  for (const Case& one : cases()) {
    SCOPED_TRACE(one.name);
    Cloth whole(one.mesh, one.fabrics, one.effects);
    std::vector<PointLoad> loads;
    for (int triangle = 0; triangle < 240; triangle += 7) {
      loads.push_back({triangle, Vector3d(0.2, 0.3, 0.5), Vector3d::Zero(), Vector3d(0.1, 0, 0),
                       Eigen::Matrix3d::Identity()});
    }
    whole.setPointLoads(loads);
    for (int i = 0; i < 143; i += 3) whole.setExternalForce(i, {0.01, 0.02, 1e-4 * i});
    expectForcesOfTheWhole(whole, rightThird(whole));
    std::uniform_int_distribution<std::size_t> any(0, whole.particleCount() - 1);
    for (int set = 0; set < 20; ++set) {
      SCOPED_TRACE(set);
      std::vector<char> included(whole.particleCount(), 0);
      for (int i = 0; i <= set % 4; ++i) included[any(random)] = 1;
      expectForcesOfTheWhole(whole, included);
    }
  }
}

TEST(ClothPart, WritesBackWhatMovesAndNothingElse) {
  ModelledEffects effects = cases()[1].effects;
  Cloth whole(sheet(mesh::Triangulation::kOneWay), fabricWithAll(), effects);
  const std::vector<char> included = rightThird(whole);
  for (std::size_t i = 0; i < included.size(); ++i) {
    if (included[i] == 0) {
      whole.attach(static_cast<int>(i),
                   {whole.mesh().initial_positions[i], Vector3d::Zero(), 0.0, 0.0});
    }
  }
  ClothPart part(whole, included);
  const ClothState start = whole.initialState();
  ClothState state = start;
  Integrator integrator(part.cloth(), {});
  for (int step = 0; step < 5; ++step) {
    ASSERT_TRUE(integrator.step(part.cloth(), part.begin(whole, state), 0.005).accepted);
    part.end(state);
  }
  EXPECT_NEAR(state.time, 0.025, 1e-15);
  for (std::size_t i = 0; i < included.size(); ++i) {
    EXPECT_EQ(state.positions[i] != start.positions[i], included[i] != 0) << i;
  }
  // What it remembers is what the whole would, after the same motion.
  ClothState followed = start;
  followed.positions = state.positions;
  whole.remember(followed);
  int changed = 0;
  for (std::size_t i = 0; i < state.memory.size(); ++i)
    changed += state.memory[i] != start.memory[i];
  EXPECT_GT(changed, 20);
  EXPECT_LT(changed, static_cast<int>(state.memory.size()));
}

TEST(ClothPart, RefusesWhatItCannotBe) {
  const auto expectRefused = [](const Cloth& whole, const std::vector<char>& included,
                                const std::string& expected) {
    try {
      ClothPart(whole, included);
      FAIL() << "accepted, instead of: " << expected;
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find(expected), std::string::npos) << error.what();
    }
  };
  const Cloth whole(square(2), linearFabric(), {});
  expectRefused(whole, {1, 0}, "included has 2 entries; the cloth has 9 particles");
  expectRefused(whole, std::vector<char>(9, 0), "no particle is included");
  ModelledEffects colliding;
  colliding.contacts = colliding.self_collision = true;
  const Cloth collides(square(2), fabricNamed("wool"), colliding);
  expectRefused(collides, std::vector<char>(9, 1), "self_collision is modelled");
}

}  // namespace
}  // namespace haptex::cloth::test_cloth_part
