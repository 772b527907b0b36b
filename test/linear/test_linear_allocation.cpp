// Couplings come and go without memory, once there is room for them.
#include <gtest/gtest.h>

#include "../malloc_counter.h"
#include "coupled_system.h"
#include "haptex/linear/linear_solver.h"

namespace haptex::linear::test_linear_allocation {
namespace {

constexpr int kCouplings = 60;

/// Between particles that are no neighbours in a square of 10 x 10 cells.
void addCouplings(SymmetricBlockMatrix& matrix, int count) {
  for (int i = 0; i < count; ++i) {
    const Eigen::Matrix3d term = Eigen::Vector3d(1, 0.1 * i, 2) * Eigen::RowVector3d(1, 0.1 * i, 2);
    matrix.diagonal(i) += term;
    matrix.diagonal(i + 60) += term;
    matrix.addCoupling(i, i + 60, -term);
  }
}

TEST(LinearAllocation, CouplingsAllocateNothingUpToWhatIsReserved) {
  SymmetricBlockMatrix matrix = cloth::randomDefinite(cloth::square(10), 1.0);
  SymmetricBlockMatrix other = matrix;
  matrix.reserveCouplings(kCouplings);
  other.reserveCouplings(kCouplings);
#ifndef __SANITIZE_ADDRESS__
  EXPECT_GT(allocations, 0);  // the counter counts
#endif
  const int size = matrix.size();
  BlockVector x = BlockVector::Random(3, size), y = x, rhs = x;
  const BlockVector normals = BlockVector::Zero(3, size);
  std::vector<char> fixed(size, 0), confined(size, 0);
  fixed[3] = confined[4] = 1;
  const long before = allocations;
  for (int count : {kCouplings, 0, 1, kCouplings}) {
    matrix.setZero();
    addCouplings(matrix, count);
    EXPECT_EQ(matrix.couplingCount(), count);
    other = matrix;
    EXPECT_EQ(other.couplingCount(), count);
    other.multiply(x, y);
    other.eliminate(fixed, x, rhs);
    other.confine(confined, normals, normals, rhs);
    other.clearCouplings();
    addCouplings(other, kCouplings);
    matrix = other;
  }
  EXPECT_EQ(allocations - before, 0);
}

TEST(LinearAllocation, SolvesWithCouplingsAllocateNothing) {
  const SymmetricBlockMatrix sheet = cloth::randomDefinite(cloth::square(10), 100.0);
  SymmetricBlockMatrix matrix = sheet;
  matrix.reserveCouplings(kCouplings);
  const BlockVector rhs = BlockVector::Random(3, sheet.size());
  BlockVector x = rhs;
  for (LinearSolverMethod method :
       {LinearSolverMethod::kConjugateGradient, LinearSolverMethod::kCholesky,
        LinearSolverMethod::kAutomatic}) {
    LinearSolver solver(sheet, method);
    const long before = allocations;
    for (int count : {0, kCouplings, 1, 0, kCouplings}) {
      matrix = sheet;
      addCouplings(matrix, count);
      x.setZero();
      EXPECT_TRUE(solver.solve(matrix, rhs, 1e-7, x).converged);
    }
    EXPECT_EQ(allocations - before, 0);
  }
}

}  // namespace
}  // namespace haptex::linear::test_linear_allocation
