#include <gtest/gtest.h>

#include <Eigen/QR>
#include <cmath>
#include <limits>

#include "../refusal.h"
#include "haptex/base/repeatable_random.h"
#include "haptex/material/monotone_fit.h"
#include "haptex/material/nonnegative_least_squares.h"

namespace haptex::material::test_monotone_fit {
namespace {

using test::refusalOf;

constexpr double kEnd = 0.1;

/// Stiffens as fabrics do: 490 at kEnd, with a seventh of its mean slope at first.
double stiffening(double strain) { return 490.0 * std::expm1(30.0 * strain) / std::expm1(3.0); }

template <typename Function>
std::vector<CurvePoint> sampled(const Function& function, int count, double noise = 0.0) {
  base::RepeatableRandom random(3);
  std::vector<CurvePoint> samples;
  for (int i = 0; i <= count; ++i) {
    const double strain = kEnd * i / count;
    samples.push_back({strain, function(strain) + noise * random.uniform(-1.0, 1.0)});
  }
  return samples;
}

StrainStressCurve asFabricFilesReadIt(const PiecewiseCubic& cubic) {
  return StrainStressCurve::fromPolynomials(cubic.knots, cubic.coefficients);
}

TEST(NonnegativeLeastSquares, AgreesWithTheBestOfAllActiveSets) {
  base::RepeatableRandom random(11);
  for (int trial = 0; trial < 50; ++trial) {
    constexpr int kUnknowns = 5;
    const Eigen::MatrixXd matrix =
        Eigen::MatrixXd::NullaryExpr(8, kUnknowns, [&] { return random.uniform(-1.0, 1.0); });
    const Eigen::VectorXd right =
        Eigen::VectorXd::NullaryExpr(8, [&] { return random.uniform(-1.0, 1.0); });
    double best = right.norm();
    for (int set = 1; set < 1 << kUnknowns; ++set) {
      std::vector<int> columns;
      for (int i = 0; i < kUnknowns; ++i) {
        if (set >> i & 1) columns.push_back(i);
      }
      const Eigen::MatrixXd part = matrix(Eigen::all, columns);
      const Eigen::VectorXd x = part.colPivHouseholderQr().solve(right);
      if ((x.array() >= 0.0).all()) best = std::min(best, (part * x - right).norm());
    }
    const Eigen::VectorXd found = nonnegativeLeastSquares(matrix, right);
    EXPECT_TRUE((found.array() >= 0.0).all());
    EXPECT_NEAR((matrix * found - right).norm(), best, 1e-12);
  }
}

TEST(NonnegativeLeastSquares, RefusesWhatIsNoSystem) {
  EXPECT_NE(refusalOf([] {
              nonnegativeLeastSquares(Eigen::MatrixXd::Zero(2, 3), Eigen::VectorXd::Zero(2));
            }).find("a matrix of 2 x 3 and 2 numbers"),
            std::string::npos);
  EXPECT_NE(refusalOf([] {
              nonnegativeLeastSquares(Eigen::MatrixXd::Identity(2, 2),
                                      Eigen::Vector2d(1.0, std::nan("")));
            }).find("not finite"),
            std::string::npos);
}

// Any C1 cubic over the knots whose B-spline coefficients rise is one of the basis.
TEST(MonotoneFit, RecoversACurveOfItsOwnKind) {
  const std::vector<CurvePoint> grid = sampled([](double) { return 0.0; }, 200);
  std::vector<double> strains;
  for (const CurvePoint& point : grid) strains.push_back(point.strain);
  const MonotoneBasis basis(quantileKnots(strains, 0.0, 4));
  Eigen::VectorXd parameters(basis.size());
  parameters << 3.0, 0.0, 2.0, 5.0, 0.5, 4.0, 7.0, 9.0;
  const PiecewiseCubic exact = basis.curve(parameters);
  const auto samples = sampled([&](double strain) { return exact.evaluate(strain); }, 200);
  const PiecewiseCubic fit = fitMonotone(samples, 4);
  EXPECT_LT(residualsOf(fit, samples).largest, 1e-9 * exact.evaluate(kEnd));
  for (double strain = -0.02; strain < 0.13; strain += 0.0007) {  // and straight on outside
    EXPECT_NEAR(basis.at(strain).dot(parameters), exact.evaluate(strain), 1e-12);
    EXPECT_NEAR(asFabricFilesReadIt(fit).evaluate(strain).stress, exact.evaluate(strain), 1e-7);
  }
}

TEST(MonotoneFit, HasTheNumberOfPiecesAskedFor) {
  for (const int pieces : {1, 2, 5, 13}) {
    const PiecewiseCubic fit = fitMonotone(sampled(stiffening, 60), pieces);
    EXPECT_EQ(fit.coefficients.size(), static_cast<std::size_t>(pieces));
    EXPECT_EQ(fit.knots.size(), static_cast<std::size_t>(pieces) + 1);
    EXPECT_EQ(fit.knots.front(), 0.0);
    EXPECT_EQ(fit.knots.back(), kEnd);
    EXPECT_EQ(fit.coefficients.front()[0], 0.0);
  }
}

// No curvature at the first knot costs there what a straight line does, second order.
TEST(MonotoneFit, ConvergesWithTheNumberOfPieces) {
  const auto samples = sampled(stiffening, 400);
  const double coarse = residualsOf(fitMonotone(samples, 2), samples).largest;
  const double fine = residualsOf(fitMonotone(samples, 8), samples).largest;
  EXPECT_LT(coarse, 2e-2 * 490.0);
  EXPECT_LT(fine, coarse / 14.0);
  EXPECT_LT(fine, 2e-4 * 490.0);
}

// Readings that err by up to 2 % of the largest stress, 1.2 % RMS: 16 parameters from 300 readings
// leave about sqrt(16 / 300) of that, 0.27 %.
TEST(MonotoneFit, SmoothsNoiseAndRisesEverywhere) {
  const auto samples = sampled(stiffening, 300, 0.02 * 490.0);
  int falling = 0;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    falling += samples[i].stress < samples[i - 1].stress;
  }
  EXPECT_GT(falling, 50) << "the noise is to be larger than the rise";
  const PiecewiseCubic fit = fitMonotone(samples, 8);
  const StrainStressCurve curve = asFabricFilesReadIt(fit);
  const auto exact = sampled(stiffening, 1000);
  EXPECT_LT(residualsOf(fit, exact).rms, 0.005 * 490.0);
  EXPECT_LT(residualsOf(fit, exact).largest, 0.015 * 490.0);
  EXPECT_GE(curve.minimumSlope(), -1e-9 * 490.0 / kEnd);
  EXPECT_GT(curve.evaluate(0.0).slope, 0.0);
  EXPECT_GT(curve.evaluate(kEnd).slope, 0.0);
  EXPECT_EQ(curve.evaluate(0.0).stress, 0.0);
  const Residuals residuals = residualsOf(fit, samples);
  EXPECT_NEAR(residuals.rms, 0.02 * 490.0 / std::sqrt(3.0), 0.1 * residuals.rms);
}

TEST(MonotoneFit, HasAMirrorImage) {
  const PiecewiseCubic fit = fitMonotone(sampled(stiffening, 60), 3);
  const PiecewiseCubic both = withMirrorImage(fit);
  EXPECT_EQ(both.coefficients.size(), 6U);
  const StrainStressCurve curve = asFabricFilesReadIt(both);
  for (const double strain : {0.01, 0.05, 0.09, 0.12}) {
    EXPECT_NEAR(curve.evaluate(strain).stress, fit.evaluate(strain), 1e-9);
    EXPECT_NEAR(curve.evaluate(-strain).stress, -fit.evaluate(strain), 1e-9);
  }
}

TEST(MonotoneFit, RefusesSamplesThatAreNoCurve) {
  auto samples = sampled(stiffening, 9);
  EXPECT_EQ(refusalOf([&] { fitMonotone(samples, 8); }),
            "has 9 different readings, 8 pieces need 18: at most 3 pieces are allowed");
  EXPECT_EQ(refusalOf([&] {
              fitMonotone({{0.0, 0.0}, {0.1, 1.0}}, 1);
            }),
            "has 1 different readings, must have at least 4");
  EXPECT_EQ(refusalOf([&] { fitMonotone(samples, 0); }),
            "quantileKnots: pieces is 0; it must be at least 1");
  samples[4].stress = std::nan("");
  EXPECT_EQ(refusalOf([&] { fitMonotone(samples, 2); }), "samples[4]: stress nan is not finite");
  samples[2].strain = -0.01;
  EXPECT_EQ(refusalOf([&] { fitMonotone(samples, 2); }),
            "samples[2]: strain -0.01 must be finite and >= 0");
  const auto slack = sampled([](double strain) { return std::max(0.0, strain - 0.07); }, 100);
  EXPECT_NE(refusalOf([&] { fitMonotone(slack, 4); }).find("does not rise from 0 to 0.025"),
            std::string::npos);
}

}  // namespace
}  // namespace haptex::material::test_monotone_fit
