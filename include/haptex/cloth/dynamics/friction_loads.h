// The normal forces that friction is taken from, of the same linear solve that it acts in.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace haptex::cloth {

/// Solves w = N(w), where w are the normal forces of the contacts that slip, by which friction
/// pushes, and N(w) those that result, which depend linearly on w, by generalised conjugate
/// residuals (Eisenstat, Elman and Schultz, SIAM J. Numer. Anal. 20, 1983). Taking N from the
/// solve before would sum up the Neumann series of the same problem. Every direction costs one
/// solve of the system with another right-hand side. Allocates nothing after construction.
class FrictionLoads {
 public:
  static constexpr int kMaxDirections = 12;

  /// @param most_contacts numbers of w, those that are not there zero
  /// @param solution_size numbers of a solution
  FrictionLoads(int most_contacts, int solution_size);

  /// @param loads w, N @param results N(w), N
  void begin(const Eigen::VectorXd& loads, const Eigen::VectorXd& results);

  /// Whether |N(w) - w| is still beyond `tolerance` |w|, and a direction may change that.
  bool wantsDirection(double tolerance) const;

  /// The change of w to try next, N.
  const Eigen::VectorXd& direction() const { return residual_; }

  /// @param results N's change by direction(), N
  /// @param change  of the solution by direction(); overwritten
  /// @param loads, solution  improved
  void add(const Eigen::VectorXd& results, Eigen::Ref<Eigen::VectorXd> change,
           Eigen::VectorXd& loads, Eigen::Ref<Eigen::VectorXd> solution);

  /// N(w) - w, N, of the loads as they are now.
  const Eigen::VectorXd& residual() const { return residual_; }

 private:
  int directions_ = 0;
  bool stalled_ = false;
  double loads_norm_ = 0.0;
  Eigen::VectorXd residual_;
  Eigen::MatrixXd steps_;      // of w, by direction
  Eigen::MatrixXd images_;     // of N - w, orthonormal
  Eigen::MatrixXd solutions_;  // of the solution
};

}  // namespace haptex::cloth
