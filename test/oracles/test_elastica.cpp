#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "../refusal.h"
#include "haptex/base/workload.h"
#include "haptex/oracles/exact/elastica.h"

namespace haptex::oracles::test_elastica {
namespace {

/// A chain of equal links that are joined by torsion springs, half a link from the clamp: the
/// minimum of its energy
///   n/2 [2 theta_1^2 + sum (theta_i+1 - theta_i)^2] - gamma/n sum (1 - s_i) sin(theta_i)
/// over the angles, s_i in the middle of the link. For angles up to 90 degrees it is convex.
/// Nothing is shared with the oracle but the mechanics.
double chainDropOverReach(double gamma, int links) {
  const double stiffness = links;
  std::vector<double> angles(links, 0.0), load(links);
  for (int i = 0; i < links; ++i) load[i] = gamma / links * (1.0 - (i + 0.5) / links);
  const auto energy = [&](const std::vector<double>& at) {
    double sum = stiffness * at[0] * at[0];
    for (int i = 0; i < links; ++i) {
      if (i > 0) sum += 0.5 * stiffness * std::pow(at[i] - at[i - 1], 2);
      sum -= load[i] * std::sin(at[i]);
    }
    return sum;
  };
  std::vector<double> diagonal(links), step(links), trial(links);
  for (int iteration = 0; iteration < 100; ++iteration) {
    for (int i = 0; i < links; ++i) {
      const double before = i > 0 ? angles[i - 1] : -angles[0];
      const double after = i + 1 < links ? angles[i + 1] : angles[i];
      step[i] = stiffness * (before - 2.0 * angles[i] + after) + load[i] * std::cos(angles[i]);
      diagonal[i] = load[i] * std::sin(angles[i]) + stiffness * (i == 0          ? 3.0
                                                                 : i + 1 < links ? 2.0
                                                                                 : 1.0);
    }
    for (int i = 1; i < links; ++i) {  // Thomas
      diagonal[i] -= stiffness * stiffness / diagonal[i - 1];
      step[i] += stiffness / diagonal[i - 1] * step[i - 1];
    }
    double largest = 0.0;
    for (int i = links - 1; i >= 0; --i) {
      step[i] = (step[i] + (i + 1 < links ? stiffness * step[i + 1] : 0.0)) / diagonal[i];
      largest = std::max(largest, std::abs(step[i]));
    }
    const double now = energy(angles);
    double share = 1.0;
    const auto move = [&] {
      for (int i = 0; i < links; ++i) trial[i] = std::min(angles[i] + share * step[i], 0.5 * M_PI);
    };
    for (move(); energy(trial) > now && share > 1e-3; move()) share *= 0.5;
    angles = trial;
    if (largest < 1e-13) break;
  }
  double drop = 0.0, reach = 0.0;
  for (const double angle : angles) {
    drop += std::sin(angle);
    reach += std::cos(angle);
  }
  return drop / reach;
}

/// To 1 / links^2, 1 / links^4 and so on: Romberg's extrapolation of four chains.
double extrapolatedDropOverReach(double gamma) {
  constexpr int kLevels = base::unlessSanitized(5, 4);
  std::vector<double> values;
  for (int level = 0; level < kLevels; ++level) {
    values.push_back(chainDropOverReach(gamma, 250 << level));
  }
  for (int order = 1; order < kLevels; ++order) {
    const double ratio = std::pow(4.0, order);
    for (int i = kLevels - 1; i >= order; --i) {
      values[i] += (values[i] - values[i - 1]) / (ratio - 1.0);
    }
  }
  return values.back();
}

TEST(Elastica, IsTheMinimumOfTheEnergyOfAChainOverItsWholeDomain) {
  for (const double gamma : {1e-3, 0.1, 1.0, 7.0, 10.0, 40.0, 100.0, 149.0, 151.0, 180.0, 300.0,
                             550.0, 999.0, kLargestGamma}) {
    const double chain = extrapolatedDropOverReach(gamma);
    EXPECT_NEAR(exactDropOverReach(gamma), chain, 1e-9 * chain) << gamma;
  }
}

TEST(Elastica, HasTheValuesOfShootingInFortyDigits) {
  // By Taylor series of order 16 in 120 steps from the tip, whose distance from the vertical is
  // found as exp(-x), in arithmetic of 40 digits.
  const double values[][2] = {{0.1, 0.012499553655398652}, {1.0, 0.12456176644170652},
                              {10.0, 1.0668023204330735},  {100.0, 5.888104623327320},
                              {150.0, 7.536455877541773},  {180.0, 8.383516770789314},
                              {300.0, 11.183116222853372}, {1000.0, 21.335440499921908}};
  for (const auto& [gamma, value] : values) {
    EXPECT_NEAR(exactDropOverReach(gamma), value, 1e-11 * value) << gamma;
  }
}

TEST(Elastica, OfALightStripIsABeam) {
  // Euler and Bernoulli: w g L^4 / (8 B). The first correction is of the order gamma^2.
  for (const double gamma : {1e-300, 1e-30, 1e-9, 1e-6}) {
    EXPECT_NEAR(exactDropOverReach(gamma), gamma / 8.0, 1e-11 * gamma) << gamma;
  }
  EXPECT_NEAR(exactDropOverReach(1e-3), 1e-3 / 8.0, 1e-9);
}

TEST(Elastica, RisesWithTheWeight) {
  double before = 0.0;
  for (int i = 0; i <= 200; ++i) {
    const double now = exactDropOverReach(std::pow(10.0, -3.0 + 6.0 * i / 200));
    EXPECT_GT(now, before) << i;
    before = now;
  }
}

std::string refusalOf(double gamma) {
  return test::refusalOf([&] { exactDropOverReach(gamma); });
}

TEST(Elastica, RefusesWeightsOutOfItsDomain) {
  const std::string allowed = "; it must be > 0 and <= 1000";
  EXPECT_EQ(refusalOf(0.0), "exactDropOverReach: gamma is 0" + allowed);
  EXPECT_EQ(refusalOf(-1.0), "exactDropOverReach: gamma is -1" + allowed);
  EXPECT_EQ(refusalOf(1000.5), "exactDropOverReach: gamma is 1000.5" + allowed);
  EXPECT_EQ(refusalOf(std::nan("")), "exactDropOverReach: gamma is nan" + allowed);
}

}  // namespace
}  // namespace haptex::oracles::test_elastica
