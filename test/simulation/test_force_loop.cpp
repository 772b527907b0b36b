#include <gtest/gtest.h>

#include <algorithm>
#include <tuple>
#include <vector>

#include "force_loop_fixtures.h"

namespace haptex::simulation::test_force_loop {
namespace {

using base::Finger;
using base::Time;
using namespace std::chrono_literals;

/// Felt, and at rest.
std::unique_ptr<TouchedSheet> touched() {
  auto sheet = std::make_unique<TouchedSheet>();
  sheet->giveLayer();
  sheet->run(100);
  sheet->touch();
  sheet->run(300);
  EXPECT_GT(sheet->force().norm(), 0.01);
  EXPECT_EQ(sheet->loop().rendered(Finger::kIndex).gain, 1.0);
  return sheet;
}

TEST(ForceLoop, AFingertipThatPressesIntoTheClothIsPushedBack) {
  const auto sheet = touched();
  EXPECT_GT(sheet->force().x(), 0.99 * sheet->force().norm()) << "straight away from the sheet";
  EXPECT_EQ(sheet->force(Finger::kThumb).norm(), 0.0);
  const ForceLoopStatus status = sheet->loop().status();
  EXPECT_TRUE(status.fingers[Finger::kIndex].touching);
  EXPECT_FALSE(status.fingers[Finger::kThumb].touching);
  EXPECT_GT(status.patch_particles, 0u);
  EXPECT_EQ(status.patches, 1u);
}

TEST(ForceLoop, FingertipIsWhereHandAndFingerAre) {
  const auto sheet = touched();
  const Eigen::Vector3d expected(TouchedSheet::kTouch, 0.0, -0.05);
  EXPECT_LT((sheet->loop().rendered(Finger::kIndex).contact.position - expected).norm(), 1e-12);
}

TEST(ForceLoop, NoForceWithoutALayer) {
  TouchedSheet sheet;
  sheet.touch();
  sheet.run(200);
  EXPECT_EQ(sheet.force().norm(), 0.0);
  EXPECT_EQ(sheet.loop().rendered(Finger::kIndex).gain, 0.0);
}

TEST(ForceLoop, ForceFallsToZeroWithin20MillisecondsAndComesBackWithoutAJump) {
  for (const RendererSource source :
       {RendererSource::kHeartbeat, RendererSource::kProximity, RendererSource::kFingertip}) {
    const auto sheet = touched();
    const double felt = sheet->force().norm();
    sheet->silence(source);
    sheet->run(20);
    EXPECT_EQ(sheet->force().norm(), 0.0) << name(source);
    sheet->run(100);
    EXPECT_EQ(sheet->force().norm(), 0.0) << name(source);
    sheet->silence(source, false);
    double before = 0.0, largest_step = 0.0;
    for (int i = 0; i < 500; ++i) {
      sheet->tick();
      largest_step = std::max(largest_step, std::abs(sheet->force().norm() - before));
      before = sheet->force().norm();
    }
    // A 35th of the force per millisecond; the cloth that has been displaced anew still swings.
    EXPECT_LT(largest_step, 0.1 * felt) << name(source);
    EXPECT_NEAR(before, felt, 0.05 * felt) << name(source);
  }
}

TEST(ForceLoop, NoForceWhileTheStatesBelongToAnotherMesh) {
  const auto sheet = touched();
  sheet->state().positions.pop_back();
  sheet->state().velocities.pop_back();
  sheet->run(40);
  EXPECT_EQ(sheet->force().norm(), 0.0);
  EXPECT_GT(sheet->loop().status().other_sizes, 0u);
}

TEST(ForceLoop, NoForceWhileTheStatesAreOfAnotherSheetWithAsManyParticles) {
  const auto sheet = touched();
  sheet->state().mesh = 1;
  sheet->run(40);
  EXPECT_EQ(sheet->force().norm(), 0.0);
  EXPECT_GT(sheet->loop().status().other_sizes, 0u);
}

TEST(ForceLoop, StartsAgainFromZeroWhenTheSimulationWasReset) {
  const auto sheet = touched();
  sheet->state().simulated_time = 0.0;
  while (sheet->loop().rendered(Finger::kIndex).gain == 1.0) sheet->tick();
  EXPECT_EQ(sheet->loop().rendered(Finger::kIndex).gain, 0.0);
  sheet->run(60);
  EXPECT_EQ(sheet->loop().rendered(Finger::kIndex).gain, 1.0);
}

TEST(ForceLoop, APausedSimulationThatRepeatsItsStateIsNotReset) {
  const auto sheet = touched();
  sheet->silence(RendererSource::kClothState);
  for (int i = 0; i < 20; ++i) {
    sheet->loop().receiveState(sheet->state(), sheet->now());
    sheet->tick();
  }
  EXPECT_EQ(sheet->loop().rendered(Finger::kIndex).gain, 1.0);
}

TEST(ForceLoop, WhatActsOnTheClothIsTheOppositeOfWhatTheFingertipFeels) {
  const auto sheet = touched();
  const LoopView& view = sheet->loop().view();
  EXPECT_EQ(view.load_gain, 1.0);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const cloth::PointLoad& load : view.loads) sum += load.force;
  EXPECT_LT((sum + sheet->force()).norm(), 0.02 * sheet->force().norm());  // it rests, nearly
  EXPECT_TRUE(view.fingertips[Finger::kIndex] && view.fingertips[Finger::kThumb]);
  EXPECT_NEAR(view.state_period, 0.012, 1e-12);
}

TEST(ForceLoop, LoadsActTimesTheirGain) {
  LoopView view;
  const cloth::PointLoad load{0,
                              {0.2, 0.3, 0.5},
                              Eigen::Vector3d::Zero(),
                              {4.0, 5.0, 6.0},
                              3.0 * Eigen::Matrix3d::Identity()};
  view.loads = {load, load};
  view.load_gain = 0.5;
  std::vector<cloth::PointLoad> acting;
  fillActingLoads(view, acting);
  ASSERT_EQ(acting.size(), 2u);
  EXPECT_EQ(acting[1].force, 0.5 * load.force);
  EXPECT_EQ(acting[1].stiffness, 0.5 * load.stiffness);
  view.load_gain = 0.0;
  fillActingLoads(view, acting);
  EXPECT_TRUE(acting.empty());
}

TEST(ForceLoop, NothingActsOnTheClothFromAFingerThatIsGone) {
  const auto sheet = touched();
  sheet->silence(RendererSource::kFingertip);
  sheet->run(40);
  const LoopView& view = sheet->loop().view();
  EXPECT_EQ(view.load_gain, 0.0);
  EXPECT_TRUE(view.loads.empty());
  EXPECT_TRUE(view.fingertips[Finger::kIndex]) << "its patch stays for when it is back";
}

/// At each of these ticks: whether there was news, how many states were taken, how many loads due.
using News = std::tuple<bool, std::uint64_t, std::uint64_t>;

std::vector<News> newsOf(TouchedSheet& sheet, int ticks) {
  std::vector<News> news;
  for (int i = 0; i < ticks; ++i) {
    sheet.tick();
    const bool came = sheet.loop().waitForNews(Time{0});
    news.push_back({came, sheet.loop().view().states, sheet.loop().view().loadings});
  }
  return news;
}

TEST(ForceLoop, LoadsAreDueOncePerStateShortlyBeforeTheNextStep) {
  TouchedSheet sheet;  // a state every 12 ms
  sheet.state().until_next = 0.012;
  sheet.run(11);
  const std::vector<News> news = newsOf(sheet, 24);
  for (int i = 0; i < 24; ++i) {
    const bool state = i % 12 == 0, loads = i % 12 == 9;
    EXPECT_EQ(news[i], News(state || loads, 1 + i / 12, (i + 3) / 12)) << i;
  }
}

TEST(ForceLoop, LoadsAreDueWithTheStateWhereTheNextStepIsNear) {
  for (const double until_next : {0.0, 0.001, 0.003}) {
    TouchedSheet sheet;
    sheet.state().until_next = until_next;
    sheet.run(11);
    EXPECT_EQ(newsOf(sheet, 13).back(), News(true, 2, 2)) << until_next;
  }
}

TEST(ForceLoop, LoadsThatAStateOvertakesAreDueWithIt) {
  TouchedSheet sheet;
  sheet.state().until_next = 0.05;
  sheet.run(12);
  EXPECT_EQ(newsOf(sheet, 11).back(), News(false, 1, 0));
  EXPECT_EQ(newsOf(sheet, 1).back(), News(true, 2, 1));
}

TEST(ForceLoop, PicturesThePatchWhenAsked) {
  const auto sheet = touched();
  EXPECT_TRUE(sheet->loop().picture().positions.empty());
  sheet->loop().askForPicture();
  sheet->run(1);
  const ContactPicture& picture = sheet->loop().picture();
  EXPECT_EQ(picture.positions.size(), sheet->loop().status().patch_particles);
  EXPECT_EQ(picture.contact_forces.size(), picture.positions.size());
  EXPECT_EQ(picture.triangles.size(), 4u * 2u * TouchedSheet::kCells * TouchedSheet::kCells);
  EXPECT_FALSE(picture.contacts[Finger::kIndex].points.empty());
  EXPECT_EQ(picture.gains[Finger::kIndex], 1.0);
}

TEST(ForceLoop, ContactorsCarryTheForceOfTheContactOnceTheirPlaceIsKnown) {
  const auto sheet = touched();
  const auto sum = [&] {
    double sum = 0.0;
    for (const double force : sheet->loop().rendered(Finger::kIndex).contactor_forces) sum += force;
    return sum;
  };
  EXPECT_EQ(sum(), 0.0);
  // z out of the pad, towards the sheet, which is at -x in the world frame.
  const contact::Fingertip fingertip = *sheet->loop().view().fingertips[Finger::kIndex];
  const Eigen::Quaterniond out = Eigen::Quaterniond::FromTwoVectors(
      Eigen::Vector3d::UnitZ(), fingertip.orientation.inverse() * -Eigen::Vector3d::UnitX());
  Eigen::Isometry3d array = Eigen::Isometry3d::Identity();
  array.linear() = out.toRotationMatrix();
  array.translation() = out * Eigen::Vector3d(0.0, 0.0, TouchedSheet::kRadius);
  sheet->loop().receiveArray(Finger::kIndex, array);
  sheet->run(1);
  const double normal_force = sheet->loop().rendered(Finger::kIndex).contact.normal_force;
  EXPECT_GT(sum(), 0.5 * normal_force);
  EXPECT_LE(sum(), normal_force * (1.0 + 1e-12));
  // The array's middle is above the middle of the contact; the sheet is dented by a fraction of a
  // mm.
  const ForceLoop::Rendered& rendered = sheet->loop().rendered(Finger::kIndex);
  EXPECT_LT((rendered.array.origin - rendered.contact.fabric_position).norm(), 1e-3);
  EXPECT_NEAR(std::abs(rendered.array.axes.determinant()), 1.0, 0.1);
  sheet->loop().wantContactors(Finger::kIndex, false);
  sheet->run(1);
  EXPECT_EQ(sum(), 0.0) << "nobody looks";
  EXPECT_GT(sheet->loop().rendered(Finger::kIndex).contact.normal_force, 0.9 * normal_force);
}

TEST(ForceLoop, AReplacedLayerStartsWithoutForceAndRises) {
  const auto sheet = touched();
  const double felt = sheet->force().norm();
  ASSERT_TRUE(sheet->loop().canOffer());
  sheet->giveLayer();
  sheet->run(1);
  EXPECT_EQ(sheet->loop().rendered(Finger::kIndex).gain, 0.0);
  EXPECT_TRUE(sheet->loop().canOffer()) << "and the old layer is freed by the one who offers";
  sheet->run(500);
  EXPECT_NEAR(sheet->force().norm(), felt, 0.05 * felt);
}

}  // namespace
}  // namespace haptex::simulation::test_force_loop
