#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "fixtures.h"
#include "haptex/contact/refined_cut.h"

namespace haptex::contact::test_refined_cut {
namespace {

double signedArea(const mesh::ClothMesh& mesh, int triangle) {
  const auto& t = mesh.triangles[triangle];
  const Eigen::Vector2d a = mesh.rest_coordinates[t[1]] - mesh.rest_coordinates[t[0]];
  const Eigen::Vector2d b = mesh.rest_coordinates[t[2]] - mesh.rest_coordinates[t[0]];
  return 0.5 * (a.x() * b.y() - a.y() * b.x());
}

class RefinedCutLevel : public testing::TestWithParam<int> {
 protected:
  /// The square of 2 x 2 cells in the middle.
  RefinedCut cutMiddle() const {
    return cutAndRefine(mesh_, topology_, triangles_, nothingAttached(mesh_), GetParam());
  }
  int divisions() const { return 1 << GetParam(); }

  const mesh::ClothMesh mesh_ = smallSample();
  const MeshTopology topology_{mesh_};
  const std::vector<int> triangles_ = trianglesAround(mesh_, {0.02, 0.02}, 0.005);
};

INSTANTIATE_TEST_SUITE_P(Refinement, RefinedCutLevel, testing::Range(0, 5));

TEST_P(RefinedCutLevel, SplitsEveryTriangleIntoEqualOnesOfTheSameOrientation) {
  const RefinedCut cut = cutMiddle();
  ASSERT_EQ(cut.mesh.triangles.size(), triangles_.size() * divisions() * divisions());
  const double part = 1.0 / (divisions() * divisions());
  for (std::size_t t = 0; t < cut.mesh.triangles.size(); ++t) {
    const double whole = signedArea(mesh_, triangles_[t / (divisions() * divisions())]);
    EXPECT_NEAR(signedArea(cut.mesh, static_cast<int>(t)), part * whole, 1e-12 * std::abs(whole));
  }
}

TEST_P(RefinedCutLevel, HasAParticleOnceAndNoLooseEdge) {
  const RefinedCut cut = cutMiddle();
  const int side = 2 * divisions();  // triangles along a side of the square
  EXPECT_EQ(cut.supports.size(), static_cast<std::size_t>((side + 1) * (side + 1)));
  EXPECT_TRUE(findDefects(cut.mesh).none());
  std::map<std::pair<int, int>, int> edges;
  for (const auto& t : cut.mesh.triangles) {
    for (int k = 0; k < 3; ++k) ++edges[std::minmax(t[k], t[(k + 1) % 3])];
  }
  int border = 0;
  for (const auto& [edge, count] : edges) {
    EXPECT_LE(count, 2);
    border += count == 1;
  }
  EXPECT_EQ(border, 4 * side) << "a triangle's corner lies on another one's edge";
}

TEST_P(RefinedCutLevel, WeightsAndSharesTellTheSamePlace) {
  const RefinedCut cut = cutMiddle();
  for (std::size_t i = 0; i < cut.supports.size(); ++i) {
    const Support& support = cut.supports[i];
    Eigen::Vector2d by_shares = Eigen::Vector2d::Zero(), by_weights = Eigen::Vector2d::Zero();
    int sum = 0;
    for (int k = 0; k < 3; ++k) {
      sum += support.shares[k];
      if (support.particles[k] >= 0) {
        EXPECT_GT(support.shares[k], 0);
        by_shares += support.shares[k] * mesh_.rest_coordinates[support.particles[k]] / divisions();
      }
      by_weights += cut.weights[i][k] * mesh_.rest_coordinates[mesh_.triangles[cut.owners[i]][k]];
    }
    EXPECT_EQ(sum, divisions());
    EXPECT_NEAR((by_shares - cut.mesh.rest_coordinates[i]).norm(), 0.0, 1e-15);
    EXPECT_NEAR((by_weights - cut.mesh.rest_coordinates[i]).norm(), 0.0, 1e-15);
  }
}

TEST_P(RefinedCutLevel, OrderSortsTheSupports) {
  const RefinedCut cut = cutMiddle();
  ASSERT_EQ(cut.order.size(), cut.supports.size());
  for (std::size_t i = 1; i < cut.order.size(); ++i) {
    EXPECT_TRUE(cut.supports[cut.order[i - 1]] < cut.supports[cut.order[i]]);
  }
}

TEST_P(RefinedCutLevel, TheRimIsWhereTheMeshGoesOn) {
  const RefinedCut cut = cutMiddle();
  const int side = 2 * divisions();
  ASSERT_EQ(cut.free_count, (side - 1) * (side - 1));
  for (std::size_t i = 0; i < cut.supports.size(); ++i) {
    const Eigen::Vector2d from_middle = cut.mesh.rest_coordinates[i] - Eigen::Vector2d(0.02, 0.02);
    const bool on_rim = from_middle.lpNorm<Eigen::Infinity>() > 0.005 - 1e-9;
    EXPECT_EQ(static_cast<int>(i) >= cut.free_count, on_rim) << from_middle.transpose();
  }
}

TEST_P(RefinedCutLevel, TheMeshsOwnBorderIsFree) {
  // The 2 x 2 cells in the corner u = v = 0: two sides are the mesh's border.
  const std::vector<int> triangles = trianglesAround(mesh_, {0.005, 0.005}, 0.005);
  const RefinedCut cut =
      cutAndRefine(mesh_, topology_, triangles, nothingAttached(mesh_), GetParam());
  const int side = 2 * divisions();
  EXPECT_EQ(cut.free_count, side * side);
  for (int i = 0; i < cut.free_count; ++i) {
    EXPECT_LT(cut.mesh.rest_coordinates[i].maxCoeff(), 0.01 - 1e-9);
  }
}

TEST_P(RefinedCutLevel, WhatIsAttachedBelongsToTheRim) {
  const std::vector<int> triangles = trianglesAround(mesh_, {0.005, 0.005}, 0.005);
  std::vector<char> attached = nothingAttached(mesh_);
  for (int particle : sideParticles(mesh_, mesh::Side::kBottom)) attached[particle] = 1;
  const RefinedCut cut = cutAndRefine(mesh_, topology_, triangles, attached, GetParam());
  const int side = 2 * divisions();
  EXPECT_EQ(cut.free_count, side * (side - 1));
  for (int i = 0; i < cut.free_count; ++i) EXPECT_GT(cut.mesh.rest_coordinates[i].y(), 1e-9);
}

TEST_P(RefinedCutLevel, OneAttachedCornerHoldsNoEdge) {
  const std::vector<int> triangles = trianglesAround(mesh_, {0.005, 0.005}, 0.005);
  std::vector<char> attached = nothingAttached(mesh_);
  attached[0] = 1;
  const RefinedCut cut = cutAndRefine(mesh_, topology_, triangles, attached, GetParam());
  const int side = 2 * divisions();
  EXPECT_EQ(cut.free_count, side * side - 1);
}

TEST_P(RefinedCutLevel, AnotherCutHasTheSameSupportForTheSamePlace) {
  const RefinedCut here = cutMiddle();
  const std::vector<int> moved = trianglesAround(mesh_, {0.025, 0.02}, 0.005);
  const RefinedCut there =
      cutAndRefine(mesh_, topology_, moved, nothingAttached(mesh_), GetParam());
  int shared = 0;
  for (std::size_t i = 0; i < here.supports.size(); ++i) {
    for (std::size_t j = 0; j < there.supports.size(); ++j) {
      const bool same_place =
          (here.mesh.rest_coordinates[i] - there.mesh.rest_coordinates[j]).norm() < 1e-9;
      ASSERT_EQ(here.supports[i] == there.supports[j], same_place);
      shared += same_place;
    }
  }
  EXPECT_EQ(shared, (divisions() + 1) * (2 * divisions() + 1));
}

/// The 2 x 2 cells in the middle refined, and all elements within 10 mm around them.
class CutWithSurroundings : public RefinedCutLevel {
 protected:
  const std::vector<int> around_ = trianglesAround(mesh_, topology_, triangles_, 0.01, 1000);
  const RefinedCut cut_ =
      cutAndRefine(mesh_, topology_, triangles_, nothingAttached(mesh_), GetParam(), around_);
};

INSTANTIATE_TEST_SUITE_P(Refinement, CutWithSurroundings, testing::Range(0, 5));

TEST_P(CutWithSurroundings, HasTheAreaOfItsElementsAndNoLooseEdge) {
  EXPECT_TRUE(findDefects(cut_.mesh).none());
  ASSERT_EQ(cut_.elements.size(), triangles_.size() + around_.size());
  double elements = 0.0, triangles = 0.0;
  for (const int element : cut_.elements) elements += signedArea(mesh_, element);
  std::map<std::pair<int, int>, int> edges;
  for (int t = 0; t < static_cast<int>(cut_.mesh.triangles.size()); ++t) {
    triangles += signedArea(cut_.mesh, t);
    EXPECT_GT(signedArea(cut_.mesh, t), 0.0);
    const auto& corners = cut_.mesh.triangles[t];
    for (int k = 0; k < 3; ++k) ++edges[std::minmax(corners[k], corners[(k + 1) % 3])];
  }
  EXPECT_NEAR(triangles, elements, 1e-12 * elements);
  int border = 0;
  for (const auto& [edge, count] : edges) border += count == 1;
  std::map<std::pair<int, int>, int> coarse_edges;
  for (const int element : cut_.elements) {
    const auto& corners = mesh_.triangles[element];
    for (int k = 0; k < 3; ++k) ++coarse_edges[std::minmax(corners[k], corners[(k + 1) % 3])];
  }
  int coarse_border = 0;
  for (const auto& [edge, count] : coarse_edges) coarse_border += count == 1;
  EXPECT_EQ(border, coarse_border) << "a triangle's corner lies on another one's edge";
}

TEST_P(CutWithSurroundings, RefinesTheElementsBeforeTheOthers) {
  const auto count = static_cast<std::size_t>(cut_.refined_count) * divisions() * divisions();
  ASSERT_GE(cut_.refined_count, static_cast<int>(triangles_.size()));
  ASSERT_LE(count, cut_.mesh.triangles.size());
  for (std::size_t t = 0; t < count; ++t) {
    const int element = cut_.elements[t / (divisions() * divisions())];
    EXPECT_NEAR(signedArea(cut_.mesh, static_cast<int>(t)),
                signedArea(mesh_, element) / (divisions() * divisions()), 1e-18);
  }
}

TEST_P(CutWithSurroundings, FindsTheParticlesOfTheMesh) {
  for (const int element : cut_.elements) {
    for (const int corner : mesh_.triangles[element]) {
      const int particle = cornerIn(cut_, corner);
      ASSERT_GE(particle, 0);
      EXPECT_EQ(cut_.mesh.rest_coordinates[particle], mesh_.rest_coordinates[corner]);
    }
  }
  EXPECT_EQ(cornerIn(cut_, 0), -1);
}

TEST(TrianglesAround, ComeNearestFirstWithinTheReachAndWithoutThoseInside) {
  const mesh::ClothMesh mesh = smallSample();
  const MeshTopology topology(mesh);
  const std::vector<int> inside = trianglesAround(mesh, {0.02, 0.02}, 0.005);
  const std::vector<int> ring = trianglesAround(mesh, topology, inside, 0.0051, 1000);
  // The 4 x 4 cells but the inner four; no corner of the square is a diagonal away.
  for (const int triangle : ring) {
    EXPECT_EQ(std::count(inside.begin(), inside.end(), triangle), 0);
    for (const int p : mesh.triangles[triangle]) {
      const Eigen::Vector2d from_middle = mesh.rest_coordinates[p] - Eigen::Vector2d(0.02, 0.02);
      EXPECT_LT(from_middle.lpNorm<Eigen::Infinity>(), 0.01 + 1e-9);
    }
  }
  EXPECT_GE(ring.size(), 16u);
  EXPECT_TRUE(trianglesAround(mesh, topology, inside, 0.0, 1000).empty());
  const std::vector<int> first = trianglesAround(mesh, topology, inside, 0.0051, 5);
  EXPECT_EQ(first, std::vector<int>(ring.begin(), ring.begin() + 5));
  EXPECT_EQ(trianglesAround(mesh, topology, inside, 1.0, 1000).size(),
            mesh.triangles.size() - inside.size());
}

TEST(MeshTopology, NeighboursAreMutualAndTheBorderHasNone) {
  const mesh::ClothMesh mesh = smallSample();
  const MeshTopology topology(mesh);
  int border = 0;
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) {
    for (int corner = 0; corner < 3; ++corner) {
      const int neighbour = topology.neighbour(t, corner);
      if (neighbour < 0) {
        ++border;
        continue;
      }
      int back = 0;
      for (int k = 0; k < 3; ++k) back += topology.neighbour(neighbour, k) == t;
      EXPECT_EQ(back, 1);
    }
  }
  EXPECT_EQ(border, 4 * 8);
}

}  // namespace
}  // namespace haptex::contact::test_refined_cut
