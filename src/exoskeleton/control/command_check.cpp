#include "haptex/exoskeleton/control/command_check.h"

#include <Eigen/Eigenvalues>
#include <sstream>

namespace haptex::exoskeleton {
namespace {

using Eigen::Matrix3d;

/// Whether the norm is at most this, without the overflow of its squares.
template <typename Numbers>
bool isWithin(const Numbers& numbers, double largest) {
  return numbers.cwiseAbs().maxCoeff() <= largest && numbers.norm() <= largest;
}

double asymmetry(const Matrix3d& matrix) { return (matrix - matrix.transpose()).norm(); }

double smallestEigenvalue(const Matrix3d& matrix) {
  // Scaled: the closed form of the eigenvalues takes third powers.
  const double scale = matrix.cwiseAbs().maxCoeff();
  if (scale == 0.0) return 0.0;
  Eigen::SelfAdjointEigenSolver<Matrix3d> solver;
  solver.computeDirect(0.5 / scale * (matrix + matrix.transpose()), Eigen::EigenvaluesOnly);
  return scale * solver.eigenvalues()[0];
}

bool isPassive(const Matrix3d& matrix) {
  const double tolerance = kMatrixTolerance * matrix.norm();
  return asymmetry(matrix) <= tolerance && smallestEigenvalue(matrix) >= -tolerance;
}

/// One field: its numbers as text, and what is said of them.
class Explanation {
 public:
  template <typename Numbers>
  void notFinite(const char* name, const Numbers& numbers) {
    if (numbers.allFinite()) return;
    say(name, numbers, ": allowed are finite numbers");
  }
  template <typename Numbers>
  void tooLarge(const char* name, const Numbers& numbers, double largest, const char* unit) {
    if (isWithin(numbers, largest)) return;
    std::ostringstream allowed;
    allowed << ": allowed are numbers of a norm up to " << largest << ' ' << unit;
    say(name, numbers, allowed.str());
  }
  void active(const char* name, const Matrix3d& matrix, const char* unit) {
    if (isPassive(matrix)) return;
    std::ostringstream allowed;
    const double tolerance = kMatrixTolerance * matrix.norm();
    if (asymmetry(matrix) > tolerance) {
      allowed << " differs from its transpose by " << asymmetry(matrix);
    } else {
      allowed << " has the eigenvalue " << smallestEigenvalue(matrix);
    }
    allowed << ' ' << unit << ": allowed are symmetric positive semidefinite matrices";
    say(name, matrix, allowed.str());
  }
  const std::string& text() const { return text_; }

 private:
  template <typename Numbers>
  void say(const char* name, const Numbers& numbers, const std::string& allowed) {
    if (!text_.empty()) return;
    std::ostringstream text;
    text << name << " = (" << numbers.template reshaped<Eigen::RowMajor>().transpose() << ")"
         << allowed;
    text_ = text.str();
  }
  std::string text_;
};

}  // namespace

CommandFlaw findFlaw(const ForceCommand& command) {
  if (!isFinite(command)) return CommandFlaw::kNotFinite;
  const bool possible = isWithin(command.force, kMaxCommandedForce) &&
                        isWithin(command.position, kFarthestPosition) &&
                        isWithin(command.velocity, kFastestVelocity) &&
                        isWithin(command.stiffness, kMaxCommandedStiffness) &&
                        isWithin(command.damping, kMaxCommandedDamping);
  if (!possible) return CommandFlaw::kTooLarge;
  const bool passive = isPassive(command.stiffness) && isPassive(command.damping);
  return passive ? CommandFlaw::kNone : CommandFlaw::kActive;
}

std::string explainFlaw(const ForceCommand& command) {
  Explanation why;
  const CommandFlaw flaw = findFlaw(command);
  if (flaw == CommandFlaw::kNotFinite) {
    why.notFinite("force", command.force);
    why.notFinite("position", command.position);
    why.notFinite("velocity", command.velocity);
    why.notFinite("stiffness", command.stiffness);
    why.notFinite("damping", command.damping);
  } else if (flaw == CommandFlaw::kTooLarge) {
    why.tooLarge("force", command.force, kMaxCommandedForce, "N");
    why.tooLarge("position", command.position, kFarthestPosition, "m");
    why.tooLarge("velocity", command.velocity, kFastestVelocity, "m/s");
    why.tooLarge("stiffness", command.stiffness, kMaxCommandedStiffness, "N/m");
    why.tooLarge("damping", command.damping, kMaxCommandedDamping, "N s/m");
  } else if (flaw == CommandFlaw::kActive) {
    why.active("stiffness", command.stiffness, "N/m");
    why.active("damping", command.damping, "N s/m");
  }
  return why.text();
}

}  // namespace haptex::exoskeleton
