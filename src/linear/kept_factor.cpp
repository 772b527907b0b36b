#include "haptex/linear/kept_factor.h"

#include <algorithm>

#include "haptex/linear/ordering.h"

namespace haptex::linear {
namespace {

// Times over that of one 3x3 block of a conjugate gradient iteration, which scripts/bench
// linear_solver prints: of one multiply-add of the factorisation in single precision, of what it
// does besides for one number of the factor (to load, to scatter, narrow panels), of one number in
// the two triangular solves, and of one number to order and analyse a pattern with couplings. The
// first two give the time of a factorisation of 2048 to 100352 triangles within a quarter.
constexpr double kOperationOverBlock = 0.006;
constexpr double kFactorNumberOverBlock = 0.6;
constexpr double kNumberOverBlock = 0.2;
constexpr double kAnalysedNumberOverBlock = 4.0;
// What a factor is expected to need before one has been made.
constexpr double kExpectedSolves = 8.0;
constexpr double kExpectedIterations = 3.0;
// Couplings are expected to make so much more of a factor.
constexpr double kExpectedGrowth = 2.0;

}  // namespace

KeptFactor::KeptFactor(const SymmetricBlockMatrix& pattern, ThreadPool* pool)
    : pool_(pool),
      factor_(std::make_unique<BasicBlockCholesky<float>>(pattern, pool)),
      block_iteration_cost_(pattern.size() + 2.0 * pattern.lowerCount()) {
  setCosts(factor_->cost(), factor_->numbers());
  mean_cost_ = factor_cost_ / kExpectedSolves + kExpectedIterations * iteration_cost_;
}

KeptFactor::KeptFactor(ThreadPool* pool, double block_iteration_cost, double operations,
                       double numbers)
    : pool_(pool),
      knows_couplings_(true),
      block_iteration_cost_(block_iteration_cost),
      analysis_cost_(kAnalysedNumberOverBlock * numbers) {
  setCosts(operations, numbers);
}

std::unique_ptr<KeptFactor> KeptFactor::ofWholeMatrices() const {
  return std::unique_ptr<KeptFactor>(new KeptFactor(pool_, block_iteration_cost_,
                                                    kExpectedGrowth * factor_->cost(),
                                                    kExpectedGrowth * factor_->numbers()));
}

void KeptFactor::setCosts(double operations, double numbers) {
  factor_cost_ = kOperationOverBlock * operations + kFactorNumberOverBlock * numbers;
  iteration_cost_ = kNumberOverBlock * numbers + block_iteration_cost_;
}

/// A factor whose pattern has room for all blocks of the matrix.
void KeptFactor::analyseWhole(const SymmetricBlockMatrix& matrix) {
  whole_ = matrix.wholePattern();
  whole_->takeValues(matrix);
  // Nested dissection takes four times as long and saves nothing where couplings tie layers.
  const Elimination elimination = analyse(*whole_, minimumDegreeOrder(*whole_));
  factor_.reset();  // it is done with the memory
  factor_ = std::make_unique<BasicBlockCholesky<float>>(*whole_, elimination, pool_, &memory_);
  setCosts(factor_->cost(), factor_->numbers());
  analysis_cost_ = kAnalysedNumberOverBlock * factor_->numbers();
  cost_ += analysis_cost_;
}

bool KeptFactor::makeFactor(const SymmetricBlockMatrix& matrix) {
  ++factorisations_;
  solves_ = 0;
  cost_ = 0.0;
  is_kept_ = false;
  if (knows_couplings_ && !(whole_ && whole_->takeValues(matrix))) analyseWhole(matrix);
  cost_ += factor_cost_;
  is_kept_ = factor_->factorise(knows_couplings_ ? *whole_ : matrix);
  return is_kept_;
}

/// With an old factor the iterations are given up when they have cost what a new one and its
/// iterations cost, and go on with that from where they are.
SolveResult KeptFactor::solve(ConjugateGradient& conjugate_gradient,
                              const SymmetricBlockMatrix& matrix, const BlockVector& rhs,
                              double tolerance, int most_iterations, BlockVector& x) {
  SolveResult result;
  int spent = 0;
  using Patience = ConjugateGradient::Patience;
  const auto iterate = [&](int most, Patience patience) {
    result = conjugate_gradient.solve(matrix, *factor_, rhs, tolerance, most, x, patience);
    cost_ += iteration_cost_ * result.iterations;
    spent += result.iterations;
  };
  // Where couplings need another way, what they cost in this one says nothing of the others.
  const auto given_up = [&] { return !result.converged && matrix.couplingCount() > 0; };
  if (old_factor_.holds()) {
    old_factor_.pass();
  } else if (is_kept_) {
    iterate(1 + fresh_iterations_ + static_cast<int>(factor_cost_ / iteration_cost_),
            Patience::kWhilePromising);
    if (result.converged) {
      old_factor_.succeeded();
    } else {
      old_factor_.failed();
    }
  }
  if (!result.converged) {
    if (!makeFactor(matrix)) return {};
    iterate(most_iterations, Patience::kToTheEnd);
    if (!given_up()) fresh_iterations_ = result.iterations;
  }
  result.iterations = spent;
  ++solves_;
  if (!given_up()) mean_cost_ = cost_ / solves_;
  if (iteration_cost_ * spent > mean_cost_) is_kept_ = false;
  return result;
}

}  // namespace haptex::linear
