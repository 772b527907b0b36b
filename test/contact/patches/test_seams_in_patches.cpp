// Patches and contact on panels that were sewn together, against the sheet that was not cut.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "../fixtures.h"
#include "haptex/contact/patch_forces.h"
#include "haptex/mesh/seam.h"

namespace haptex::contact::test_seams_in_patches {
namespace {

using base::Finger;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kCut = 0.02;  // m, along weft
constexpr double kTurn = 0.7;  // rad, of what lies beyond, in its own coordinates

/// Where something of the second panel lies in its own coordinates.
Vector2d inSecondPanel(const Vector2d& place) {
  return Eigen::Rotation2Dd(kTurn) * place + Vector2d(0.3, -1.1);
}

/// The small sample, cut in two panels that are sewn together again: the second one is turned and
/// shifted, and so is its grain.
mesh::ClothMesh sewnSample() {
  mesh::ClothMesh mesh = smallSample();
  mesh.panels = {{0, 0.0}, {0, kTurn}};
  const std::vector<Vector2d> rest = mesh.rest_coordinates;
  mesh::Seam seam;
  std::vector<int> beyond(rest.size());  // per particle, its number in the second panel
  for (std::size_t i = 0; i < rest.size(); ++i) {
    beyond[i] = static_cast<int>(i);
    if (std::abs(rest[i].x() - kCut) < 1e-9) {
      beyond[i] = static_cast<int>(mesh.rest_coordinates.size());
      seam.first.push_back(static_cast<int>(i));
      seam.second.push_back(beyond[i]);
      mesh.rest_coordinates.push_back(inSecondPanel(rest[i]));
      mesh.initial_positions.push_back(Vector3d(mesh.initial_positions[i]));
    } else if (rest[i].x() > kCut) {
      mesh.rest_coordinates[i] = inSecondPanel(rest[i]);
    }
  }
  for (auto& triangle : mesh.triangles) {
    const auto& [a, b, c] = triangle;
    const bool is_second = rest[a].x() + rest[b].x() + rest[c].x() > 3.0 * kCut;
    mesh.triangle_panels.push_back(is_second ? 1 : 0);
    for (int& particle : triangle) particle = is_second ? beyond[particle] : particle;
  }
  return mesh::merge(mesh, {seam}).mesh;
}

material::Fabric woolWithoutBending() {
  material::Fabric fabric = wool();
  fabric.bending = material::BendingRigidity{0.0, 0.0};
  return fabric;
}

/// The same finger on the sheet and on what was sewn.
class SeamsInPatches : public testing::Test {
 protected:
  const mesh::ClothMesh sheet_ = smallSample();
  const mesh::ClothMesh sewn_ = sewnSample();
  const std::vector<int> middle_ = trianglesAround(sheet_, {kCut, 0.02}, 0.01);
  const std::vector<int> around_ = others(trianglesAround(sheet_, {kCut, 0.02}, 0.015), middle_);

  static std::vector<int> others(std::vector<int> triangles, const std::vector<int>& without) {
    const auto is_without = [&](int t) {
      return std::count(without.begin(), without.end(), t) > 0;
    };
    triangles.erase(std::remove_if(triangles.begin(), triangles.end(), is_without),
                    triangles.end());
    return triangles;
  }
  /// m, where a particle of a cut is on the flat sheet.
  Vector3d placeOf(const RefinedCut& cut, std::size_t particle) const {
    Vector3d place = Vector3d::Zero();
    for (int k = 0; k < 3; ++k) {
      place += cut.weights[particle][k] *
               sheet_.initial_positions[sheet_.triangles[cut.owners[particle]][k]];
    }
    return place;
  }

  HapticLayer layerOf(const mesh::ClothMesh& mesh, const material::Fabric& fabric) const {
    return {mesh, fabric, {true, Vector3d::Zero()}, settings_};
  }
  void start(HapticLayer& layer, const std::vector<int>& around) const {
    if (settings_.layer == HapticSettings::Layer::kPatch) {
      layer.exchange(layer.preparePatch(middle_, nothingAttached(sheet_), around));
    }
    layer.receive(sheet_.initial_positions, atRest(sheet_), 0.02);
  }
  /// Of pressing near the seam and rubbing across it: the largest difference of the forces (N), and
  /// the largest force.
  std::array<double, 2> compare(const material::Fabric& fabric, int steps,
                                const std::vector<int>& around = {}) const {
    HapticLayer whole = layerOf(sheet_, fabric), sewn = layerOf(sewn_, fabric);
    start(whole, around);
    start(sewn, around);
    std::array<double, 2> largest{};
    for (int i = 0; i < steps; ++i) {
      Fingertip finger = pressing(whole.law(), kSmallSampleMiddle, 1.5e-3);
      finger.velocity = {0.0, 0.03, 0.0};
      finger.position += (i - 0.5 * steps) * settings_.time_step * finger.velocity;
      whole.step({finger, std::nullopt});
      sewn.step({finger, std::nullopt});
      const FingertipContact& expected = whole.contacts()[Finger::kIndex];
      const FingertipContact& felt = sewn.contacts()[Finger::kIndex];
      EXPECT_EQ(felt.touching, expected.touching);
      largest[0] = std::max(largest[0], (felt.force - expected.force).norm());
      largest[1] = std::max(largest[1], expected.force.norm());
    }
    return largest;
  }

  HapticSettings settings_;
};

TEST_F(SeamsInPatches, HaveTheSheetsTrianglesAndOtherRestCoordinates) {
  ASSERT_EQ(sewn_.triangles, sheet_.triangles);
  EXPECT_EQ(sewn_.initial_positions, sheet_.initial_positions);
  EXPECT_EQ(sewn_.seam_hinges.size(), 8u);
  const RefinedCut cut =
      cutAndRefine(sewn_, MeshTopology(sewn_), middle_, nothingAttached(sewn_), 2);
  EXPECT_EQ(cut.mesh.seam_hinges.size(), 4u * 4u) << "of the edges on the seam, refined";
}

TEST_F(SeamsInPatches, HaveTheForcesOfTheSheetHoweverTheyAreDeformed) {
  for (const std::vector<int>& around : {std::vector<int>(), around_}) {
    std::array<std::vector<Vector3d>, 2> forces;
    for (const int i : {0, 1}) {
      const mesh::ClothMesh& mesh = i == 0 ? sheet_ : sewn_;
      const MeshTopology topology(mesh);
      const RefinedCut cut =
          cutAndRefine(mesh, topology, middle_, nothingAttached(mesh), 2, around);
      std::vector<Vector3d> positions, velocities;
      for (std::size_t k = 0; k < cut.supports.size(); ++k) {
        const double n = static_cast<double>(k);
        positions.push_back(placeOf(cut, k) +
                            1e-4 * Vector3d(std::sin(n), std::cos(3.0 * n), std::sin(7.0 * n)));
        velocities.emplace_back(0.1 * Vector3d(std::cos(n), std::sin(2.0 * n), std::cos(5.0 * n)));
      }
      forces[i].assign(positions.size(), Vector3d::Zero());
      const cloth::ModelledEffects effects{true, Vector3d::Zero()};
      forcesOn(mesh, cut, {woolWithoutBending()}, effects)
          .sum.addForces({positions, velocities}, forces[i]);
    }
    ASSERT_EQ(forces[1].size(), forces[0].size());
    double largest = 0.0, difference = 0.0;
    for (std::size_t k = 0; k < forces[0].size(); ++k) {
      largest = std::max(largest, forces[0][k].norm());
      difference = std::max(difference, (forces[1][k] - forces[0][k]).norm());
    }
    EXPECT_GT(largest, 0.01);
    EXPECT_LT(difference, 1e-9 * largest);
  }
}

TEST_F(SeamsInPatches, FeelAsTheSheetThatWasNotCut) {
  for (const std::vector<int>& around : {std::vector<int>(), around_}) {
    const auto [difference, force] = compare(woolWithoutBending(), 1, around);
    EXPECT_GT(force, 0.05);
    EXPECT_LT(difference, 1e-9 * force);
  }
}

// Steps are solved until a residual is small, from rounding errors that differ.
TEST_F(SeamsInPatches, RubbedAcrossTheSeamFeelAsTheSheetThatWasNotCut) {
  for (const std::vector<int>& around : {std::vector<int>(), around_}) {
    const auto [difference, force] = compare(woolWithoutBending(), 100, around);
    EXPECT_GT(force, 0.05);
    EXPECT_LT(difference, 1e-3 * force);
  }
}

TEST_F(SeamsInPatches, OfWholeClothFeelAsTheSheetThatWasNotCut) {
  settings_.layer = HapticSettings::Layer::kWholeCloth;
  const auto [difference, force] = compare(wool(), 100);
  EXPECT_GT(force, 0.01);
  EXPECT_LT(difference, 1e-9 * force);
}

// Over a seam the hinges of cloth::SeamBending stand in for those of the sheet: another
// discretisation of the same plate, and of a small part of what a finger feels here.
TEST_F(SeamsInPatches, BendAcrossTheSeamNearlyAsTheSheet) {
  const auto [difference, force] = compare(wool(), 100);
  EXPECT_LT(difference, 0.01 * force);
  EXPECT_GT(difference, 0.0);
}

TEST_F(SeamsInPatches, HaveTheBendingEnergyOfTheSheetRolledUp) {
  constexpr double kCurvature = 2.0;  // 1/m
  const auto energy = [&](const mesh::ClothMesh& mesh, const std::vector<int>& around) {
    const MeshTopology topology(mesh);
    const RefinedCut cut = cutAndRefine(mesh, topology, middle_, nothingAttached(mesh), 2, around);
    const PatchForces forces = forcesOn(mesh, cut, {wool()}, {});
    std::vector<Vector3d> positions;
    for (std::size_t i = 0; i < cut.supports.size(); ++i) {
      const Vector3d place = placeOf(cut, i);  // the cut at y = 0
      const double angle = kCurvature * place.y();
      positions.emplace_back((1.0 - std::cos(angle)) / kCurvature, std::sin(angle) / kCurvature,
                             place.z());
    }
    const std::vector<Vector3d> velocities(positions.size(), Vector3d::Zero());
    return forces.sum.energy({positions, velocities});
  };
  const double whole = energy(sheet_, {}), sewn = energy(sewn_, {});
  EXPECT_GT(whole, 0.0);
  EXPECT_NEAR(sewn, whole, 0.02 * whole);
}

TEST_F(SeamsInPatches, SayWhereTheFingerIsInThePanelWithMostOfTheForce) {
  for (const HapticSettings::Layer kind :
       {HapticSettings::Layer::kPatch, HapticSettings::Layer::kWholeCloth}) {
    settings_.layer = kind;
    for (const double off : {-5e-3, -1e-3, 1e-3, 5e-3}) {
      // Without a patch a finger there touches the particles of the seam, which are of both.
      if (kind == HapticSettings::Layer::kWholeCloth && std::abs(off) < 2e-3) continue;
      HapticLayer whole = layerOf(sheet_, wool()), sewn = layerOf(sewn_, wool());
      start(whole, {});
      start(sewn, {});
      const Fingertip finger =
          pressing(whole.law(), kSmallSampleMiddle + Vector3d(0.0, off, 0.0), 1e-3);
      for (int i = 0; i < 20; ++i) {
        whole.step({finger, std::nullopt});
        sewn.step({finger, std::nullopt});
      }
      const FingertipContact& felt = sewn.contacts()[Finger::kIndex];
      // Near the seam the other panel's part of the contact is left out of the mean.
      const double tolerance = std::abs(off) < 2e-3 ? 3e-3 : 5e-4;
      const Vector2d place = Vector2d(kCut + off, 0.02);
      const Eigen::Rotation2Dd into_fabric(-kTurn);
      const Vector2d expected = off < 0.0 ? place : into_fabric * inSecondPanel(place);
      EXPECT_LT((felt.fabric_position - expected).norm(), tolerance) << off;
      const auto& directions = whole.contacts()[Finger::kIndex].to_fabric;
      EXPECT_LT((felt.to_fabric - directions).norm(), 0.02) << off;
    }
  }
}

TEST_F(SeamsInPatches, ReachAsFarBeyondASeamAsWithout) {
  const auto around = [](const mesh::ClothMesh& mesh) {
    std::vector<int> triangles =
        contact::trianglesAround(mesh, MeshTopology(mesh), {0}, 0.0312, mesh.triangles.size());
    std::sort(triangles.begin(), triangles.end());
    return triangles;
  };
  EXPECT_GT(around(sheet_).size(), 60u);
  EXPECT_EQ(around(sewn_), around(sheet_));
}

TEST_F(SeamsInPatches, TouchThePanelsFabric) {
  mesh::ClothMesh sewn = sewn_;
  sewn.panels[1].fabric = 1;
  material::Fabric slippery = wool();
  slippery.friction = 0.0;
  HapticLayer layer(sewn, std::vector<material::Fabric>{wool(), slippery}, {true, Vector3d::Zero()},
                    settings_);
  for (const double off : {-6e-3, 6e-3}) {
    start(layer, {});
    const Fingertip finger =
        pressing(layer.law(), kSmallSampleMiddle + Vector3d(0.0, off, 0.0), 1e-3);
    layer.step({finger, std::nullopt});
    EXPECT_EQ(layer.contacts()[Finger::kIndex].fabric, off < 0.0 ? 0 : 1);
  }
}

}  // namespace
}  // namespace haptex::contact::test_seams_in_patches
