#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numeric>
#include <vector>

#include "fixtures.h"
#include "haptex/contact/layers_between.h"

namespace haptex::contact::test_layers_between {
namespace {

using base::Finger;
using Eigen::Vector3d;

constexpr double kThickness = 6e-4;  // m
constexpr double kStep = 1e-3;       // s
constexpr double kRadius = 7.5e-3;   // m

/// smallSample()s in planes x = height, as one mesh, and what is counted in a patch of all of them.
class Stack {
 public:
  explicit Stack(const std::vector<double>& heights, double turn = 0.0)
      : mesh_(stacked(heights, turn)), motion_(mesh_.rest_coordinates.size()) {
    motion_.receive(mesh_.initial_positions, 0.02);
    std::vector<int> all(mesh_.triangles.size());
    std::iota(all.begin(), all.end(), 0);
    cut_ = cutAndRefine(mesh_, MeshTopology(mesh_), all, nothingAttached(mesh_), 1);
    areas_.assign(cut_.supports.size(), 1.0);
    layers_ = std::make_unique<LayersBetween>(mesh_, cut_, kThickness, areas_);
    index_.radius = thumb_.radius = kRadius;
    index_.position = kSmallSampleMiddle + Vector3d(kRadius + 2e-3, 0.0, 0.0);
    thumb_.position = kSmallSampleMiddle - Vector3d(kRadius + 2e-3, 0.0, 0.0);
  }

  void pinch(double seconds) { update(seconds, {&index_, &thumb_}); }
  void update(double seconds, const base::PerFinger<const Fingertip*>& fingertips) {
    for (int i = 0; i < std::lround(seconds / kStep); ++i) {
      motion_.advance(kStep);
      layers_->update(motion_, fingertips, kStep);
    }
  }
  /// Calls with the number of the layer and the particle, of those in the middle.
  template <typename Visit>
  void forEach(Visit&& visit) const {
    int count = 0;
    const int per_layer = static_cast<int>(mesh_.rest_coordinates.size()) / layers_in_stack_;
    for (int i = 0; i < cut_.free_count; ++i) {
      const int corner = mesh_.triangles[cut_.owners[i]][0];
      const Vector3d place = mesh_.initial_positions[corner] - kSmallSampleMiddle;
      if (std::hypot(place.y(), place.z()) > 3e-3) continue;
      visit(corner / per_layer, i);
      ++count;
    }
    EXPECT_GE(count, 4 * layers_in_stack_);
  }
  const LayersBetween& layers() const { return *layers_; }
  const Fingertip& index() const { return index_; }
  const std::vector<double>& areas() const { return areas_; }

 private:
  mesh::ClothMesh stacked(const std::vector<double>& heights, double turn) {
    layers_in_stack_ = static_cast<int>(heights.size());
    mesh::ClothMesh all;
    const mesh::ClothMesh one = smallSample();
    for (std::size_t layer = 0; layer < heights.size(); ++layer) {
      const int first = static_cast<int>(all.rest_coordinates.size());
      const Eigen::AngleAxisd turned(turn * static_cast<double>(layer), Vector3d::UnitX());
      for (std::size_t i = 0; i < one.rest_coordinates.size(); ++i) {
        all.rest_coordinates.push_back(one.rest_coordinates[i] +
                                       Eigen::Vector2d(0.1 * static_cast<double>(layer), 0.0));
        all.initial_positions.push_back(kSmallSampleMiddle +
                                        turned * (one.initial_positions[i] - kSmallSampleMiddle) +
                                        Vector3d(heights[layer], 0.0, 0.0));
      }
      for (const auto& [a, b, c] : one.triangles) {
        all.triangles.push_back({a + first, b + first, c + first});
      }
    }
    return all;
  }

  int layers_in_stack_ = 0;
  mesh::ClothMesh mesh_;
  LargeScaleMotion motion_;
  RefinedCut cut_;
  std::vector<double> areas_;
  std::unique_ptr<LayersBetween> layers_;
  Fingertip index_, thumb_;
};

// Straight above each other, so that lines pass exactly through particles and edges; and turned.
TEST(LayersBetween, CountsThoseOnEitherSide) {
  for (const double turn : {0.0, 0.4}) {
    Stack stack({0.9 * kThickness, 0.0, -0.9 * kThickness}, turn);
    stack.pinch(1.0);
    EXPECT_FALSE(stack.layers().isSingle());
    stack.forEach([&](int layer, int particle) {
      EXPECT_DOUBLE_EQ(stack.layers().before(Finger::kIndex)[particle], layer);
      EXPECT_DOUBLE_EQ(stack.layers().before(Finger::kThumb)[particle], 2 - layer);
      EXPECT_DOUBLE_EQ(stack.layers().areas()[particle], stack.areas()[particle] / 3.0);
    });
  }
}

TEST(LayersBetween, LeaveASingleLayerAsItIs) {
  Stack stack({0.0});
  stack.pinch(0.2);
  EXPECT_TRUE(stack.layers().isSingle());
  EXPECT_EQ(stack.layers().areas(), stack.areas());
}

TEST(LayersBetween, CountLessTheFartherALayerIsFromTheNext) {
  const auto counted = [](double thicknesses) {
    Stack stack({0.0, -thicknesses * kThickness});
    stack.pinch(1.0);
    double most = 0.0;
    stack.forEach([&](int, int particle) {
      most = std::max(most, stack.layers().before(Finger::kThumb)[particle]);
    });
    return most;
  };
  EXPECT_DOUBLE_EQ(counted(1.0), 1.0);
  EXPECT_NEAR(counted(2.0), 0.5, 0.1);  // lines are inclined
  EXPECT_DOUBLE_EQ(counted(2.6), 0.0);
}

TEST(LayersBetween, ChangeByASmallPartPerStep) {
  Stack stack({0.0, -kThickness});
  std::vector<double> before = stack.layers().areas();
  const double most = 1.0 - std::exp(-kStep / LayersBetween::kFade);
  for (int i = 0; i < 200; ++i) {
    stack.pinch(kStep);
    const std::vector<double>& now = stack.layers().areas();
    for (std::size_t p = 0; p < now.size(); ++p) {
      ASSERT_LE(std::abs(1.0 / now[p] - 1.0 / before[p]), 1.01 * most / stack.areas()[p]);
    }
    before = now;
  }
}

TEST(LayersBetween, AreForgottenWithThePinch) {
  Stack stack({0.0, -kThickness});
  stack.update(0.2, {&stack.index(), nullptr});
  EXPECT_TRUE(stack.layers().isSingle());
  stack.pinch(0.2);
  EXPECT_FALSE(stack.layers().isSingle());
  stack.update(1.0, {&stack.index(), nullptr});
  EXPECT_TRUE(stack.layers().isSingle());
  EXPECT_EQ(stack.layers().areas(), stack.areas());
}

}  // namespace
}  // namespace haptex::contact::test_layers_between
