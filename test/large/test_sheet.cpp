#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "../refusal.h"
#include "../temporary_directory.h"
#include "haptex/large/sheet.h"
#include "haptex/material/fabric_file.h"

namespace haptex::large {
namespace {

using cloth::ClothState;
using Eigen::Vector3d;

constexpr double kA = 5e-3;  // s, of a stage

struct Modelled {
  const char* name;
  cloth::ModelledEffects effects;
  mesh::Triangulation triangulation = mesh::Triangulation::kAlternating;
};

/// All that forces on a sheet may be of.
std::vector<Modelled> modelled() {
  cloth::ModelledEffects plain;
  plain.gravity = {0.0, 0.0, -9.80665};
  plain.viscosity = true;
  cloth::ModelledEffects cells = plain;
  cells.bending = true;
  cells.elasticity = cloth::Elasticity::kBilinear;
  cloth::ModelledEffects quadratic = plain;
  quadratic.bending = true;
  quadratic.bending_settings.model = cloth::BendingModel::kQuadratic;
  cloth::ModelledEffects remembering = plain;
  remembering.bending = remembering.bending_hysteresis = remembering.membrane_hysteresis = true;
  cloth::ModelledEffects windy = cells;
  windy.air = cloth::Air{};
  cloth::ModelledEffects corotational = plain;
  corotational.elasticity = cloth::Elasticity::kCorotational;
  cloth::ModelledEffects springs = plain;
  springs.elasticity = cloth::Elasticity::kMassSpring;
  return {{"plain", plain},
          {"plain, one way", plain, mesh::Triangulation::kOneWay},
          {"cells that bend", cells},
          {"cells that bend, one way", cells, mesh::Triangulation::kOneWay},
          {"quadratic bending", quadratic},
          {"hysteresis", remembering},
          {"wind", windy},
          {"corotational", corotational},
          {"springs", springs}};
}

Sheet sheetOf(const Modelled& what) {
  Sheet sheet;
  sheet.width = 0.14;
  sheet.height = 1.01;
  sheet.cells_u = 7;
  sheet.cells_v = 101;
  sheet.triangulation = what.triangulation;
  sheet.axes.col(0) = Vector3d::UnitY();
  sheet.axes.col(1) = Vector3d::UnitX();
  sheet.held = {mesh::Side::kTop, mesh::Side::kLeft};
  sheet.fabric = material::loadFabric(HAPTEX_CONFIG_DIRECTORY "/fabrics/wool.yaml");
  sheet.effects = what.effects;
  return sheet;
}

/// Waves by the rest coordinates, so that parts have what the whole has.
void deform(const cloth::Cloth& cloth, ClothState& state) {
  for (std::size_t i = 0; i < cloth.particleCount(); ++i) {
    const Eigen::Vector2d& rest = cloth.mesh().rest_coordinates[i];
    const double wave = std::sin(210.0 * rest.x() + 97.0 * rest.y());
    state.positions[i] += Vector3d(1e-3 * wave, 2e-3 * std::cos(143.0 * rest.y()), 4e-3 * wave);
    state.velocities[i] = {0.3 * wave, std::cos(71.0 * rest.x()), -0.7 * wave * wave};
  }
  cloth.remember(state);
  for (std::size_t i = 0; i < cloth.particleCount(); ++i) {
    state.positions[i] += 1e-3 * state.velocities[i];
  }
}

struct System {
  explicit System(const cloth::Cloth& cloth)
      : matrix(cloth.pattern()), rhs(linear::BlockVector::Zero(3, matrix.size())) {}
  linear::SymmetricBlockMatrix matrix;
  linear::BlockVector rhs;
};

/// Of the first solve of a stage, and of a Newton iteration.
struct Systems {
  System linearised, newton;
  double potential = 0.0, energy = 0.0;
};

Systems systemsOf(const cloth::Cloth& cloth) {
  Systems systems{System(cloth), System(cloth)};
  ClothState state = cloth.initialState();
  deform(cloth, state);
  ClothState base = state;
  for (std::size_t i = 0; i < cloth.particleCount(); ++i) {
    base.positions[i] -= kA * base.velocities[i];
  }
  const cloth::ForceState at = state.ofForces();
  cloth.forces().assembleLinearised(at, {kA, kA}, systems.linearised.matrix,
                                    systems.linearised.rhs);
  std::vector<Vector3d> held(cloth.forces().heldSize());
  cloth.forces().hold({base.positions, at, kA, false}, held.data());
  cloth.forces().assembleNewton(at, held.data(), kA, cloth::Hessian::kExact, systems.newton.matrix,
                                systems.newton.rhs);
  systems.potential = cloth.forces().incrementalPotential(at, held.data(), kA);
  systems.energy = cloth.potentialEnergy(state);
  return systems;
}

/// The largest difference of the rows that a part knows whole from those of the sheet, over the
/// largest number of these.
double difference(const System& whole, const System& part, const PartPlace& place) {
  const auto offset = static_cast<int>(place.offset);
  double largest = 0.0, scale = 0.0, rhs_difference = 0.0;
  for (int i = 0; i < part.matrix.size(); ++i) {
    const bool known = i >= place.whole_begin && i < place.whole_end;
    const auto compare = [&](const Eigen::Matrix3d& here, const Eigen::Matrix3d& there) {
      largest = std::max(largest, (here - there).cwiseAbs().maxCoeff());
      scale = std::max(scale, there.cwiseAbs().maxCoeff());
    };
    if (known) {
      compare(part.matrix.diagonal(i), whole.matrix.diagonal(offset + i));
      rhs_difference =
          std::max(rhs_difference, (part.rhs.col(i) - whole.rhs.col(offset + i)).norm());
    }
    for (int s = part.matrix.rowBegin(i); s < part.matrix.rowBegin(i + 1); ++s) {
      const int j = part.matrix.column(s);
      if (!known && (j < place.whole_begin || j >= place.whole_end)) continue;
      compare(part.matrix.lower(s), whole.matrix.lower(whole.matrix.slot(offset + i, offset + j)));
    }
  }
  return std::max(largest / scale, rhs_difference / whole.rhs.cwiseAbs().maxCoeff());
}

/// Blocks of the rows from begin to end.
int blocksOf(const linear::SymmetricBlockMatrix& matrix, int begin, int end) {
  const auto own = [&](int i) { return i >= begin && i < end; };
  int count = 0;
  for (int i = 0; i < matrix.size(); ++i) {
    for (int s = matrix.rowBegin(i); s < matrix.rowBegin(i + 1); ++s) {
      count += own(i) || own(matrix.column(s)) ? 1 : 0;
    }
  }
  return count;
}

TEST(LargeSheet, PartsHaveTheirRowsOfTheWholeSystem) {
  for (const Modelled& what : modelled()) {
    const Sheet sheet = sheetOf(what);
    const cloth::Cloth cloth = clothOf(sheet, {0, sheet.rowCount()});
    const Systems whole = systemsOf(cloth);
    for (const int parts : {1, 3, 4, 11}) {
      int own = 0;
      for (int part = 0; part < parts; ++part) {
        const Systems mine = systemsOf(clothOf(sheet, knownRows(sheet, part, parts)));
        const PartPlace place = placeOf(sheet, part, parts);
        EXPECT_LT(difference(whole.linearised, mine.linearised, place), 1e-12)
            << what.name << ", part " << part << " of " << parts;
        EXPECT_LT(difference(whole.newton, mine.newton, place), 1e-12)
            << what.name << ", part " << part << " of " << parts;
        const auto offset = static_cast<int>(place.offset);
        EXPECT_EQ(
            blocksOf(mine.newton.matrix, place.whole_begin, place.whole_end),
            blocksOf(whole.newton.matrix, offset + place.whole_begin, offset + place.whole_end))
            << what.name << ", part " << part << " of " << parts;
        own += place.own_end - place.own_begin;
      }
      EXPECT_EQ(own, sheet.particleCount());
    }
  }
}

TEST(LargeSheet, EnergiesOfPartsLessThoseOfSharedRowsAreThatOfTheWhole) {
  for (const Modelled& what : modelled()) {
    const Sheet sheet = sheetOf(what);
    const Systems whole = systemsOf(clothOf(sheet, {0, sheet.rowCount()}));
    for (const int parts : {3, 11}) {
      double potential = 0.0, energy = 0.0;
      for (int part = 0; part < parts; ++part) {
        const Rows known = knownRows(sheet, part, parts);
        const Systems mine = systemsOf(clothOf(sheet, known));
        potential += mine.potential;
        energy += mine.energy;
        if (part + 1 == parts) break;
        const Rows next = knownRows(sheet, part + 1, parts);
        const Systems shared = systemsOf(clothOf(sheet, {next.begin, known.end}));
        potential -= shared.potential;
        energy -= shared.energy;
      }
      EXPECT_NEAR(potential, whole.potential, 1e-11 * std::abs(whole.potential)) << what.name;
      EXPECT_NEAR(energy, whole.energy, 1e-11 * std::abs(whole.energy)) << what.name;
    }
  }
}

TEST(LargeSheet, HoldsWhatTheSceneHoldsWhereTheSceneHasIt) {
  const test::TemporaryDirectory directory;
  const std::string path = directory.path() + "/lying.yaml";
  std::ofstream(path) << "fabric: " HAPTEX_CONFIG_DIRECTORY
                         "/fabrics/wool.yaml\n"
                         "sheet: {size: [0.3, 0.2], cells: [3, 2], diagonals: one_way,\n"
                         "        position: [1, 2, 3], rpy: [0, -1.5707963267948966, 0]}\n"
                         "attach: [top, left]\n"
                         "model: [gravity]\n"
                         "time_step: 0.01\n";
  const Sheet sheet = loadSheet(path, 0.0101);
  EXPECT_EQ(sheet.cells_u, 30);
  EXPECT_EQ(sheet.cells_v, 20);
  EXPECT_EQ(sheet.triangulation, mesh::Triangulation::kOneWay);
  EXPECT_EQ(sheet.time_step, 0.01);
  const cloth::Cloth cloth = clothOf(sheet, {0, sheet.rowCount()});
  int held = 0;
  for (std::size_t i = 0; i < cloth.particleCount(); ++i) {
    held += cloth.isAttached(static_cast<int>(i)) ? 1 : 0;
  }
  EXPECT_EQ(held, 31 + 20);
  const auto middle_of_top = cloth.mesh().initial_positions[20 * 31 + 15];
  EXPECT_LT((middle_of_top - Vector3d(1.0, 2.0, 3.0)).norm(), 1e-12);
  EXPECT_NEAR(cloth.mesh().initial_positions[0].z(), 3.0, 1e-12);
}

TEST(LargeSheet, RefusesWhatIsMoreThanASheetInTheAir) {
  const std::string scenes = HAPTEX_CONFIG_DIRECTORY "/scenes/";
  const auto refusal = [](const std::string& path, double edge) {
    return test::refusalOf([&] { loadSheet(path, edge); });
  };
  const std::string allowed = "; allowed is a sheet that is held by its sides and moves in the air";
  EXPECT_EQ(refusal(scenes + "dropped_sheet.yaml", 0.01),
            scenes + "dropped_sheet.yaml: its cloth collides" + allowed);
  EXPECT_EQ(refusal(scenes + "tshirt.yaml", 0.01),
            scenes +
                "tshirt.yaml: its cloth is no sheet, has regions, starts from a saved state or "
                "is attached by more than its sides" +
                allowed);
  EXPECT_EQ(refusal(scenes + "linear_sheet.yaml", 0.0),
            "the edge is 0 m: allowed are finite lengths greater than 0");
  EXPECT_EQ(refusal(scenes + "linear_sheet.yaml", std::nan("")),
            "the edge is nan m: allowed are finite lengths greater than 0");
  EXPECT_EQ(refusal(scenes + "linear_sheet.yaml", 1e-9),
            "with edges of 1e-09 m there would be 250000001000000001 particles: allowed are "
            "700000000");
}

}  // namespace
}  // namespace haptex::large
