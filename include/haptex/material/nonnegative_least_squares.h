// Least squares whose unknowns must not be negative.
#pragma once

#include <Eigen/Core>

namespace haptex::material {

/// The x >= 0 that minimises |matrix x - right_side|, by the active set method of Lawson and Hanson
/// 1974, Solving Least Squares Problems, chapter 23.
/// @param matrix at least as many rows as columns @param right_side a number per row
/// @throws std::invalid_argument naming the sizes, or that a number is not finite;
///   std::runtime_error if rounding keeps the active set from settling
Eigen::VectorXd nonnegativeLeastSquares(const Eigen::MatrixXd& matrix,
                                        const Eigen::VectorXd& right_side);

}  // namespace haptex::material
