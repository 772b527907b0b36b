#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "haptex/cloth/dynamics/friction_loads.h"

namespace haptex::cloth::test_friction_loads {
namespace {

// N(w) = N(0) + L w where contacts load each other as along a rope: the Neumann series of its
// inverse grows to some ten times N(0) before it converges.
TEST(FrictionLoads, FindWhatTakingTheLastLoadsWouldMissByFar) {
  constexpr int kContacts = 40, kSolution = 5;
  constexpr double kShare = 0.1;  // of a contact's friction in each load after it
  const Eigen::MatrixXd influence =
      kShare *
      Eigen::MatrixXd(
          Eigen::MatrixXd::Ones(kContacts, kContacts).triangularView<Eigen::StrictlyLower>());
  const Eigen::VectorXd alone = Eigen::VectorXd::Ones(kContacts);
  const Eigen::MatrixXd motion = Eigen::MatrixXd::Random(kSolution, kContacts);
  const Eigen::VectorXd exact =
      (Eigen::MatrixXd::Identity(kContacts, kContacts) - influence).lu().solve(alone);
  Eigen::VectorXd loads = alone, solution = motion * loads;
  FrictionLoads friction(kContacts, kSolution);
  friction.begin(loads, alone + influence * loads);
  int directions = 0;
  while (friction.wantsDirection(1e-9)) {
    const Eigen::VectorXd direction = friction.direction();
    Eigen::VectorXd change = motion * direction;
    friction.add(influence * direction, change, loads, solution);
    ++directions;
  }
  EXPECT_LE(directions, FrictionLoads::kMaxDirections);
  EXPECT_LT((loads - exact).norm(), 1e-8 * exact.norm());
  EXPECT_LT((solution - motion * loads).norm(), 1e-12 * (motion * loads).norm());
}

}  // namespace
}  // namespace haptex::cloth::test_friction_loads
