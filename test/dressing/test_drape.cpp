// Panels that are sewn on a body and come to rest.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>

#include "../refusal.h"
#include "dressing_fixtures.h"
#include "haptex/dressing/drape.h"
#include "haptex/garment/placement/overlaps.h"

namespace haptex::dressing::test_drape {
namespace {

const auto refusalOf = [](const auto& call) { return test::refusalOf<std::exception>(call); };

constexpr double kEdge = 0.05;  // m

const DrapeOutcome& tubeOnCone() {
  static const DrapeOutcome outcome =
      drape(garment::makeGarmentMesh(tube(0.15), kEdge), wool(), cone(0.2, 0.04, 0.4), {});
  return outcome;
}

/// m, above the ground.
double lowest(const mesh::ClothMesh& mesh) {
  double lowest = 1.0;
  for (const Eigen::Vector3d& place : mesh.initial_positions) {
    lowest = std::min(lowest, place.z());
  }
  return lowest;
}

TEST(Drape, EndsAtRestWithoutAnIntersection) {
  const DrapeOutcome& outcome = tubeOnCone();
  EXPECT_TRUE(outcome.isSound());
  EXPECT_TRUE(outcome.at_rest);
  EXPECT_LE(outcome.fastest, DrapeSettings().rest_speed);
  EXPECT_EQ(outcome.intersecting_states, 0);
  EXPECT_EQ(outcome.with_itself, 0u);
  EXPECT_EQ(outcome.with_body, 0u);
  EXPECT_LT(outcome.closed_gap, DrapeSettings().sewn_gap);
}

TEST(Drape, LeavesOpenOnlyWhatIsNotSewn) {
  std::map<std::array<int, 2>, int> triangles_at;
  const mesh::ClothMesh& mesh = tubeOnCone().mesh;
  for (const auto& t : mesh.triangles) {
    for (int i = 0; i < 3; ++i) {
      const int a = t[i], b = t[(i + 1) % 3];
      ++triangles_at[{std::min(a, b), std::max(a, b)}];
    }
  }
  // Both hems of the tube, each of two panels' widths.
  double border = 0.0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto corners = mesh.restCorners(t);
    for (int i = 0; i < 3; ++i) {
      const int a = mesh.triangles[t][i], b = mesh.triangles[t][(i + 1) % 3];
      if (triangles_at[{std::min(a, b), std::max(a, b)}] > 1) continue;
      border += (corners[(i + 1) % 3] - corners[i]).norm();
    }
  }
  EXPECT_NEAR(border, 4 * 0.3, 1e-12);
}

/// The tube gets no lower than where the cone is as wide as its lower hem.
TEST(Drape, HangsOnAConeWhereThatIsAsWide) {
  // The radius falls by 0.4 m/m; a tube of circumference 0.6 m around a polygon of 24 sides.
  const double radius = 0.6 / (2.0 * 24 * std::sin(M_PI / 24));
  const double expected = (0.2 - radius) / 0.4;
  // The hem stretches by some 1e-3, and is not quite level.
  EXPECT_NEAR(lowest(tubeOnCone().mesh), expected, 0.01);
}

/// Sewn with few triangles: what is halved comes to rest in the same place, of four times as many.
TEST(Drape, ComesToRestWithEdgesHalvedOnceItIsSewn) {
  DrapeSettings settings;
  settings.halvings = 1;
  const auto garment = garment::makeGarmentMesh(tube(0.15), kEdge);
  const DrapeOutcome outcome = drape(garment, wool(), cone(0.2, 0.04, 0.4), settings);
  EXPECT_TRUE(outcome.isSound());
  EXPECT_EQ(outcome.intersecting_states, 0);
  EXPECT_LE(outcome.fastest, settings.rest_speed);
  EXPECT_EQ(outcome.mesh.triangles.size(), 4 * tubeOnCone().mesh.triangles.size());
  EXPECT_EQ(outcome.mesh.panels.size(), garment.mesh.panels.size());
  EXPECT_NEAR(lowest(outcome.mesh), lowest(tubeOnCone().mesh), 0.01);
}

TEST(Drape, StartsWithTheLongestEdgesThatHalvingMakesThoseAskedFor) {
  const auto is = [](double edge_length, double coarse, int halvings) {
    const CoarseStart start = coarseStart(edge_length);
    EXPECT_EQ(start.edge_length, coarse);
    EXPECT_EQ(start.halvings, halvings);
  };
  is(0.06, 0.06, 0);
  is(0.03, 0.03, 0);
  is(0.02, 0.04, 1);
  is(0.01, 0.04, 2);
  is(0.007, 0.028, 2);
}

TEST(Drape, RefusesToHalveEdgesLessThanNeverOrTooOften) {
  const auto garment = garment::makeGarmentMesh(tube(0.15), kEdge);
  for (const int halvings : {-1, 9}) {
    DrapeSettings settings;
    settings.halvings = halvings;
    const std::string refusal =
        refusalOf([&] { drape(garment, wool(), cone(0.2, 0.04, 0.4), settings); });
    EXPECT_NE(refusal.find("halvings"), std::string::npos) << refusal;
    EXPECT_NE(refusal.find("0 to 8"), std::string::npos) << refusal;
  }
}

TEST(Drape, ReadsAsManyFabricsAsTheGarmentNames) {
  const auto garment = garment::makeGarmentMesh(tube(0.15), kEdge);
  EXPECT_NE(refusalOf([&] {
              drape(garment, {}, cone(0.2, 0.04, 0.4), {});
            }).find("there are 0 fabrics: allowed are 1"),
            std::string::npos);
}

/// Sewn where it starts it would cut into the cone, and nobody waits: so the second way closes it.
TEST(Drape, BeginsAnewWhereWhatIsSewnWouldIntersect) {
  DrapeSettings settings;
  settings.sewn_gap = 0.3;
  settings.patience = 1e-9;
  const auto garment = garment::makeGarmentMesh(tube(0.15), kEdge);
  const mesh::ObstacleMesh body = cone(0.25, 0.04, 0.4);
  const mesh::ClothMesh sewn = mesh::merge(garment.mesh, garment.seams).mesh;
  ASSERT_FALSE(garment::findOverlaps(sewn, body.vertices, body.triangles).empty());
  const DrapeOutcome outcome = drape(garment, wool(), body, settings);
  EXPECT_TRUE(outcome.isSound());
  EXPECT_EQ(outcome.intersecting_states, 0);
  EXPECT_GT(outcome.closing_time, 0.0);
}

TEST(Drape, RefusesPanelsThatStartInTheBody) {
  const auto garment = garment::makeGarmentMesh(tube(0.15), kEdge);
  const std::string refusal = refusalOf([&] { drape(garment, wool(), cone(0.5, 0.04, 0.4), {}); });
  EXPECT_NE(refusal.find("touches obstacle 'body' at the start"), std::string::npos) << refusal;
}

TEST(Drape, NamesThePanelsOfASeamThatCannotClose) {
  DrapeSettings settings;
  settings.most_closing_time = 1.0;
  const auto garment = garment::makeGarmentMesh(tube(0.15), kEdge);
  // 0.2 m wide everywhere: 1.26 m around, and the tube has 0.6 m.
  const std::string refusal =
      refusalOf([&] { drape(garment, wool(), cone(0.2, 0.2, 0.4), settings); });
  EXPECT_NE(refusal.find("the seam of the panels 'front' and 'back' is open by"), std::string::npos)
      << refusal;
}

TEST(Drape, RefusesSettingsThatAreNoNumbers) {
  const auto garment = garment::makeGarmentMesh(tube(0.15), kEdge);
  for (double DrapeSettings::*number :
       {&DrapeSettings::time_step, &DrapeSettings::damping, &DrapeSettings::closing_speed,
        &DrapeSettings::tension, &DrapeSettings::lift, &DrapeSettings::thickness,
        &DrapeSettings::patience, &DrapeSettings::sewn_gap, &DrapeSettings::halved_speed,
        &DrapeSettings::farthest, &DrapeSettings::longest_step, &DrapeSettings::rest_speed,
        &DrapeSettings::rest_time, &DrapeSettings::most_closing_time, &DrapeSettings::most_time}) {
    for (const double value : {-1.0, std::numeric_limits<double>::quiet_NaN(),
                               std::numeric_limits<double>::infinity()}) {
      DrapeSettings settings;
      settings.*number = value;
      EXPECT_THROW(drape(garment, wool(), cone(0.2, 0.04, 0.4), settings), std::invalid_argument);
    }
  }
}

TEST(Drape, CountsWhatIsInTheBody) {
  const mesh::ObstacleMesh body = cone(0.2, 0.04, 0.4);
  mesh::ClothMesh cloth;
  cloth.triangles = {{0, 1, 2}};
  const auto count = [&](const std::vector<Eigen::Vector3d>& positions) {
    cloth.initial_positions = positions;
    const auto overlaps = garment::findOverlaps(cloth, body.vertices, body.triangles);
    return overlaps.count({0, 1}) > 0 ? overlaps.at({0, 1}) : 0;
  };
  EXPECT_EQ(count({{1, 0, 0}, {1, 1, 0}, {1, 0, 1}}), 0);
  EXPECT_GT(count({{-1, 0, 0.1}, {1, 1, 0.1}, {1, -1, 0.1}}), 0);
}

}  // namespace
}  // namespace haptex::dressing::test_drape
