#include <gtest/gtest.h>

#include <algorithm>

#include "../cloth/fixtures.h"
#include "haptex/linear/dense_kernels.h"

namespace haptex::linear::test_dense_kernels {
namespace {

TEST(DenseKernels, SubtractTheProductForEverySizeOfRemainder) {
  for (int rows = 1; rows <= 29; ++rows) {
    for (int columns : {1, 2, 3, 4, 6, 11}) {
      const int depth = 7, lda = rows + 2, ldb = columns + 1, ldc = rows + 3;
      const Eigen::MatrixXd a = Eigen::MatrixXd::Random(lda, depth);
      const Eigen::MatrixXd b = Eigen::MatrixXd::Random(ldb, depth);
      Eigen::MatrixXd c = Eigen::MatrixXd::Random(ldc, columns);
      Eigen::MatrixXd exact = c;
      exact.topRows(rows) -= a.topRows(rows) * b.topRows(columns).transpose();
      subtractProduct(rows, columns, depth, a.data(), lda, b.data(), ldb, c.data(), ldc);
      // The rows below must stay as they are.
      EXPECT_LT((c - exact).cwiseAbs().maxCoeff(), 1e-14) << rows << " x " << columns;
    }
  }
}

/// Rows that leave every kind of remainder, more columns than one pass takes, and more depth.
template <typename T>
void expectProductsOfLargePanels(double rounding) {
  using Matrix = Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic>;
  for (int rows : {3, 15, 48, 49, 63, 64, 95, 96, 113}) {
    for (int columns : {3, 6, 7, 9, 24}) {
      for (int depth : {1, 191, 192, 193, 400}) {
        const int lda = rows + 2, ldb = columns + 1, ldc = rows + 3;
        const Matrix a = Matrix::Random(lda, depth), b = Matrix::Random(ldb, depth);
        const Matrix start = Matrix::Random(ldc, columns);
        Matrix c = start;
        subtractProduct(rows, columns, depth, a.data(), lda, b.data(), ldb, c.data(), ldc);
        Eigen::MatrixXd exact = start.template cast<double>();
        exact.topRows(rows) -= a.topRows(rows).template cast<double>() *
                               b.topRows(columns).transpose().template cast<double>();
        const Eigen::MatrixXd error = c.template cast<double>() - exact;
        // Every sum rounds at most as often as it has terms, which are about 0.3 in the mean.
        EXPECT_LT(error.cwiseAbs().maxCoeff(), rounding * (1 + depth))
            << rows << " x " << columns << " x " << depth;
        EXPECT_EQ(c.bottomRows(3), start.bottomRows(3));  // the rows below stay as they are
      }
    }
  }
}

TEST(DenseKernels, SubtractTheProductOfLargePanels) {
  expectProductsOfLargePanels<double>(1e-15);
  expectProductsOfLargePanels<float>(6e-7);
}

TEST(DenseKernels, MultiplyForEverySizeOfRemainder) {
  for (int rows = 1; rows <= 115; ++rows) {
    for (int columns : {3, 6, 9, 24}) {
      const int depth = 6, lda = rows + 2, ldb = columns + 2, ldc = rows + 3;
      const Eigen::MatrixXd a = Eigen::MatrixXd::Random(lda, depth);
      const Eigen::MatrixXd b = Eigen::MatrixXd::Random(ldb, depth);
      Eigen::MatrixXd c = Eigen::MatrixXd::Random(ldc, columns);
      Eigen::MatrixXd exact = c;
      exact.topRows(rows) = a.topRows(rows) * b.topRows(columns).transpose();
      multiply(rows, columns, depth, a.data(), lda, b.data(), ldb, c.data(), ldc);
      // The rows below must stay as they are.
      EXPECT_LT((c - exact).cwiseAbs().maxCoeff(), 1e-14) << rows << " x " << columns;
    }
  }
}

template <typename T>
void expectRunsOfEveryLengthSubtracted() {
  using Matrix = Eigen::Matrix<T, Eigen::Dynamic, 3>;
  for (int count = 1; count <= 70; ++count) {
    const Matrix a = Matrix::Random(count + 9, 3);
    const Matrix start = Matrix::Random(count + 30, 3);
    // Two runs: their rows are 2 and what follows 5, and they go to 4 and, with a gap, behind.
    const RowRun runs[] = {{2, 4, count}, {count + 2, count + 20, 5}};
    Matrix c = start, exact = start;
    exact.middleRows(4, count) -= a.middleRows(2, count);
    exact.middleRows(count + 20, 5) -= a.middleRows(count + 2, 5);
    subtractRuns(runs, 2, a.data(), count + 9, c.data(), count + 30);
    EXPECT_EQ(c, exact) << count;
  }
}

TEST(DenseKernels, SubtractRunsOfEveryLengthAndNothingBesideThem) {
  expectRunsOfEveryLengthSubtracted<double>();
  expectRunsOfEveryLengthSubtracted<float>();
}

TEST(DenseKernels, AreTheSameInSinglePrecisionToItsRounding) {
  for (int rows = 3; rows <= 60; ++rows) {
    const int depth = 9, ld = rows + 1;
    const Eigen::MatrixXf a = Eigen::MatrixXf::Random(ld, depth);
    const Eigen::MatrixXf start = Eigen::MatrixXf::Random(ld, 3);
    const Eigen::MatrixXd product =
        a.topRows(rows).cast<double>() * a.topRows(3).cast<double>().transpose();
    Eigen::MatrixXf c = start;
    multiply(rows, 3, depth, a.data(), ld, a.data(), ld, c.data(), ld);
    // Nine products of numbers up to 1 with a rounding of 6e-8 each.
    EXPECT_LT((c.topRows(rows).cast<double>() - product).cwiseAbs().maxCoeff(), 2e-6) << rows;
    EXPECT_EQ(c.row(rows), start.row(rows));
    c = start;
    subtractProduct(rows, 3, depth, a.data(), ld, a.data(), ld, c.data(), ld);
    const Eigen::MatrixXd difference = start.topRows(rows).cast<double>() - product;
    EXPECT_LT((c.topRows(rows).cast<double>() - difference).cwiseAbs().maxCoeff(), 2e-6) << rows;
    EXPECT_EQ(c.row(rows), start.row(rows));
  }
}

/// A panel of the factor as the kernels keep it, with its diagonal inverted.
struct RandomPanel {
  Eigen::MatrixXd exact;   // lower trapezoid
  Eigen::MatrixXd stored;  // with a row more, which no kernel may change
  RandomPanel(int rows, int columns) : exact(Eigen::MatrixXd::Random(rows, columns)) {
    exact.triangularView<Eigen::StrictlyUpper>().setZero();
    exact.diagonal().array() += 3.0;
    stored = Eigen::MatrixXd::Constant(rows + 1, columns, 7.0);
    stored.topRows(rows) = exact;
    stored.diagonal() = exact.diagonal().cwiseInverse();
  }
};

TEST(DenseKernels, FactoriseThreeColumnsOfEveryHeight) {
  for (int rows = 3; rows <= 32; ++rows) {
    const RandomPanel panel(rows, 3);
    Eigen::MatrixXd a = panel.stored;
    a.topRows(rows) = panel.exact * panel.exact.topRows(3).transpose();
    ASSERT_TRUE(factoriseThreeColumns(rows, a.data(), rows + 1));
    a.triangularView<Eigen::StrictlyUpper>().setZero();
    Eigen::MatrixXd exact = panel.stored;
    // Some ten operations on numbers of order 10.
    EXPECT_LT((a - exact).cwiseAbs().maxCoeff(), 1e-13) << rows;
  }
}

TEST(DenseKernels, DivideThreeColumnsAsTheirFactorisationDoes) {
  for (int rows = 4; rows <= 32; ++rows) {
    Eigen::MatrixXd a = Eigen::MatrixXd::Random(rows, 3);
    a.topRows(3) += 5.0 * Eigen::Matrix3d::Identity();
    a.topRows(3) = (a.topRows(3) * a.topRows(3).transpose()).eval();
    Eigen::MatrixXd whole = a;
    ASSERT_TRUE(factoriseThreeColumns(rows, whole.data(), rows));
    Eigen::MatrixXd below = a.bottomRows(rows - 3);
    divideThreeColumns(rows - 3, whole.data(), rows, below.data(), rows - 3);
    EXPECT_LT((below - whole.bottomRows(rows - 3)).cwiseAbs().maxCoeff(), 1e-15) << rows;
  }
}

TEST(DenseKernels, SubstituteThroughPanelsOfEveryHeight) {
  for (int columns : {3, 6, 9}) {
    for (int rows = columns; rows <= columns + 20; ++rows) {
      const RandomPanel panel(rows, columns);
      const auto top = panel.exact.topRows(columns).triangularView<Eigen::Lower>();
      const auto below = panel.exact.bottomRows(rows - columns);
      const Eigen::VectorXd start = Eigen::VectorXd::Random(rows + 1);

      Eigen::VectorXd x = start, exact = start;
      substituteForward(rows, columns, panel.stored.data(), rows + 1, x.data());
      exact.head(columns) = top.solve(start.head(columns));
      exact.segment(columns, rows - columns) -= below * exact.head(columns);
      EXPECT_LT((x - exact).cwiseAbs().maxCoeff(), 1e-14) << rows << " x " << columns;

      x = exact = start;
      substituteBackward(rows, columns, panel.stored.data(), rows + 1, x.data());
      exact.head(columns) -= below.transpose() * start.segment(columns, rows - columns);
      exact.head(columns) = top.transpose().solve(exact.head(columns)).eval();
      EXPECT_LT((x - exact).cwiseAbs().maxCoeff(), 1e-14) << rows << " x " << columns;
    }
  }
}

}  // namespace
}  // namespace haptex::linear::test_dense_kernels
