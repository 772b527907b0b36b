#include "haptex/linear/multigrid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

namespace haptex::linear {
namespace {

constexpr int kCoarsest = 600;  // block rows that need no coarser level
constexpr int kMostFactored = 20'000;
constexpr double kLeastCoarsening = 0.8;  // from which on a coarser level saves too little
// Steps of the power method on D^-1 A, and so much more than what they find. Damped by 4/3 of its
// reciprocal, Jacobi's method diverges where the eigenvalue is half as large again. That of sums
// over triangles is 3 at most, and hardly changes with the state of a cloth.
constexpr int kPowerSteps = 15;
constexpr float kEigenvalueMargin = 1.05f;
constexpr float kDampingTimesEigenvalue = 4.0f / 3.0f;
// Added to the diagonal of the coarsest matrix, scaled to ones, where it is not positive definite:
// by rounding, in light and stiff cloth that nothing holds.
constexpr float kShifts[] = {0.0f, 1e-6f, 1e-5f, 1e-4f, 1e-3f};

/// Of no eigenvector, and the same in every run.
PaddedVector startOfPowerMethod(int size) {
  unsigned random = 1;
  PaddedVector vector(size);
  for (Eigen::Array4f& entry : vector) {
    entry.setZero();
    for (int c = 0; c < 3; ++c) {
      random = 1664525u * random + 1013904223u;
      entry[c] = static_cast<float>(random >> 8) / 16777216.0f - 0.5f;
    }
  }
  return vector;
}

float norm(const PaddedVector& vector) {
  double sum = 0.0;
  for (const Eigen::Array4f& entry : vector) sum += entry.square().sum();
  return static_cast<float>(std::sqrt(sum));
}

}  // namespace

Multigrid::Level::Level(BlockRows its_rows)
    : rows(std::move(its_rows)),
      residual(rows.size()),
      next(rows.size()),
      rhs(rows.size()),
      x(rows.size()),
      correction(rows.size()) {}

Multigrid::Multigrid(const SymmetricBlockMatrix& matrix, ThreadPool* pool) : pool_(pool) {
  levels_.emplace_back(BlockRows(matrix));
  levels_.back().rows.take(matrix, pool_);
  while (levels_.back().rows.size() > kCoarsest) {
    Level& finer = levels_.back();
    finer.interpolation = smoothedAggregation(finer.rows);
    const int size = finer.interpolation.coarse_size;
    if (size == 0 || size > kLeastCoarsening * finer.rows.size()) break;
    makeCoarser();
  }
  for (Level& level : levels_) estimateDamping(level);
  prepareCoarsest();
}

/// Rows of which few are coupled stay many: they have no factor, but their diagonal blocks.
void Multigrid::prepareCoarsest() {
  const BlockRows& rows = levels_.back().rows;
  if (rows.size() > kMostFactored) return;
  std::vector<std::array<int, 2>> pairs;
  for (int i = 0; i < rows.size(); ++i) {
    for (int s = rows.begin(i) + 1; s < rows.begin(i + 1); ++s)
      pairs.push_back({i, rows.column(s)});
  }
  coarsest_.emplace(rows.size(), std::vector<std::array<int, 3>>{}, pairs);
  for (const auto& [i, j] : pairs) {
    if (j < i) coarsest_slots_.push_back(coarsest_->slot(i, j));
  }
  factor_ = std::make_unique<BasicBlockCholesky<float>>(*coarsest_);
  coarsest_vector_.resize(3, rows.size());
}

/// By the interpolation of the coarsest level so far.
void Multigrid::makeCoarser() {
  Level& finer = levels_.back();
  finer.restriction = finer.interpolation.transposed();
  finer.product = std::make_unique<CoarseProduct>(finer.rows, finer.interpolation);
  Level coarser(finer.product->pattern());
  finer.product->multiply(finer.rows, finer.interpolation, coarser.rows, pool_);
  levels_.push_back(std::move(coarser));
}

std::vector<int> Multigrid::sizes() const {
  std::vector<int> sizes;
  for (const Level& level : levels_) sizes.push_back(level.rows.size());
  return sizes;
}

void Multigrid::estimateDamping(Level& level) {
  const BlockRows& rows = level.rows;
  PaddedVector vector = startOfPowerMethod(rows.size());
  float eigenvalue = 1.0f, length = norm(vector);
  for (int step = 0; step < kPowerSteps; ++step) {
    shareRows(pool_, rows.size(), [&](int first, int end) {
      for (int i = first; i < end; ++i) {
        level.next[i] = rows.timesInverseDiagonal(i, rows.product(i, vector));
      }
    });
    const float next_length = norm(level.next);
    eigenvalue = next_length / length;
    length = 1.0f;
    for (int i = 0; i < rows.size(); ++i) vector[i] = level.next[i] / next_length;
  }
  level.damping = kDampingTimesEigenvalue / (kEigenvalueMargin * eigenvalue);
}

bool Multigrid::takeValues(const SymmetricBlockMatrix& matrix) {
  levels_.front().rows.take(matrix, pool_);
  for (std::size_t k = 0; k + 1 < levels_.size(); ++k) {
    Level& level = levels_[k];
    level.product->multiply(level.rows, level.interpolation, levels_[k + 1].rows, pool_);
  }
  return factoriseCoarsest();
}

bool Multigrid::factoriseCoarsest() {
  if (!factor_) return true;
  const BlockRows& rows = levels_.back().rows;
  auto slot_of_pair = coarsest_slots_.begin();
  for (int i = 0; i < rows.size(); ++i) {
    const auto block = [&](int slot) {
      return Eigen::Map<const Eigen::Matrix3f>(rows.block(slot));
    };
    coarsest_->diagonal(i) = block(rows.begin(i)).cast<double>();
    for (int s = rows.begin(i) + 1; s < rows.begin(i + 1); ++s) {
      if (rows.column(s) < i) coarsest_->lower(*slot_of_pair++) = block(s).cast<double>();
    }
  }
  return std::any_of(std::begin(kShifts), std::end(kShifts),
                     [&](float shift) { return factor_->factorise(*coarsest_, shift); });
}

void Multigrid::solve(BlockVector& x) {
  Level& finest = levels_.front();
  const double scale = x.norm();
  if (!(scale > 0.0)) return;  // or not a number
  shareRows(pool_, finest.rows.size(), [&](int first, int end) {
    for (int i = first; i < end; ++i)
      finest.rhs[i] << (x.col(i) / scale).cast<float>().array(), 0.0f;
  });
  cycle(0, finest.rhs, finest.x);
  shareRows(pool_, finest.rows.size(), [&](int first, int end) {
    for (int i = first; i < end; ++i) {
      x.col(i) = scale * finest.x[i].head<3>().cast<double>().matrix();
    }
  });
}

/// x is about the solution of a level's matrix.
void Multigrid::cycle(std::size_t k, const PaddedVector& rhs, PaddedVector& x) {
  if (k + 1 == levels_.size()) return solveCoarsest(rhs, x);
  Level& level = levels_[k];
  const BlockRows& rows = level.rows;
  shareRows(pool_, rows.size(), [&](int first, int end) {
    for (int i = first; i < end; ++i) {
      const float damping = rows.isAlone(i) ? 1.0f : level.damping;
      x[i] = damping * rows.timesInverseDiagonal(i, rhs[i]);
    }
  });
  shareRows(pool_, rows.size(), [&](int first, int end) {
    for (int i = first; i < end; ++i) {
      level.residual[i] = rows.isAlone(i) ? Eigen::Array4f(Eigen::Array4f::Zero())
                                          : Eigen::Array4f(rhs[i] - rows.product(i, x));
    }
  });
  correctByCoarser(k, x);
  smooth(level, rhs, x);
}

/// Adds what the next coarser level finds for the residual.
void Multigrid::correctByCoarser(std::size_t k, PaddedVector& x) {
  Level& level = levels_[k];
  Level& coarser = levels_[k + 1];
  const Interpolation& restriction = level.restriction;
  shareRows(pool_, coarser.rows.size(), [&](int first, int end) {
    for (int i = first; i < end; ++i) {
      coarser.rhs[i].setZero();
      for (int m = restriction.begin[i]; m < restriction.begin[i + 1]; ++m) {
        coarser.rhs[i] += restriction.weights[m] * level.residual[restriction.columns[m]];
      }
    }
  });
  cycle(k + 1, coarser.rhs, coarser.x);
  if (k + 2 < levels_.size()) {
    shareRows(pool_, coarser.rows.size(), [&](int first, int end) {
      for (int i = first; i < end; ++i) coarser.rhs[i] -= coarser.rows.product(i, coarser.x);
    });
    cycle(k + 1, coarser.rhs, coarser.correction);
    shareRows(pool_, coarser.rows.size(), [&](int first, int end) {
      for (int i = first; i < end; ++i) coarser.x[i] += coarser.correction[i];
    });
  }
  const Interpolation& interpolation = level.interpolation;
  shareRows(pool_, level.rows.size(), [&](int first, int end) {
    for (int i = first; i < end; ++i) {
      if (level.rows.isAlone(i)) continue;
      for (int m = interpolation.begin[i]; m < interpolation.begin[i + 1]; ++m) {
        x[i] += interpolation.weights[m] * coarser.x[interpolation.columns[m]];
      }
    }
  });
}

void Multigrid::smooth(Level& level, const PaddedVector& rhs, PaddedVector& x) {
  const BlockRows& rows = level.rows;
  shareRows(pool_, rows.size(), [&](int first, int end) {
    for (int i = first; i < end; ++i) {
      level.next[i] = x[i];
      if (rows.isAlone(i)) continue;
      level.next[i] += level.damping * rows.timesInverseDiagonal(i, rhs[i] - rows.product(i, x));
    }
  });
  x.swap(level.next);
}

void Multigrid::solveCoarsest(const PaddedVector& rhs, PaddedVector& x) {
  const BlockRows& rows = levels_.back().rows;
  if (!factor_) {
    for (int i = 0; i < rows.size(); ++i) x[i] = rows.timesInverseDiagonal(i, rhs[i]);
    return;
  }
  for (int i = 0; i < rows.size(); ++i) {
    coarsest_vector_.col(i) = rhs[i].head<3>().cast<double>();
  }
  factor_->solve(coarsest_vector_);
  for (int i = 0; i < rows.size(); ++i) {
    x[i] << coarsest_vector_.col(i).cast<float>().array(), 0.0f;
  }
}

}  // namespace haptex::linear
