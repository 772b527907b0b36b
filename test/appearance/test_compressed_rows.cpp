#include <gtest/gtest.h>

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "../refusal.h"
#include "haptex/appearance/compressed_rows.h"
#include "haptex/base/repeatable_random.h"

namespace haptex::appearance::test_compressed_rows {
namespace {

using Eigen::MatrixXf;

/// Independent values in components of falling size, about a mean.
MatrixXf fallingMatrix(int rows, int columns, int rank) {
  base::RepeatableRandom random(11);
  MatrixXf matrix = MatrixXf::Constant(rows, columns, 3.0f);
  for (int k = 0; k < rank; ++k) {
    Eigen::VectorXf left(rows), right(columns);
    for (float& value : left) value = static_cast<float>(random.uniform(-1.0, 1.0));
    for (float& value : right) value = static_cast<float>(random.uniform(-1.0, 1.0));
    matrix += std::pow(0.5f, static_cast<float>(k)) * left * right.transpose();
  }
  return matrix;
}

RowSource rowsOf(const MatrixXf& matrix) {
  return [&](int row, float* values) {
    Eigen::Map<Eigen::RowVectorXf>(values, matrix.cols()) = matrix.row(row);
  };
}

MatrixXf restored(const CompressedRows& compressed) {
  MatrixXf matrix(compressed.rows(), compressed.columns());
  for (int i = 0; i < compressed.rows(); ++i) {
    matrix.row(i) =
        (compressed.mean + compressed.basis.transpose() * compressed.coordinates(i)).transpose();
  }
  return matrix;
}

TEST(CompressedRows, WithAsManyComponentsAsTheRankAreTheMatrix) {
  const MatrixXf matrix = fallingMatrix(300, 90, 6);
  for (const int clusters : {1, 5}) {
    const auto compressed = compressRows(300, 90, rowsOf(matrix), {6, clusters, 6});
    // 16 bits of every coefficient.
    EXPECT_LT((restored(compressed) - matrix).norm(),
              2e-4 * (matrix.array() - 3.0f).matrix().norm())
        << clusters;
  }
}

TEST(CompressedRows, LoseNoMoreThanSingularValuesSay) {
  const MatrixXf matrix = fallingMatrix(300, 90, 12);
  const MatrixXf about = matrix.rowwise() - matrix.colwise().mean();
  const Eigen::VectorXf values = Eigen::JacobiSVD<MatrixXf>(about).singularValues();
  for (const int components : {1, 3, 7}) {
    const auto compressed = compressRows(300, 90, rowsOf(matrix), {components, 1, components});
    EXPECT_NEAR((restored(compressed) - matrix).norm(), values.tail(90 - components).norm(),
                0.002 * values.tail(90 - components).norm())
        << components;
  }
}

TEST(CompressedRows, OfASubsetServeTheOthers) {
  // More rows than kSubset, all of the same kind.
  const MatrixXf matrix = fallingMatrix(2 * kSubset, 60, 12);
  const auto error = [&](const CompressedRows& compressed) {
    return (restored(compressed) - matrix).norm();
  };
  const MatrixXf about = matrix.rowwise() - matrix.colwise().mean();
  const Eigen::VectorXf values = Eigen::JacobiSVD<MatrixXf>(about).singularValues();
  EXPECT_LT(error(compressRows(2 * kSubset, 60, rowsOf(matrix), {5, 1, 5})),
            1.1 * values.tail(55).norm());
}

TEST(CompressedRows, InClustersNeedFewerComponentsEach) {
  // Two groups, each with one component of its own, and far apart.
  base::RepeatableRandom random(4);
  MatrixXf matrix = MatrixXf::Zero(200, 40);
  for (int i = 0; i < 200; ++i) {
    const int first = i % 2 == 0 ? 0 : 20;
    matrix.block<1, 20>(i, first).setConstant(static_cast<float>(10.0 + random.uniform(-1.0, 1.0)));
  }
  const auto single = compressRows(200, 40, rowsOf(matrix), {3, 1, 1});
  const auto clustered = compressRows(200, 40, rowsOf(matrix), {3, 2, 1});
  EXPECT_LT((restored(clustered) - matrix).norm(), 1e-3f * matrix.norm());
  EXPECT_GT((restored(single) - matrix).norm(), 3e-2f * matrix.norm());
  for (int i = 0; i < 200; ++i) EXPECT_EQ(clustered.clusters[i], clustered.clusters[i % 2]);
}

TEST(CompressedRows, ThatAreAllAlikeAreTheirMean) {
  const MatrixXf matrix = MatrixXf::Constant(50, 12, 0.25f);
  const auto compressed = compressRows(50, 12, rowsOf(matrix), {4, 3, 2});
  EXPECT_LT((restored(compressed) - matrix).cwiseAbs().maxCoeff(), 1e-6f);
}

TEST(CompressedRows, TakeWhatTheirNumbersTake) {
  const auto compressed = compressRows(100, 30, rowsOf(fallingMatrix(100, 30, 5)), {4, 3, 2});
  EXPECT_EQ(compressed.bytes(),
            4u * (30 + 4 * 30 + 4 * 3 + 4 * 3 * 2 + 2 * 3) + 100u + 2u * 2 * 100);
}

TEST(CompressedRows, RefuseSizesThatMakeNoSense) {
  const auto expect_refusal = [](const Compression& size, const std::string& text) {
    const std::string refusal = test::refusalOf([&] {
      compressRows(
          4, 4, [](int, float*) { ADD_FAILURE() << "asked for a row"; }, size);
    });
    EXPECT_NE(refusal.find(text), std::string::npos) << refusal;
  };
  expect_refusal({0, 1, 1}, "0 components: allowed are 1 to 256");
  expect_refusal({257, 1, 1}, "257 components");
  expect_refusal({4, 0, 1}, "0 clusters");
  expect_refusal({4, 257, 1}, "257 clusters");
  expect_refusal({4, 1, 5}, "5 local components: allowed are 1 to 4");
}

}  // namespace
}  // namespace haptex::appearance::test_compressed_rows
