// The factorisation and what it is prepared by: order, separators, supernodes.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "../cloth/fixtures.h"
#include "haptex/linear/block_cholesky.h"
#include "haptex/linear/conjugate_gradient.h"
#include "haptex/linear/elimination.h"
#include "haptex/linear/ordering.h"
#include "haptex/linear/separator.h"

namespace haptex::linear::test_block_cholesky {
namespace {

TEST(Elimination, SupernodesPartitionTheColumnsAndHoldTheWholePattern) {
  const SymmetricBlockMatrix pattern = cloth::randomDefinite(cloth::square(9), 1.0);
  const Elimination elimination = analyse(pattern);
  int next = 0;
  for (const Supernode& supernode : elimination.supernodes) {
    EXPECT_EQ(supernode.first, next);
    next = supernode.end;
    EXPECT_TRUE(std::is_sorted(supernode.rows.begin(), supernode.rows.end()));
  }
  EXPECT_EQ(next, pattern.size());
  for (int i = 0; i < pattern.size(); ++i) {
    EXPECT_EQ(elimination.position[elimination.order[i]], i);
    for (int s = pattern.rowBegin(i); s < pattern.rowBegin(i + 1); ++s) {
      const int a = elimination.position[i], b = elimination.position[pattern.column(s)];
      const int row = std::max(a, b), column = std::min(a, b);
      const Supernode& home = elimination.supernodes[elimination.supernode_of[column]];
      EXPECT_TRUE(row < home.end || std::binary_search(home.rows.begin(), home.rows.end(), row));
    }
  }
}

TEST(BlockCholesky, SolvesToRoundingOnEveryShapeOfPattern) {
  std::vector<mesh::ClothMesh> meshes = {
      cloth::square(1),
      cloth::square(2),
      cloth::square(5),
      cloth::square(13),
      mesh::makeRectangle(1.0, 0.1, 40, 1, mesh::Triangulation::kOneWay),
      mesh::makeRectangle(1.0, 1.0, 11, 9, mesh::Triangulation::kOneWay)};
  mesh::ClothMesh separate = cloth::square(3);  // two pieces without a common particle
  const int offset = static_cast<int>(separate.rest_coordinates.size());
  for (const auto& t : cloth::square(3).triangles) {
    separate.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
  }
  separate.rest_coordinates.resize(2 * offset);
  meshes.push_back(separate);
  for (const mesh::ClothMesh& mesh : meshes) {
    const SymmetricBlockMatrix matrix = cloth::randomDefinite(mesh, 40.0);
    BlockCholesky cholesky(matrix);
    ASSERT_TRUE(cholesky.factorise(matrix));
    const BlockVector rhs = BlockVector::Random(3, matrix.size());
    BlockVector x = rhs;
    cholesky.solve(x);
    const Eigen::VectorXd exact = cloth::dense(matrix).llt().solve(cloth::stacked(rhs));
    EXPECT_LT((cloth::stacked(x) - exact).norm(), 1e-11 * exact.norm());
  }
}

TEST(BlockCholesky, FactorisesAgainAfterTheValuesChanged) {
  SymmetricBlockMatrix matrix = cloth::randomDefinite(cloth::square(6), 2.0);
  BlockCholesky cholesky(matrix);
  ASSERT_TRUE(cholesky.factorise(matrix));
  for (int i = 0; i < matrix.size(); ++i) matrix.diagonal(i) *= 3.0;
  ASSERT_TRUE(cholesky.factorise(matrix));
  const BlockVector rhs = BlockVector::Random(3, matrix.size());
  BlockVector x = rhs;
  cholesky.solve(x);
  EXPECT_LT((cloth::dense(matrix) * cloth::stacked(x) - cloth::stacked(rhs)).norm(),
            1e-12 * cloth::stacked(rhs).norm());
}

TEST(BlockCholesky, RefusesAnIndefiniteMatrixAndOneThatIsNotFinite) {
  SymmetricBlockMatrix matrix = cloth::randomDefinite(cloth::square(5), 1.0);
  BlockCholesky cholesky(matrix);
  const Eigen::Matrix3d sound = matrix.diagonal(4);
  matrix.diagonal(4)(1, 1) = -1.0;
  EXPECT_FALSE(cholesky.factorise(matrix));
  matrix.diagonal(4)(1, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(cholesky.factorise(matrix));
  matrix.diagonal(4) = sound;
  EXPECT_TRUE(cholesky.factorise(matrix));
}

TEST(NestedDissection, OrdersEveryRowOnceOnEveryShapeOfPattern) {
  std::vector<SymmetricBlockMatrix> patterns;
  for (int cells : {1, 2, 7, 30})
    patterns.push_back(cloth::randomDefinite(cloth::square(cells), 1.0));
  patterns.push_back(cloth::randomDefinite(
      mesh::makeRectangle(1.0, 0.1, 200, 1, mesh::Triangulation::kOneWay), 1.0));
  patterns.push_back(cloth::randomDefinite(
      mesh::makeRectangle(1.0, 1.0, 25, 20, mesh::Triangulation::kOneWay), 1.0));
  patterns.emplace_back(100, std::vector<std::array<int, 3>>{});  // no coupling at all
  std::vector<std::array<int, 2>> star, complete;
  for (int i = 1; i < 150; ++i) {
    star.push_back({0, i});
    for (int j = 0; j < i; ++j) complete.push_back({i, j});
  }
  patterns.emplace_back(150, std::vector<std::array<int, 3>>{}, star);
  patterns.emplace_back(150, std::vector<std::array<int, 3>>{}, complete);
  for (const SymmetricBlockMatrix& pattern : patterns) {
    std::vector<int> order = nestedDissectionOrder(pattern);
    std::sort(order.begin(), order.end());
    ASSERT_EQ(static_cast<int>(order.size()), pattern.size());
    for (int i = 0; i < pattern.size(); ++i) EXPECT_EQ(order[i], i);
  }
}

TEST(NestedDissection, SeparatesByNodesThatNoEdgeCrosses) {
  const SymmetricBlockMatrix pattern = cloth::randomDefinite(cloth::square(20), 1.0);
  Graph graph(pattern.size());
  std::vector<int> all(pattern.size());
  for (int i = 0; i < pattern.size(); ++i) {
    all[i] = i;
    for (int s = pattern.rowBegin(i); s < pattern.rowBegin(i + 1); ++s) {
      graph[i].push_back(pattern.column(s));
      graph[pattern.column(s)].push_back(i);
    }
  }
  const Separation separation = SeparatorFinder(graph).separate(all);
  std::vector<int> half_of(pattern.size(), -1);
  for (int half : {0, 1}) {
    EXPECT_GT(separation.halves[half].size(), all.size() / 4);
    for (int node : separation.halves[half]) half_of[node] = half;
  }
  EXPECT_LE(separation.separator.size(), 21U);  // a straight line across
  EXPECT_EQ(separation.halves[0].size() + separation.halves[1].size() + separation.separator.size(),
            all.size());
  for (int node : separation.halves[0]) {
    for (int other : graph[node]) EXPECT_NE(half_of[other], 1);
  }
}

TEST(NestedDissection, NeedsFarFewerOperationsThanMinimumDegreeInLargeSheets) {
  const mesh::ClothMesh mesh = cloth::square(150);
  const SymmetricBlockMatrix pattern(151 * 151, mesh.triangles);
  const std::vector<int> order = nestedDissectionOrder(pattern);
  EXPECT_LT(factorisationCost(analyse(pattern, order)),
            0.8 * factorisationCost(analyse(pattern, minimumDegreeOrder(pattern))));
}

TEST(BlockCholesky, IsEqualToTheLastBitForAnyNumberOfThreads) {
  const SymmetricBlockMatrix matrix = cloth::randomDefinite(cloth::square(60), 40.0);
  const BlockVector rhs = BlockVector::Random(3, matrix.size());
  const auto solution = [&](auto number, int threads) {
    ThreadPool pool(threads);
    BasicBlockCholesky<decltype(number)> cholesky(matrix, &pool);
    BlockVector x = rhs;
    EXPECT_GT(cholesky.cost(), 1e7);  // large enough to be shared
    EXPECT_TRUE(cholesky.factorise(matrix));
    cholesky.solve(x);
    return x;
  };
  for (int threads : {2, 3, 5}) {
    EXPECT_EQ(solution(1.0, threads), solution(1.0, 1));
    EXPECT_EQ(solution(1.0F, threads), solution(1.0F, 1));
  }
  BasicBlockCholesky<float> alone(matrix);
  ASSERT_TRUE(alone.factorise(matrix));
  BlockVector x = rhs;
  alone.solve(x);
  EXPECT_EQ(x, solution(1.0F, 3));
  BlockVector product(3, matrix.size());
  matrix.multiply(solution(1.0, 3), product);
  EXPECT_LT((product - rhs).norm(), 1e-10 * rhs.norm());
}

TEST(BlockCholesky, IsTheSameWithTheSymbolicPartOfAnother) {
  const SymmetricBlockMatrix matrix = cloth::randomDefinite(cloth::square(20), 40.0);
  const BasicBlockCholesky<float> other(matrix);
  BlockCholesky own(matrix), shared(matrix, other.elimination(), nullptr);
  ASSERT_TRUE(own.factorise(matrix));
  ASSERT_TRUE(shared.factorise(matrix));
  BlockVector x = BlockVector::Random(3, matrix.size()), y = x;
  own.solve(x);
  shared.solve(y);
  EXPECT_EQ(x, y);
}

TEST(BlockCholesky, IsTheSameInUsedMemory) {
  std::vector<float> memory;
  for (const int cells : {20, 21, 8, 30, 20}) {  // what is lent fits, or has to grow
    SCOPED_TRACE(cells);
    const SymmetricBlockMatrix matrix = cloth::randomDefinite(cloth::square(cells), 40.0);
    BasicBlockCholesky<float> own(matrix), lent(matrix, own.elimination(), nullptr, &memory);
    BlockVector x = BlockVector::Random(3, matrix.size()), y = x;
    ASSERT_TRUE(own.factorise(matrix));
    ASSERT_TRUE(lent.factorise(matrix));
    own.solve(x);
    lent.solve(y);
    EXPECT_EQ(x, y);
    EXPECT_EQ(own.numbers(), lent.numbers());
    std::fill(memory.begin(), memory.end(), std::numeric_limits<float>::quiet_NaN());
  }
}

TEST(BlockCholesky, PreconditionsInSinglePrecisionWhateverTheScale) {
  for (double scale : {1e-60, 1e-3, 1.0, 1e7, 1e60}) {
    SymmetricBlockMatrix matrix = cloth::randomDefinite(cloth::square(12), 40.0);
    for (int i = 0; i < matrix.size(); ++i) {
      matrix.diagonal(i) *= scale;
      for (int s = matrix.rowBegin(i); s < matrix.rowBegin(i + 1); ++s) matrix.lower(s) *= scale;
    }
    BasicBlockCholesky<float> factor(matrix);
    ASSERT_TRUE(factor.factorise(matrix)) << scale;
    const BlockVector rhs = BlockVector::Random(3, matrix.size());
    BlockVector x = BlockVector::Zero(3, matrix.size());
    ConjugateGradient solver(matrix.size());
    const SolveResult result = solver.solve(matrix, factor, rhs, 1e-12, 20, x);
    EXPECT_TRUE(result.converged) << scale;  // conjugate gradients are in double precision
    EXPECT_LE(result.iterations, 5) << scale;
  }
}

TEST(BlockCholesky, RefusesInSinglePrecisionWhatItRefusesInDouble) {
  SymmetricBlockMatrix matrix = cloth::randomDefinite(cloth::square(5), 1.0);
  BasicBlockCholesky<float> cholesky(matrix);
  const Eigen::Matrix3d sound = matrix.diagonal(4);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (double number : {-1.0, 0.0, nan, std::numeric_limits<double>::infinity()}) {
    matrix.diagonal(4)(1, 1) = number;
    EXPECT_FALSE(cholesky.factorise(matrix)) << number;
  }
  matrix.diagonal(4) = sound;
  EXPECT_TRUE(cholesky.factorise(matrix));
  matrix.lower(3)(0, 0) = nan;
  EXPECT_FALSE(cholesky.factorise(matrix));
}

}  // namespace
}  // namespace haptex::linear::test_block_cholesky
