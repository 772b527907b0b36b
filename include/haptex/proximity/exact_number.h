// Numbers that are not rounded.
//
// Shewchuk, Adaptive precision floating-point arithmetic and fast robust geometric predicates,
// Discrete & Computational Geometry 18 (1997): a number is kept as a sum of doubles that do not
// overlap.
#pragma once

#include <cmath>
#include <vector>

namespace haptex::proximity {

/// What sums, differences and products of doubles are without rounding, as long as no product of
/// two of its parts leaves the range of a double: with factors of 0 or between 1e-60 and 1e60, up
/// to four of them may be multiplied. Its size grows with every operation: for decisions that
/// doubles cannot take, not for long calculations.
class ExactNumber {
 public:
  // Doubles are numbers of this kind, too.
  ExactNumber(double value = 0.0) {  // NOLINT(google-explicit-constructor)
    if (value != 0.0) parts_.push_back(value);
  }

  /// -1, 0 or 1.
  int sign() const { return parts_.empty() ? 0 : (parts_.back() > 0.0 ? 1 : -1); }
  /// The nearest double, or one of its neighbours.
  double rounded() const {
    double sum = 0.0;
    for (double part : parts_) sum += part;
    return sum;
  }

  ExactNumber operator-() const {
    ExactNumber result;
    for (double part : parts_) result.parts_.push_back(-part);
    return result;
  }
  friend ExactNumber operator+(const ExactNumber& a, const ExactNumber& b) {
    ExactNumber result = a;
    for (double part : b.parts_) result.add(part);
    return result;
  }
  friend ExactNumber operator-(const ExactNumber& a, const ExactNumber& b) { return a + -b; }
  friend ExactNumber operator*(const ExactNumber& a, const ExactNumber& b) {
    ExactNumber result;
    for (double x : a.parts_) {
      for (double y : b.parts_) {
        const double product = x * y;
        result.add(std::fma(x, y, -product));
        result.add(product);
      }
    }
    return result;
  }

 private:
  // GROW-EXPANSION, without the parts that are zero.
  void add(double value) {
    std::size_t kept = 0;
    double carried = value;
    for (double part : parts_) {
      const double sum = carried + part;
      const double of_part = sum - carried;
      const double error = (carried - (sum - of_part)) + (part - of_part);
      carried = sum;
      if (error != 0.0) parts_[kept++] = error;
    }
    parts_.resize(kept);
    if (carried != 0.0) parts_.push_back(carried);
  }

  std::vector<double> parts_;  // by magnitude, ascending, without zeros
};

}  // namespace haptex::proximity
