// The kernels of every instruction set that the processor has, also of those that are not chosen.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cstdlib>
#include <limits>

#include "haptex/linear/dense_kernels.h"

namespace haptex::linear::test_instruction_sets {
namespace {

template <typename T>
using Matrix = Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic>;

/// By which the results of two sets may differ: some sums of ten products of numbers up to ten.
template <typename T>
constexpr T kRounding = 1000 * std::numeric_limits<T>::epsilon();

/// Symmetric and positive definite at its top.
template <typename T>
Matrix<T> threeColumns(int rows) {
  Matrix<T> panel = Matrix<T>::Random(rows, 3);
  const Matrix<T> top = panel.topRows(3);
  panel.topRows(3) = top * top.transpose() + 4 * Matrix<T>::Identity(3, 3);
  return panel;
}

/// What every function makes of the same numbers, one below the other.
template <typename T>
Matrix<T> resultsOf(const DenseKernels<T>& kernels, int rows) {
  std::srand(static_cast<unsigned>(rows));
  const int depth = 9;
  const Matrix<T> a = Matrix<T>::Random(rows, depth), start = Matrix<T>::Random(rows, 3);
  Matrix<T> all(0, 3);
  const auto keep = [&all](const Matrix<T>& result) {
    all.conservativeResize(all.rows() + result.rows(), 3);
    all.bottomRows(result.rows()) = result;
  };
  Matrix<T> c = start;
  kernels.subtract_product(rows, 3, depth, a.data(), rows, a.data(), rows, c.data(), rows);
  keep(c);
  kernels.multiply(rows, 3, depth, a.data(), rows, a.data(), rows, c.data(), rows);
  keep(c);
  const RowRun run{0, 0, rows};
  c = start;
  kernels.subtract_runs(&run, 1, a.data(), rows, c.data(), rows);
  keep(c);
  Matrix<T> panel = threeColumns<T>(rows);
  EXPECT_TRUE(kernels.factorise_three_columns(rows, panel.data(), rows));
  panel.template triangularView<Eigen::StrictlyUpper>().setZero();
  keep(panel);
  c = start;
  kernels.divide_three_columns(rows, panel.data(), rows, c.data(), rows);
  keep(c);
  c = start;
  kernels.substitute_forward(rows, 3, panel.data(), rows, c.data());
  kernels.substitute_backward(rows, 3, panel.data(), rows, c.data() + rows);
  keep(c);
  return all;
}

template <typename T>
void expectSetsToAgree() {
  const DenseKernels<T>* const baseline = denseKernels<T>(InstructionSet::kBaseline);
  ASSERT_NE(baseline, nullptr);
  for (const InstructionSet set : {InstructionSet::kAvx2, InstructionSet::kAvx512}) {
    const DenseKernels<T>* const kernels = denseKernels<T>(set);
    if (!kernels) continue;
    for (int rows = 3; rows <= 70; ++rows) {
      const Matrix<T> difference = resultsOf(*kernels, rows) - resultsOf(*baseline, rows);
      EXPECT_TRUE(difference.allFinite()) << rows;
      EXPECT_LT(difference.cwiseAbs().maxCoeff(), kRounding<T>) << rows;
    }
  }
}

TEST(InstructionSets, AgreeInDoublePrecision) { expectSetsToAgree<double>(); }

TEST(InstructionSets, AgreeInSinglePrecision) { expectSetsToAgree<float>(); }

/// The baseline against the definitions; the set that is chosen is compared in DenseKernels.
TEST(InstructionSets, TheBaselineIsExact) {
  const DenseKernels<double>& kernels = *denseKernels<double>(InstructionSet::kBaseline);
  for (int rows = 3; rows <= 40; ++rows) {
    std::srand(static_cast<unsigned>(rows));
    const Matrix<double> a = Matrix<double>::Random(rows, 5);
    Matrix<double> c = Matrix<double>::Random(rows, 3);
    kernels.multiply(rows, 3, 5, a.data(), rows, a.data(), rows, c.data(), rows);
    const Matrix<double> exact = a * a.topRows(3).transpose();
    EXPECT_LT((c - exact).cwiseAbs().maxCoeff(), 1e-14) << rows;
    Matrix<double> panel = threeColumns<double>(rows);
    const Matrix<double> whole = panel;
    ASSERT_TRUE(kernels.factorise_three_columns(rows, panel.data(), rows));
    panel.triangularView<Eigen::StrictlyUpper>().setZero();
    panel.diagonal() = panel.diagonal().cwiseInverse().eval();
    const Matrix<double> product = panel * panel.topRows(3).transpose();
    EXPECT_LT((product - whole).cwiseAbs().maxCoeff(), 1e-13) << rows;
  }
}

TEST(InstructionSets, DoublePrecisionHasNoneOfTheWidest) {
  EXPECT_EQ(denseKernels<double>(InstructionSet::kAvx512), nullptr);
}

}  // namespace
}  // namespace haptex::linear::test_instruction_sets
